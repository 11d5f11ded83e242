"""Triangles as arrays: their areas, angles, sides and edges, and their refinement."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from meshes.curves import Curve
from meshes.types import BoolArray, FloatArray, IntArray


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


def refine(
    points: FloatArray,
    triangles: IntArray,
    boundaries: Mapping[str, IntArray],
    curves: Mapping[str, Curve],
    marked: BoolArray | None,
) -> tuple[FloatArray, IntArray, dict[str, IntArray]]:
    """Points, triangles and boundaries after cutting marked triangles (m,), all by default, in four.

    An edge is cut only if the longest edges of its triangles are cut too, so that angles do not shrink (red, green and
    blue refinement: R. Verfuerth, A Posteriori Error Estimation Techniques, 2013, section 2.1).
    """
    start, end = np.moveaxis(points[sides(triangles)], 1, 0)
    length = np.linalg.norm(end - start, axis=1).reshape(-1, 3)
    # Turn every triangle to start at its longest side.
    order = (np.argmax(length, axis=1)[:, None] + np.arange(3)) % 3
    triangles = np.take_along_axis(triangles, order, axis=1)
    edges, edge_of = np.unique(edge_numbers(sides(triangles), len(points)), return_inverse=True)
    edge_of = edge_of.reshape(-1, 3)
    cut = np.zeros(len(edges), dtype=bool)
    cut[edge_of if marked is None else edge_of[marked]] = True
    while True:
        longest = edge_of[cut[edge_of].any(axis=1), 0]
        if cut[longest].all():
            break
        cut[longest] = True
    middle = np.full(len(edges), -1)
    middle[cut] = len(points) + np.arange(cut.sum())
    ends = np.stack(np.divmod(edges[cut], len(points)), axis=1)
    new_points = points[ends].mean(axis=1)
    halved = {}
    for name, pairs in boundaries.items():
        between = middle[np.searchsorted(edges, edge_numbers(pairs, len(points)))]
        if name in curves:
            on_curve = between[between >= 0] - len(points)
            new_points[on_curve] = curves[name].project(new_points[on_curve])
        whole, halves = pairs[between < 0], np.insert(pairs, 1, between, axis=1)[between >= 0]
        halved[name] = np.concatenate([whole, halves[:, :2], halves[:, 1:]])
    return np.concatenate([points, new_points]), _cut(triangles, middle[edge_of]), halved


def _cut(triangles: IntArray, middle: IntArray) -> IntArray:
    """The pieces of triangles abc (m, 3) whose sides ab, bc, ca have middles (m, 3), -1 where a side is whole.

    Where any side is cut, ab is.
    """
    (a, b, c), (ab, bc, ca) = triangles.T, middle.T
    cut = middle >= 0
    patterns = {
        (False, False, False): [(a, b, c)],
        (True, False, False): [(a, ab, c), (ab, b, c)],
        (True, True, False): [(a, ab, c), (ab, b, bc), (ab, bc, c)],
        (True, False, True): [(a, ab, ca), (ca, ab, c), (ab, b, c)],
        (True, True, True): [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)],
    }
    return np.concatenate(
        [
            np.stack(piece, axis=1)[(cut == pattern).all(axis=1)]
            for pattern, pieces in patterns.items()
            for piece in pieces
        ]
    )
