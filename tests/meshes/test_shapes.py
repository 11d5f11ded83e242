"""Rectangle, annulus, ellipse, and parts of meshes: areas, angles, boundaries, corners, and mistakes."""

import re

import numpy as np
import pytest
from mesh_checks import STAR, areas, check_conforms, perimeter, smallest_angles, three_times, true_area

from meshes import annulus, disc, ellipse, polygon, rectangle


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
    (disc, {"radius": 1.0, "cell_size": 0.5}),
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
