"""Integrals of powers over a Gaussian, against mpmath or scipy in closed form."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import gamma, pbdv

from particle.friction.quadrature import from_power, gaussian, on_panels


@pytest.mark.parametrize("d", [0.0, 1.0, 3.0])
@pytest.mark.parametrize("power", [0.093, 0.982, 1.5, 4.425])
def test_the_full_tail_is_a_parabolic_cylinder_function(power, d):
    """int_0^inf x^b exp(-(d + x)^2 / 2) dx = Gamma(b + 1) exp(-d^2/4) D_{-b-1}(d), (Gradshteyn and Ryzhik 3.462)."""
    expected = gamma(power + 1) * math.exp(-d * d / 4) * pbdv(-power - 1, d)[0] / math.sqrt(2 * math.pi)
    assert from_power(np.array([d]), power, 0, math.inf, 1.0, 1.0)[0] == pytest.approx(expected, rel=1e-11)


def test_ranges_add_up():
    d = np.array([0.3, 2.0])
    parts = from_power(d, 1.425, 0, 1, 0.2, 0.9) + from_power(d, 1.425, 1, math.inf, 0.2, 0.9)
    assert parts == pytest.approx(from_power(d, 1.425, 0, math.inf, 0.2, 0.9), rel=1e-13)


def test_the_unit_of_x_is_a_change_of_variable():
    d = np.array([1.1])
    small = 0.05**1.5 * 0.05 * from_power(d, 1.5, 0, 20, 0.05, 0.9)
    assert small == pytest.approx(from_power(d, 1.5, 0, 1, 1.0, 0.9), rel=1e-13)


def test_each_separation_is_integrated_on_its_own():
    d = np.array([0.0, 5.0, 2.0])
    together = from_power(d, 0.298, 0, 6, 0.15, 0.95)
    alone = [from_power(d[[i]], 0.298, 0, 6, 0.15, 0.95)[0] for i in range(3)]
    assert together == pytest.approx(alone, rel=1e-12)


@pytest.mark.parametrize("d", [0.0, 2.5])
def test_a_gap_of_eps_to_infinity_is_integrated_to_rounding(d):
    eps, width = 0.015, 0.95

    def f(x):
        return ((eps / x) ** 2 - 0.25 * (eps / x) ** 8) * float(gaussian(np.array(d - (x - eps)), width))

    edges = np.append(eps * 2.0 ** np.arange(10), [d + 4, d + 12])
    expected = math.fsum(quad(f, a, b, epsabs=0, epsrel=1e-13)[0] for a, b in zip(edges[:-1], edges[1:], strict=True))
    assert on_panels(np.array([d]), eps, width)[0] == pytest.approx(expected, rel=1e-12)
