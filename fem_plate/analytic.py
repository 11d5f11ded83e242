"""Closed forms for the clamped disc: the theory that the finite elements are checked against.

Central load: equation (2) of the paper,  w = P / (16 pi D) (2 r^2 ln(r/a) + a^2 - r^2).
Any load: Boggio's function (Boggio, 1905), on the unit disc with rigidity 1
    G(x, y) = (R ln(R/S) + S - R) / (16 pi),   R = |x - y|^2,   S = |x|^2 |y|^2 - 2 x.y + 1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from fem_plate.elements import Derivatives, point_load, point_value
from fem_plate.inputs import check_points
from fem_plate.shapes import Shapes
from fem_plate.types import FloatArray, IntArray
from meshes import Outline


def central_load(r: ArrayLike, radius: float, rigidity: float, force: float) -> FloatArray:
    """Deflection of a clamped disc under a central force: equation (2).

    Parameters
    ----------
    r : array_like
        Distance from the centre [m], of any shape.
    radius : float
        [m].
    rigidity : float
        Flexural rigidity [N m].
    force : float
        [N].

    Returns
    -------
    array of the shape of r
        [m].
    """
    r = np.asarray(r, dtype=float)
    logarithm = np.log(np.where(r > 0, r, radius) / radius)
    return np.asarray(force / (16 * np.pi * rigidity) * (2 * r**2 * logarithm + radius**2 - r**2))


def disc_green(xy: ArrayLike, source: ArrayLike, radius: float, rigidity: float) -> Derivatives:
    """Deflection of a clamped disc around the origin under a unit force, with first and second derivatives.

    Parameters
    ----------
    xy : (n, 2) array_like
        Points [m].
    source : (2,) array_like
        Where the force acts, inside the disc [m].
    radius : float
        [m].
    rigidity : float
        Flexural rigidity [N m].

    Returns
    -------
    w : (n,) array
        [m/N].
    gradient : (n, 2) array
        [1/N].
    hessian : (n, 2, 2) array
        [1/(m N)]; -inf on its diagonal at the source.

    Raises
    ------
    ValueError
        The source does not lie inside the disc.
    """
    x, y = np.asarray(xy, dtype=float) / radius, np.asarray(source, dtype=float)[None] / radius
    if not np.sum(y**2) < 1:
        raise ValueError(f"Input source of disc_green must lie inside the radius {radius!r} m; got {source!r}")
    value, gradient, hessian = (a[:, 0] + b[:, 0] for a, b in zip(point_load(x, y), smooth_part(x, y), strict=True))
    factor = radius**2 / rigidity
    return factor * value, factor / radius * gradient, factor / radius**2 * hessian


def smooth_part(x: FloatArray, sources: FloatArray) -> Derivatives:
    """Boggio's function without its singular part: (-R ln S + S - R) / (16 pi), on the unit disc with rigidity 1.

    x: (n, 2).  sources: (N, 2).
    Returns the value (n, N), gradient (n, N, 2) and Hessian (n, N, 2, 2), smooth up to the rim and somewhat beyond it.
    """
    half_grad_r = x[:, None] - sources
    square = (sources**2).sum(axis=1)
    half_grad_s = x[:, None] * square[:, None] - sources
    R = (half_grad_r**2).sum(axis=-1)
    S = (x**2).sum(axis=1)[:, None] * square - 2 * x @ sources.T + 1
    logarithm, ratio = np.log(S), R / S
    by_r, by_s = -logarithm - 1, 1 - ratio  # derivatives of -R ln S + S - R
    value = -R * logarithm + S - R
    gradient = 2 * (by_r[..., None] * half_grad_r + by_s[..., None] * half_grad_s)
    rs = half_grad_r[..., :, None] * half_grad_s[..., None, :]
    ss = half_grad_s[..., :, None] * half_grad_s[..., None, :]
    hessian = 4 / S[..., None, None] * (ratio[..., None, None] * ss - rs - np.swapaxes(rs, -1, -2))
    for axis in range(2):
        hessian[..., axis, axis] += 2 * (by_r + by_s * square)
    return value / (16 * np.pi), gradient / (16 * np.pi), hessian / (16 * np.pi)


def smooth_value(x: FloatArray, sources: FloatArray) -> FloatArray:
    """The value (n, N) of `smooth_part` alone, in a twentieth of its memory."""
    x_square, y_square, product = (x**2).sum(axis=1)[:, None], (sources**2).sum(axis=1), 2 * x @ sources.T
    R, S = x_square + y_square - product, x_square * y_square - product + 1
    return np.asarray((S - R * (np.log(S) + 1)) / (16 * np.pi))


class DiscShapes(Shapes):
    """The influence functions of rigid actuators under a clamped disc around the origin, by Boggio's function.

    Parameters
    ----------
    points : (N, 2) array_like
        Places of the actuators, inside the disc [m].
    radius : float
        [m].

    Raises
    ------
    ValueError
        A point does not lie inside the disc, or two coincide.
    """

    def __init__(self, points: ArrayLike, radius: float) -> None:
        points = np.atleast_2d(np.asarray(points, dtype=float))
        check_points("DiscShapes", points, radius - np.hypot(*points.T), radius)
        self.points, self.size = np.ascontiguousarray(points), radius
        self.springs = np.full(len(points), np.inf)
        self.outline = Outline(conics=np.array([[0.0, 0.0, radius, radius]]))
        x = points / radius
        compliance = point_value(x, x) + smooth_value(x, x)
        self.strengths = np.asarray(np.linalg.inv((compliance + compliance.T) / 2))

    def derivatives(self, x: FloatArray, weights: FloatArray | None) -> Derivatives:
        forces = self.strengths if weights is None else self.strengths @ weights
        sources = self.points / self.size
        parts = zip(smooth_part(x, sources), point_load(x, sources), strict=True)
        value, gradient, hessian = (smooth + singular for smooth, singular in parts)
        return (
            value @ forces,
            np.einsum("njd,jk->nkd", gradient, forces),
            np.einsum("njde,jk->nkde", hessian, forces),
        )

    def nonzero_values(self, xy: FloatArray) -> tuple[IntArray, FloatArray]:
        return np.arange(len(self.points)), self._values(xy / self.size)

    def own_heights(self) -> FloatArray:
        return np.abs(np.diag(self._values(self.points / self.size)))

    def _values(self, x: FloatArray) -> FloatArray:
        sources = self.points / self.size
        return np.asarray((smooth_value(x, sources) + point_value(x, sources)) @ self.strengths)
