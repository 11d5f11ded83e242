"""Influence shapes: how the plate stands when one actuator is raised by one metre and the others hold 0."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fem_plate.singular import point_load
from meshes import Circle

FloatArray = NDArray[np.float64]
Fields = tuple[FloatArray, FloatArray, FloatArray]


class Shapes(ABC):
    """The influence functions of N actuators, phi_i(x_j) = delta_ij.

    Each is a sum of free-space point loads and a smooth part, phi_i = sum_j strengths[j, i] F((x - x_j)/size) + v_i(x),
    with dimensionless forces `strengths` = G^-1, the inverse of the compliance G_ij = w(x_i) under a unit force at x_j.

    points: (N, 2) m.  size: m, the length that makes everything dimensionless.  outline: the rim's curve.
    """

    def __init__(self, points: FloatArray, size: float, outline: Circle, compliance: FloatArray) -> None:
        self.points = np.ascontiguousarray(points)  # kernels would be compiled anew for another layout
        self.size = size
        self.outline = outline
        self.strengths: FloatArray = np.asarray(np.linalg.inv((compliance + compliance.T) / 2), dtype=float)

    @abstractmethod
    def loaded(self, x: FloatArray, strengths: FloatArray) -> Fields:
        """The smooth part of the plate under dimensionless forces (N, k) at the actuators, at x (n, 2), dimensionless.

        Returns value (n, k), gradient (n, k, 2) and Hessian (n, k, 2, 2), dimensionless.
        """

    def smooth(self, xy: ArrayLike) -> FloatArray:
        """The smooth parts v_i at points (n, 2) [m]: (n, N), dimensionless."""
        return self.loaded(np.asarray(xy, dtype=float) / self.size, self.strengths)[0]

    def evaluate(self, xy: ArrayLike, weights: ArrayLike | None = None) -> Fields:
        """The shapes, or their weighted sum.

        xy: (n, 2) m.  weights: (N,), for instance the strokes [m].
        Returns value (n, N), gradient (n, N, 2) 1/m and Hessian (n, N, 2, 2) 1/m^2; with weights (n,), (n, 2) and
        (n, 2, 2), times the weights' unit. At an actuator the Hessian is infinite (a point load bends without bound).
        Raises ValueError when a point lies beyond the rim.
        """
        strengths = self.strengths
        if weights is not None:
            strengths = strengths @ np.asarray(weights, dtype=float)[:, None]
        fields = self.under_forces(xy, strengths)
        return fields if weights is None else (fields[0][:, 0], fields[1][:, 0], fields[2][:, 0])

    def under_forces(self, xy: ArrayLike, strengths: FloatArray) -> Fields:
        """The plate under dimensionless forces (N, k) at the actuators, with none of them holding it.

        Returns value (n, k), gradient (n, k, 2) 1/m and Hessian (n, k, 2, 2) 1/m^2 at points (n, 2) [m].
        Raises ValueError when a point lies beyond the rim.
        """
        xy = np.asarray(xy, dtype=float)
        beyond = self.outline.gap(xy) < -1e-9 * self.size
        if np.any(beyond):
            raise ValueError(f"Input xy of evaluate must lie on the plate; got {xy[beyond][0].tolist()} m")
        x = xy / self.size
        value, gradient, hessian = self.loaded(x, strengths)
        f, f_x, f_xx = point_load(x, self.points / self.size)
        with np.errstate(invalid="ignore"):
            return (
                value + f @ strengths,
                (gradient + np.einsum("njd,jk->nkd", f_x, strengths)) / self.size,
                (hessian + np.einsum("njde,jk->nkde", f_xx, strengths)) / self.size**2,
            )


def check_points(points: FloatArray, gap: FloatArray, size: float) -> None:
    """Raises ValueError, naming every point (N, 2) that is not inside the rim (by its gap) or stands on another."""
    wrong = [] if points.size else ["at least one point is needed"]
    for i, (point, room) in enumerate(zip(points.tolist(), gap.tolist(), strict=True)):
        if not room > 1e-9 * size:
            wrong.append(f"point {i + 1} at {point} m must lie inside the rim; it is {-room:.3g} m beyond it")
    if len(points) > 1:
        distance = np.linalg.norm(points[:, None] - points, axis=-1)
        for i, j in np.argwhere(np.triu(distance < 1e-9 * size, k=1)).tolist():
            wrong.append(f"points {i + 1} and {j + 1} must differ; both are at {points[i].tolist()} m")
    if wrong:
        raise ValueError("Input points of influence: " + "; ".join(wrong))
