"""The plate under given loads, with no actuator holding it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fem_plate.elements import Estimated, Field, Fields, PlateModel
from fem_plate.influence import check_on_plate

FloatArray = NDArray[np.float64]

BALANCE = 1e-9  # of the loads: a larger sum of them moves a plate that is not held


class Deflection(Estimated):
    """The plate under forces (N,) [N] at points (N, 2) [m] and a uniform pressure [Pa]; made by `Plate.deflection`.

    rigidity: N m.
    """

    def __init__(
        self, model: PlateModel, points: FloatArray, forces: FloatArray, pressure: float, rigidity: float
    ) -> None:
        self.model, self.forces, self.load = model, forces, pressure
        self.size = model.mesh.size
        x = points / self.size
        loads = forces[:, None] * self.size**2 / rigidity  # in metres of deflection
        load = pressure * self.size**4 / rigidity
        self._check_balance(x, loads, load)
        unknowns = load * model.under_pressure() if pressure else np.zeros((model.unknowns, 1))
        if len(x):
            unknowns = unknowns + model.under_forces(x) @ loads
        still = Field(model.space, unknowns, x, loads, np.zeros((3, 1)), np.array([load]))
        self.field = Field(model.space, unknowns, x, loads, self._without_motion(still), still.pressure)

    def _check_balance(self, x: FloatArray, forces: FloatArray, pressure: float) -> None:
        model = self.model
        if not model.rigid.size:
            return
        points, weights = model.space.quadrature
        total = model.motions(x).T @ forces[:, 0] + pressure * (weights @ model.motions(points))
        scale = np.abs(forces).sum() + abs(pressure) * weights.sum()
        if np.any(np.abs(total) > BALANCE * scale):
            raise ValueError(
                "Input loads of a plate whose supports leave it a rigid motion must be in balance; forces and moments "
                f"do not vanish (by {np.abs(total).max() / scale:.1e} of all loads)"
            )

    def _without_motion(self, field: Field) -> FloatArray:
        """The rigid motion (3, 1) that takes away mean deflection and slope, as far as the supports allow it."""
        rigid = self.model.rigid
        if not rigid.size:
            return np.zeros((3, 1))
        points, weights = self.model.space.quadrature
        motions = self.model.motions(points)
        mean = motions.T @ (weights[:, None] * field.values(points))
        return np.asarray(-rigid @ mean)  # the motions are orthonormal

    def evaluate(self, xy: ArrayLike) -> Fields:
        """The deflection at points.

        Parameters
        ----------
        xy : array (n, 2)
            Points, m.

        Returns
        -------
        w : array (n,)
            Deflection, m.
        gradient : array (n, 2)
            Its gradient.
        hessian : array (n, 2, 2)
            Its Hessian, 1/m.

        Raises
        ------
        ValueError
            A point lies beyond the rim.
        """
        xy = np.asarray(xy, dtype=float)
        check_on_plate(self.model.mesh.outline, xy, self.size)
        value, gradient, hessian = self.field.evaluate(xy / self.size)
        return value[:, 0], gradient[:, 0] / self.size, hessian[:, 0] / self.size**2
