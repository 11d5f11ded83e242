"""Quadrature at the rim: along the true curve, and in the slivers between it and the chords of the mesh."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fem_plate.elements.forms import Rim
from fem_plate.elements.supports import prescribed
from meshes import PlateMesh

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# A rim triangle's integrands are polynomials along a curve: this many points a side leave rounding errors only.
RIM_POINTS = 8


class Slivers(NamedTuple):
    """Quadrature between chords and the true rim, of negative weight where the rim lies inside its chord."""

    triangle: IntArray  # (k,)
    points: FloatArray  # (k, n, 2)
    weights: FloatArray  # (k, n)


def rim_of(mesh: PlateMesh, supports: Mapping[str, str]) -> tuple[Rim, Slivers]:
    """The rim of a mesh and what its triangles lack of the plate, both dimensionless."""
    gauss, weights = _unit_gauss(RIM_POINTS)
    s = np.concatenate([[0.0], gauss, [1.0]])  # the ends have no weight, but see `Rim.twist`
    edges = np.concatenate(list(mesh.boundaries.values()))
    triangle = _owners(mesh, edges)
    start, end = mesh.points[edges.T] / mesh.size
    arcs = [mesh.arcs(name, s) for name in mesh.boundaries]
    points = np.concatenate([points for points, _ in arcs]) / mesh.size
    tangents = np.concatenate([tangents for _, tangents in arcs]) / mesh.size
    speed = np.linalg.norm(tangents, axis=-1)
    normal = np.stack([tangents[..., 1], -tangents[..., 0]], axis=-1) / speed[..., None]
    length = np.pad(weights, 1) * speed
    kinds = np.repeat([supports[name] for name in mesh.boundaries], [len(e) for e in mesh.boundaries.values()])
    slope, value = np.empty((*points.shape, 2)), np.empty(length.shape)
    for kind in set(kinds.tolist()):
        slope[kinds == kind], value[kinds == kind] = prescribed(kind, normal[kinds == kind])
    held, twist = value[:, 0] > 0, np.zeros(points.shape)
    for side, at, sign in ((0, 0, -1.0), (1, -1, 1.0)):
        meets = ~held & np.isin(edges[:, side], edges[held])
        twist[meets, at] = sign * tangents[meets, at] / speed[meets, at, None]
    # What a trace can be against the energy goes by the cell's height over the edge: 0.87 of it where equilateral.
    a, b, c = np.moveaxis(mesh.points[mesh.triangles[triangle]] / mesh.size, 1, 0)
    height = np.abs(_cross(b - a, c - a)) / np.linalg.norm(end - start, axis=1)
    h = np.minimum(length.sum(axis=1), 2 / np.sqrt(3) * height)
    rim = Rim(triangle, points, length, normal, slope, value, h, twist)

    chord = start[:, None] + gauss[:, None] * (end - start)[:, None]
    bulge, growth = points[:, 1:-1] - chord, tangents[:, 1:-1] - (end - start)[:, None]
    curved = np.abs(bulge).max(axis=(1, 2)) > 1e-14
    chord, bulge, growth = chord[curved, None], bulge[curved, None], growth[curved, None]  # (k, 1, along, 2)
    across = gauss[:, None, None]
    area = _cross(bulge, (end - start)[curved, None, None] + across * growth)
    inside = (chord + across * bulge).reshape(len(bulge), RIM_POINTS**2, 2)
    return rim, Slivers(
        triangle[curved], inside, (np.outer(weights, weights) * area).reshape(len(bulge), RIM_POINTS**2)
    )


def _owners(mesh: PlateMesh, edges: IntArray) -> IntArray:
    """The triangle that each boundary edge (k, 2) belongs to."""
    count = len(mesh.points)
    sides = np.sort(np.stack([mesh.triangles, np.roll(mesh.triangles, -1, axis=1)], axis=2), axis=2)
    keys = (sides[..., 0] * count + sides[..., 1]).reshape(-1)
    order = np.argsort(keys)
    lower, upper = np.sort(edges, axis=1).T
    return np.asarray(order[np.searchsorted(keys, lower * count + upper, sorter=order)] // 3)


def _unit_gauss(count: int) -> tuple[FloatArray, FloatArray]:
    """Gauss-Legendre points and weights on [0, 1]."""
    x, w = np.polynomial.legendre.leggauss(count)
    return (x + 1) / 2, w / 2


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
