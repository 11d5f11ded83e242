"""Actuators that all but coincide: shapes against Boggio's function in 50 digits, and what their estimate says."""

import mpmath
import numpy as np
import pytest

from fem_plate import Plate
from fem_plate.elements import source_basis
from fem_plate.elements.infinite import IsotropicPlate
from meshes import disc

FAR = [-0.5, 0.2]
PLACES = [[0.3, 0.1], [0.0, 0.0]]


def green(x, y):
    """Boggio's function on the unit disc with rigidity 1, of points with mpmath's coordinates."""
    R = sum((a - b) ** 2 for a, b in zip(x, y, strict=True))
    S = sum(a * a for a in x) * sum(b * b for b in y) - 2 * sum(a * b for a, b in zip(x, y, strict=True)) + 1
    return ((R * mpmath.log(R / S) if R else 0) + S - R) / (16 * mpmath.pi)


def exact_shapes(points, xy, radius):
    with mpmath.workdps(50):
        sources, targets = (
            [[mpmath.mpf(float(c)) / mpmath.mpf(radius) for c in row] for row in p] for p in (points, xy)
        )
        forces = mpmath.matrix([[green(a, b) for b in sources] for a in sources]) ** -1
        values = mpmath.matrix([[green(a, b) for b in sources] for a in targets]) * forces
    return np.array(values.tolist(), dtype=float)


def compared(section, radius, points):
    """The largest error of each shape, and the estimate of all; both relative to the largest deflection."""
    points = np.array(points) * radius
    shapes = Plate(disc(radius, radius / 8), section, tolerance=1e-8).influence(points)
    angle, r = np.linspace(0, 40, 25), 0.97 * radius * np.sqrt(np.linspace(0.01, 1, 25))
    xy = np.concatenate([np.column_stack([r * np.cos(angle), r * np.sin(angle)]), points])
    exact = exact_shapes(points, xy, radius)
    return np.abs(shapes.values(xy) - exact).max(axis=0) / np.abs(exact).max(axis=0), shapes.error_estimate


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("apart", [1e-2, 1e-4, 1e-6, 1e-7, 1e-8])
def test_the_estimate_tells_of_actuators_that_all_but_coincide(section, radius, place, apart):
    second = np.add(place, np.multiply(apart, [0.8, 0.6]))
    errors, estimate = compared(section, radius, [place, second, FAR])
    assert 0.1 < errors.max() / estimate < 10
    assert errors.max() < 2e-9 + 2e-15 / apart


@pytest.mark.slow
def test_two_pairs_and_a_group_of_three_are_as_exact(section, radius):
    apart = 1e-7
    pair = np.add(PLACES[1], [[0, 0], [apart, 0]])
    group = np.add(FAR, [[0, 0], [0, 2 * apart], [apart, apart]])
    errors, estimate = compared(section, radius, [*pair, *group])
    assert errors.max() < 1e-7 and 0.1 < errors.max() / estimate < 10


def test_springs_and_forces_beside_a_close_pair_act_as_without_it(section, radius):
    """Two springs on almost the same point are one with both stiffnesses, and raise it by their share."""
    plate, apart = Plate(disc(radius, radius / 8), section), 1e-8
    points = np.array([PLACES[0], np.add(PLACES[0], [apart, 0]), FAR, [0.1, -0.6]]) * radius
    pair = plate.influence(points, [30.0, 90.0, np.inf, 0.0])
    one = plate.influence(points[[0, 2, 3]], [120.0, np.inf, 0.0])
    xy = np.array([[0.1, 0.2], [-0.3, -0.3], [0.3, 0.5]]) * radius
    expected = one.values(xy)
    assert pair.values(xy) == pytest.approx(expected[:, [0, 0, 1, 2]] * [0.25, 0.75, 1, 1], rel=2e-6)
    compliance = pair.compliance
    assert compliance[[0, 2, 3]][:, [0, 2, 3]] == pytest.approx(one.compliance, rel=1e-8)


def test_actuators_that_are_not_close_are_taken_as_they_are():
    x = np.array([PLACES[0], FAR, [0.301, 0.2]])
    basis = source_basis(x, np.array([True, True, True]))
    assert (basis.matrix.toarray() == np.eye(3)).all() and basis.rounding == 0
    assert (basis.point_values(IsotropicPlate()) == IsotropicPlate().point_value(x, x)).all()
