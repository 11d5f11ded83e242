"""Shapes: what influence functions offer, however they are computed."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from common import draw, notebook_html
from fem_plate.elements import Derivatives
from fem_plate.inputs import check_on_plate
from fem_plate.types import FloatArray, IntArray
from meshes import Outline

if TYPE_CHECKING:
    from common import Axes, Figure
    from fem_plate.plate import Plate


class Shapes(ABC):
    """The influence functions of N actuators.

    Each is a sum of point loads on an infinite plate and a smooth part,
    ``phi_i(x) = sum_j strengths[j, i] F((x - x_j) / size) + v_i(x)`` with ``F(r) = r^2 ln(r) / (8 pi)``.

    Attributes
    ----------
    points : (N, 2) array
        Places of the actuators [m].
    plate : Plate
        The plate that they are of.
    springs : (N,) array
        Stiffness of the actuators [N/m]; inf is rigid, 0 floating.
    strengths : (N, N) array
        How much of F is at i in the shape of actuator j: of a uniform, isotropic plate the dimensionless force there.
        Where the stiffness depends on direction, F is the mean over directions.
    size : float
        The length that makes everything dimensionless [m].
    outline : Outline
        The plate's rim.
    truncation_error : float
        The largest value left out of a shape, over its largest; a closer fit is not worth while.
    spare : float
        The share of the tolerance that polynomials fitted to the shapes must be good to, of the lowest degree that is.
    """

    points: FloatArray
    plate: Plate
    springs: FloatArray
    strengths: FloatArray
    size: float
    outline: Outline
    truncation_error: float = 0.0
    spare: float = 0.01

    @abstractmethod
    def derivatives(self, x: FloatArray, weights: FloatArray | None) -> Derivatives:
        """The shapes, or their sums with weights (N, k), at x (n, 2); all dimensionless.

        Returns the value (n, k), gradient (n, k, 2) and Hessian (n, k, 2, 2).
        """

    def values(self, xy: ArrayLike, weights: FloatArray | None = None) -> FloatArray:
        """The shapes' values alone.

        Parameters
        ----------
        xy : (n, 2) array_like
            Points on the plate [m].
        weights : (N, k) array, optional
            Weights of k sums of the shapes.

        Returns
        -------
        (n, N) array, or (n, k) with weights
            Metres per metre of stroke, metres per newton for floating actuators; with weights, times their unit.
        """
        return self.derivatives(np.asarray(xy, dtype=float) / self.size, weights)[0]

    @abstractmethod
    def nonzero_values(self, xy: FloatArray) -> tuple[IntArray, FloatArray]:
        """The rows (k,) of all shapes that do not vanish at all of the points (n, 2) [m], and their values (n, k)."""

    @abstractmethod
    def own_heights(self) -> FloatArray:
        """The height (N,) of each shape at its own actuator; 1 where that is rigid."""

    def evaluate(self, xy: ArrayLike, weights: ArrayLike | None = None) -> Derivatives:
        """The shapes, or their weighted sum, with first and second derivatives.

        At an actuator the Hessian is infinite: the curvature under a point load has no bound.

        Parameters
        ----------
        xy : (n, 2) array_like
            Points on the plate [m].
        weights : (N,) array_like, optional
            One per actuator, such as the strokes [m].

        Returns
        -------
        value : (n, N) array, or (n,) with weights
        gradient : (n, N, 2) array, or (n, 2) with weights
            [1/m], with weights times their unit.
        hessian : (n, N, 2, 2) array, or (n, 2, 2) with weights
            [1/m^2], with weights times their unit.

        Raises
        ------
        ValueError
            A point lies beyond the rim, or there is not one weight per actuator.
        """
        xy = np.asarray(xy, dtype=float)
        check_on_plate(self.outline, xy, self.size)
        if weights is None:
            value, gradient, hessian = self.derivatives(xy / self.size, None)
            return value, gradient / self.size, hessian / self.size**2
        value, gradient, hessian = self.derivatives(xy / self.size, self._checked(weights, "evaluate")[:, None])
        return value[:, 0], gradient[:, 0] / self.size, hessian[:, 0] / self.size**2

    def __repr__(self) -> str:
        kinds = {"rigid": np.isinf(self.springs), "floating": self.springs == 0}
        kinds["springy"] = ~(kinds["rigid"] | kinds["floating"])
        counts = ", ".join(f"{int(which.sum())} {kind}" for kind, which in kinds.items() if which.any())
        plural = "s" * (len(self.points) != 1)
        width, height = np.ptp(self.outline.box, axis=0)
        return f"{type(self).__name__} of {counts} actuator{plural} on a plate of {width:.4g} m x {height:.4g} m"

    def plot(self, weights: ArrayLike | None = None, axes: Axes | None = None) -> Figure:
        """Draw the weighted sum of the shapes.

        Parameters
        ----------
        weights : (N,) array_like, optional
            One per actuator, such as the strokes [m]; by default the shape of the actuator in the middle is drawn.
        axes : matplotlib.axes.Axes, optional
            Axes in m to draw into; by default new ones.

        Returns
        -------
        matplotlib.figure.Figure
        """
        return draw(self, axes, weights=None if weights is None else self._checked(weights, "plot"))

    _repr_html_ = notebook_html

    def _checked(self, weights: ArrayLike, caller: str) -> FloatArray:
        array = np.asarray(weights, dtype=float)
        if array.shape != (len(self.points),):
            raise ValueError(
                f"Input weights of {caller} must be one an actuator, {len(self.points)}; got shape {array.shape}"
            )
        return array
