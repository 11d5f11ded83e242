"""The plate as drawn: actuators among its points, nothing outside of the rim, no cell turned over."""

from pathlib import Path

import numpy as np
import pytest

import meshes
from coupling.drawn_plate import CELLS, drawn_plate

MESH = Path(__file__).parents[1] / "data" / "l_with_hole.msh"
PLATES = {
    "disc": (meshes.disc(1.0, 0.125), [[0, 0], [0.3, 0.2], [0.99, 0]]),
    "annulus": (meshes.annulus(0.3, 1.0, 0.125), [[0.5, 0], [-0.31, 0.0], [0.5, 1e-3]]),
    "L with a hole": (meshes.read(MESH), [[60, 180], [350, 199.9], [155, 105], [200.1, 199]]),
    "crowded": (meshes.disc(1.0, 0.25), 0.02 * np.random.default_rng(0).uniform(-1, 1, (60, 2))),
}


def areas(points, triangles):
    (a, b), (c, d) = (points[triangles[:, k]].T - points[triangles[:, 0]].T for k in (1, 2))
    return (a * d - b * c) / 2


@pytest.mark.parametrize("name", PLATES)
def test_the_actuators_come_first_and_the_cells_tile_the_plate(name):
    mesh, actuators = PLATES[name][0], np.array(PLATES[name][1], dtype=float)
    points, triangles = drawn_plate(mesh, actuators)
    assert np.array_equal(points[: len(actuators)], actuators)
    while len(mesh.triangles) < CELLS:
        mesh = mesh.refined()
    assert (areas(points, triangles) > 0).all()
    assert areas(points, triangles).sum() == pytest.approx(areas(mesh.points, mesh.triangles).sum(), rel=1e-12)
    assert len(np.unique(triangles)) == len(points)
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    _, count = np.unique(edges, axis=0, return_counts=True)
    assert (count == 1).sum() == sum(map(len, mesh.boundaries.values()))
    assert count.max() == 2
    assert mesh.outline.gap(points).min() > -1e-9 * mesh.size
