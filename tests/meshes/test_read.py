"""Mesh files: what is read of them, and every mistake in them by its count and place."""

import re
import warnings
from pathlib import Path

import meshio
import numpy as np
import pytest
from mesh_checks import areas, true_area

from meshes import Parabolas, read, rectangle

L_WITH_HOLE = Path(__file__).parents[1] / "data" / "l_with_hole.msh"
UM = 1e-6
AREA = (400 * 400 - 200 * 200 - np.pi * 50**2) * UM**2

# A square of four triangles around its middle, point 4, with the names of its sides.
POINTS = np.array([(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)], dtype=float)
TRIANGLES = np.array([(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
LINES = np.array([(0, 1), (1, 2), (2, 3), (3, 0)])
TAGS = np.array([7, 8, 8, 8])


def write(path, points=POINTS, triangles=TRIANGLES, lines=LINES, tags=TAGS, names=None, kind="triangle", **options):
    """A file with physical curves (by default 7 and 8, named "foot" and "rest")."""
    points = np.asarray(points, dtype=float)
    points = points if points.shape[1] == 3 else np.column_stack([points, np.zeros(len(points))])
    tags = [np.ones(len(triangles), dtype=int), np.asarray(tags, dtype=int)]
    mesh = meshio.Mesh(
        points,
        [(kind, np.asarray(triangles)), ("line3" if np.shape(lines)[1] == 3 else "line", np.asarray(lines))],
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
        field_data={"foot": np.array([7, 1]), "rest": np.array([8, 1]), "plate": np.array([1, 2])}
        if names is None
        else {},
    )
    meshio.write(path, mesh, **({"file_format": "gmsh22", "binary": False} if path.suffix == ".msh" else {}) | options)
    return path


def check_l_with_hole(mesh, outer="outer", hole="hole"):
    assert set(mesh.boundaries) == {outer, hole}
    assert areas(mesh).min() > 0
    assert np.array_equal(np.unique(mesh.triangles), np.arange(len(mesh.points)))
    assert list(mesh.curves) == [hole] and isinstance(mesh.curves[hole], Parabolas)
    # The hole's eight parabolas miss the area of the circle by 0.2 %, their chords by 10 %.
    assert true_area(mesh) == pytest.approx(AREA, rel=3e-4)
    assert abs(areas(mesh).sum() / AREA - 1) > 5e-3
    assert mesh.outline.box == pytest.approx(np.array([[0, 0], [400 * UM, 400 * UM]]), abs=1e-18)
    gap = mesh.outline.gap(np.array([[100, 100], [100, 25], [300, 300], [300, 100]]) * UM)
    assert gap == pytest.approx(np.array([-50, 25, -100, 100]) * UM, abs=0.2 * UM)
    degrees = sorted(round(np.rad2deg(corner.angle)) for corner in mesh.corners)
    assert degrees == [90, 90, 90, 90, 90, 270]
    assert {corner.sides for corner in mesh.corners} == {(outer, outer)}


def test_a_gmsh_file_keeps_its_names_and_its_curved_hole():
    check_l_with_hole(read(L_WITH_HOLE, UM))
    check_l_with_hole(read(str(L_WITH_HOLE), unit=UM))


def test_refining_an_imported_mesh_follows_the_curve():
    mesh = read(L_WITH_HOLE, UM)
    fine = mesh.refined().refined()
    assert true_area(fine) == pytest.approx(true_area(mesh), rel=1e-13)
    assert np.abs(fine.outline.gap(fine.points[np.unique(fine.boundaries["hole"])])).max() < 1e-18
    assert abs(areas(fine).sum() - true_area(mesh)) < abs(areas(mesh).sum() - true_area(mesh)) / 15
    assert fine.outline is mesh.outline


def test_binary_files_of_gmsh_4():
    check_l_with_hole(read(L_WITH_HOLE.with_stem("l_with_hole_binary"), UM))


@pytest.mark.parametrize("binary", [False, True], ids=["ascii", "binary"])
def test_files_of_gmsh_2(tmp_path, binary):
    original = meshio.read(L_WITH_HOLE)
    original.point_data, original.cell_sets = {}, {}
    meshio.write(tmp_path / "mesh.msh", original, "gmsh22", binary=binary)
    check_l_with_hole(read(tmp_path / "mesh.msh", UM))


def test_a_curve_of_gmsh_4_with_two_names_is_refused(tmp_path):
    text = L_WITH_HOLE.read_text()
    doubled = text.replace("$PhysicalNames\n3\n", '$PhysicalNames\n4\n1 9 "again"\n')
    curves = re.search(r"\$Entities\n.*?\$EndEntities", doubled, re.S)[0]
    # The tags of a curve: their count, the tags, the count of its ends.
    twice = re.sub(r" 1 2 2 (\d+ -\d+ )$", r" 2 2 9 2 \1", curves, count=1, flags=re.M)
    assert twice != curves
    (tmp_path / "mesh.msh").write_text(doubled.replace(curves, twice))
    with pytest.raises(ValueError, match="2 boundary edges with more than one name, at "):
        read(tmp_path / "mesh.msh")


def test_numbers_that_are_not_known_to_be_the_boundaries_are_left_alone(tmp_path):
    points, zero = np.column_stack([POINTS, np.zeros(5)]), np.zeros(4, dtype=int)
    data = {"one": [zero, TAGS], "other": [zero, TAGS]}
    meshio.write(tmp_path / "m.vtu", meshio.Mesh(points, [("triangle", TRIANGLES), ("line", LINES)], cell_data=data))
    with pytest.raises(ValueError, match="an unnamed boundary: 4 edges"):
        read(tmp_path / "m.vtu")


def test_formats_without_names_give_numbers(tmp_path):
    original = meshio.read(L_WITH_HOLE)
    plain = meshio.Mesh(
        original.points, original.cells, cell_data={"gmsh:physical": original.cell_data["gmsh:physical"]}
    )
    meshio.write(tmp_path / "mesh.vtu", plain)
    check_l_with_hole(read(tmp_path / "mesh.vtu", UM), outer="1", hole="2")


@pytest.mark.parametrize("suffix", ["vtu", "xdmf"])
@pytest.mark.parametrize("key", ["boundary", "gmsh:physical", "some integers"])
def test_vtu_and_xdmf_by_any_of_the_known_numbers(tmp_path, suffix, key):
    points = np.column_stack([POINTS, np.zeros(5)])
    data = {key: [np.zeros(4, dtype=int), TAGS], "heat": [np.zeros(4), np.ones(4)]}
    path = tmp_path / f"mesh.{suffix}"
    meshio.write(path, meshio.Mesh(points, [("triangle", TRIANGLES), ("line", LINES)], cell_data=data))
    mesh = read(path, 0.5)
    assert {name: len(pairs) for name, pairs in mesh.boundaries.items()} == {"7": 1, "8": 3}
    assert areas(mesh).sum() == pytest.approx(1.0)


def test_cells_may_be_turned_either_way(tmp_path):
    """As surfaces of a CAD model are."""
    mesh = read(write(tmp_path / "mesh.msh", triangles=[(0, 1, 4), (1, 2, 4), (2, 3, 4), (0, 3, 4)]))
    assert areas(mesh) == pytest.approx([1] * 4)


def test_a_clockwise_mesh_with_unused_points_is_put_right(tmp_path):
    points = np.concatenate([[(9, 9)], POINTS])
    mesh = read(write(tmp_path / "mesh.msh", points, TRIANGLES[:, ::-1] + 1, LINES[:, ::-1] + 1))
    assert len(mesh.points) == 5 and areas(mesh) == pytest.approx([1] * 4)
    assert mesh.points[mesh.boundaries["foot"]].tolist() == [[[0, 0], [2, 0]]]
    assert {corner.sides for corner in mesh.corners} == {("foot", "rest"), ("rest", "foot"), ("rest", "rest")}


def test_second_order_cells_turned_over_keep_their_middles(tmp_path):
    middles = np.array([(1, -0.1), (2, 1), (1, 2), (0, 1), (0.5, 0.5), (1.5, 0.5), (1.5, 1.5), (0.5, 1.5)])
    cells = np.array([(0, 1, 4, 5, 10, 9), (1, 2, 4, 6, 11, 10), (2, 3, 4, 7, 12, 11), (3, 0, 4, 8, 9, 12)])
    points = np.concatenate([POINTS, middles])
    turned = cells[:, [0, 2, 1, 5, 4, 3]]
    for data in (cells, turned, [*cells[:2], *turned[2:]]):
        mesh = read(write(tmp_path / "mesh.msh", points, data, kind="triangle6"))
        assert list(mesh.curves) == ["foot"]
        assert true_area(mesh) == pytest.approx(4 + 2 * 0.1 * 2 / 3)
        assert mesh.outline.box.tolist() == [[0, -0.1], [2, 2]]


def test_cells_that_touch_in_a_point_are_fine(tmp_path):
    lines = np.array([(0, 1), (1, 4), (4, 0), (2, 3), (3, 4), (4, 2)])
    mesh = read(write(tmp_path / "mesh.msh", triangles=TRIANGLES[[0, 2]], lines=lines, tags=[7] * 6))
    assert len(mesh.triangles) == 2 and len(mesh.boundaries["foot"]) == 6


def test_lines_inside_the_plate_are_no_boundary(tmp_path):
    mesh = read(write(tmp_path / "mesh.msh", lines=np.concatenate([LINES, [(0, 4)]]), tags=[*TAGS, 7]))
    assert len(mesh.boundaries["foot"]) == 1


MISTAKES = {
    "off the plane": (
        {"points": np.column_stack([POINTS, [0, 0, 0, 0.1, 0]])},
        "1 point off the plane of the others, at (0, 2, 0.1)",
    ),
    "folded": (
        {"points": np.concatenate([POINTS, [(1, 0.5)]]), "triangles": [*TRIANGLES, (0, 1, 5)]},
        "1 edge at which the plate folds back over itself, at (1, 0)",
    ),
    "no surface": (
        {"triangles": np.empty((0, 3), dtype=int)},
        "no triangles; give the plate a Physical Surface in gmsh, without which only the named curves are saved",
    ),
    "flat": (
        {"points": np.concatenate([POINTS, [(1, 0)]]), "triangles": [*TRIANGLES, (0, 5, 1)]},
        "1 cell without an area, at (1, 0)",
    ),
    "shared": (
        {"points": np.concatenate([POINTS, [(3, 1)]]), "triangles": [*TRIANGLES, (4, 1, 5)]},
        "1 edge shared by more than two cells, at (1.5, 0.5)",
    ),
    "unnamed": (
        {"lines": LINES[:2], "tags": TAGS[:2]},
        "an unnamed boundary: 2 edges, the first between (2, 2) and (0, 2); give them a Physical Curve name in gmsh",
    ),
    "one unnamed": (
        {"tags": [7, 8, 8, 0]},
        "an unnamed boundary: 1 edge, between (0, 2) and (0, 0); give them a Physical Curve name in gmsh",
    ),
    "two names": (
        {"lines": [*LINES, (0, 1)], "tags": [*TAGS, 8]},
        "1 boundary edge with more than one name, at (1, 0)",
    ),
    "not finite": (
        {"points": np.concatenate([POINTS[:4], [(np.nan, 1)]])},
        "1 point with coordinates that are not finite, at (nan, 1, 0)",
    ),
    "no triangles": ({"kind": "quad", "triangles": [(0, 1, 2, 3)]}, "no triangles"),
    "other cells": (
        {"kind": "quad", "triangles": [(0, 1, 2, 3)]},
        "1 cell of kind quad: only triangle and triangle6 can be used",
    ),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_mistakes_are_told_with_count_and_place(tmp_path, name):
    changes, message = MISTAKES[name]
    path = write(tmp_path / "mesh.msh", **changes)
    with pytest.raises(ValueError, match=re.escape(message)) as error:
        read(path)
    start = f"Input path of read must be a plane mesh of triangles with named boundaries; {path} has\n"
    assert str(error.value).startswith(start)


def second_order(inner=(0.5, 0.5), rim=(1, 0)):
    middles = np.array([rim, (2, 1), (1, 2), (0, 1), inner, (1.5, 0.5), (1.5, 1.5), (0.5, 1.5)])
    cells = np.array([(0, 1, 4, 5, 10, 9), (1, 2, 4, 6, 11, 10), (2, 3, 4, 7, 12, 11), (3, 0, 4, 8, 9, 12)])
    return {"points": np.concatenate([POINTS, middles]), "triangles": cells, "kind": "triangle6"}


def test_curved_edges_inside_are_refused(tmp_path):
    message = "1 curved edge inside the plate: only the rim may be, at (0.5, 0.5)"
    with pytest.raises(ValueError, match=re.escape(message)):
        read(write(tmp_path / "mesh.msh", **second_order(inner=(0.5, 0.5 + 1e-5))))
    assert read(write(tmp_path / "mesh.msh", **second_order(inner=(0.5, 0.5 + 1e-7)))).curves == {}


def test_edges_bent_beyond_their_cell_are_refused(tmp_path):
    with pytest.raises(ValueError, match=re.escape("1 cell folded by a curved edge, at (1, 0)")):
        read(write(tmp_path / "mesh.msh", **second_order(rim=(1, 1.1))))
    assert list(read(write(tmp_path / "mesh.msh", **second_order(rim=(1, 0.4)))).curves) == ["foot"]


def test_many_mistakes_come_at_once_and_many_places_as_three(tmp_path):
    mesh = rectangle(2, 2, 0.2)
    points = np.column_stack([mesh.points, 0.1 * (np.arange(len(mesh.points)) < 5)])
    with pytest.raises(ValueError) as error:
        read(write(tmp_path / "mesh.msh", points, mesh.triangles, mesh.boundaries["left"], [7] * 10))
    lines = str(error.value).splitlines()[1:]
    assert len(lines) == 2
    assert re.fullmatch(r"  5 points off the plane of the others, at (\([-\d., ]+\), ){3}\.\.\.", lines[0])
    assert lines[1].startswith("  an unnamed boundary: 30 edges, the first between (")


@pytest.mark.parametrize("unit", [0, -1.0, float("nan")])
def test_a_unit_that_is_no_length_is_refused(unit):
    with pytest.raises(ValueError, match=re.escape(f"Input unit of read must be a positive length in m; got {unit!r}")):
        read(L_WITH_HOLE, unit)


ISLANDS = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
6
1 0 0 0
2 1 0 0
3 0 1 0
4 5 0 0
5 6 0 0
6 5 1 0
$EndNodes
$Elements
2
1 2 2 0 1 1 2 3
2 2 2 0 1 4 5 6
$EndElements
"""


@pytest.mark.parametrize(
    ("old", "new", "wrong"),
    [
        ("", "", "2 pieces that do not hang together: a plate is one"),
        ("1 4 5 6", "1 4 5 9", "it is damaged, or its parts do not fit together"),
        ("6\n1 0 0 0", "99999999999\n1 0 0 0", "states 99999999999, more than its"),
        ("2\n1 2 2", "99999999999\n1 2 2", "states 99999999999, more than its"),
    ],
)
def test_a_file_whose_numbers_do_not_fit_is_refused(tmp_path, old, new, wrong):
    (tmp_path / "mesh.msh").write_text(ISLANDS.replace(old, new) if old else ISLANDS)
    with pytest.raises(ValueError, match=re.escape(wrong)):
        read(tmp_path / "mesh.msh")


def test_a_cell_on_a_point_that_is_not_there_is_refused(tmp_path):
    text = meshio.Mesh(np.eye(3), [("triangle", np.array([[0, 1, 2]]))])
    text.write(tmp_path / "mesh.vtu", binary=False)
    path = tmp_path / "mesh.vtu"
    path.write_text(re.sub(r"0\s+1\s+2", "0 1 7", path.read_text(), count=1))
    with pytest.raises(ValueError, match=r"1 triangle between points that are not there, of 3: .* \[0, 1, 7\]"):
        read(path)


@pytest.mark.parametrize(
    ("place", "wrong"),
    [("1e300", "2 points more than 1e+06 m from the origin"), ("1e-300", "all its points within 1e-300 m")],
)
def test_a_mesh_has_a_size(tmp_path, place, wrong):
    nodes = f"3\n1 0 0 0\n2 {place} 0 0\n3 0 {place} 0\n"
    cells = "1\n1 2 2 0 1 1 2 3\n"
    head = ISLANDS.partition("$Nodes")[0]
    (tmp_path / "mesh.msh").write_text(f"{head}$Nodes\n{nodes}$EndNodes\n$Elements\n{cells}$EndElements\n")
    with pytest.raises(ValueError, match=re.escape(wrong)):
        read(tmp_path / "mesh.msh")


def test_a_refusal_has_no_warnings_of_numpy(tmp_path):
    path = write(tmp_path / "mesh.msh")
    head, nodes = path.read_text().split("$Nodes\n5\n")
    path.write_text(f"{head}$Nodes\n5\n{nodes.replace('1 ', 'nan ', 1)}")
    with (
        pytest.raises(ValueError, match="Input path of read must be") as error,
        warnings.catch_warnings(record=True) as heard,
    ):
        warnings.simplefilter("always")  # as outside of tests, where they are printed into the refusal
        read(path)
    assert heard == [] and "Warning" not in str(error.value)
