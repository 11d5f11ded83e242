"""PlateMesh: the triangles of a plate, its named boundaries and the curves that they stand for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshes.curves import Circle

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class PlateMesh:
    """A conforming triangulation of a plate, centred on the origin.

    points: (n, 2) m.  triangles: (m, 3) rows of points, counter-clockwise.
    boundaries: name -> (k, 2) rows of points, the edges on that boundary.
    curves: name -> the curve that those edges approximate.
    """

    points: FloatArray
    triangles: IntArray
    boundaries: Mapping[str, IntArray]
    curves: Mapping[str, Circle] = field(default_factory=dict)

    @cached_property
    def size(self) -> float:
        """Half of the larger side of the box around the plate [m]: the length that makes equations dimensionless."""
        return float(np.max(np.ptp(self.points, axis=0)) / 2)

    def mirrored(self, xy: FloatArray) -> FloatArray:
        """Points (n, 2) [m] reflected at each of b boundaries: (b n, 2)."""
        return np.concatenate([2 * curve.project(xy) - xy for curve in self.curves.values()])

    def rim_gap(self, xy: ArrayLike) -> FloatArray:
        """Distance [m] of points (..., 2) from the nearest boundary, negative beyond it."""
        return np.min([curve.gap(xy) for curve in self.curves.values()], axis=0)

    def arcs(self, name: str, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """A boundary's edges along its true curve at s (n,) in [0, 1]: points (k, n, 2) m and derivatives in s."""
        start, end = self.points[self.boundaries[name].T]
        return self.curves[name].arc(start, end, s)

    @cached_property
    def cell_sizes(self) -> FloatArray:
        """The longest edge of each triangle [m], (m,)."""
        corners = self.points[self.triangles]
        return np.asarray(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1))

    def refined(self, marked: NDArray[np.bool_] | None = None) -> PlateMesh:
        """The mesh with marked triangles (m,) cut in four, all by default, and their neighbours cut to fit.

        An edge is only cut along with the longest edge of its triangles, so that angles stay as they are (red, green
        and blue refinement). New boundary points lie on the true curve.
        """
        sides = np.stack([self.triangles, np.roll(self.triangles, -1, axis=1)], axis=2)  # side k: corners k, k+1
        length = np.linalg.norm(np.diff(self.points[sides], axis=2)[:, :, 0], axis=2)
        # Every triangle starts at its longest side.
        order = (np.argmax(length, axis=1)[:, None] + np.arange(3)) % 3
        triangles = np.take_along_axis(self.triangles, order, axis=1)
        sides = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2)
        edges, edge_of = np.unique(np.sort(sides.reshape(-1, 2), axis=1), axis=0, return_inverse=True)
        edge_of = edge_of.reshape(-1, 3)
        cut = np.zeros(len(edges), dtype=bool)
        cut[edge_of if marked is None else edge_of[marked]] = True
        while True:
            longest = edge_of[cut[edge_of].any(axis=1), 0]
            if cut[longest].all():
                break
            cut[longest] = True
        middle = np.full(len(edges), -1)
        middle[cut] = len(self.points) + np.arange(cut.sum())
        new_points = self.points[edges[cut]].mean(axis=1)
        row = {(a, b): int(middle[index]) for index, (a, b) in enumerate(edges.tolist())}
        boundaries = {}
        for name, pairs in self.boundaries.items():
            between = np.array([row[min(a, b), max(a, b)] for a, b in pairs.tolist()])
            if name in self.curves:
                new = between[between >= 0] - len(self.points)
                new_points[new] = self.curves[name].project(new_points[new])
            whole, halves = pairs[between < 0], np.insert(pairs, 1, between, axis=1)[between >= 0]
            boundaries[name] = np.concatenate([whole, halves[:, :2], halves[:, 1:]])
        pieces = _cut(triangles, middle[edge_of])
        return PlateMesh(np.concatenate([self.points, new_points]), pieces, boundaries, self.curves)


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
