"""The references among themselves: closed forms, series, Goursat's fits, Bessel and Levy roots, Ritz, and limits."""

import goursat
import numpy as np
import plate_modes as modes
import pytest
from goursat_rim import Arc, polygon
from plate_rectangles import levy_pressure, supported_force
from plate_theory import annulus_pressure, clamped_ellipse_pressure, disc_central_force, disc_force, disc_pressure

from fem_plate.analytic import disc_green

C, S, F = "clamped", "simply-supported", "free"
SPOTS = np.array([(0.1, 0.2), (-0.5, 0.3), (0.2, -0.8), (0.95, 0.1)])
SMALL = np.array([(0.1, 0.2), (-0.4, 0.3), (0.2, -0.34), (0.5, 0.1)])
OBLONG = [0.5 + 0.4j, -0.5 + 0.4j, -0.5 - 0.4j, 0.5 - 0.4j]
SQUARE = [0.5 + 0.5j, -0.5 + 0.5j, -0.5 - 0.5j, 0.5 - 0.5j]


def difference(fields, expected):
    """Largest differences of w, gradient and Hessian."""
    return np.array([np.abs(a - b).max() for a, b in zip(fields, expected, strict=True)])


def test_clamped_ellipse_is_goursats_and_the_disc_in_the_limit():
    rim = [[Arc(0, (1, 0.6))]]
    inner = SPOTS * 0.6
    plate = goursat.solve(rim, pressure=1, degree=8, poles=0)
    assert difference(clamped_ellipse_pressure(inner, 1, 0.6), plate.evaluate(inner)).max() < 1e-14
    assert difference(clamped_ellipse_pressure(SPOTS, 1, 1), disc_pressure(SPOTS, 1, C)).max() < 1e-16


@pytest.mark.parametrize("support", [C, S])
def test_disc_under_pressure(support):
    plate = goursat.solve([[Arc(0, (2, 2), support)]], pressure=1, nu=0.2, degree=6, poles=0)
    assert difference(disc_pressure(SPOTS, 2, support, 0.2), plate.evaluate(SPOTS)).max() < 1e-13


@pytest.mark.parametrize("support", [C, S, F])
def test_disc_under_a_central_force(support):
    pressure = -1 / (4 * np.pi) if support == F else 0.0
    plate = goursat.solve([[Arc(0, (2, 2), support)]], [(0, 0)], [1], pressure, nu=0.2, degree=6, poles=0)
    w, gradient, hessian = plate.evaluate(np.vstack([SPOTS, [(0, 0)]]))
    if support == F:  # up to a rigid motion
        tilt = gradient[-1]
        w, gradient = w - w[-1] - np.vstack([SPOTS, [(0, 0)]]) @ tilt, gradient - tilt
    assert difference(disc_central_force(SPOTS, 2, support, 0.2), (w[:4], gradient[:4], hessian[:4])).max() < 1e-13


@pytest.mark.parametrize("source", [(0.0, 0.0), (0.5, 0.3), (-0.2, 0.75)])
def test_disc_under_any_force(source):
    assert difference(disc_force(SPOTS, source, C), disc_green(SPOTS, source, 1, 1)).max() < 1e-15
    plate = goursat.solve([[Arc(0, (1, 1), S)]], [source], [1], nu=0.2, degree=125, poles=0)
    assert difference(disc_force(SPOTS, source, S, 0.2), plate.evaluate(SPOTS)).max() < 1e-13
    # An edge that turns freely is the softer the smaller nu; a clamped one does not know it.
    assert (disc_force(SPOTS[:2], source, S, 0.0)[0] > disc_force(SPOTS[:2], source, S, 0.3)[0]).all()


@pytest.mark.parametrize("supports", [(i, o) for i in (C, S, F) for o in (C, S, F) if (i, o) != (F, F)])
def test_annulus_under_pressure(supports):
    rim = [[Arc(0, (1, 1), supports[1])], [Arc(0, (0.2, 0.2), supports[0], 0, -2 * np.pi)]]
    plate = goursat.solve(rim, pressure=1, degree=6, poles=0)
    assert difference(annulus_pressure(SPOTS, 0.2, 1, supports), plate.evaluate(SPOTS)).max() < 2e-13


def test_annulus_with_a_tiny_free_hole_is_the_disc():
    """The hole's effect falls like its area."""
    big, small = (
        difference(annulus_pressure(SPOTS, r, 1, (F, S))[:1], disc_pressure(SPOTS, 1, S)[:1]) for r in (1e-2, 1e-3)
    )
    assert small < 1e-6 and big / small == pytest.approx(100, rel=0.05)


@pytest.mark.parametrize("source", [(0.0, 0.0), (0.1, 0.05), (-0.45, 0.3)])
def test_supported_rectangle_under_a_force(source):
    plate = goursat.solve([polygon(OBLONG, S)], [source], [1], degree=20, poles=25)
    w, gradient, _ = difference(supported_force(SMALL, source, 1, 0.8), plate.evaluate(SMALL))
    assert w < 2e-8 and gradient < 1e-6 and w < plate.residual
    turned = supported_force(SMALL[:, ::-1], source[::-1], 0.8, 1)
    found = supported_force(SMALL, source, 1, 0.8)
    assert turned[0] == pytest.approx(found[0], abs=1e-15)
    assert turned[1][:, ::-1] == pytest.approx(found[1], abs=1e-14)
    assert turned[2][:, ::-1, ::-1] == pytest.approx(found[2], abs=1e-13)


def test_supported_square_has_the_digits_of_timoshenko():
    assert supported_force([(0, 0)], (0, 0), 1, 1)[0][0] == pytest.approx(0.0116008, abs=5e-8)
    assert levy_pressure([(0, 0)], 1, 1)[0][0] == pytest.approx(0.00406235, abs=5e-9)
    strip = 7 * 1.2020569031595942 / (16 * np.pi**3)  # Nadai: a^2 sum over odd m of m^-3, over 2 pi^3
    assert supported_force([(0, 0)], (0, 0), 1, 60)[0][0] == pytest.approx(strip, rel=1e-14)


@pytest.mark.parametrize("supports", [(S, S), (C, C), (F, F), (C, F), (S, F), (S, C)])
def test_levys_rectangle_under_pressure(supports):
    bottom, top = supports
    plate = goursat.solve([polygon(OBLONG, [top, S, bottom, S])], pressure=1, degree=18, poles=20)
    found = difference(levy_pressure(SMALL, 1, 0.8, supports), plate.evaluate(SMALL))
    assert (found < [1e-9, 1e-8, 1e-7]).all()


def test_first_frequencies_of_discs():
    """Leissa, chapter 2 (free: nu = 0.33); its 4.977 is 0.8 % too high. A clamped rim does not know nu."""
    assert modes.disc(C, 4) == pytest.approx([10.2158, 21.26, 21.26, 34.88], rel=1e-3)
    assert modes.disc(S, 4) == pytest.approx([4.977, 13.94, 13.94, 25.65], rel=1e-2)
    assert modes.disc(F, 5, nu=0.33) == pytest.approx([5.253, 5.253, 9.084, 12.23, 12.23], rel=2e-3)
    assert modes.disc(C, 4, nu=0.0) == pytest.approx(modes.disc(C, 4, nu=0.4), rel=1e-14)


@pytest.mark.parametrize("support", [C, S])
def test_a_held_centre_by_bessel_is_the_sum_over_all_modes(support):
    """0 = sum shapes^2 / (omega^2 - lambda) over the axisymmetric modes, which `modes.held` sums from scratch."""
    roots = np.array(modes._disc_roots(support, 0, 24, 0.3, False))
    k = np.sqrt(roots)
    r, w = np.polynomial.legendre.leggauss(200)
    r, w = (r + 1) / 2, w / 2

    def mode(r):
        ratio = modes.jv(0, k) / modes.ive(0, k)  # w = 0 at the rim
        return modes.jv(0, np.outer(r, k)) - ratio * modes.ive(0, np.outer(r, k)) * np.exp(-np.outer(1 - r, k))

    shapes = mode(np.zeros(1))[0] / np.sqrt(2 * np.pi * (w * r) @ mode(r) ** 2)
    origin, rings = np.zeros((1, 2)), np.stack([r, 0 * r], axis=1)
    second = 2 * np.pi * (w * r) @ disc_central_force(rings, 1, support)[0] ** 2
    compliance = disc_central_force(origin, 1, support)[0][0]
    found = modes.held(roots, shapes, compliance, 2, second)
    assert modes._disc_roots(support, 0, 2, 0.3, True)[:2] == pytest.approx(found, rel=2e-8)


@pytest.mark.parametrize("supports", [(S, S), (C, C), (F, F), (C, F), (S, F), (S, C)])
def test_levys_frequencies_are_ritzs(supports):
    ritz = modes.ritz_rectangle(1, 0.8, (S, S, *supports), 18)[0]
    assert modes.levy_rectangle(1, 0.8, supports, 6) == pytest.approx(ritz[:6], rel=1e-10)
    if supports == (S, S):
        assert modes.supported_rectangle(1, 0.8, 6) == pytest.approx(ritz[:6], rel=1e-12)


def test_clamped_and_free_square_converge_to_the_digits_of_the_literature():
    """Leissa, "The free vibration of rectangular plates", J. Sound Vib. 31 (1973), and later, sharper bounds."""
    clamped = [modes.ritz_rectangle(1, 1, [C] * 4, n)[0][:4] for n in (20, 28)]
    assert clamped[1] == pytest.approx([35.98519, 73.39385, 73.39385, 108.21650], abs=6e-6)
    assert clamped[0] == pytest.approx(clamped[1], rel=1e-10)
    free = [modes.ritz_rectangle(1, 1, [F] * 4, n)[0][:8] for n in (20, 28)]
    assert free[1][3:] == pytest.approx([13.4682, 19.5961, 24.2702, 34.8009, 34.8009], abs=5e-5)
    assert free[0][3:] == pytest.approx(free[1][3:], rel=1e-8)
    assert free[1][:3].max() < 1e-3


def test_modes_have_mass_one():
    s, w = np.polynomial.legendre.leggauss(40)
    x, y = np.meshgrid(s / 2, s * 0.4, indexing="ij")
    values = modes.ritz_rectangle(1, 0.8, (C, F, S, C), 12)[1](np.stack([x.ravel(), y.ravel()], axis=1))[:, :5]
    mass = values.T @ (np.outer(w, w).ravel()[:, None] * 0.2 * values)
    assert np.abs(mass - np.eye(5)).max() < 1e-11


def test_supported_square_with_its_centre_held():
    compliance = supported_force([(0, 0)], (0, 0), 1, 1)[0][0]
    found = modes.held_supported_rectangle(1, 1, (0, 0), compliance, 6)
    coarse = modes.held_supported_rectangle(1, 1, (0, 0), compliance, 6, terms=75)
    assert found == pytest.approx(coarse, rel=1e-9)
    free = modes.supported_rectangle(1, 1, 12)
    assert found[[0, 1, 3, 4]] == pytest.approx(free[[1, 2, 3, 4]], rel=1e-12)  # these do not move the centre
    assert found[2] == pytest.approx(52.6185073813, rel=1e-10)
    assert free[0] < found[2] < free[5]


def test_clamped_square_with_its_centre_held():
    """The compliance from Goursat's fit, the modes from Ritz: 78.5744276."""
    plate = goursat.solve([polygon(SQUARE)], [(0, 0)], [1], degree=20, poles=20)
    s, w = np.polynomial.legendre.leggauss(20)
    x, y = np.meshgrid((s + 1) / 4, (s + 1) / 4)
    quarter = plate.evaluate(np.stack([x.ravel(), y.ravel()], axis=1))[0]
    second = np.outer(w, w).ravel() @ quarter**2 / 4
    compliance, found = plate.evaluate([(0, 0)])[0][0], []
    for degree in (16, 26):
        omega, shapes = modes.ritz_rectangle(1, 1, [C] * 4, degree)
        found.append(modes.held(omega, shapes([(0, 0)])[0], compliance, 4, second))
    assert found[0] == pytest.approx(found[1], rel=1e-7)
    assert found[1][2] == pytest.approx(78.5744276, rel=2e-8)
    assert found[1][:2] == pytest.approx([73.393845524, 73.393845524], rel=1e-10)
