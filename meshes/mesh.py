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

    def rim_gap(self, xy: ArrayLike) -> FloatArray:
        """Distance [m] of points (..., 2) from the nearest boundary, negative beyond it."""
        return np.min([curve.gap(xy) for curve in self.curves.values()], axis=0)

    def arcs(self, name: str, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """A boundary's edges along its true curve at s (n,) in [0, 1]: points (k, n, 2) m and derivatives in s."""
        start, end = self.points[self.boundaries[name].T]
        return self.curves[name].arc(start, end, s)

    def refined(self) -> PlateMesh:
        """The mesh with every triangle cut in four; new boundary points lie on the true curve."""
        corners = np.sort(self.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges, edge_of = np.unique(corners, axis=0, return_inverse=True)
        middle = self.points[edges].mean(axis=1)
        row = {(int(a), int(b)): index for index, (a, b) in enumerate(edges)}
        boundaries = {}
        for name, pairs in self.boundaries.items():
            cut = np.array([row[min(a, b), max(a, b)] for a, b in pairs.tolist()])
            if name in self.curves:
                middle[cut] = self.curves[name].project(middle[cut])
            new = len(self.points) + cut
            boundaries[name] = np.concatenate(
                [np.stack([pairs[:, 0], new], axis=1), np.stack([new, pairs[:, 1]], axis=1)]
            )
        a, b, c = self.triangles.T
        ab, bc, ca = (len(self.points) + edge_of.reshape(-1, 3)).T
        triangles = np.concatenate([np.stack(t, axis=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
        return PlateMesh(np.concatenate([self.points, middle]), triangles, boundaries, self.curves)
