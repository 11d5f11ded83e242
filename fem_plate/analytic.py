"""Closed forms for the clamped disc: the theory that the finite elements are checked against.

Central load: equation (2) of the paper,  w = P / (16 pi D) (2 r^2 ln(r/a) + a^2 - r^2).
Any load: Boggio's function (Boggio, 1905), on the unit disc with rigidity 1
    G(x, y) = (R ln(R/S) + S - R) / (16 pi),   R = |x - y|^2,   S = |x|^2 |y|^2 - 2 x.y + 1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fem_plate.elements import Fields, point_load, point_value
from fem_plate.influence import Shapes, check_points
from meshes import Outline

FloatArray = NDArray[np.float64]


def central_load(r: ArrayLike, radius: float, rigidity: float, force: float) -> FloatArray:
    """Deflection [m] of a clamped disc under a central force, at the distance r [m] (any shape) from the centre.

    radius: m.  rigidity: N m.  force: N.
    """
    r = np.asarray(r, dtype=float)
    logarithm = np.log(np.where(r > 0, r, radius) / radius)
    return np.asarray(force / (16 * np.pi * rigidity) * (2 * r**2 * logarithm + radius**2 - r**2))


def disc_green(xy: ArrayLike, source: ArrayLike, radius: float, rigidity: float) -> Fields:
    """Deflection of a clamped disc around the origin under a unit force at `source`.

    xy: (n, 2) m.  source: (2,) m, inside the disc.  radius: m.  rigidity: N m.
    Returns w (n,) m/N, gradient (n, 2) 1/N, Hessian (n, 2, 2) 1/(m N); the Hessian is -inf at the source.
    Raises ValueError when the source does not lie inside the disc.
    """
    x, y = np.asarray(xy, dtype=float) / radius, np.asarray(source, dtype=float)[None] / radius
    if not np.sum(y**2) < 1:
        raise ValueError(f"Input source of disc_green must lie inside the radius {radius!r} m; got {source!r}")
    value, gradient, hessian = (a[:, 0] + b[:, 0] for a, b in zip(point_load(x, y), smooth_part(x, y), strict=True))
    factor = radius**2 / rigidity
    return factor * value, factor / radius * gradient, factor / radius**2 * hessian


def smooth_part(x: FloatArray, sources: FloatArray) -> Fields:
    """Boggio's function without its singular part: (-R ln S + S - R) / (16 pi), on the unit disc with rigidity 1.

    x: (n, 2).  sources: (N, 2).  Returns the value (n, N), gradient (n, N, 2) and Hessian (n, N, 2, 2); it is smooth
    up to the rim and somewhat beyond.
    """
    offset = x[:, None] - sources  # half the gradient of R
    square = (sources**2).sum(axis=1)
    image = x[:, None] * square[:, None] - sources  # half the gradient of S
    big_r = (offset**2).sum(axis=-1)
    big_s = (x**2).sum(axis=1)[:, None] * square - 2 * x @ sources.T + 1
    logarithm, ratio = np.log(big_s), big_r / big_s
    by_r, by_s = -logarithm - 1, 1 - ratio
    value = -big_r * logarithm + big_s - big_r
    gradient = 2 * (by_r[..., None] * offset + by_s[..., None] * image)
    cross = offset[..., :, None] * image[..., None, :]
    both = image[..., :, None] * image[..., None, :]
    hessian = 4 / big_s[..., None, None] * (ratio[..., None, None] * both - cross - np.swapaxes(cross, -1, -2))
    for axis in range(2):
        hessian[..., axis, axis] += 2 * (by_r + by_s * square)
    return value / (16 * np.pi), gradient / (16 * np.pi), hessian / (16 * np.pi)


def smooth_value(x: FloatArray, sources: FloatArray) -> FloatArray:
    """The value (n, N) of `smooth_part` alone, in a twentieth of its memory."""
    near, far, product = (x**2).sum(axis=1)[:, None], (sources**2).sum(axis=1), 2 * x @ sources.T
    big_r, big_s = near + far - product, near * far - product + 1
    return np.asarray((big_s - big_r * (np.log(big_s) + 1)) / (16 * np.pi))


class DiscShapes(Shapes):
    """The influence functions of a clamped disc in closed form (Boggio): what `Plate.influence` computes, exactly.

    points: (N, 2) m, inside the radius [m], around the origin.
    Raises ValueError when a point does not lie inside the disc or two coincide.
    """

    def __init__(self, points: ArrayLike, radius: float) -> None:
        points = np.atleast_2d(np.asarray(points, dtype=float))
        check_points("DiscShapes", points, radius - np.hypot(*points.T), radius)
        self.points, self.size = np.ascontiguousarray(points), radius
        self.outline = Outline(conics=np.array([[0.0, 0.0, radius, radius]]))
        x = points / radius
        compliance = point_value(x, x) + smooth_value(x, x)
        self.strengths = np.asarray(np.linalg.inv((compliance + compliance.T) / 2))

    def fields(self, x: FloatArray, weights: FloatArray | None) -> Fields:
        strengths = self.strengths if weights is None else self.strengths @ weights
        sources = self.points / self.size
        parts = zip(smooth_part(x, sources), point_load(x, sources), strict=True)
        value, gradient, hessian = (smooth + singular for smooth, singular in parts)
        return (
            value @ strengths,
            np.einsum("njd,jk->nkd", gradient, strengths),
            np.einsum("njde,jk->nkde", hessian, strengths),
        )

    def nearby(self, xy: FloatArray) -> tuple[NDArray[np.int64], FloatArray]:
        return np.arange(len(self.points)), self._values(xy / self.size)

    def own_heights(self) -> FloatArray:
        return np.abs(np.diag(self._values(self.points / self.size)))

    def _values(self, x: FloatArray) -> FloatArray:
        sources = self.points / self.size
        return np.asarray((smooth_value(x, sources) + point_value(x, sources)) @ self.strengths)
