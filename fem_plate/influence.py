"""Influence shapes: how the plate stands when one actuator is raised by one metre and the others hold 0."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from fem_plate.field import Estimated, Field, Fields
from fem_plate.model import PlateModel
from fem_plate.singular import point_value
from meshes import Outline

FloatArray = NDArray[np.float64]

MOST_DENSE = 2000  # actuators whose compliance and stiffness are worth a dense matrix


class Shapes(ABC):
    """The influence functions of N actuators.

    Each is a sum of free-space point loads and a smooth part, phi_i = sum_j strengths[j, i] F((x - x_j)/size) + v_i(x).

    points: (N, 2) m.  size: m, the length that makes everything dimensionless.  outline: the plate's rim.
    strengths: (N, N), dimensionless forces.
    """

    points: FloatArray
    size: float
    outline: Outline
    strengths: FloatArray

    @abstractmethod
    def fields(self, x: FloatArray, weights: FloatArray | None) -> Fields:
        """The shapes, or their sums with weights (N, k), at x (n, 2); all dimensionless.

        Returns value (n, k), gradient (n, k, 2) and Hessian (n, k, 2, 2).
        """

    @abstractmethod
    def smooth(self, xy: ArrayLike) -> FloatArray:
        """The smooth parts v_i at points (n, 2) [m]: (n, N), dimensionless."""

    def evaluate(self, xy: ArrayLike, weights: ArrayLike | None = None) -> Fields:
        """The shapes, or their weighted sum.

        xy: (n, 2) m.  weights: (N,), for instance the strokes [m].
        Returns value (n, N), gradient (n, N, 2) 1/m and Hessian (n, N, 2, 2) 1/m^2; with weights (n,), (n, 2) and
        (n, 2, 2), times the weights' unit. At an actuator the Hessian is infinite (a point load bends without bound).
        Raises ValueError when a point lies beyond the rim or there is not one weight an actuator.
        """
        xy = np.asarray(xy, dtype=float)
        check_on_plate(self.outline, xy, self.size)
        if weights is None:
            value, gradient, hessian = self.fields(xy / self.size, None)
            return value, gradient / self.size, hessian / self.size**2
        weights = np.asarray(weights, dtype=float)
        if weights.shape != (len(self.points),):
            raise ValueError(
                f"Input weights of evaluate must be one an actuator, {len(self.points)}; got shape {weights.shape}"
            )
        value, gradient, hessian = self.fields(xy / self.size, weights[:, None])
        return value[:, 0], gradient[:, 0] / self.size, hessian[:, 0] / self.size**2


class InfluenceShapes(Shapes, Estimated):
    """Influence shapes found by finite elements on one mesh; made by `Plate.influence`.

    A rigid actuator's shape is 1 there and 0 at the other rigid ones. One of finite stiffness k yields, so that the
    plate follows h - P/k. A floating one (k = 0) holds nothing: its shape is the answer to a unit force there [m/N].

    rigidity: N m.  springs: (N,) N/m, inf where rigid.
    """

    def __init__(self, model: PlateModel, points: FloatArray, rigidity: float, springs: FloatArray) -> None:
        self.model = model
        self.points = np.ascontiguousarray(points)  # kernels would be compiled anew for another layout
        self.size = model.mesh.size
        self.outline = model.mesh.outline
        self.springs = springs
        self._force_unit = rigidity / self.size**2  # N/m: of strengths per metre
        x = points / self.size
        answers = model.under_forces(x)
        green = point_value(x, x) + np.asarray(model.space.point_values(x) @ answers)
        self._green = (green + green.T) / 2
        self.strengths, rigid = self._solve(x)
        count = len(points)
        self.field = Field(
            model.space, answers @ self.strengths, x, self.strengths, model.rigid @ rigid, np.zeros(count)
        )

    def _solve(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Forces (N, N) and rigid motions (r, N) of the shapes.

        The held: (G + 1/k) P + R c = h.  The floating: P given.  All: R^T P = 0.
        """
        held = self.springs > 0
        motions = self.model.motions(x)
        r = motions.shape[1]
        if r and np.linalg.matrix_rank(motions[held], tol=1e-9) < r:
            raise ValueError(
                "Input points of influence leave the plate a rigid motion: its supports and the actuators that hold "
                f"it, {int(held.sum())}, must fix three points that are not on one line"
            )
        drives = np.eye(len(x))
        given = drives[~held] / self._force_unit
        matrix = np.block(
            [
                [self._green[np.ix_(held, held)] + np.diag(self._force_unit / self.springs[held]), motions[held]],
                [motions[held].T, np.zeros((r, r))],
            ]
        )
        right = np.concatenate(
            [drives[held] - self._green[np.ix_(held, ~held)] @ given, -motions[~held].T @ given], axis=0
        )
        answer = np.linalg.solve(matrix, right)
        strengths = np.empty((len(x), len(x)))
        strengths[held], strengths[~held] = answer[: held.sum()], given
        return strengths, answer[held.sum() :]

    @property
    def compliance(self) -> FloatArray:
        """Deflection at i under a unit force at j, (N, N) [m/N], with no actuator holding the plate.

        Raises ValueError when the plate's supports leave it a rigid motion.
        """
        if self.model.rigid.size:
            raise ValueError("Input supports of Plate must hold it without actuators for a compliance; they do not")
        return self._green / self._force_unit

    @property
    def stiffness(self) -> FloatArray:
        """Force at i that a unit stroke of j takes, (N, N) [N/m]; of a floating one, per unit of its force."""
        return self.strengths * self._force_unit

    def fields(self, x: FloatArray, weights: FloatArray | None) -> Fields:
        return (self.field if weights is None else self.field.weighted(weights)).evaluate(x)

    def smooth(self, xy: ArrayLike) -> FloatArray:
        return self.field.smooth(np.asarray(xy, dtype=float) / self.size)[0]


def check_on_plate(outline: Outline, xy: FloatArray, size: float) -> None:
    """Raises ValueError when one of the points (n, 2) [m] lies beyond the rim."""
    beyond = outline.gap(xy) < -1e-9 * size
    if np.any(beyond):
        raise ValueError(f"Input xy of evaluate must lie on the plate; got {xy[beyond][0].tolist()} m")


def check_points(points: FloatArray, gap: FloatArray, size: float) -> None:
    """Raises ValueError, naming every point (N, 2) that is not inside the rim (by its gap) or stands on another."""
    wrong = [] if points.size else ["at least one point is needed"]
    for i in np.flatnonzero(~(gap > 1e-9 * size)).tolist():
        wrong.append(
            f"point {i + 1} at {points[i].tolist()} m must lie inside the rim; it is {-gap[i]:.3g} m beyond it"
        )
    rows = np.flatnonzero(np.isfinite(points).all(axis=1))
    for i, j in rows[sorted(cKDTree(points[rows]).query_pairs(1e-9 * size))].tolist():
        wrong.append(f"points {i + 1} and {j + 1} must differ; both are at {points[i].tolist()} m")
    if wrong:
        raise ValueError("Input points of influence: " + "; ".join(wrong))
