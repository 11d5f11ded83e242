"""Responses of an infinite plate to loads, in closed form: what finite elements need not approximate.

In dimensionless variables a unit force deflects it by F(r) = r^2 ln(r) / (8 pi), which no polynomial can follow, and a
unit pressure by r^4 / 64 (laplace^2 F = delta, laplace^2 r^4 / 64 = 1).
"""

from __future__ import annotations

import numpy as np

from fem_plate.types import FloatArray

UNIT_STRENGTH = 1 / (8 * np.pi)


def point_load(xy: FloatArray, sources: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """F around each source.

    xy: (n, 2).  sources: (N, 2).  Returns the value (n, N), gradient (n, N, 2) and Hessian (n, N, 2, 2). At a source,
    value and gradient are 0 and the diagonal of the Hessian is -inf.
    """
    offset = xy[:, None] - sources
    square = (offset**2).sum(axis=-1)
    at_source = square == 0
    with np.errstate(divide="ignore"):
        logarithm = np.log(square)  # 2 ln r
    finite = np.where(at_source, 0.0, logarithm)
    value = UNIT_STRENGTH * 0.5 * square * finite
    gradient = UNIT_STRENGTH * (finite + 1)[..., None] * offset
    direction = offset / np.sqrt(np.where(at_source, 1.0, square))[..., None]
    hessian = 2 * direction[..., :, None] * direction[..., None, :]
    hessian[..., 0, 0] += logarithm + 1
    hessian[..., 1, 1] += logarithm + 1
    return value, gradient, UNIT_STRENGTH * hessian


def point_value(xy: FloatArray, sources: FloatArray) -> FloatArray:
    """F alone, (n, N)."""
    square = (xy[:, :1] - sources[:, 0]) ** 2 + (xy[:, 1:] - sources[:, 1]) ** 2
    return UNIT_STRENGTH * 0.5 * square * np.log(np.where(square == 0, 1.0, square))


def point_laplacian(xy: FloatArray, sources: FloatArray, floor: float) -> FloatArray:
    """The Laplacian of F, (n, N); within the radius `floor`, of the parabola in r^2 that continues F there (C2)."""
    square = (xy[:, :1] - sources[:, 0]) ** 2 + (xy[:, 1:] - sources[:, 1]) ** 2
    bounded = np.maximum(square, floor**2)
    return UNIT_STRENGTH * (2 * np.log(bounded) + 4 * square / bounded)


def point_derivatives(xy: FloatArray, source: FloatArray) -> list[FloatArray]:
    """The derivatives of orders 0 to 3, each (d, k, n), of F around one source (2,) at points (k, n, 2) off it."""
    x, y = np.moveaxis(xy - source, -1, 0)
    square = x**2 + y**2
    logarithm = np.log(square) + 1
    orders = [
        [0.5 * square * (logarithm - 1)],
        [logarithm * x, logarithm * y],
        [logarithm + 2 * x**2 / square, 2 * x * y / square, logarithm + 2 * y**2 / square],
        [
            (6 * x - 4 * x**3 / square) / square,
            (2 * y - 4 * x**2 * y / square) / square,
            (2 * x - 4 * x * y**2 / square) / square,
            (6 * y - 4 * y**3 / square) / square,
        ],
    ]
    return [UNIT_STRENGTH * np.stack(order) for order in orders]


def pressure_derivatives(xy: FloatArray) -> list[FloatArray]:
    """The derivatives of orders 0 to 3, each (d, ...), of r^4 / 64 at points (..., 2)."""
    x, y = np.moveaxis(xy, -1, 0)
    square = x**2 + y**2
    orders = [
        [square**2],
        [4 * x * square, 4 * y * square],
        [4 * square + 8 * x**2, 8 * x * y, 4 * square + 8 * y**2],
        [24 * x, 8 * y, 8 * x, 24 * y],
    ]
    return [np.stack(order) / 64 for order in orders]
