"""Patches of large arrays: where they are cut, which are shared, how far they reach, and what is refused."""

import re
from functools import cache

import numpy as np
import pytest
from scipy.sparse import issparse

from fem_plate import AnisotropicSection, PatchedShapes, Plate
from fem_plate.arrays import patched, patches
from fem_plate.arrays.patches import spacing
from meshes import disc, polygon, rectangle

PITCH = 25e-6


def lattice(nx, ny, dx=PITCH, dy=PITCH):
    x, y = (np.arange(nx) - (nx - 1) / 2) * dx, (np.arange(ny) - (ny - 1) / 2) * dy
    return np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)


def unlike(shapes):
    return len({id(tile.patch) for tile in shapes.tiles})


@pytest.fixture(scope="module", autouse=True)
def small_tiles():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(patches, "TILE", 4)
        yield


@pytest.fixture(scope="module")
def row(section):
    """A strip for 60 actuators."""
    return Plate(rectangle(61 * PITCH, 4 * PITCH, PITCH), section)


@pytest.fixture(scope="module")
def shapes_to(row):
    """The shapes of 60 actuators along the strip, to a truncation; each is made once."""
    return cache(lambda truncation: row.influence(lattice(60, 1), truncation=truncation))


@pytest.fixture(scope="module")
def shapes(shapes_to):
    return shapes_to(1e-3)


def test_tiles_that_look_alike_share_a_patch(shapes):
    """Towards either end tiles differ by how far they are from it, all others are alike."""
    assert len(shapes.tiles) == 15 and unlike(shapes) <= 5
    middle = [tile.patch for tile in shapes.tiles[3:-3]]
    assert all(patch is middle[0] for patch in middle)
    assert np.concatenate([np.sort(tile.rows[tile.patch.core]) for tile in shapes.tiles]).tolist() == list(range(60))


def test_tiles_that_mirror_each_other_share_a_patch_whose_fields_are_turned(row, shapes):
    first, last = shapes.tiles[0], shapes.tiles[-1]
    assert first.patch is last.patch and unlike(shapes) <= 3
    assert (first.turn.signs * last.turn.signs).tolist() == [-1.0, 1.0]
    dense, weights = row.influence(lattice(60, 1)), np.random.default_rng(0).uniform(-1, 1, 60)
    for sign in (-1, 1):
        spots = np.random.default_rng(1).uniform([26, -1.5], [30, 1.5], (40, 2)) * PITCH * [sign, 1]
        for order, (found, truth) in enumerate(
            zip(shapes.evaluate(spots, weights), dense.evaluate(spots, weights), strict=True)
        ):
            assert np.abs(found - truth).max() * PITCH**order < 3e-3 * 3**order


def test_tiles_along_two_sides_share_a_patch_whose_fields_are_swapped(section):
    points, rng = lattice(12, 12), np.random.default_rng(1)
    shapes = Plate(rectangle(13 * PITCH, 13 * PITCH, PITCH), section).influence(points, truncation=4e-2)
    assert [1, 0] in [tile.turn.axes for tile in shapes.tiles]
    spots, weights = rng.uniform(-6, 6, (100, 2)) * PITCH, rng.uniform(-1, 1, (12, 12))
    value, gradient, hessian = shapes.evaluate(spots, weights.ravel())
    truth = value, gradient[:, ::-1], hessian[:, ::-1, ::-1]
    for order, found in enumerate(shapes.evaluate(spots[:, ::-1], weights.T.ravel())):
        assert np.abs(found - truth[order]).max() * PITCH**order < 1e-9


def test_a_crystal_at_an_angle_has_no_patches_seen_another_way_round():
    crystal = AnisotropicSection.cubic((165.7e9, 63.9e9, 79.6e9), 1e-6, angle=0.3)
    assert crystal.law[0, 0] == pytest.approx(crystal.law[2, 2]) and abs(crystal.law[1, 0]) > 0.01
    shapes = Plate(rectangle(13 * PITCH, 13 * PITCH, PITCH), crystal).influence(lattice(12, 12), truncation=4e-2)
    assert all(tile.turn.is_none for tile in shapes.tiles)


@pytest.mark.slow
def test_rounding_and_another_order_of_the_points_do_not_keep_patches_apart(row):
    rng = np.random.default_rng(2)
    points = lattice(60, 1) + [0.01234565 * PITCH, 0.0]
    plain = row.influence(points, truncation=1e-3)
    order = rng.permutation(60)
    other = row.influence((points + rng.uniform(-1e-12, 1e-12, points.shape) * PITCH)[order], truncation=1e-3)
    assert unlike(other) == unlike(plain) <= 6
    spots = np.array([[0.3, 0.2], [7.6, -1.2], [-29.0, 0.9]]) * PITCH
    assert np.abs(other.evaluate(spots)[0] - plain.evaluate(spots)[0][:, order]).max() < 1e-9


@pytest.mark.slow
def test_actuators_out_of_line_keep_patches_apart(row, shapes):
    points = lattice(60, 1)
    points[30, 1] += 1e-3 * PITCH
    assert unlike(row.influence(points, truncation=1e-3)) > unlike(shapes)


@pytest.mark.parametrize("noise", [0.0, 1e-12])
@pytest.mark.parametrize("shift", [0.0, 0.1234565])
@pytest.mark.parametrize("ratio", [1.0, 3.0, 1.2])
def test_the_pitch_of_a_lattice_is_found_along_either_axis(ratio, shift, noise):
    points = lattice(9, 7, PITCH, ratio * PITCH) + shift * PITCH
    points = points + np.random.default_rng(0).uniform(-noise, noise, points.shape) * PITCH
    assert spacing(points) / PITCH == pytest.approx([1.0, ratio], rel=1e-9)


def test_the_pitch_of_another_layout_is_the_distance_of_neighbours():
    points = np.random.default_rng(0).uniform(-1, 1, (50, 2))
    distance = np.linalg.norm(points[:, None] - points, axis=-1) + 9 * np.eye(50)
    assert spacing(points) == pytest.approx(np.full(2, np.median(distance.min(axis=1))))


@pytest.mark.slow
def test_a_smaller_truncation_takes_wider_margins_and_is_met(shapes_to):
    found = [shapes_to(t) for t in (1e-2, 1e-4, 1e-6)]
    assert [shapes.truncation_error <= t for shapes, t in zip(found, (1e-2, 1e-4, 1e-6), strict=True)] == [True] * 3
    assert found[0].truncation_error > found[1].truncation_error > found[2].truncation_error > 0
    widths = [np.ptp(shapes.tiles[7].patch.box[:, 0]) for shapes in found]
    assert widths[0] < widths[1] < widths[2]


@pytest.mark.parametrize("truncation", [-1.0, float("nan")])
def test_a_truncation_must_be_positive(row, truncation):
    with pytest.raises(ValueError, match="^Input truncation of influence must be positive; got (-1.0|nan)$"):
        row.influence(lattice(60, 1), truncation=truncation)


@pytest.mark.slow
def test_clusters_on_a_big_plate_take_patches_as_large_as_needed(section):
    """Beyond its last actuator the plate swings far out, and is held only by the rim."""
    plate = Plate(rectangle(1.5e-3, 1.5e-3, 0.15e-3), section)
    points = np.concatenate([lattice(3, 3) + np.array(place) * PITCH for place in ([-16, -10], [15, 12])])
    dense, shapes = plate.influence(points), plate.influence(points, truncation=1e-2)
    xy = np.random.default_rng(0).uniform(-0.7e-3, 0.7e-3, (500, 2))
    value = dense.evaluate(xy)[0]
    assert np.abs(value).max() > 2
    relative = np.abs(shapes.evaluate(xy)[0] - value).max(axis=0) / np.abs(value).max(axis=0)
    assert relative.max() < 1e-2
    assert shapes.truncation_error <= 1e-2


def test_one_actuator_may_have_a_truncation(section, radius):
    plate = Plate(disc(radius, radius / 8), section)
    dense, shapes = plate.influence([[90e-6, 40e-6]]), plate.influence([[90e-6, 40e-6]], truncation=1e-3)
    spots = np.array([[0.0, 0.0], [100e-6, -50e-6]])
    assert isinstance(shapes, PatchedShapes)
    assert np.abs(shapes.evaluate(spots)[0] - dense.evaluate(spots)[0]).max() < 1e-6


@pytest.mark.slow
def test_a_boundary_named_cut_is_not_taken_for_one(section):
    """Its own support holds there, and cuts are clamped."""
    corners = np.array([[-15.5, -2], [15.5, -2], [15.5, 2], [-15.5, 2.2]]) * PITCH
    found = []
    for name in ("cut", "other"):
        mesh = polygon(corners, PITCH, names=["wall", "wall", name, "wall"])
        shapes = Plate(mesh, section, {"wall": "clamped", name: "simply-supported"}).influence(
            lattice(30, 1), truncation=1e-3
        )
        found.append(shapes)
    assert len(found[0].tiles) == 8
    assert found[0].truncation_error == found[1].truncation_error <= 1e-3
    xy = np.array([[0.4, 0.3], [-12.0, 1.9], [15.2, -1.0]]) * PITCH
    assert (found[0].evaluate(xy)[0] == found[1].evaluate(xy)[0]).all()


@pytest.mark.slow
def test_points_on_the_rim_and_on_cuts_belong_to_the_plate(section):
    """On a free rim a shape does not vanish, wherever rounding puts the point."""
    plate = Plate(rectangle(19 * PITCH, 4 * PITCH, PITCH), section, {"left": "clamped", "right": "clamped"})
    points = lattice(18, 2, PITCH, 1.7 * PITCH)
    dense, shapes = plate.influence(points), plate.influence(points, truncation=1e-3)
    x = np.concatenate([np.linspace(-9.5, 9.5, 39), np.unique([t.cut.box[:, 0] / PITCH for t in shapes.tiles])])
    x = np.clip(np.concatenate([x, (points[:, 0] / PITCH)[::4] - 0.5]), -9.5, 9.5)
    for y in (-2.0, 0.0, 2.0):
        xy = np.stack([x, np.full(len(x), y)], axis=1) * PITCH
        value = dense.evaluate(xy)[0]
        assert y == 0 or np.abs(value).max(axis=1).min() < 0.1 < np.median(np.abs(value).max(axis=1))
        assert np.abs(shapes.evaluate(xy)[0] - value).max() < 2e-3


def test_forces_are_sparse_and_there_is_no_compliance(row, shapes):
    dense = row.influence(lattice(60, 1))
    assert issparse(shapes.strengths) and issparse(shapes.stiffness) and shapes.stiffness.shape == (60, 60)
    assert shapes.stiffness.nnz < 60 * 30
    # The scale is the largest force; the truncation's share of it, some stiffness per deflection, is of order one.
    assert np.abs(shapes.stiffness.toarray() - dense.stiffness).max() < 1e-3 * np.abs(dense.stiffness).max()
    assert np.abs(shapes.strengths.toarray() - dense.strengths).max() < 1e-3 * np.abs(dense.strengths).max()
    with pytest.raises(
        ValueError, match="must be at most 2000, and without a truncation, for a compliance; got 60 on patches"
    ):
        _ = shapes.compliance


def test_all_shapes_at_too_many_points_are_refused_and_sums_are_not(shapes, monkeypatch):
    monkeypatch.setattr(patched, "MAX_VALUES", 600)
    spots = np.stack([np.linspace(-20, 20, 11), np.full(11, 0.4)], axis=1) * PITCH
    every = shapes.evaluate(spots[:10])
    with pytest.raises(ValueError, match=re.escape("must be at most 10 points for all 60 shapes at once; got 11")):
        shapes.evaluate(spots)
    weights = np.random.default_rng(4).uniform(-1, 1, 60)
    for total, one in zip(shapes.evaluate(spots, weights), every, strict=True):
        assert np.abs(total[:10] - np.tensordot(one, weights, (1, 0))).max() < 1e-11 * np.abs(one).max()


@pytest.mark.slow
def test_the_shapes_nearby_are_all_that_are_not_zero_there(row):
    points, springs = lattice(60, 1), np.where(np.arange(60) % 3, np.inf, 0.0)
    shapes = row.influence(points, springs, truncation=1e-4)
    spots = np.array([[0.3, 0.2], [7.6, -1.2]]) * PITCH
    rows, values = shapes.nonzero_values(spots)
    every = shapes.evaluate(spots)[0]
    assert len(rows) < 60 and len(set(rows.tolist())) == len(rows)
    assert np.array_equal(values, every[:, rows])
    assert not np.delete(every, rows, axis=1).any()
    assert shapes.own_heights() == pytest.approx(np.diag(shapes.evaluate(points)[0]))


@pytest.mark.slow
def test_the_error_estimate_counts_what_is_left_out_and_the_cells(section, shapes_to):
    fine, mesh = shapes_to(1e-2), rectangle(61 * PITCH, 4 * PITCH, 4 * PITCH)
    coarse = Plate(mesh, section).influence(lattice(60, 1), truncation=1e-8)
    assert fine.error_estimate == fine.truncation_error
    assert coarse.truncation_error <= 1e-8 < coarse.error_estimate < 1e-5


@pytest.mark.slow
def test_what_floats_is_left_out_by_its_own_deflection(row):
    """A newton on a floating actuator moves it by its compliance, be it large or small; that is the scale."""
    springs = np.where(np.arange(60) % 2, np.inf, 0.0)
    dense = Plate(row.mesh.refined(), row.section).influence(lattice(60, 1), springs)
    shapes = row.influence(lattice(60, 1), springs, truncation=1e-4)
    spots = np.stack([np.linspace(-30, 30, 200), np.full(200, 0.4)], axis=1) * PITCH
    value = dense.evaluate(spots)[0]
    assert np.abs(value[:, ::2]).max() < 1e-2  # m/N: without the scale 1e-4 would be a hundredth of them
    assert (np.abs(shapes.evaluate(spots)[0] - value).max(axis=0) < 2e-4 * np.abs(value).max(axis=0)).all()


def test_a_sum_may_be_asked_for_at_the_actuators(shapes_to):
    """Its curvature is infinite there, of either sign on either patch: no warning."""
    points, heights = lattice(60, 1), np.random.default_rng(6).uniform(-1, 1, 60)
    value, gradient, _ = shapes_to(1e-4).evaluate(points, heights)
    assert np.abs(value - heights).max() < 1e-3 and np.isfinite(gradient).all()
