"""Shapes on patches against those of the whole plate: values, gradients, Hessians, single ones and sums.

Both are right to their error estimates, and patches to what they leave out as well. Those are of deflections; a slope
or a curvature of what is left out is a few times larger per pitch, and how good the mesh is for them is seen by the
whole plate on cells of half the size.
"""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from coupling.display.surface import TRUNCATED_HEIGHT, deflections
from coupling.extremes import steepest
from fem_plate import PatchedShapes, Plate
from fem_plate.arrays import patches
from meshes import annulus, disc, polygon, rectangle

pytestmark = pytest.mark.slow  # it has no kernels, so that the compiled pass is enough

PITCH = 25e-6
TRUNCATION = 1e-2
DERIVATIVE = (1, 3, 10)  # what is left out of w, its slope and its curvature, times the pitch to the order
MESH = (1, 4, 4)  # of the change of the whole plate's shapes with cells of half the size


def lattice(nx, ny):
    x, y = (np.arange(nx) - (nx - 1) / 2) * PITCH, (np.arange(ny) - (ny - 1) / 2) * PITCH
    return np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)


def inside(mesh, points, gap):
    return points[mesh.outline.gap(points) > gap * PITCH]


SQUARE = rectangle(12 * PITCH, 11 * PITCH, PITCH)
ARRAY = lattice(11, 10)
DISC = disc(8 * PITCH, 1.5 * PITCH)
RING = annulus(2 * PITCH, 7 * PITCH, 1.5 * PITCH)
L = polygon(PITCH * np.array([[-6, -6], [6, -6], [6, 0], [0, 0], [0, 6], [-6, 6]]), 2 * PITCH)
MIXED = {"left": "simply-supported", "bottom": "clamped", "right": "simply-supported"}
IRREGULAR = lattice(15, 15) + np.random.default_rng(1).uniform(-0.3, 0.3, (225, 2)) * PITCH
KINDS = np.random.default_rng(2).choice([np.inf, 20e3, 0.0], 400, p=[0.6, 0.3, 0.1])  # N/m

CASES = {
    "rectangle, mixed sides": (SQUARE, MIXED, ARRAY, None),
    "annulus": (RING, {"outer": "clamped"}, inside(RING, lattice(14, 14), 0.6), None),
    "disc, irregular, springs and floating": (DISC, "clamped", inside(DISC, IRREGULAR, 0.6), KINDS),
    "re-entrant corner": (L, "clamped", inside(L, lattice(11, 11), 0.6), None),
}


@pytest.fixture(scope="module", autouse=True)
def small_tiles():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(patches, "TILE", 3)
        yield


@pytest.fixture(scope="module")
def plate(section):
    return Plate(SQUARE, section)


@pytest.fixture(scope="module")
def shapes(plate):
    return plate.influence(ARRAY, truncation=TRUNCATION)


@pytest.fixture(scope="module")
def yielding(plate):
    return plate.influence(ARRAY, KINDS[: len(ARRAY)], truncation=TRUNCATION)


@pytest.mark.parametrize("name", CASES)
def test_patches_give_the_shapes_of_the_whole_plate(section, name):
    mesh, supports, points, springs = CASES[name]
    springs = None if springs is None else springs[: len(points)]
    plate = Plate(mesh, section, supports)
    dense, shapes = plate.influence(points, springs), plate.influence(points, springs, truncation=TRUNCATION)
    finer = dense.refine()
    assert len(shapes.tiles) > 4 and shapes.truncation_error <= TRUNCATION
    xy = np.random.default_rng(0).uniform(*mesh.outline.box, (600, 2))
    xy = xy[(mesh.outline.gap(xy) > 0.2 * PITCH) & (cKDTree(points).query(xy)[0] > 0.1 * PITCH)]
    scale = np.abs(dense.evaluate(points)[0]).max(axis=0)  # of each shape: m per m, or m/N where it floats
    weights = np.random.default_rng(3).uniform(-1, 1, len(points)) / scale
    bound = shapes.truncation_error + shapes.error_estimate + dense.error_estimate
    for order, (found, truth, better) in enumerate(zip(*(s.evaluate(xy) for s in (shapes, dense, finer)), strict=True)):
        unit = PITCH**order / scale.reshape(-1, *[1] * order)
        allowed = DERIVATIVE[order] * bound + MESH[order] * np.abs((better - truth) * unit).max()
        assert np.abs((found - truth) * unit).max() < allowed
    for order, (found, truth, better) in enumerate(
        zip(*(s.evaluate(xy, weights) for s in (shapes, dense, finer)), strict=True)
    ):
        allowed = DERIVATIVE[order] * bound + MESH[order] * np.abs(better - truth).max() * PITCH**order
        assert np.abs(found - truth).max() * PITCH**order < allowed
    assert np.abs(shapes.stiffness.toarray() - dense.stiffness).max() < bound * np.abs(dense.stiffness).max()


def test_more_than_2000_actuators_take_patches_by_themselves(section, monkeypatch):
    """A row in a strip, whose inner tiles are alike, as are its ends: each shape is that of a short strip."""
    monkeypatch.setattr(patches, "TILE", 10)
    points = lattice(2100, 1)
    shapes = Plate(rectangle(2101 * PITCH, 4 * PITCH, 2 * PITCH), section).influence(points)
    assert isinstance(shapes, PatchedShapes) and shapes.truncation_error <= 1e-6
    assert len(shapes.tiles) == 210 and len({id(tile.patch) for tile in shapes.tiles}) == 2
    short = Plate(rectangle(41 * PITCH, 4 * PITCH, PITCH), section).influence(lattice(40, 1))
    spots = np.array([[0.3, 0.2], [2.6, -1.2], [-3.9, 1.7]]) * PITCH
    weights = np.zeros(2100)
    weights[1030:1070] = np.random.default_rng(0).uniform(-1, 1, 40)
    for order, (found, truth) in enumerate(
        zip(shapes.evaluate(spots, weights), short.evaluate(spots, weights[1030:1070]), strict=True)
    ):
        assert np.abs(found - truth).max() * PITCH**order < 10.0**order * (shapes.error_estimate + short.error_estimate)


def test_a_lattice_of_900_is_1_at_each_actuator_and_0_at_the_others(section, monkeypatch):
    monkeypatch.setattr(patches, "TILE", 10)
    points = lattice(30, 30)
    shapes = Plate(rectangle(31 * PITCH, 31 * PITCH, 6 * PITCH), section).influence(points, truncation=1e-6)
    assert isinstance(shapes, PatchedShapes) and shapes.truncation_error <= 1e-6
    assert shapes.stiffness.nnz < 0.9 * 900**2
    heights = np.random.default_rng(0).uniform(-1, 1, 900)
    assert np.abs(shapes.evaluate(points, heights)[0] - heights).max() < 1e-5
    row = int(np.argmin(np.hypot(*points.T)))
    assert shapes.evaluate(points, np.eye(900)[row])[0] == pytest.approx(np.eye(900)[row], abs=1e-6)


def test_values_alone_are_those_of_the_fields_and_the_drawn_plate_follows_the_whole_plate(plate, shapes):
    dense = plate.influence(ARRAY)
    xy = 0.9 * PITCH * np.random.default_rng(0).uniform(-5.5, 5.5, (300, 2))
    heights = np.random.default_rng(1).uniform(0, 1, (5, len(ARRAY)))
    for one in (dense, shapes):
        assert np.allclose(one.values(xy), one.evaluate(xy)[0], atol=1e-12)
        sums = one.derivatives(xy / one.size, heights.T)[0]
        assert np.allclose(one.values(xy, heights.T), sums, atol=1e-12)
        assert np.allclose(deflections(one, xy)(heights), sums.T, atol=100 * TRUNCATED_HEIGHT)
    left_out = np.abs(deflections(dense, xy)(heights) - deflections(shapes, xy)(heights)).max()
    assert left_out <= 2 * TRUNCATION * heights.max()
    even = np.repeat(heights[:, :1], len(ARRAY), axis=1)
    summed = deflections(shapes, xy, np.zeros(len(ARRAY), dtype=int))(even)
    assert np.allclose(summed, deflections(shapes, xy)(even), rtol=0, atol=1e-12)


def test_the_steepest_and_highest_place_is_found_without_looking_everywhere(plate):
    """Against a fine grid all over the plate, for strokes, and where some actuators yield or only push."""
    rng = np.random.default_rng(4)
    xy = np.stack(np.meshgrid(np.linspace(-6, 6, 97), np.linspace(-5.5, 5.5, 89)), axis=-1).reshape(-1, 2) * PITCH
    for springs in (None, KINDS[: len(ARRAY)]):
        shapes = plate.influence(ARRAY, springs)
        heights = rng.uniform(0, 1, (3, len(ARRAY))) / shapes.own_heights()
        fields = [shapes.evaluate(xy, h) for h in heights]
        slope, height = steepest(shapes, heights)
        assert slope == pytest.approx(max(np.hypot(*g.T).max() for _, g, _ in fields), rel=0.15)
        assert height == pytest.approx(max(np.abs(w).max() for w, _, _ in fields), rel=0.05)


def test_what_a_part_feels_and_the_first_frequency_are_found_from_a_piece_of_plate(plate, shapes, section):
    for spot in np.array([[5.7, -5.2], [-2.5, 1.5]]) * PITCH:
        whole = plate.influence(np.vstack([ARRAY, spot]), [*[np.inf] * len(ARRAY), 0.0])
        assert shapes.compliance_at(spot) == pytest.approx(whole.evaluate(spot[None])[0][0, -1], rel=1e-3)
    found, truth = shapes.first_frequency(section.density * section.thickness), plate.frequencies(1, ARRAY)[0]
    assert truth * (1 - 1e-3) < found < 1.1 * truth
    sparse = ARRAY[np.hypot(*(ARRAY - 2 * PITCH).T) > 2.1 * PITCH]
    found = plate.influence(sparse, truncation=TRUNCATION).first_frequency(section.density * section.thickness)
    assert found == pytest.approx(plate.frequencies(1, sparse)[0], rel=0.02)
    assert found < truth / 2


def test_the_matrix_of_shapes_is_their_values(shapes, yielding):
    xy = np.vstack([ARRAY, ARRAY[:-1] + PITCH / 3])
    for one in (shapes, yielding):
        assert np.abs(one.matrix(xy).toarray() - one.values(xy)).max() < 1e-12 * one.own_heights().max()
        left_out = np.abs(one.matrix(xy, 1e-2).toarray() - one.values(xy)) / one.own_heights()
        assert 1e-3 < left_out.max() < 1e-2
        assert one.matrix(xy, 1e-2).nnz < one.matrix(xy).nnz / 2
