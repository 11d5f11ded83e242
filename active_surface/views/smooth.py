"""Smooth: heights between the points of a mesh, by cubics with slopes that are fitted around each point.

A result holds heights at points; a picture made of flat triangles between them shows edges that the plate has not.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_matrix, diags
from scipy.spatial import cKDTree

from active_surface.arrays import BoolArray, FloatArray, IntArray
from active_surface.views.triangles import barycentric

AROUND = 12  # points that a slope is fitted to, by a quadratic
NEAREST = 24  # triangles among which that of a point is sought
BATCH = 4096  # points that are sought together
OUTSIDE = 1e-6  # of a triangle's height: a point further out is not on the mesh


@dataclass(frozen=True, eq=False)
class Smooth:
    """Heights at points (n, 2) [m] with triangles (m, 3), and anywhere between."""

    points: FloatArray
    triangles: IntArray

    def locate(self, xy: FloatArray) -> tuple[IntArray, FloatArray, BoolArray]:
        """The triangle (k,) of points (k, 2) [m], their barycentric coordinates (k, 3), and whether they are in it.

        A point that is in none has a place near it, on the rim.
        """
        blocks = [self._locate(xy[first : first + BATCH]) for first in range(0, max(len(xy), 1), BATCH)]
        triangle, shares, inside = (np.concatenate(parts) for parts in zip(*blocks, strict=True))
        return triangle, shares, inside

    def _locate(self, xy: FloatArray) -> tuple[IntArray, FloatArray, BoolArray]:
        """The same for so few points that memory does not matter."""
        nearest = self._tree.query(xy, k=min(NEAREST, len(self.triangles)))[1].reshape(len(xy), -1)
        corners = self.points[self.triangles[nearest]]  # (k, NEAREST, 3, 2)
        shares = barycentric(corners, xy[:, None, :])
        kept = np.clip(shares, 0, None)
        kept /= kept.sum(axis=-1, keepdims=True)
        away = np.square((corners * kept[..., None]).sum(axis=2) - xy[:, None]).sum(axis=-1)
        best, rows = away.argmin(axis=1), np.arange(len(xy))
        inside = shares[rows, best].min(axis=-1) >= -OUTSIDE
        return nearest[rows, best], kept[rows, best], inside

    def at(self, xy: FloatArray) -> csr_matrix:
        """The matrix (k, n) from heights (n,) at the mesh's points to those at points (k, 2) [m] on it."""
        triangle, shares, _ = self.locate(xy)
        return self.within(triangle, shares)

    def within(self, triangle: IntArray, shares: FloatArray) -> csr_matrix:
        """The same for barycentric coordinates (k, 3) in triangles (k,).

        A Bezier triangle: w_1 at a corner, w_1 + g_1 (p_2 - p_1)/3 a third of the way to the next, and in the middle
        what keeps quadratics exact.
        """
        corners = self.triangles[triangle]
        place = self.points[corners]
        value = shares**2 * (3 - 2 * shares)
        slope = np.zeros((len(triangle), 3, 2))
        middle = shares.prod(axis=1)
        for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            value[:, i] += 2 * middle
            for other in (j, k):
                share = shares[:, i] ** 2 * shares[:, other] + middle / 2
                slope[:, i] += share[:, None] * (place[:, other] - place[:, i])
        rows = np.repeat(np.arange(len(triangle)), 3)
        shape = (len(triangle), len(self.points))

        def matrix(weights: FloatArray) -> csr_matrix:
            return csr_matrix((weights.ravel(), (rows, corners.ravel())), shape)

        along_x, along_y = self._slopes
        return csr_matrix(matrix(value) + matrix(slope[..., 0]) @ along_x + matrix(slope[..., 1]) @ along_y)

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.points[self.triangles].mean(axis=1))

    @cached_property
    def _slopes(self) -> tuple[csr_matrix, csr_matrix]:
        """The matrices (n, n) from heights to slopes along x and y."""
        n = len(self.points)
        if n <= AROUND:
            return csr_matrix((n, n)), csr_matrix((n, n))
        tree = cKDTree(self.points)
        blocks = [self._fit(tree, self.points[first : first + BATCH]) for first in range(0, n, BATCH)]
        nearest, fit = (np.concatenate(parts) for parts in zip(*blocks, strict=True))
        rows = np.repeat(np.arange(n), AROUND)
        slopes = [csr_matrix((part.ravel(), (rows, nearest.ravel())), (n, n)) for part in np.moveaxis(fit, 1, 0)]
        along_x, along_y = (s - diags(np.asarray(s.sum(axis=1)).ravel()) for s in slopes)
        return csr_matrix(along_x), csr_matrix(along_y)

    def _fit(self, tree: cKDTree, points: FloatArray) -> tuple[IntArray, FloatArray]:
        """The points (k, AROUND) around some, and the weights (k, 2, AROUND) of their heights in the slopes there."""
        distance, nearest = tree.query(points, k=AROUND + 1)
        nearest, reach = nearest[:, 1:], distance[:, -1:]
        x, y = np.moveaxis((self.points[nearest] - points[:, None]) / reach[..., None], -1, 0)
        weight = 1 / (0.1 + x**2 + y**2)
        terms = np.stack([x, y, x * x, x * y, y * y], axis=-1) * weight[..., None]
        return nearest, np.linalg.pinv(terms, rcond=1e-6)[:, :2] * weight[:, None, :] / reach[..., None]
