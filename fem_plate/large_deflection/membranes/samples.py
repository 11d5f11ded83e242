"""Samples: the slopes of a plate's functions, and the forces of a membrane's, at the points of a quadrature."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem_plate.elements import PlateSpace
from fem_plate.types import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Samples:
    """n points on each of k triangles.

    Arrays are stacked: slopes (k, 2 n) hold x at all points, then y; tensors (k, 3 n) hold xx, then xy, then yy.
    """

    triangle: IntArray  # (k,)
    points: FloatArray  # (k, n, 2)
    weights: FloatArray  # (k, n)
    gradient: FloatArray  # (k, 2 n, 21), slopes of the plate's functions
    operator: FloatArray  # (k, 3 n, m), membrane forces of the membrane's functions

    @staticmethod
    def at(
        space: PlateSpace, triangle: IntArray, points: FloatArray, weights: FloatArray, operator: FloatArray
    ) -> Samples:
        """Samples at points of triangles (k,)."""
        x, y = space.triangles.derivatives(points, triangle, 1)
        return Samples(triangle, points, weights, np.concatenate([x, y], axis=1), operator)

    def weighted(self, stacked: FloatArray) -> FloatArray:
        """Stacked quantities (k, j n, ...) times the weights."""
        whole = np.tile(self.weights, stacked.shape[1] // self.weights.shape[1])
        return stacked * whole.reshape(*whole.shape, *[1] * (stacked.ndim - 2))


def halves(slopes: FloatArray) -> tuple[FloatArray, FloatArray]:
    """x and y of stacked slopes (k, 2 n, ...)."""
    n = slopes.shape[1] // 2
    return slopes[:, :n], slopes[:, n:]


def thirds(tensor: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """xx, xy and yy of stacked tensors (k, 3 n, ...)."""
    n = tensor.shape[1] // 3
    return tensor[:, :n], tensor[:, n : 2 * n], tensor[:, 2 * n :]


def times(tensor: FloatArray, slopes: FloatArray) -> FloatArray:
    """Tensors (k, 3 n) times slopes (k, 2 n, c): (k, 2 n, c)."""
    xx, xy, yy = thirds(tensor[..., None])
    x, y = halves(slopes)
    return np.concatenate([xx * x + xy * y, xy * x + yy * y], axis=1)


def strains(p: FloatArray, slopes: FloatArray) -> FloatArray:
    """p (k, 2 n) with slopes q (k, 2 n, c) as strains (p_x q_x, p_x q_y + p_y q_x, p_y q_y): (k, 3 n, c)."""
    (p_x, p_y), (x, y) = halves(p[..., None]), halves(slopes)
    return np.concatenate([p_x * x, p_x * y + p_y * x, p_y * y], axis=1)


def squares(p: FloatArray) -> FloatArray:
    """p with itself, (k, 3 n)."""
    return strains(p, p[..., None])[..., 0]
