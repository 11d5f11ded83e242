"""Polygons: areas, angles, corners, and their mistakes."""

import numpy as np
import pytest
from mesh_checks import STAR, areas, check_conforms, perimeter, smallest_angles, three_times

from meshes import polygon, regular_polygon

POLYGONS = {
    "L": [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)],
    "T": [(0, 1), (0.8, 1), (0.8, 0), (1.2, 0), (1.2, 1), (2, 1), (2, 1.5), (0, 1.5)],
    "star": STAR,
    "slot": [(0, 0), (1, 0), (1, 1), (0.55, 1), (0.55, 0.2), (0.45, 0.2), (0.45, 1), (0, 1)],
    "notch": [(0, 0), (1, 0), (1, 1), (0.55, 1), (0.5, 0.5), (0.45, 1), (0, 1)],
    "short side": [(0, 0), (1, 0), (1, 1), (0.5, 1), (0.49, 1.01), (0, 1)],
    "corner of 180 degrees": [(0, 0), (0.3, 0), (1, 0), (1, 1), (0, 1)],
}


@pytest.mark.parametrize("cell_size", [0.3, 0.1, 0.04])
@pytest.mark.parametrize("name", POLYGONS)
def test_polygon(name, cell_size):
    corners, scale = np.array(POLYGONS[name]), 1e-5
    ends = np.roll(corners, -1, axis=0)
    area = (corners[:, 0] @ ends[:, 1] - corners[:, 1] @ ends[:, 0]) / 2
    for mesh in three_times(polygon(scale * corners, scale * cell_size)):
        check_conforms(mesh)
        assert areas(mesh).sum() == pytest.approx(scale**2 * area, rel=1e-12)
        assert perimeter(mesh) == pytest.approx(scale * np.hypot(*(ends - corners).T).sum(), rel=1e-13)
        assert smallest_angles(mesh).min() > 20
    mesh = polygon(scale * corners, scale * cell_size)
    assert {tuple(p) for p in (scale * corners).tolist()} <= {tuple(p) for p in mesh.points.tolist()}
    assert mesh.cell_sizes.max() < 1.8 * scale * cell_size
    before = np.roll(corners, 1, axis=0) - corners
    after = ends - corners
    angle = np.arctan2(after[:, 0] * before[:, 1] - after[:, 1] * before[:, 0], (after * before).sum(axis=1)) % (
        2 * np.pi
    )
    expected = {
        tuple(p): a for p, a in zip((scale * corners).tolist(), angle, strict=True) if abs(a - np.pi) > np.deg2rad(15)
    }
    assert {tuple(mesh.points[c.row].tolist()): c.angle for c in mesh.corners} == pytest.approx(expected)


@pytest.mark.parametrize("degrees", [5, 10, 25])
@pytest.mark.parametrize("cell_size", [0.3, 0.05])
def test_a_thin_wedge_is_thin_only_at_its_tip(degrees, cell_size):
    mesh = polygon([(0, 0), (2, 0), (2, 2 * np.tan(np.deg2rad(degrees)))], cell_size)
    check_conforms(mesh)
    angle = smallest_angles(mesh)
    tip = (mesh.points[mesh.triangles] == 0).all(axis=-1).any(axis=1)
    assert tip.sum() == 1
    assert angle[tip] == pytest.approx(degrees)
    assert angle[~tip].min() > 25


def test_random_polygons_have_no_thinner_cells_than_their_corners():
    rng = np.random.default_rng(5)
    for _ in range(30):
        count = rng.integers(5, 15)
        angle = 2 * np.pi * (np.arange(count) + rng.uniform(0, 0.7, count)) / count
        xy = rng.uniform(0.3, 1, (count, 1)) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        mesh = polygon(xy, rng.choice([0.3, 0.1]))
        check_conforms(mesh)
        corner = np.rad2deg(min(corner.angle for corner in mesh.corners))
        assert smallest_angles(mesh).min() > min(20, corner - 1e-6)


def test_a_clockwise_polygon_is_turned_with_the_names_of_its_sides():
    corners = np.array(POLYGONS["L"])
    names = ["bottom", "right", "step", "step", "top", "left"]
    mesh = polygon(corners, 0.5, names)
    turned = polygon(corners[::-1], 0.5, [names[k] for k in (4, 3, 2, 1, 0, 5)])
    for one in (mesh, turned):
        check_conforms(one)
        assert perimeter(one, "step") == pytest.approx(2)
        assert (one.points[one.boundaries["left"]][..., 0] == 0).all()
        assert (one.points[one.boundaries["bottom"]][..., 1] == 0).all()
        sides = {tuple(one.points[c.row].tolist()): c.sides for c in one.corners}
        assert sides[1.0, 1.0] == ("step", "step") and sides[0.0, 0.0] == ("left", "bottom")


def test_a_corner_of_180_degrees_counts_where_the_name_changes():
    mesh = polygon(POLYGONS["corner of 180 degrees"], 0.3, ["one", "two", "two", "two", "two"])
    straight = [corner for corner in mesh.corners if corner.sides == ("one", "two")]
    assert [corner.angle for corner in straight] == pytest.approx([np.pi])
    assert mesh.points[straight[0].row].tolist() == [0.3, 0.0]


SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]


@pytest.mark.parametrize(
    "corners, cell_size, names, messages",
    [
        (SQUARE[:2], 0.1, None, ["corners of polygon must be at least three points (x, y) in m; got"]),
        ([1, 2, 3], 0.1, None, ["corners of polygon must be at least three points"]),
        ([(0, 0), (1, 0), (1,)], 0.1, None, ["corners of polygon must be at least three points"]),
        ([(0, 0), (1, 0), (np.nan, 1)], 0.1, None, ["corners of polygon must be at least three points"]),
        ([*SQUARE, (1, 0)], 0.1, None, ["corners of polygon must differ; got corner 4 at corner 1, [1.0, 0.0] m"]),
        ([SQUARE[k] for k in (0, 2, 1, 3)], 0.1, None, ["must give sides that do not cross; got 0 and 2"]),
        ([*SQUARE, (0.5, 0)], 0.1, None, ["must give sides that do not cross; got 0 and 3", "0 and 4"]),
        ([(0, 0), (2, 0), (1, 0), (1, 1)], 0.1, None, ["must give sides that do not cross; got 0 and 1", "0 and 2"]),
        (SQUARE, 0.1, ["a"], ["names of polygon must be one for each of its 4 sides; got ['a']"]),
        (SQUARE, 0.1, "abcd", ["names of polygon must be one for each of its 4 sides; got 'abcd'"]),
        (SQUARE, -1, ["a"], ["cell_size of polygon must be a positive length in m; got -1", "names of polygon"]),
    ],
)
def test_mistakes_of_a_polygon_are_all_told_at_once(corners, cell_size, names, messages):
    with pytest.raises(ValueError) as error:
        polygon(corners, cell_size, names)
    lines = str(error.value).splitlines()
    assert len(lines) == len(messages)
    for line, message in zip(lines, messages, strict=True):
        assert line.startswith("Input ") and message in line


@pytest.mark.parametrize("sides", [3, 6, 7, 24])
@pytest.mark.parametrize("rotation", [0.0, 0.3])
def test_a_regular_polygon_has_its_area_perimeter_and_distances(sides, rotation):
    mesh, half = regular_polygon(sides, 2.0, 0.3, rotation), np.pi / sides
    a, b, c = np.moveaxis(mesh.points[mesh.triangles], 1, 0)
    (x, y), (u, v) = (b - a).T, (c - a).T
    assert (x * v - y * u).min() > 0
    assert (x * v - y * u).sum() / 2 == pytest.approx(sides * 4 * np.sin(half) * np.cos(half), rel=1e-12)
    rim = mesh.points[mesh.boundaries["rim"]]
    assert list(mesh.boundaries) == ["rim"]
    assert np.hypot(*(rim[:, 1] - rim[:, 0]).T).sum() == pytest.approx(sides * 4 * np.sin(half), rel=1e-12)
    # From the centre to a side, and from beyond a corner to that corner.
    tip = 2.5 * np.array([np.cos(rotation), np.sin(rotation)])
    assert mesh.outline.gap(np.array([[0.0, 0.0], tip])) == pytest.approx([2 * np.cos(half), -0.5], rel=1e-12)


def test_every_mistake_in_a_regular_polygon_is_named():
    with pytest.raises(ValueError) as caught:
        regular_polygon(2, -1.0, np.nan, np.inf)
    for name in ("sides", "radius", "cell_size", "rotation"):
        assert f"Input {name} of regular_polygon must be" in str(caught.value)
