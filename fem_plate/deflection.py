"""The plate under given loads, with no actuator holding it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from fem_plate.elements import Derivatives, PlateFunctions, PlateModel
from fem_plate.estimated import Estimated
from fem_plate.inputs import check_on_plate
from fem_plate.types import FloatArray

BALANCE = 1e-9  # of the loads: a larger resultant moves a plate that is not held


class Deflection(Estimated):
    """The plate under forces and a uniform pressure; made by `Plate.deflection`.

    Attributes
    ----------
    forces : (N,) array
        [N].
    load : float
        Pressure [Pa].
    """

    def __init__(
        self, model: PlateModel, points: FloatArray, forces: FloatArray, pressure: float, rigidity: float
    ) -> None:
        self.model, self.forces, self.load = model, forces, pressure
        self.size = model.mesh.size
        x = points / self.size
        scaled_forces = forces[:, None] * self.size**2 / rigidity  # in metres of deflection
        scaled_pressure = pressure * self.size**4 / rigidity
        self._check_balance(x, scaled_forces, scaled_pressure)
        unknowns = scaled_pressure * model.under_pressure() if pressure else np.zeros((model.unknowns, 1))
        if len(x):
            unknowns = unknowns + model.under_forces(x) @ scaled_forces
        pressures = np.array([scaled_pressure])
        unmoved = PlateFunctions(model.space, unknowns, x, scaled_forces, np.zeros((3, 1)), pressures, model.infinite)
        self.functions = replace(unmoved, rigid=self._levelling(unmoved))

    def _check_balance(self, x: FloatArray, forces: FloatArray, pressure: float) -> None:
        model = self.model
        if not model.rigid.size:
            return
        points, weights = model.space.quadrature
        resultant = model.motions(x).T @ forces[:, 0] + pressure * (weights @ model.motions(points))
        scale = np.abs(forces).sum() + abs(pressure) * weights.sum()
        if np.any(np.abs(resultant) > BALANCE * scale):
            raise ValueError(
                "Input loads of a plate whose supports leave it a rigid motion must be in balance; forces and moments "
                f"do not vanish (by {np.abs(resultant).max() / scale:.1e} of all loads)"
            )

    def _levelling(self, functions: PlateFunctions) -> FloatArray:
        """The rigid motion (3, 1) that removes mean deflection and slope, as far as the supports allow it."""
        rigid = self.model.rigid
        if not rigid.size:
            return np.zeros((3, 1))
        points, weights = self.model.space.quadrature
        motions = self.model.motions(points)
        mean = motions.T @ (weights[:, None] * functions.values(points))
        return np.asarray(-rigid @ mean)  # the motions are orthonormal

    def evaluate(self, xy: ArrayLike) -> Derivatives:
        """The deflection with first and second derivatives.

        Parameters
        ----------
        xy : (n, 2) array_like
            Points on the plate [m].

        Returns
        -------
        w : (n,) array
            [m].
        gradient : (n, 2) array
            [1].
        hessian : (n, 2, 2) array
            [1/m].

        Raises
        ------
        ValueError
            A point lies beyond the rim.
        """
        xy = np.asarray(xy, dtype=float)
        check_on_plate(self.model.mesh.outline, xy, self.size)
        value, gradient, hessian = self.functions.evaluate(xy / self.size)
        return value[:, 0], gradient[:, 0] / self.size, hessian[:, 0] / self.size**2
