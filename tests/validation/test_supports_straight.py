"""Straight rims under every support: Navier, Levy and least-squares plates, and their singular corners.

Frequencies of the same rims are in test_frequencies.py.
"""

import goursat
import numpy as np
import pytest
from goursat_rim import polygon as loop
from plate_rectangles import levy_pressure, supported_force
from spots import scattered

from fem_plate import Plate, PlateSection
from meshes import polygon, rectangle

UNIT = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0)  # rigidity 1
C, S, F = "clamped", "simply-supported", "free"
SQUARE = np.array([-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j])
AROUND = ("bottom", "right", "top", "left")
SOURCE = (0.37, 0.21)
L_SHAPE = [(0, 0), (1, 0), (1, 1), (-1, 1), (-1, -1), (0, -1)]


# Series converge slowly on the rim.
FROM_RIM = 1e-3


def errors(mesh, supports, points, forces, pressure, truth):
    """Largest errors of w, gradient and Hessian over their largest values."""
    spots = scattered(mesh, points, from_rim=FROM_RIM)
    found = Plate(mesh, UNIT, supports).deflection(points, forces, pressure).evaluate(spots)
    return np.array([np.abs(f - t).max() / np.abs(t).max() for f, t in zip(found, truth(spots), strict=True)])


PRESSURE = np.empty((0, 2)), [], 1.0
FORCE = [SOURCE], [1.0], 0.0


def test_pressure_on_the_clamped_square():
    truth = goursat.solve([loop(SQUARE)], pressure=1.0, degree=25, poles=25).evaluate
    found = errors(rectangle(2.0, 2.0, 0.1), C, *PRESSURE, truth)
    assert (found < (2e-7, 5e-6, 2e-4)).all()


def test_the_centre_of_the_clamped_square():
    """0.00126532 q a^4 / D and 0.0056120 P a^2 / D (Timoshenko and Woinowsky-Krieger, tables 35 and 37, refined)."""
    plate = Plate(rectangle(1.0, 1.0, 0.05), UNIT)
    assert plate.pressure(1.0).evaluate([[0.0, 0.0]])[0][0] == pytest.approx(0.00126532, abs=6e-9)
    assert plate.deflection([[0.0, 0.0]], [1.0]).evaluate([[0.0, 0.0]])[0][0] == pytest.approx(0.0056120, abs=5e-8)


def test_a_force_on_the_clamped_square():
    truth = goursat.solve([loop(SQUARE)], [SOURCE], [1], degree=30, poles=30)
    found = errors(rectangle(2.0, 2.0, 0.12), C, *FORCE, truth.evaluate)
    assert truth.residual < 1e-8
    assert (found < (1e-6, 2e-5, 3e-4)).all()


def test_pressure_on_the_simply_supported_square():
    found = errors(rectangle(2.0, 2.0, 0.1), S, *PRESSURE, lambda xy: levy_pressure(xy, 2.0, 2.0))
    assert (found < (1e-7, 2e-6, 2e-4)).all()


@pytest.mark.parametrize("source", [SOURCE, (0.8, 0.85)])
def test_a_force_on_the_simply_supported_square(source):
    truth = [[source], [1.0], 0.0, lambda xy: supported_force(xy, source, 2.0, 2.0)]
    found = errors(rectangle(2.0, 2.0, 0.15), S, *truth)
    assert (found < (5e-7, 5e-6, 1e-4)).all()


@pytest.mark.parametrize("sides", [(C, C), (C, S), (S, S), (C, F), (S, F), (F, F)])
def test_pressure_on_rectangles_by_levy(sides):
    supports = {"left": S, "right": S, "bottom": sides[0], "top": sides[1]}
    found = errors(rectangle(2.0, 1.4, 0.075), supports, *PRESSURE, lambda xy: levy_pressure(xy, 2.0, 1.4, sides))
    assert (found < (2e-7, 3e-5, 4e-4)).all()


def test_order_where_a_free_side_meets_supported_ones():
    """The twist at the free side's ends is a force on the corners: without it the order is 2."""
    supports = {"left": S, "right": S, "bottom": S}
    rows = [
        errors(rectangle(2.0, 1.4, h), supports, *PRESSURE, lambda xy: levy_pressure(xy, 2.0, 1.4, (S, F)))
        for h in (0.3, 0.15, 0.075)
    ]
    orders = np.log2(rows[0] / rows[-1]) / 2
    assert (orders >= (3.5, 2.5, 2)).all()
    assert rows[0][0] < 2e-6 and rows[-1][0] < 1e-8


@pytest.mark.parametrize(
    "kinds",
    [
        (C, C, F, F),
        (C, S, S, F),
        *(pytest.param(kinds, marks=pytest.mark.slow) for kinds in ((C, F, F, F), (F, C, F, C), (S, C, S, C))),
    ],
    ids=lambda kinds: "-".join(kind[0] for kind in kinds),
)
def test_a_force_on_squares_of_mixed_supports(kinds):
    truth = goursat.solve([loop(SQUARE, list(kinds))], [SOURCE], [1], degree=30, poles=35)
    mesh = rectangle(2.0, 2.0, 0.15)
    found = errors(mesh, dict(zip(AROUND, kinds, strict=True)), *FORCE, truth.evaluate)
    assert truth.residual < 1e-7
    assert (found < (1e-6, 3e-5, 5e-4)).all()


def test_balanced_forces_on_the_free_square():
    four = np.array([[0.5, 0.15], [-0.3, 0.5], [-0.45, -0.25], [0.25, -0.6]])
    balanced = np.linalg.svd(np.column_stack([np.ones(4), four]).T)[2][3]
    mesh = rectangle(2.0, 2.0, 0.15)
    spots = scattered(mesh, four, from_rim=FROM_RIM)
    truth = goursat.solve([loop(SQUARE, F)], four, balanced, degree=35, poles=35)
    found = Plate(mesh, UNIT, F).deflection(four, balanced).evaluate(spots)
    rigid = np.column_stack([np.ones(len(spots)), spots])
    difference = found[0] - truth.evaluate(spots)[0]
    difference -= rigid @ np.linalg.lstsq(rigid, difference, rcond=None)[0]
    assert truth.residual < 1e-5  # of the shear, next to the corners
    assert np.abs(difference).max() < 1e-6 * np.ptp(found[0])


L_CELLS = 0.2, 0.1, 0.07


@pytest.fixture(scope="module")
def clamped_l():
    """Errors of the clamped L on three meshes, everywhere and in the Hessian away from the re-entrant corner."""
    corners = np.array(L_SHAPE) @ [1, 1j]
    truth = goursat.solve([loop(corners)], [(-0.5, -0.4)], [1], degree=20, poles=40)
    assert truth.residual < 2e-7
    rows = [errors(polygon(L_SHAPE, h), C, [(-0.5, -0.4)], [1.0], 0.0, truth.evaluate) for h in L_CELLS]
    return np.array(rows)


@pytest.mark.slow
def test_the_clamped_l_with_its_reentrant_corner(clamped_l):
    assert (clamped_l[-1] < (1e-6, 1e-5, 1e-3)).all()


@pytest.mark.slow
def test_order_of_the_clamped_l(clamped_l):
    """Against the fineness: w ~ r^1.54 alone would leave order 1.1 on cells that are not graded."""
    assert (np.log(clamped_l[0] / clamped_l[-1]) / np.log(L_CELLS[0] / L_CELLS[-1]) >= (4, 3.5, 2.5)).all()
