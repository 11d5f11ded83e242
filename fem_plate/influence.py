"""Influence shapes: how the plate stands when one actuator is raised by one metre and the others hold 0."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from fem_plate.elements import Estimated, Field, Fields, PlateModel, point_value
from meshes import Outline

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

ROWS = 4096  # unknowns combined at once
MOST_DENSE = 2000  # actuators whose compliance and stiffness are worth a dense matrix


class Shapes(ABC):
    """The influence functions of N actuators.

    Each is a sum of free-space point loads and a smooth part, phi_i = sum_j strengths[j, i] F((x - x_j)/size) + v_i(x).

    points: (N, 2) m.  size: m, the length that makes everything dimensionless.  outline: the plate's rim.
    strengths: (N, N), dimensionless forces.  springs: (N,) N/m of the actuators, inf rigid, 0 floating.
    """

    springs: FloatArray
    points: FloatArray
    size: float
    outline: Outline
    strengths: FloatArray

    @abstractmethod
    def fields(self, x: FloatArray, weights: FloatArray | None) -> Fields:
        """The shapes, or their sums with weights (N, k), at x (n, 2); all dimensionless.

        Returns value (n, k), gradient (n, k, 2) and Hessian (n, k, 2, 2).
        """

    def values(self, xy: ArrayLike, weights: FloatArray | None = None) -> FloatArray:
        """The shapes alone at points (n, 2) [m] of the plate, or their sums with weights (N, k): (n, N) or (n, k)."""
        return self.fields(np.asarray(xy, dtype=float) / self.size, weights)[0]

    @abstractmethod
    def nearby(self, xy: FloatArray) -> tuple[IntArray, FloatArray]:
        """The rows (k,) of all shapes that are not zero at every one of points (n, 2) [m], and their values (n, k).

        Those of held actuators are per metre of stroke, those of floating ones in m/N.
        """

    @abstractmethod
    def own_heights(self) -> FloatArray:
        """How high each shape is at its own actuator: (N,), 1 where that is rigid."""

    def evaluate(self, xy: ArrayLike, weights: ArrayLike | None = None) -> Fields:
        """The shapes, or their weighted sum.

        At an actuator the Hessian is infinite: a point load bends without bound.

        Parameters
        ----------
        xy : array (n, 2)
            Points, m.
        weights : array (N,), optional
            Weights, for instance the strokes, m.

        Returns
        -------
        value : array (n, N)
            Shapes; with weights (n,), times their unit.
        gradient : array (n, N, 2)
            Their gradients, 1/m; with weights (n, 2).
        hessian : array (n, N, 2, 2)
            Their Hessians, 1/m^2; with weights (n, 2, 2).

        Raises
        ------
        ValueError
            A point lies beyond the rim, or there is not one weight an actuator.
        """
        xy = np.asarray(xy, dtype=float)
        check_on_plate(self.outline, xy, self.size)
        if weights is None:
            value, gradient, hessian = self.fields(xy / self.size, None)
            return value, gradient / self.size, hessian / self.size**2
        value, gradient, hessian = self.fields(xy / self.size, self._one_each(weights, "evaluate")[:, None])
        return value[:, 0], gradient[:, 0] / self.size, hessian[:, 0] / self.size**2

    def __repr__(self) -> str:
        kinds = {"rigid": np.isinf(self.springs), "floating": self.springs == 0}
        kinds["springy"] = ~(kinds["rigid"] | kinds["floating"])
        told = ", ".join(f"{int(which.sum())} {kind}" for kind, which in kinds.items() if which.any())
        many = "s" * (len(self.points) != 1)
        width, height = np.ptp(self.outline.box, axis=0)
        return f"{type(self).__name__} of {told} actuator{many} on a plate of {width:.4g} m x {height:.4g} m"

    def plot(self, weights: ArrayLike | None = None, axes: Axes | None = None) -> Figure:
        """Draw the sum of the shapes with weights (N,), such as strokes [m], into axes in m or new ones.

        Without weights it is the shape of the actuator in the middle.
        """
        from fem_plate.pictures import draw_shapes  # here, because matplotlib is loaded for pictures only
        from meshes import plotted

        chosen = None if weights is None else self._one_each(weights, "plot")
        return plotted(lambda axes: draw_shapes(self, chosen, axes), axes)

    def _repr_html_(self) -> str:
        from meshes import notebook_html

        return notebook_html(self)

    def _one_each(self, weights: ArrayLike, where: str) -> FloatArray:
        found = np.asarray(weights, dtype=float)
        if found.shape != (len(self.points),):
            raise ValueError(
                f"Input weights of {where} must be one an actuator, {len(self.points)}; got shape {found.shape}"
            )
        return found


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
        self.field, self._green = held_shapes(model, points / self.size, springs, self._force_unit)
        self.strengths = self.field.forces

    @property
    def compliance(self) -> FloatArray:
        """Deflection at i under a unit force at j, (N, N) m/N, with no actuator holding the plate.

        Raises
        ------
        ValueError
            The supports leave the plate a rigid motion.
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

    def values(self, xy: ArrayLike, weights: FloatArray | None = None) -> FloatArray:
        field = self.field if weights is None else self.field.weighted(weights)
        return field.values(np.asarray(xy, dtype=float) / self.size)

    def laplacians(self, xy: ArrayLike, floor: float) -> FloatArray:
        """The Laplacians of the shapes.

        Parameters
        ----------
        xy : array (n, 2)
            Points, m.
        floor : float
            Radius around an actuator within which the Laplacian grows no more, m; a point load bends without bound.

        Returns
        -------
        laplacians : array (n, N)
            1/m^2 for each unit of the shapes' weights.
        """
        return self.field.laplacians(np.asarray(xy, dtype=float) / self.size, floor / self.size) / self.size**2

    def nearby(self, xy: FloatArray) -> tuple[IntArray, FloatArray]:
        return np.arange(len(self.points)), self.field.values(xy / self.size)

    def own_heights(self) -> FloatArray:
        return np.abs(np.diag(self.field.values(self.points / self.size)))


def held_shapes(
    model: PlateModel, x: FloatArray, springs: FloatArray, force_unit: float, wanted: NDArray[np.int64] | None = None
) -> tuple[Field, FloatArray]:
    """The shapes of actuators at x (N, 2), all of them or the wanted, and the compliance (N, N); dimensionless.

    springs: (N,) N/m.  force_unit: N/m, of dimensionless stiffness.  For the held, with forces P and rigid motions c,
    (G + 1/springs) P + R c = h; the forces of the floating are given, one newton; and R^T P = 0 over all.
    Raises ValueError when supports and actuators leave the plate a rigid motion.
    """
    answers = model.under_forces(x)
    green = point_value(x, x) + np.asarray(model.space.point_values(x) @ answers)
    green = (green + green.T) / 2
    held = springs > 0
    motions = model.motions(x)
    r = motions.shape[1]
    if r and (held.sum() < r or np.linalg.matrix_rank(motions[held], tol=1e-9) < r):
        raise ValueError(
            "Input points of influence leave the plate a rigid motion: its supports and the actuators that hold "
            f"it, {int(held.sum())}, must fix three points that are not on one line"
        )
    drives = np.eye(len(x)) if wanted is None else np.eye(len(x))[:, wanted]
    drives = drives * np.where(held if wanted is None else held[wanted], 1.0, 1 / force_unit)
    stiff = green[np.ix_(held, held)] + np.diag(force_unit / springs[held])
    matrix = np.block([[stiff, motions[held]], [motions[held].T, np.zeros((r, r))]])
    lifted = drives[held] - green[np.ix_(held, ~held)] @ drives[~held]
    answer = np.linalg.solve(matrix, np.concatenate([lifted, -motions[~held].T @ drives[~held]]))
    forces = drives.copy()
    forces[held] = answer[: held.sum()]
    rigid = model.rigid @ answer[held.sum() :]
    if wanted is None:
        for start in range(0, len(answers), ROWS):  # in place: there is not always room for two
            answers[start : start + ROWS] = answers[start : start + ROWS] @ forces
    else:
        answers = answers @ forces
    return Field(model.space, answers, x, forces, rigid, np.zeros(forces.shape[1])), green


def check_on_plate(outline: Outline, xy: FloatArray, size: float) -> None:
    """Raises ValueError when one of the points (n, 2) [m] lies beyond the rim."""
    beyond = outline.gap(xy) < -1e-9 * size
    if np.any(beyond):
        raise ValueError(f"Input xy of evaluate must lie on the plate; got {xy[beyond][0].tolist()} m")


def check_points(what: str, points: FloatArray, gap: FloatArray, size: float) -> None:
    """Raises ValueError, naming every one of the points (N, 2) that is not inside the rim or stands on another.

    what: what they are an input of.  gap: (N,) m, how far inside the rim they are.
    """
    wrong = [] if points.size else ["at least one point is needed"]
    for i in np.flatnonzero(~(gap > 1e-9 * size)).tolist():
        wrong.append(
            f"point {i + 1} at {points[i].tolist()} m must lie inside the rim; it is {-gap[i]:.3g} m beyond it"
        )
    rows = np.flatnonzero(np.isfinite(points).all(axis=1))
    for i, j in rows[sorted(cKDTree(points[rows]).query_pairs(1e-9 * size))].tolist():
        wrong.append(f"points {i + 1} and {j + 1} must differ; both are at {points[i].tolist()} m")
    if wrong:
        raise ValueError(f"Input points of {what}: " + "; ".join(wrong))
