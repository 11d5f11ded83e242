"""The free-space deflection under a unit force: the part of a point load's answer that no polynomial can follow.

F(r) = r^2 ln(r) / (8 pi), in dimensionless variables, satisfies laplace^2 F = delta.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

UNIT_STRENGTH = 1 / (8 * np.pi)


def point_load(xy: FloatArray, sources: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """F around each source.

    xy: (n, 2).  sources: (N, 2).  Returns the value (n, N), gradient (n, N, 2) and Hessian (n, N, 2, 2). At a source
    value and gradient are 0 and the Hessian is -inf on its diagonal.
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
