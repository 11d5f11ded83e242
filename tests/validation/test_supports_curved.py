"""Curved rims under every support against closed forms (S. P. Timoshenko and S. Woinowsky-Krieger, 1959).

Frequencies of the same rims are in test_frequencies.py.
"""

import goursat
import numpy as np
import plate_theory as theory
import pytest
from goursat_rim import Arc
from spots import scattered

from fem_plate import Plate, PlateSection
from meshes import annulus, disc, ellipse

UNIT = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0)  # rigidity 1
C, S, F = "clamped", "simply-supported", "free"
SOURCE = (0.4, 0.2)


def errors(mesh, supports, points, forces, pressure, truth, nu=0.3):
    """Largest errors of w, gradient and Hessian over their largest values."""
    section = PlateSection(12 * (1 - nu**2), nu, 1.0)
    spots = scattered(mesh, points)
    found = Plate(mesh, section, supports).deflection(points, forces, pressure).evaluate(spots)
    return np.array([np.abs(f - t).max() / np.abs(t).max() for f, t in zip(found, truth(spots), strict=True)])


PRESSURE = np.empty((0, 2)), [], 1.0


@pytest.mark.parametrize("support", [C, S])
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45])
def test_pressure_on_the_disc_is_a_polynomial(support, nu):
    found = errors(disc(1.0, 0.4), support, *PRESSURE, lambda xy: theory.disc_pressure(xy, 1.0, support, nu), nu)
    assert (found < (1e-12, 1e-11, 1e-10)).all()


@pytest.mark.parametrize("support", [C, S, F])
def test_a_central_force_on_the_disc(support):
    """On the free disc against a pressure; there the deflection's mean is taken away."""

    def truth(xy):
        w, gradient, hessian = theory.disc_central_force(xy, 1.0, support)
        if support == F:
            r, weights = np.polynomial.legendre.leggauss(40)
            ring = (r + 1) / 2  # r^2 over the disc is uniform
            values = theory.disc_central_force(np.stack([np.sqrt(ring), 0 * ring], axis=1), 1.0, F)[0]
            w = w - weights @ values / 2
        return w, gradient, hessian

    pressure = -1 / np.pi if support == F else 0.0
    found = errors(disc(1.0, 0.3), support, [(0, 0)], [1.0], pressure, truth)
    assert found[0] < (1e-5 if support == F else 1e-11)  # the mean's quadrature sees the logarithm
    assert (found[1:] < (1e-10, 1e-9)).all()


@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_a_force_off_the_centre_of_the_simply_supported_disc(nu):
    found = errors(disc(1.0, 0.15), S, [SOURCE], [1.0], 0.0, lambda xy: theory.disc_force(xy, SOURCE, S, nu), nu)
    assert (found < (1e-8, 2e-7, 3e-6)).all()


@pytest.mark.parametrize("support", [C, S])
def test_orders_of_the_disc(support):
    rows = [
        errors(disc(1.0, 1 / k), support, [SOURCE], [1.0], 0.0, lambda xy: theory.disc_force(xy, SOURCE, support))
        for k in (4, 8, 13)
    ]
    orders = np.log(rows[0] / rows[-1]) / np.log(13 / 4)
    assert (orders >= (5.3, 4.5, 3.5)).all()


def test_pressure_on_the_clamped_ellipse_is_a_polynomial():
    for a, b in ((1.0, 0.6), (0.4, 1.0)):
        mesh = ellipse(a, b, 0.3)
        found = errors(mesh, C, *PRESSURE, lambda xy, a=a, b=b: theory.clamped_ellipse_pressure(xy, a, b))
        assert (found < (1e-11, 1e-10, 1e-9)).all()


@pytest.mark.slow
def test_a_force_on_ellipses_of_every_support():
    """Against the least-squares plate, up to a rigid motion on the free one, where four forces balance."""
    four = np.array([[0.5, 0.15], [-0.3, 0.3], [-0.45, -0.25], [0.25, -0.35]])
    balanced = np.linalg.svd(np.column_stack([np.ones(4), four]).T)[2][3]
    mesh = ellipse(1.0, 0.6, 0.075)
    for support in (C, S, F):
        spots = scattered(mesh, four)
        plate = goursat.solve([[Arc(0, (1, 0.6), support)]], four, balanced, degree=100, poles=0)
        truth = plate.evaluate(spots)
        assert plate.residual < 1e-9
        found = Plate(mesh, UNIT, support).deflection(four, balanced).evaluate(spots)
        difference = found[0] - truth[0]
        if support == F:
            rigid = np.column_stack([np.ones(len(spots)), spots])
            difference = difference - rigid @ np.linalg.lstsq(rigid, difference, rcond=None)[0]
        assert np.abs(difference).max() < 1e-6 * np.ptp(truth[0])
        assert np.abs(found[2] - truth[2]).max() < 1e-4 * np.abs(truth[2]).max()


@pytest.mark.parametrize("inner, outer", [(i, o) for i in (C, S, F) for o in (C, S, F) if C in (i, o) or S in (i, o)])
def test_pressure_on_the_annulus(inner, outer):
    mesh, supports = annulus(0.4, 1.0, 0.12), {"inner": inner, "outer": outer}
    found = errors(mesh, supports, *PRESSURE, lambda xy: theory.annulus_pressure(xy, 0.4, 1.0, (inner, outer)))
    assert (found < (1e-6, 1e-5, 3e-4)).all()


def test_orders_of_the_annulus():
    rows = [
        errors(
            annulus(0.4, 1.0, h),
            {"inner": F, "outer": S},
            *PRESSURE,
            lambda xy: theory.annulus_pressure(xy, 0.4, 1.0, (F, S)),
        )
        for h in (0.4, 0.1)
    ]
    orders = np.log2(rows[0] / rows[-1]) / 2
    assert (orders >= (5, 4, 3)).all()


@pytest.mark.slow
def test_an_off_centre_force_on_an_annulus():
    rim = [[Arc(0, (1, 1), S)], [Arc(0, (0.3, 0.3), C, 0, -2 * np.pi)]]
    truth = goursat.solve(rim, [(0.6, 0.2)], [1], degree=120, poles=0)
    supports = {"inner": C, "outer": S}
    found = errors(annulus(0.3, 1.0, 0.12), supports, [(0.6, 0.2)], [1.0], 0.0, truth.evaluate)
    assert truth.residual < 1e-8
    assert (found < (1e-6, 1e-5, 3e-4)).all()
