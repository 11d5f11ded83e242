"""Influence shapes on one mesh: the plate with one actuator raised by one metre while the others hold 0."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from fem_plate.elements import Derivatives, PlateFunctions, PlateModel
from fem_plate.estimated import Estimated
from fem_plate.held import held_shapes, held_under_pressure, unheld_shapes
from fem_plate.shapes import Shapes
from fem_plate.types import FloatArray, IntArray

MAX_DENSE = 2000  # actuators whose compliance and stiffness are worth a dense matrix


class InfluenceShapes(Shapes, Estimated):
    """Influence shapes computed by finite elements on one mesh; made by `Plate.influence`.

    A rigid actuator's shape is 1 there and 0 at the other rigid ones. An actuator of finite stiffness k yields: under
    its force P the plate stands at h - P/k. A floating one (k = 0) holds nothing: its shape is the deflection under a
    unit force there [m/N].

    free_motions: whether the plate may be left rigid motions; then its shapes carry none of their momentum.
    """

    def __init__(
        self,
        model: PlateModel,
        points: FloatArray,
        rigidity: float,
        actuator_stiffness: FloatArray,
        free_motions: bool = False,
    ) -> None:
        self.model = model
        self.points = np.ascontiguousarray(points)  # kernels would be compiled anew for another layout
        self.size = model.mesh.size
        self.outline = model.mesh.outline
        self.springs = actuator_stiffness
        self._stiffness_unit = rigidity / self.size**2  # N/m
        solve = unheld_shapes if free_motions else held_shapes
        self.functions, self._green = solve(model, points / self.size, actuator_stiffness, self._stiffness_unit)
        self.strengths = model.infinite.logarithms(points / self.size)[:, None] * self.functions.forces
        self.rounding = model.rounding(points / self.size, actuator_stiffness > 0)

    @property
    def compliance(self) -> FloatArray:
        """Deflection at i under a unit force at j, (N, N) m/N, with no actuator holding the plate.

        Raises
        ------
        ValueError
            The plate's supports leave it a rigid motion.
        """
        if self.model.rigid.size:
            raise ValueError("Input supports of Plate must hold it without actuators for a compliance; they do not")
        return self._green / self._stiffness_unit

    @property
    def stiffness(self) -> FloatArray:
        """Force at i for a unit stroke of actuator j, (N, N) [N/m]; for a floating one, for a unit force."""
        return self.functions.forces * self._stiffness_unit

    def under_pressure(self, pressure: float) -> PlateFunctions:
        """The plate's deflection under a uniform pressure [Pa], up, while its actuators' strokes and forces are 0.

        Its value is in m, over places in `size`. Rigid actuators stay where they are and springs yield.
        """
        scale = pressure * self.size**2 / self._stiffness_unit
        unit = held_under_pressure(self.model, self.points / self.size, self.springs, self._stiffness_unit)
        return unit.weighted(np.array([scale]))

    def pressure_forces(self, pressure: float) -> FloatArray:
        """The forces (N,) [N] on the plate with which actuators bear a uniform pressure [Pa]; 0 of floating ones."""
        return np.asarray(self.under_pressure(pressure).forces[:, 0] * self._stiffness_unit)

    def derivatives(self, x: FloatArray, weights: FloatArray | None) -> Derivatives:
        return self._weighted(weights).evaluate(x)

    def values(self, xy: ArrayLike, weights: FloatArray | None = None) -> FloatArray:
        return self._weighted(weights).values(np.asarray(xy, dtype=float) / self.size)

    def laplacians(self, xy: ArrayLike, floor: float) -> FloatArray:
        """The shapes' Laplacians.

        Parameters
        ----------
        xy : (n, 2) array_like
            Points on the plate [m].
        floor : float
            Radius around an actuator within which its Laplacian grows no more [m]; under a point load it has no bound.

        Returns
        -------
        (n, N) array
            [1/m^2].
        """
        return self.functions.laplacians(np.asarray(xy, dtype=float) / self.size, floor / self.size) / self.size**2

    def nonzero_values(self, xy: FloatArray) -> tuple[IntArray, FloatArray]:
        return np.arange(len(self.points)), self.functions.values(xy / self.size)

    def own_heights(self) -> FloatArray:
        return np.abs(np.diag(self.functions.values(self.points / self.size)))

    def _weighted(self, weights: FloatArray | None) -> PlateFunctions:
        return self.functions if weights is None else self.functions.weighted(weights)
