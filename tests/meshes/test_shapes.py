"""Rectangle, annulus, ellipse and polygon: areas, angles, boundaries, corners, and their mistakes."""

import re
from collections import Counter

import numpy as np
import pytest

from meshes import PlateMesh, annulus, disc, ellipse, polygon, rectangle, regular_polygon

STAR = [(r * np.cos(k * np.pi / 5), r * np.sin(k * np.pi / 5)) for k, r in enumerate([1, 0.4] * 5)]
POLYGONS = {
    "L": [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)],
    "T": [(0, 1), (0.8, 1), (0.8, 0), (1.2, 0), (1.2, 1), (2, 1), (2, 1.5), (0, 1.5)],
    "star": STAR,
    "slot": [(0, 0), (1, 0), (1, 1), (0.55, 1), (0.55, 0.2), (0.45, 0.2), (0.45, 1), (0, 1)],
    "notch": [(0, 0), (1, 0), (1, 1), (0.55, 1), (0.5, 0.5), (0.45, 1), (0, 1)],
    "short side": [(0, 0), (1, 0), (1, 1), (0.5, 1), (0.49, 1.01), (0, 1)],
    "corner of 180 degrees": [(0, 0), (0.3, 0), (1, 0), (1, 1), (0, 1)],
}
GAUSS = (np.polynomial.legendre.leggauss(12)[0] + 1) / 2, np.polynomial.legendre.leggauss(12)[1] / 2


def areas(mesh):
    a, b, c = np.moveaxis(mesh.points[mesh.triangles], 1, 0)
    return ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2


def smallest_angles(mesh):
    """Of each triangle, in degrees."""
    sides = np.linalg.norm(
        mesh.points[np.roll(mesh.triangles, 1, 1)] - mesh.points[np.roll(mesh.triangles, -1, 1)], axis=-1
    )
    b, c = np.roll(sides, 1, axis=1), np.roll(sides, -1, axis=1)
    return np.rad2deg(np.arccos((b**2 + c**2 - sides**2) / (2 * b * c))).min(axis=1)


def true_area(mesh):
    """By Green's theorem over the true rim."""
    total = 0.0
    for name in mesh.boundaries:
        points, tangents = mesh.arcs(name, GAUSS[0])
        total += ((points[..., 0] * tangents[..., 1] - points[..., 1] * tangents[..., 0]) @ GAUSS[1]).sum() / 2
    return total


def perimeter(mesh, name="rim"):
    return (np.linalg.norm(mesh.arcs(name, GAUSS[0])[1], axis=-1) @ GAUSS[1]).sum()


def check_conforms(mesh: PlateMesh):
    """Counter-clockwise cells, no hanging or unused point, and boundaries that are the rim, the plate on their left."""
    assert areas(mesh).min() > 0
    assert np.array_equal(np.unique(mesh.triangles), np.arange(len(mesh.points)))
    directed = Counter(map(tuple, mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2).tolist()))
    assert set(directed.values()) == {1}
    rim = {edge for edge in directed if edge[::-1] not in directed}
    named = [tuple(edge) for pairs in mesh.boundaries.values() for edge in pairs.tolist()]
    assert len(named) == len(rim) and set(named) == rim
    assert np.abs(mesh.outline.gap(mesh.points[np.unique(named)])).max() < 1e-15 * mesh.size * 4


def three_times(mesh):
    """The mesh, refined, and refined again in one place."""
    fine = mesh.refined()
    return mesh, fine, fine.refined(np.arange(len(fine.triangles)) < 5)


@pytest.mark.parametrize("size", [(1, 1, 0.3), (2e-6, 1e-6, 1e-7), (1, 0.1, 1), (1.01, 1, 0.5), (3, 0.7, 0.2)])
def test_rectangle(size):
    width, height, cell_size = size
    for mesh in three_times(rectangle(*size)):
        check_conforms(mesh)
        assert areas(mesh).sum() == pytest.approx(width * height, rel=1e-14)
        lengths = {name: perimeter(mesh, name) for name in mesh.boundaries}
        assert lengths == pytest.approx({"left": height, "right": height, "bottom": width, "top": width}, rel=1e-13)
        assert np.rad2deg([corner.angle for corner in mesh.corners]) == pytest.approx([90] * 4)
        walks = {("left", "bottom"), ("bottom", "right"), ("right", "top"), ("top", "left")}
        assert {corner.sides for corner in mesh.corners} == walks
    assert smallest_angles(rectangle(*size)).min() > 35
    assert rectangle(*size).cell_sizes.max() < 1.4143 * cell_size
    ends = {"left": (0, -width), "right": (0, width), "bottom": (1, -height), "top": (1, height)}
    for name, (axis, place) in ends.items():
        assert (rectangle(*size).points[rectangle(*size).boundaries[name]][..., axis] == place / 2).all()


@pytest.mark.parametrize("turn", [np.diag([-1, 1]), np.diag([1, -1]), np.array([[0, 1], [1, 0]])], ids=["x", "y", "xy"])
def test_a_squares_mesh_has_its_symmetries(turn):
    mesh = rectangle(2, 2, 0.3)
    rows = {tuple(point): row for row, point in enumerate(mesh.points.tolist())}
    image = np.array([rows[tuple(point)] for point in (mesh.points @ turn).tolist()])
    assert {frozenset(t) for t in mesh.triangles.tolist()} == {frozenset(t) for t in image[mesh.triangles].tolist()}


@pytest.mark.parametrize("size", [(0.1, 1, 0.1), (0.5, 1, 0.2), (0.9, 1, 0.2), (0.01, 1, 0.3), (3e-5, 1e-4, 1)])
def test_annulus(size):
    inner, outer, cell_size = size
    for mesh in three_times(annulus(*size)):
        check_conforms(mesh)
        assert true_area(mesh) == pytest.approx(np.pi * (outer**2 - inner**2), rel=1e-13)
        assert perimeter(mesh, "inner") == pytest.approx(2 * np.pi * inner, rel=1e-13)
        assert perimeter(mesh, "outer") == pytest.approx(2 * np.pi * outer, rel=1e-13)
        assert mesh.corners == ()
        assert smallest_angles(mesh).min() > 25
    assert smallest_angles(annulus(*size)).min() > 40
    assert annulus(*size).cell_sizes.max() < 1.3 * cell_size


@pytest.mark.parametrize("size", [(1, 1, 0.2), (2, 1, 0.2), (5, 1, 0.3), (1e-6, 3e-6, 1e-7), (5, 1, 9)])
def test_ellipse(size):
    a, b, cell_size = size
    for mesh in three_times(ellipse(*size)):
        check_conforms(mesh)
        assert true_area(mesh) == pytest.approx(np.pi * a * b, rel=1e-13)
        assert mesh.outline.conics.tolist() == [[0, 0, a, b]]
        assert mesh.corners == ()
    mesh = ellipse(*size)
    assert smallest_angles(mesh).min() > 25
    assert mesh.cell_sizes.max() < 1.8 * cell_size
    # Ramanujan's second formula, good to 1.5e-5 at this flatness.
    h = ((a - b) / (a + b)) ** 2
    assert perimeter(mesh) == pytest.approx(np.pi * (a + b) * (1 + 3 * h / (10 + np.sqrt(4 - 3 * h))), rel=2e-4)


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


def test_part_names_the_cut_and_keeps_the_rest():
    mesh = annulus(1.0, 3.0, 0.5)
    keep = mesh.points[mesh.triangles].mean(axis=1)[:, 0] > 0.3
    part = mesh.part(keep)
    assert areas(part).sum() == pytest.approx(areas(mesh)[keep].sum())
    assert set(part.boundaries) == {"inner", "outer", "cut"}
    assert set(part.curves) == {"inner", "outer"} and part.outline is mesh.outline
    outer = part.points[part.boundaries["outer"]]
    assert np.hypot(*outer.reshape(-1, 2).T) == pytest.approx(np.full(2 * len(outer), 3.0))
    directed = set(map(tuple, part.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2).tolist()))
    named = [tuple(edge) for pairs in part.boundaries.values() for edge in pairs.tolist()]
    assert set(named) == {edge for edge in directed if edge[::-1] not in directed} and len(named) == len(set(named))
    points, tangents = part.arcs("cut", np.array([0.0, 0.25]))
    assert points[:, 1] == pytest.approx(points[:, 0] + tangents[:, 0] / 4)
    assert {("cut", "outer"), ("outer", "cut"), ("cut", "inner"), ("inner", "cut")} <= {c.sides for c in part.corners}
    again = part.part(part.points[part.triangles].mean(axis=1)[:, 1] > 0)
    assert true_area(again) == pytest.approx(true_area(again.refined()), rel=1e-13)


def test_an_inner_part_has_only_a_cut():
    mesh = disc(1.0, 0.1)
    part = mesh.part(np.linalg.norm(mesh.points[mesh.triangles].mean(axis=1), axis=1) < 0.4)
    assert list(part.boundaries) == ["cut"] and part.curves == {}
    assert len(part.boundaries["cut"]) == 6 * 4
    assert np.array_equal(np.unique(part.triangles), np.arange(len(part.points)))


def test_where_cells_touch_in_a_point_each_corner_is_its_own():
    mesh = rectangle(2, 2, 1)
    middle = mesh.points[mesh.triangles].mean(axis=1)
    part = mesh.part(middle[:, 0] * middle[:, 1] > 0)
    at_origin = [corner for corner in part.corners if (part.points[corner.row] == 0).all()]
    assert [corner.angle for corner in at_origin] == pytest.approx([np.pi / 2] * 2)


def test_the_outline_survives_refinement():
    for mesh in (disc(1, 0.3), rectangle(1, 2, 0.3), ellipse(2, 1, 0.4), polygon(STAR, 0.3)):
        assert mesh.refined().outline is mesh.outline
        assert mesh.refined(np.arange(len(mesh.triangles)) == 0).outline is mesh.outline


SHAPES = [
    (rectangle, {"width": 1.0, "height": 2.0, "cell_size": 0.5}),
    (annulus, {"inner_radius": 1.0, "outer_radius": 2.0, "cell_size": 0.5}),
    (ellipse, {"semi_axis_x": 1.0, "semi_axis_y": 2.0, "cell_size": 0.5}),
]


@pytest.mark.parametrize("shape, lengths", SHAPES, ids=lambda x: getattr(x, "__name__", ""))
@pytest.mark.parametrize("value", [0.0, -1.0, float("inf"), float("nan")])
def test_every_length_that_is_not_positive_is_named(shape, lengths, value):
    with pytest.raises(ValueError) as error:
        shape(**dict.fromkeys(lengths, value))
    expected = [f"Input {name} of {shape.__name__} must be a positive length in m; got {value!r}" for name in lengths]
    assert str(error.value).splitlines() == expected


def test_an_annulus_needs_the_smaller_radius_inside():
    message = "Input inner_radius of annulus must be less than its outer_radius, 1.0; got 1.0"
    with pytest.raises(ValueError, match=f"^{re.escape(message)}$"):
        annulus(1.0, 1.0, 0.1)


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
