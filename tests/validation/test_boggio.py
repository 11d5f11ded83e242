"""Boggio's function (Boggio, 1905) as printed, in 40 digits:  G = (R ln(R/S) + S - R) / (16 pi),

R = |x - y|^2, S = |x|^2 |y|^2 - 2 x.y + 1 on the unit disc with rigidity 1.
"""

import numpy as np
import pytest

from fem_plate.analytic import disc_green

mpmath = pytest.importorskip("mpmath")

RADIUS, RIGIDITY = 300e-6, 1.9e-6
POINTS = [(0.1, 0.2), (-0.7, 0.3), (0.301, 0.099), (0.0, -0.99), (0.6, 0.75)]
SOURCES = [(0.3, 0.1), (0.0, 0.0), (-0.5, 0.8)]


def literal(x1, x2, y1, y2):
    big_r = (x1 - y1) ** 2 + (x2 - y2) ** 2
    big_s = (x1**2 + x2**2) * (y1**2 + y2**2) - 2 * (x1 * y1 + x2 * y2) + 1
    return (big_r * mpmath.log(big_r / big_s) + big_s - big_r) / (16 * mpmath.pi)


@pytest.mark.parametrize("source", SOURCES)
def test_value_gradient_and_hessian_are_those_of_the_printed_formula(source):
    w, gradient, hessian = disc_green(np.array(POINTS) * RADIUS, np.array(source) * RADIUS, RADIUS, RIGIDITY)
    with mpmath.workdps(40):

        def derivative(point, orders):
            x1, x2, y1, y2 = map(mpmath.mpf, (*point, *source))
            return float(mpmath.diff(lambda a, b: literal(a, b, y1, y2), (x1, x2), orders))

        table = {k: np.array([derivative(p, k) for p in POINTS]) for k in [(1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]}
        value = np.array([float(literal(*map(mpmath.mpf, (*p, *source)))) for p in POINTS])
    found = {
        (1, 0): gradient[:, 0],
        (0, 1): gradient[:, 1],
        (2, 0): hessian[:, 0, 0],
        (1, 1): hessian[:, 0, 1],
        (0, 2): hessian[:, 1, 1],
    }
    scale = RADIUS**2 / RIGIDITY
    # Close to the rim G is the small difference of terms of order 1 / (16 pi) = 0.02.
    assert np.abs(w / scale - value).max() < 5e-17
    for orders, expected in table.items():
        got = found[orders] / scale * RADIUS ** sum(orders)
        assert np.abs(got - expected).max() < 4e-17 + 4e-15 * np.abs(expected).max(), orders
    assert hessian[:, 0, 1] == pytest.approx(hessian[:, 1, 0], rel=1e-12)
