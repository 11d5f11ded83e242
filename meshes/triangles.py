"""Triangles as arrays: their areas, angles, sides and edges."""

from __future__ import annotations

import numpy as np

from meshes.nearest import FloatArray, IntArray


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """The cross products of vectors (..., 2)."""
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def areas(points: FloatArray, triangles: IntArray) -> FloatArray:
    """The areas (m,) of triangles (m, 3), negative where they run clockwise."""
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    return cross(b - a, c - a) / 2


def angles(points: FloatArray, triangles: IntArray) -> FloatArray:
    """The angles (m, 3) [rad] of triangles at their corners, negative where they run clockwise."""
    corners = points[triangles]
    to_next, to_last = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    return np.asarray(np.arctan2(cross(to_next, to_last), (to_next * to_last).sum(axis=-1)))


def sides(triangles: IntArray) -> IntArray:
    """The directed sides (3 m, 2) of triangles (m, 3); side k of a triangle runs from corner k to corner k + 1."""
    return np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)


def edge_numbers(pairs: IntArray, count: int) -> IntArray:
    """One number (k,) for each undirected edge (k, 2) between `count` points, in the order of its sorted ends."""
    return np.asarray(pairs.min(axis=1).astype(np.int64) * count + pairs.max(axis=1))
