"""The plate as drawn: actuators among its points, nothing outside of the rim, no cell turned over, even cells."""

from pathlib import Path

import numpy as np
import pytest

import meshes
from coupling.display.mesh import CELLS, MAX_POINTS, display_mesh, display_points
from meshes.triangles import angles, sides

MESH = Path(__file__).parents[1] / "data" / "l_with_hole.msh"
SPOTS = np.random.default_rng(0).uniform(-1, 1, (600, 2))
PLATES = {  # plate, actuators, holes, area
    "disc": (meshes.disc(1.0, 0.125), [[0, 0], [0.3, 0.2], [0.99, 0]], 0, np.pi),
    "no actuators": (meshes.rectangle(1.5, 1.0, 0.1), np.zeros((0, 2)), 0, 1.5),
    "almost on the rim": (meshes.disc(1.0, 0.125), [[0, 0], [1 - 1e-8, 0]], 0, np.pi),
    "annulus": (meshes.annulus(0.3, 1.0, 0.125), [[0.5, 0], [-0.31, 0.0], [0.5, 1e-3]], 1, 0.91 * np.pi),
    "L with a hole": (meshes.read(MESH), [[60, 180], [350, 199.9], [155, 105], [200.1, 199]], 1, None),
    "sharp corner": (meshes.polygon([[0, 0], [1, 0], [1, 0.1]], 0.05), [[0.5, 0.02], [0.02, 1e-3]], 0, 0.05),
    "crowded": (meshes.disc(1.0, 0.25), 0.02 * SPOTS[:60], 0, np.pi),
    "irregular": (meshes.rectangle(2.1, 2.1, 0.5), SPOTS, 0, 4.41),
}


def areas(points, triangles):
    (a, b), (c, d) = (points[triangles[:, k]].T - points[triangles[:, 0]].T for k in (1, 2))
    return (a * d - b * c) / 2


@pytest.mark.parametrize("name", PLATES)
def test_the_actuators_come_first_and_the_cells_tile_the_plate(name):
    mesh, actuators, holes, area = PLATES[name]
    actuators = np.array(actuators, dtype=float)
    points, triangles = display_mesh(mesh, actuators)
    assert np.array_equal(points[: len(actuators)], actuators)
    assert 0.7 * len(points) < display_points(mesh, actuators) < 1.5 * len(points)
    assert CELLS / 2 < len(triangles) < 25 * len(actuators) + 2 * CELLS
    assert (areas(points, triangles) > 0).all()
    assert len(np.unique(triangles)) == len(points)
    edges, count = np.unique(np.sort(sides(triangles), axis=1), axis=0, return_counts=True)
    assert count.max() == 2
    assert len(points) - len(edges) + len(triangles) == 1 - holes  # one piece without gaps
    rim = edges[count == 1]
    assert np.unique(rim, return_counts=True)[1].max() == 2  # closed
    assert np.abs(mesh.outline.gap(points[rim.ravel()])).max() < 1e-9 * mesh.size
    assert mesh.outline.gap(points).min() > -1e-9 * mesh.size
    if area is not None:
        assert areas(points, triangles).sum() == pytest.approx(area, rel=5e-3)


def lattice(nx, ny):
    return np.stack(np.meshgrid(np.arange(nx), np.arange(ny), indexing="ij"), axis=-1).reshape(-1, 2) - [
        (nx - 1) / 2,
        (ny - 1) / 2,
    ]


@pytest.mark.slow
@pytest.mark.parametrize(("across", "pitch"), [(12, (1.0, 1.0)), (30, (1.0, 0.7)), (100, (1.0, 1.0))])
def test_over_a_lattice_all_cells_but_those_at_the_rim_are_alike(across, pitch):
    actuators = lattice(across, across) * pitch
    side = (across + 2) * np.array(pitch)
    points, triangles = display_mesh(meshes.rectangle(*side, side.max() / 4), actuators)
    assert len(points) < MAX_POINTS
    area, middle = areas(points, triangles), np.abs(points[triangles].mean(axis=1))
    inner = (middle < (across - 1) / 2 * np.array(pitch)).all(axis=1)
    assert np.ptp(area[inner]) < 1e-6 * area[inner].max()
    assert np.prod(pitch) / area[inner][0] >= 18 * (1 - 1e-6)  # three cells either way, each cut in two
    assert np.rad2deg(angles(points, triangles).min()) > 15


@pytest.mark.slow
def test_a_hundred_thousand_actuators_have_no_more_points_than_they_need():
    points, _ = display_mesh(meshes.rectangle(400.0, 252.0, 100.0), lattice(398, 250))
    assert len(points) < 1.05 * MAX_POINTS
