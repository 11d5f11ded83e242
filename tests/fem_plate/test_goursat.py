"""The least-squares plates against Boggio's function, closed forms, each other and the digits of the literature."""

import goursat
import numpy as np
import pytest
from goursat_rim import CLAMPED, FREE, SIMPLY_SUPPORTED, Arc, Piece, polygon

from fem_plate.analytic import disc_green

SQUARE = [0.5 + 0.5j, -0.5 + 0.5j, -0.5 - 0.5j, 0.5 - 0.5j]
NOTCHED = [0j, 1j, -1 + 1j, -1 - 1j, 1 - 1j, 1 + 0j]  # an L with a re-entrant corner at the origin
SPOTS = np.array([(0.0, 0.0), (0.1, 0.05), (-0.2, 0.3), (0.31, -0.44)])
CENTRE = [(0.0, 0.0)]


@pytest.mark.parametrize(("source", "degree"), [((0.0, 0.0), 20), ((0.5, 0.3), 60), ((0.0, -0.7), 100)])
def test_clamped_disc_is_boggios(source, degree):
    plate = goursat.solve([[Arc(0, (1, 1))]], [source], [1], degree=degree, poles=0)
    spots = SPOTS[1:]
    for found, expected in zip(plate.evaluate(spots), disc_green(spots, source, 1, 1), strict=True):
        assert np.abs(found - expected).max() < 1e-13
    assert plate.residual < 1e-13


def test_clamped_ellipse_under_pressure_is_the_closed_form():
    a, b = 1.0, 0.6
    x, y = SPOTS.T
    w, gradient, hessian = goursat.solve([[Arc(0, (a, b))]], pressure=2, degree=12, poles=0).evaluate(SPOTS)
    top, u = 2 / (24 / a**4 + 16 / (a * b) ** 2 + 24 / b**4), 1 - (x / a) ** 2 - (y / b) ** 2
    assert w == pytest.approx(top * u**2, rel=1e-12, abs=1e-16)
    assert gradient[:, 0] == pytest.approx(-4 * top * u * x / a**2, abs=1e-15)
    assert hessian[:, 0, 1] == pytest.approx(8 * top * x * y / (a * b) ** 2, abs=1e-14)


@pytest.mark.parametrize("inner", [CLAMPED, SIMPLY_SUPPORTED, FREE])
@pytest.mark.parametrize("outer", [CLAMPED, SIMPLY_SUPPORTED])
def test_annulus_is_that_of_its_logarithms(inner, outer):
    """Axisymmetric: the basis holds the exact solution in its first functions, so the fit must be exact."""
    rim = [[Arc(0.2 + 0.1j, (1, 1), outer)], [Arc(0.2 + 0.1j, (0.4, 0.4), inner, 0, -2 * np.pi)]]
    plate = goursat.solve(rim, pressure=1, degree=4, poles=0)
    angle = np.linspace(0, 2 * np.pi, 7)
    ring = plate.evaluate(np.stack([0.2 + 0.7 * np.cos(angle), 0.1 + 0.7 * np.sin(angle)], axis=1))[0]
    assert plate.residual < 1e-14 and np.ptp(ring) < 1e-15 and ring[0] > 1e-5


@pytest.mark.slow
def test_hole_off_the_centre_converges():
    rim = [[Arc(0, (1, 0.8), CLAMPED)], [Arc(0.2 + 0.1j, (0.3, 0.2), FREE, 0, -2 * np.pi)]]
    spots = [(0.6, 0.1), (-0.5, 0.2)]
    coarse, fine = (goursat.solve(rim, [(-0.4, -0.1)], [1], degree=n, poles=0) for n in (60, 100))
    assert np.abs(coarse.evaluate(spots)[0] - fine.evaluate(spots)[0]).max() < 1e-9
    assert fine.residual < 2e-8


@pytest.mark.parametrize(
    ("support", "force", "pressure", "digits"),
    [
        # Timoshenko & Woinowsky-Krieger, tables 8, 23, 35 and 37, with the digits of later work.
        (CLAMPED, 1, 0, (0.0056120, 5e-8)),
        (CLAMPED, 0, 1, (0.00126532, 5e-9)),
        (SIMPLY_SUPPORTED, 1, 0, (0.0116008, 5e-8)),
        (SIMPLY_SUPPORTED, 0, 1, (0.00406235, 5e-9)),
    ],
)
def test_centre_of_the_square(support, force, pressure, digits):
    found = [
        goursat.solve([polygon(SQUARE, support)], CENTRE, [force], pressure, degree=n, poles=n).evaluate(CENTRE)[0][0]
        for n in (10, 20)
    ]
    assert found[1] == pytest.approx(digits[0], abs=digits[1])
    assert found[0] == pytest.approx(found[1], abs=1e-10)


@pytest.mark.parametrize(
    "supports",
    [
        (CLAMPED, SIMPLY_SUPPORTED, CLAMPED, SIMPLY_SUPPORTED),
        (CLAMPED, FREE, SIMPLY_SUPPORTED, FREE),
        (FREE, CLAMPED, CLAMPED, FREE),
        (FREE, FREE, FREE, CLAMPED),
    ],
)
def test_mixed_square_converges_and_is_reciprocal(supports):
    rim, (a, b) = [polygon(SQUARE, supports)], SPOTS[1:3]
    coarse = goursat.solve(rim, [a], [1], degree=12, poles=15).evaluate([b])[0][0]
    there, back = (goursat.solve(rim, [p], [1], degree=18, poles=25).evaluate([q])[0][0] for p, q in [(a, b), (b, a)])
    assert there == pytest.approx(back, rel=1e-6)
    assert coarse == pytest.approx(there, rel=1e-4)


@pytest.mark.slow
def test_clamped_l_with_its_reentrant_corner():
    spots = [(-0.3, 0.5), (-0.5, -0.4), (-0.03, -0.02)]
    coarse, fine = (
        goursat.solve([polygon(NOTCHED)], [(-0.5, -0.4)], [1], degree=n, poles=p) for n, p in [(15, 25), (20, 35)]
    )
    assert np.abs(coarse.evaluate(spots)[0] - fine.evaluate(spots)[0]).max() < 1e-8
    assert fine.residual < 2e-6


def test_a_strip_with_free_sides_is_a_beam_but_for_poissons_ratio():
    sides = (FREE, SIMPLY_SUPPORTED, FREE, SIMPLY_SUPPORTED)
    loose, stiff = (
        goursat.solve([polygon(SQUARE, sides)], pressure=1, nu=nu, degree=15, poles=20) for nu in (0.0, 0.3)
    )
    x = np.array([-0.3, 0.1])  # without Poisson's effect it is a beam: (5 - 24 x^2 + 16 x^4) / 384
    edge = np.stack([x, [0.5, 0.2]], axis=1)
    values = [p.evaluate(edge)[0] for p in (loose, stiff)]
    assert values[0] == pytest.approx((5 - 24 * x**2 + 16 * x**4) / 384, rel=1e-9)
    assert abs(values[1] - values[0]).max() > 1e-4


def test_influence_is_one_at_its_point_and_zero_at_the_others():
    points = SPOTS[:3]
    for support, tolerance in [(CLAMPED, 1e-8), (FREE, 1e-6)]:
        four = SPOTS if support == FREE else points
        shapes = goursat.influence([polygon(SQUARE, support)], four, degree=12, poles=12)
        heights = np.stack([s.evaluate(four)[0] for s in shapes])
        assert np.abs(heights - np.eye(len(four))).max() < tolerance
        if support == FREE:
            assert all(abs(s.forces.sum()) < 1e-8 * np.abs(s.forces).max() for s in shapes)


def test_a_square_of_two_halves_is_the_square():
    """A joint on a straight side, where nothing happens, changes nothing."""
    halves = [Piece(0.5j, -0.5 + 0.5j), *polygon(SQUARE)[1:], Piece(0.5 + 0.5j, 0.5j)]
    a, b = (goursat.solve([rim], CENTRE, [1], degree=15, poles=15) for rim in (halves, polygon(SQUARE)))
    assert np.abs(a.evaluate(SPOTS)[0] - b.evaluate(SPOTS)[0]).max() < 1e-9


def test_a_free_reentrant_corner_is_refused():
    with pytest.raises(ValueError, match="^Input loops of Rim must turn left at a free corner; got a turn by -1.57"):
        goursat.solve([polygon(NOTCHED, FREE)], degree=4, poles=4)
