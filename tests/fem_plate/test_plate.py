"""Plate: its meshes, graded and halved, the rigidity that it enters with, and refinement to a tolerance."""

from dataclasses import replace

import numpy as np
import pytest

from fem_plate import Plate
from fem_plate.analytic import DiscShapes
from meshes import annulus, disc, polygon, rectangle

L_SHAPE = [(0, 0), (1, 0), (1, 1), (-1, 1), (-1, -1), (0, -1)]


@pytest.fixture(scope="module")
def plate(section, radius):
    return Plate(disc(radius, radius / 4), section)


def test_halving_makes_four_times_the_cells(plate):
    assert len(plate.model(halvings=1).mesh.triangles) == 4 * len(plate.mesh.triangles)


def test_a_model_is_made_once_for_each_mesh(plate, layout):
    first = plate.model(layout)
    assert plate.model(layout) is first
    assert plate.model(halvings=1) is not first


def test_an_actuator_near_the_rim_makes_cells_smaller_there_and_hardly_elsewhere(plate, radius):
    place = np.array([[0.95 * radius, 0.0]])
    mesh = plate.model(place).mesh
    centre = mesh.points[mesh.triangles].mean(axis=1)
    near, far = np.hypot(*(centre - place).T) < 0.1 * radius, centre[:, 0] < -0.2 * radius
    assert mesh.cell_sizes[near].max() < plate.mesh.cell_sizes.min() / 4
    assert mesh.cell_sizes[far].max() > 0.9 * plate.mesh.cell_sizes.max()
    assert np.abs(np.hypot(*mesh.points[mesh.boundaries["rim"][:, 0]].T) / radius - 1).max() < 1e-15


def test_an_actuator_whose_image_falls_on_the_other_rim_of_a_hole_is_like_any_other(section):
    """At (0.5, 0) the hole of radius 0.1 reflects it to (-0.3, 0), and halfway back is the hole's rim."""
    plate = Plate(annulus(0.1, 1.0, 0.4), section)
    exactly, nearly = (plate.model(np.array([[x, 0.0]])).unknowns for x in (0.5, 0.51))
    assert exactly < 2 * nearly


def test_cells_shrink_towards_singular_corners_only(section):
    clamped = Plate(polygon(L_SHAPE, 0.25), section).model().mesh
    size = clamped.cell_sizes
    distance = np.hypot(*clamped.points[clamped.triangles].mean(axis=1).T)
    assert size[distance < 1e-3].max() < 1e-3 and size[distance > 0.5].max() > 0.1
    square = rectangle(2.0, 2.0, 0.5)
    assert Plate(square, section, "simply-supported").model().mesh is square


def test_poissons_ratio_enters_only_through_the_rigidity(section, radius, layout, spots):
    """On a clamped plate; so the bending energy and the Nitsche rim must agree about it."""
    mesh = disc(radius, radius / 8)
    found = [Plate(mesh, replace(section, poisson_ratio=nu)).influence(layout).evaluate(spots) for nu in (0.0, 0.45)]
    assert np.abs(found[0][0] - found[1][0]).max() < 1e-7


def test_poissons_ratio_counts_where_a_rim_is_not_clamped(section, radius, layout, spots):
    mesh = disc(radius, radius / 4)
    found = [
        Plate(mesh, replace(section, poisson_ratio=nu), "simply-supported").influence(layout).evaluate(spots)
        for nu in (0.0, 0.45)
    ]
    assert np.abs(found[0][0] - found[1][0]).max() > 1e-3


def test_a_rim_in_two_halves_is_a_rim(section):
    """A name that changes where nothing else does changes nothing but rounding."""
    corners = [(0, -1), (1, -1), (1, 1), (0, 1), (-1, 1), (-1, -1)]
    split = Plate(polygon(corners, 0.5, names=["a", "a", "a", "b", "b", "b"]), section)
    whole = Plate(polygon(corners, 0.5), section)
    spots = np.random.default_rng(2).uniform(-1, 1, (50, 2))
    found = [p.pressure(1e-3).evaluate(spots)[0] for p in (split, whole)]
    assert np.abs(found[0] - found[1]).max() < 1e-5 * found[0].max()


@pytest.mark.parametrize("supports", ["clamped", "simply-supported"])
def test_reversed_boundary_edges_change_nothing(section, supports):
    """Edges have the plate on their left; a mesh that says otherwise has the same rim."""
    mesh = annulus(0.4, 1.0, 0.5)
    turned = replace(mesh, boundaries={name: pairs[:, ::-1] for name, pairs in mesh.boundaries.items()})
    spots = 0.7 * np.stack([np.cos(np.arange(9)), np.sin(np.arange(9))], axis=1)
    found = [Plate(m, section, supports).pressure(1e-3).evaluate(spots)[0] for m in (mesh, turned)]
    assert found[0] == pytest.approx(found[1], rel=1e-9)


@pytest.mark.parametrize("tolerance", [1e-5, 1e-7])
def test_shapes_meet_a_tolerance_near_the_rim_too(section, radius, tolerance, spots):
    points = np.array([[0.9 * radius, 0.0], [-0.2 * radius, 0.3 * radius]])
    shapes = Plate(disc(radius, radius / 3), section, tolerance=tolerance).influence(points)
    away = spots[np.linalg.norm(spots[:, None] - points, axis=-1).min(axis=1) > 0.02 * radius]
    assert shapes.error_estimate <= tolerance
    assert np.abs(shapes.evaluate(away)[0] - DiscShapes(points, radius).evaluate(away)[0]).max() < 3 * tolerance


@pytest.mark.slow
def test_a_tolerance_out_of_reach_ends_and_says_what_was_reached(section, radius, layout):
    shapes = Plate(disc(radius, radius / 2), section, tolerance=1e-14).influence(layout)
    assert shapes.unknowns < 100_000
    assert 1e-14 < shapes.error_estimate < 1e-9
