"""Meshes that once gave wrong plates: flat cells, cells far from the origin, rims in pieces or the wrong way round."""

from __future__ import annotations

import numpy as np
import pytest

from fem_plate import Plate, PlateSection
from meshes import Circle, PlateMesh, disc, polygon, rectangle

UNIT = PlateSection(12 * (1 - 0.3**2), 0.3, 1.0)


def moved(mesh: PlateMesh, by: float) -> PlateMesh:
    return PlateMesh(mesh.points + by, mesh.triangles, mesh.boundaries)


@pytest.mark.parametrize("support", ["clamped", "simply-supported"])
@pytest.mark.parametrize("degrees", [5, 15])
def test_flat_cells_leave_the_plate_stiff(degrees, support):
    """Nitsche's weights go by the height of a rim cell; by the edge's length the matrix was indefinite."""
    wedge = polygon([[0, 0], [1, 0], [1, np.tan(np.radians(degrees))]], 0.2)
    matrix = Plate(wedge, UNIT, support).model().space.stiffness(UNIT.law).toarray()
    scale = 1 / np.sqrt(np.diagonal(matrix))
    assert np.linalg.eigvalsh(scale[:, None] * matrix * scale).min() > 0


def test_flat_boxes_are_solved():
    box = rectangle(1.0, 1.0, 0.1)
    flat = PlateMesh(box.points * [1.0, 0.2], box.triangles, box.boundaries)
    square = rectangle(1.0, 0.2, 0.02)
    middles = [Plate(mesh, UNIT).pressure(1.0).evaluate([[0, 0]])[0][0] for mesh in (flat, square)]
    assert middles[0] == pytest.approx(middles[1], rel=1e-3)


def test_pressure_far_from_the_origin():
    near, far = (Plate(moved(rectangle(6e-4, 6e-4, 6e-5), by), UNIT).pressure(1.0) for by in (0.0, 1.0))
    assert far.evaluate([[1, 1]])[0] == pytest.approx(near.evaluate([[0, 0]])[0], rel=1e-8)


def test_a_circle_in_two_boundaries_one_of_them_turned():
    whole = disc(1.0, 0.25)
    rim = whole.boundaries["rim"]
    parts = {"a": rim[:9, ::-1], "b": rim[9:]}
    halves = PlateMesh(whole.points, whole.triangles, parts, {"a": Circle(1.0), "b": Circle(1.0)})
    assert halves.outline.gap([0.5, 0.0]) == 0.5
    answers = [Plate(mesh, UNIT).pressure(1.0).evaluate([[0.3, 0.2]])[0][0] for mesh in (whole, halves)]
    assert answers[0] == pytest.approx(answers[1], rel=1e-12)


def test_a_circle_that_is_only_part_of_a_rim_is_refused():
    whole = disc(1.0, 0.25)
    parts = {"a": whole.boundaries["rim"][:9], "b": whole.boundaries["rim"][9:]}
    with pytest.raises(ValueError, match="whole rims; boundaries cover 135 degrees"):
        PlateMesh(whole.points, whole.triangles, parts, {"a": Circle(1.0)})


def test_cells_that_touch_in_a_point_only_are_refused():
    box = rectangle(1.0, 1.0, 0.5)
    count = len(box.points)
    top = int(np.flatnonzero((box.points == 0.5).all(axis=1))[0])
    low = int(np.flatnonzero((box.points == -0.5).all(axis=1))[0])
    rows = np.where(np.arange(count) == low, top, np.arange(count) + count)
    points = np.concatenate([box.points, box.points + 1.0])
    rims = {"one": np.concatenate(list(box.boundaries.values()))}
    rims["two"] = rows[rims["one"]]
    touching = PlateMesh(points, np.concatenate([box.triangles, rows[box.triangles]]), rims)
    with pytest.raises(ValueError, match="touch only in a point"):
        Plate(touching, UNIT).pressure(1.0)


def test_no_load_has_no_error():
    assert Plate(disc(1.0, 0.5), UNIT).pressure(0.0).error_estimate == 0
