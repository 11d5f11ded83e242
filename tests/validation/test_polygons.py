"""Simply supported polygons against harmonic expansions, whose errors are bounded by residuals at the rim.

Corners of 108 to 165 degrees, where moments are infinite as r^(pi / omega - 2).
"""

import warnings

import numpy as np
import polygons
import pytest

from fem_plate import Plate, PlateSection
from meshes import polygon, regular_polygon

UNIT = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0, density=1.0)
S = "simply-supported"
EVERY = [5, 12, pytest.param(24, marks=pytest.mark.slow)]


def plate(sides, cell_size):
    with warnings.catch_warnings(action="ignore"):  # that with so many sides it looks like a round one
        return Plate(regular_polygon(sides, 1.0, cell_size), UNIT, S)


def places(sides):
    """Points (n, 2) all over the plate, some close to a corner."""
    xy = np.random.default_rng(0).uniform(-1, 1, (900, 2))
    xy = xy[np.hypot(*xy.T) < 0.99 * np.cos(np.pi / sides)]
    return np.concatenate([xy[np.hypot(*xy.T) > 0.02], [[1 - d, 0.0] for d in (0.1, 0.01, 1e-3, 1e-5)]])


@pytest.mark.parametrize("sides", EVERY)
def test_regular_polygons_under_pressure_and_force(sides):
    xy, found = places(sides), plate(sides, 0.22)
    for load, deflection in (("pressure", found.pressure(1.0)), ("force", found.deflection([[0.0, 0.0]], 1.0))):
        exact = polygons.Polygon(sides, load)
        assert exact.residual < 1e-11
        w = exact.at(xy @ [1, 1j])
        error = np.abs(deflection.evaluate(xy)[0] - w).max() / np.abs(w).max()
        assert error < 4e-6
        assert error < 1e-11 or 0.2 < error / deflection.error_estimate < 5


def test_the_square_meets_its_tolerance_where_its_cells_alone_do_not():
    """Its functions are Argyris's alone, though w is like r^4 log r at a right angle."""
    xy, mesh = places(4), regular_polygon(4, 1.0, 0.15)
    w = polygons.Polygon(4, "pressure").at(xy @ [1, 1j])
    for tolerance, low, high in ((None, 1e-6, 2e-6), (1e-6, 0.0, 2e-7)):
        found = Plate(mesh, UNIT, S, tolerance).pressure(1.0)
        error = np.abs(found.evaluate(xy)[0] - w).max() / np.abs(w).max()
        assert low < error < high and error < 3 * found.error_estimate


def test_the_first_frequency_of_a_regular_polygon():
    modes = plate(6, 0.22).modes(1)
    assert 2 * np.pi * modes.frequencies[0] == pytest.approx(polygons.first_frequency(6), rel=5e-7)
    assert modes.error_estimate[0] < 2e-6


def test_the_first_frequency_of_a_hexagon_is_the_published_one():
    """R. S. Jones, Computing ultra-precise eigenvalues of the Laplacian within polygons, 2017: 7.15533913392..."""
    assert polygons.first_frequency(6) == pytest.approx(7.155339133926, rel=1e-9)


@pytest.mark.parametrize("sides", [12, pytest.param(24, marks=pytest.mark.slow)])
def test_estimates_with_a_tolerance_are_no_less_than_half_of_the_error(sides):
    """Where rounding of corner functions is most of it, finer cells gain little: estimates were 1/3 to 1/30 of it."""
    xy, exact = places(sides), polygons.Polygon(sides, "pressure")
    with warnings.catch_warnings(action="ignore"):
        found = Plate(regular_polygon(sides, 1.0, 1 / 6), UNIT, S, 1e-6).pressure(1.0)
    w = exact.at(xy @ [1, 1j])
    error = np.abs(found.evaluate(xy)[0] - w).max() / np.abs(w).max()
    assert error < 2 * found.error_estimate and found.error_estimate < 1e-6


@pytest.mark.parametrize(
    ("sides", "tension", "foundation"),
    [(6, 0.0, 100.0), pytest.param(8, -1.0, -10.0, marks=pytest.mark.slow)],
)
def test_modes_on_foundations_know_how_far_corners_take_them_off(sides, tension, foundation):
    """omega^2 rho t = D lam^2 + N lam + k, lam the membrane's; estimates were 3e3 to 2e5 times too small."""
    exact = polygons.first_frequency(sides)
    with warnings.catch_warnings(action="ignore"):
        found = Plate(regular_polygon(sides, 1.0, 0.5), UNIT, S, None, tension, foundation).modes(1)
    error = 2 * np.pi * found.frequencies[0] / np.sqrt(exact**2 + tension * exact + foundation) - 1
    assert 0.5 < abs(error) / found.error_estimate[0] < 2


@pytest.mark.parametrize("shape", ["convex", "re-entrant"])
def test_estimates_of_irregular_polygons(shape):
    """Against cells of a third of the size."""
    corners = {
        "convex": [(0, 0), (1.3, -0.2), (1.9, 0.6), (1.5, 1.4), (0.6, 1.7), (-0.2, 1.0)],
        "re-entrant": [(0, 0), (1, 0), (1, 1), (-1, 1), (-1, -1), (0, -1)],
    }[shape]
    coarse, fine = (Plate(polygon(corners, cell_size), UNIT, S).pressure(1.0) for cell_size in (0.3, 0.1))
    xy = fine.functions.space.points * fine.size
    exact = fine.evaluate(xy)[0]
    error = np.abs(coarse.evaluate(xy)[0] - exact).max() / np.abs(exact).max()
    assert error < 5e-5
    assert 0.2 < error / coarse.error_estimate < 5
