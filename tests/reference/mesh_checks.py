"""Areas, angles and perimeters of meshes, and whether they conform."""

from collections import Counter

import numpy as np

from meshes import PlateMesh

STAR = [(r * np.cos(k * np.pi / 5), r * np.sin(k * np.pi / 5)) for k, r in enumerate([1, 0.4] * 5)]
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
