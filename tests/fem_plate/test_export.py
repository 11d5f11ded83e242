"""Influence functions as arrays: what a file holds, and how much of a stroke the nearest neighbour feels."""

import numpy as np
import pytest

from fem_plate import Plate, neighbour_coupling, save_influence
from meshes import annulus, disc, rectangle

FOUR = np.array([[90e-6, 40e-6], [-60e-6, 120e-6], [-100e-6, -80e-6], [70e-6, -150e-6]])
NEAREST = [1, 0, 3, 2]


@pytest.fixture(scope="module")
def plate(section, radius):
    return Plate(disc(radius, radius / 8), section)


def saved(path, shapes, **options):
    save_influence(path, shapes, **options)
    with np.load(path) as file:
        return dict(file)


def test_a_file_holds_every_shape_on_a_grid_and_nan_off_the_plate(tmp_path, section, radius):
    plate = Plate(annulus(radius / 10, radius, radius / 6), section)
    shapes = plate.influence(FOUR)
    arrays = saved(tmp_path / "shapes.npz", shapes, across=21)
    assert arrays["x"] == pytest.approx(np.linspace(-radius, radius, 21))
    assert arrays["y"] == pytest.approx(np.linspace(-radius, radius, 21))
    assert arrays["shapes"].shape == (4, 21, 21)
    grid = np.stack(np.meshgrid(arrays["x"], arrays["y"], indexing="ij"), axis=-1)
    on = plate.mesh.outline.gap(grid) >= 0
    assert 0 < on.sum() < on.size and not on[10, 10]
    assert (np.isfinite(arrays["shapes"]) == on).all()
    assert np.abs(arrays["shapes"][:, on] - shapes.evaluate(grid[on])[0].T).max() < 1e-12
    assert (arrays["points"] == FOUR).all() and (arrays["stiffness"] == shapes.stiffness).all()
    assert (arrays["coupling"] == neighbour_coupling(shapes)).all()
    distance = np.linalg.norm(FOUR - FOUR[NEAREST], axis=1)
    assert arrays["pitch"] == pytest.approx(np.median(distance))


def test_the_grids_step_is_the_same_along_both_sides(tmp_path, section):
    shapes = Plate(rectangle(600e-6, 300e-6, 150e-6), section).influence(FOUR / 2)
    arrays = saved(tmp_path / "shapes.npz", shapes, across=21)
    assert arrays["shapes"].shape == (4, 21, 11)
    assert np.diff(arrays["x"]) == pytest.approx(30e-6) and np.diff(arrays["y"]) == pytest.approx(30e-6)


def test_patched_shapes_are_saved_alike(tmp_path, plate):
    dense, patched = plate.influence(FOUR), plate.influence(FOUR, truncation=1e-4)
    one, other = (saved(tmp_path / "shapes.npz", shapes, across=15) for shapes in (dense, patched))
    assert set(one) == set(other) and other["stiffness"].shape == (4, 4)
    assert other["stiffness"] == pytest.approx(one["stiffness"], rel=1e-4)
    on = np.isfinite(one["shapes"])
    assert np.abs(one["shapes"] - other["shapes"])[on].max() < 1e-4


def test_one_actuator_has_no_neighbour(tmp_path, plate):
    shapes = plate.influence(FOUR[:1])
    arrays = saved(tmp_path / "shapes.npz", shapes, across=5)
    assert arrays["shapes"].shape == (1, 5, 5) and np.isnan(arrays["pitch"]) and arrays["coupling"] == [0]
    with pytest.raises(
        ValueError, match="^Input shapes of neighbour_coupling must have at least two actuators; got one"
    ):
        neighbour_coupling(shapes)


def test_a_grid_of_one_point_is_refused(tmp_path, plate):
    with pytest.raises(ValueError, match="^Input across of save_influence must be at least 2; got 1$"):
        save_influence(tmp_path / "shapes.npz", plate.influence(FOUR), across=1)


def test_rigid_actuators_are_not_coupled(plate):
    assert np.abs(neighbour_coupling(plate.influence(FOUR))).max() < 1e-7


def test_yielding_actuators_are_coupled_in_part(plate):
    soft, stiff = (neighbour_coupling(plate.influence(FOUR, k)) for k in (20.0, 2000.0))
    assert (soft > 0).all() and (soft < 1).all()
    assert np.abs(stiff).max() < soft.min()
    heights = plate.influence(FOUR, 20.0).evaluate(FOUR)[0]
    assert soft == pytest.approx(heights[NEAREST, range(4)] / np.diagonal(heights), rel=1e-9)


def test_floating_actuators_are_coupled_by_the_compliance(plate):
    shapes = plate.influence(FOUR, 0.0)
    c = shapes.compliance
    assert neighbour_coupling(shapes) == pytest.approx(c[NEAREST, range(4)] / np.diagonal(c), rel=1e-6)


def test_neighbours_that_are_equally_near_count_alike(section):
    """On a rectangle those beside and those above differ; rounding of the distances must not choose."""
    plate = Plate(rectangle(600e-6, 300e-6, 100e-6), section)
    points = 60e-6 * np.array([[0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]]) + [1e-7, 0.0]
    shapes = plate.influence(points, 20.0)
    heights = shapes.evaluate(points)[0]
    heights /= np.diagonal(heights)
    beside, above = heights[[1, 0, 3, 2], range(4)], heights[[3, 2, 1, 0], range(4)]
    assert (np.abs(beside - above) > 1e-3).all()
    assert neighbour_coupling(shapes) == pytest.approx((beside + above) / 2, rel=1e-9)
