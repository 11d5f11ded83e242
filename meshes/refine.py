"""Refinement of triangles: which edges are cut, and the pieces."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from meshes.curves import Curve
from meshes.nearest import FloatArray, IntArray
from meshes.triangles import edge_numbers, sides


def refine(
    points: FloatArray,
    triangles: IntArray,
    boundaries: Mapping[str, IntArray],
    curves: Mapping[str, Curve],
    marked: NDArray[np.bool_] | None,
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
