"""The disc's mesh: orientation, boundary, true rim and refinement."""

import numpy as np
import pytest
from mesh_checks import areas, check_conforms, smallest_angles

from meshes import Circle, disc

RADIUS = 300e-6


@pytest.fixture(params=["disc", "refined", "refined twice"])
def mesh(request):
    mesh = disc(RADIUS, RADIUS / 3)
    return {"disc": mesh, "refined": mesh.refined(), "refined twice": mesh.refined().refined()}[request.param]


def test_it_conforms_and_its_rim_lies_on_the_circle_to_rounding(mesh):
    check_conforms(mesh)
    corners = mesh.points[np.unique(mesh.boundaries["rim"])]
    assert np.abs(np.hypot(*corners.T) / RADIUS - 1).max() < 4e-16


def test_no_point_is_doubled(mesh):
    assert len(np.unique(np.round(mesh.points / RADIUS, 9), axis=0)) == len(mesh.points)


def test_size_is_the_radius(mesh):
    assert mesh.size == pytest.approx(RADIUS, rel=1e-15)


@pytest.mark.parametrize("refine", [False, True])
def test_area_tends_to_the_circles_at_second_order(refine):
    meshes = [disc(1.0, 1 / 4)]
    for k in (8, 16):
        meshes.append(meshes[-1].refined() if refine else disc(1.0, 1 / k))
    missing = np.array([np.pi - areas(mesh).sum() for mesh in meshes])
    assert np.log2(missing[:-1] / missing[1:]) == pytest.approx(2.0, abs=0.01)
    assert 0 < missing[-1] < 3e-3


def test_refining_cuts_every_triangle_in_four():
    mesh = disc(RADIUS, RADIUS / 3)
    fine = mesh.refined()
    assert len(fine.triangles) == 4 * len(mesh.triangles)
    assert len(fine.boundaries["rim"]) == 2 * len(mesh.boundaries["rim"])
    assert np.array_equal(fine.points[: len(mesh.points)], mesh.points)


@pytest.mark.parametrize("cell_size", [0.3, 0.13, 0.05])
def test_cells_are_about_as_wide_as_asked_for_and_none_is_thin(cell_size):
    mesh = disc(1.0, cell_size)
    sides = np.linalg.norm(np.diff(mesh.points[mesh.triangles[:, [0, 1, 2, 0]]], axis=1), axis=-1)
    assert sides.max() < 1.45 * cell_size
    assert smallest_angles(mesh).min() > 40


def test_a_cell_size_that_divides_the_radius_gives_that_many_rings():
    assert len(disc(0.3, 0.1).points) == 1 + 6 + 12 + 18
    assert len(disc(300e-6, 100e-6).points) == 1 + 6 + 12 + 18


def test_a_disc_has_at_least_two_rings():
    assert len(disc(1.0, 10.0).points) == 1 + 6 + 12


def test_circle_projects_to_the_nearest_point():
    circle = Circle(2.0, (1.0, -1.0))
    assert circle.project([[4.0, 3.0], [1.3, -0.6]]) == pytest.approx(np.array([[2.2, 0.6], [2.2, 0.6]]), abs=1e-15)
    assert circle.gap([4.0, 3.0]) == pytest.approx(-3.0, abs=1e-15)


def test_arcs_take_the_short_way_also_over_the_branch_of_the_angle():
    circle = Circle(2.0, (1.0, -1.0))
    angle = np.array([[3.0, -3.0], [-3.0, 3.0], [0.2, 0.5]])
    ends = [np.array(circle.centre) + 2 * np.stack([np.cos(a), np.sin(a)], axis=1) for a in angle.T]
    s = np.linspace(0, 1, 2001)
    points, tangents = circle.arc(*ends, s)
    assert np.abs(circle.gap(points)).max() < 1e-15
    assert points[:, [0, -1]] == pytest.approx(np.stack(ends, axis=1), abs=1e-15)
    lengths = np.linalg.norm(np.diff(points, axis=1), axis=-1).sum(axis=1)
    assert lengths == pytest.approx(2 * np.array([2 * np.pi - 6, 2 * np.pi - 6, 0.3]), rel=1e-7)
    assert tangents[:, 1:-1] == pytest.approx((points[:, 2:] - points[:, :-2]) / (s[2] - s[0]), abs=1e-7)


@pytest.fixture(params=[1, 4], ids=["once", "four times"])
def graded(request):
    """A mesh refined only near one point of the rim."""
    mesh = disc(RADIUS, RADIUS / 4)
    for _ in range(request.param):
        middle = mesh.points[mesh.triangles].mean(axis=1)
        distance = np.linalg.norm(middle - [RADIUS, 0.0], axis=1)
        mesh = mesh.refined(distance < 0.5 * RADIUS)
    return mesh


def test_refining_in_one_place_leaves_no_hanging_node_and_no_thin_triangle(graded):
    check_conforms(graded)
    assert smallest_angles(graded).min() > 20
    assert np.abs(np.hypot(*graded.points[np.unique(graded.boundaries["rim"])].T) / RADIUS - 1).max() < 4e-16


def test_refining_in_one_place_leaves_far_cells_alone(graded):
    far = np.linalg.norm(graded.points[graded.triangles].mean(axis=1) - [-RADIUS, 0.0], axis=1) < 0.6 * RADIUS
    plain = disc(RADIUS, RADIUS / 4)
    before = np.linalg.norm(plain.points[plain.triangles].mean(axis=1) - [-RADIUS, 0.0], axis=1) < 0.6 * RADIUS
    assert np.count_nonzero(far) == np.count_nonzero(before)


def test_marking_nothing_refines_nothing():
    mesh = disc(RADIUS, RADIUS / 4)
    same = mesh.refined(np.zeros(len(mesh.triangles), dtype=bool))
    assert len(same.triangles) == len(mesh.triangles)
