"""The plate under given loads, the error estimate of such a solution, and its refinement to a tolerance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property, partial
from typing import Self, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from fem_plate.elements import GAIN, Derivatives, PlateFunctions, PlateModel
from fem_plate.inputs import check_on_plate
from fem_plate.types import FloatArray

MAX_UNKNOWNS = 100_000  # refinement to a tolerance stops here
BALANCE = 1e-9  # of the loads: a larger resultant moves a plate that is not held


class Estimated:
    """A solution on one mesh that can estimate its own error."""

    functions: PlateFunctions
    size: float  # m, the length that makes the functions dimensionless
    refine: Callable[[], Self]  # solves again on cells of half the size, or by elements of a higher degree
    rounding: float = 0.0  # error of w that finer cells have as well, relative as the estimate

    @property
    def unknowns(self) -> int:
        """Number of unknowns of the mesh."""
        return self.functions.space.unknowns

    @cached_property
    def error_estimate(self) -> float:
        """Estimated largest error of w, relative to each function's largest deflection.

        It is the difference from a finer solution, which is computed on first use, and rounding.
        """
        return self.refine().difference(self) + self.rounding

    def difference(self, coarser: Estimated) -> float:
        """The largest difference from a solution on another mesh, at this space's samples, relative as the estimate."""
        x = self.functions.space.samples
        w = self.functions.values(x)
        # New points on a curved rim may make the refined mesh's box, and so its size, a little larger.
        w_coarser = coarser.functions.values(x * (self.size / coarser.size))
        largest = np.abs(w).max(axis=0)
        return float(np.max(np.abs(w - w_coarser) / np.where(largest > 0, largest, 1.0)))


Solution = TypeVar("Solution", bound=Estimated)


def refined(solve: Callable[[int], Solution], tolerance: float | None, gain: float = GAIN) -> Solution:
    """The solution as fine as the tolerance requires; without one, the coarsest.

    solve: takes the level of fineness.  gain: what the next level divides the error of w by, at least.
    """
    solution = _at_level(solve, 0)
    if tolerance is None:
        return solution
    change, level = np.inf, 0
    least = tolerance + solution.rounding  # finer cells do not lessen rounding
    while 4 * solution.unknowns < MAX_UNKNOWNS and (not level or solution.error_estimate > least):
        level += 1
        coarse, solution = solution, _at_level(solve, level)
        last_change, change = change, solution.difference(coarse)
        solution.error_estimate = change * max(change / last_change, 1 / gain) + solution.rounding
        if change > last_change / 2:
            # It gains no more: the rest is rounding, or the estimates were too optimistic.
            coarse.error_estimate, solution.error_estimate = (e + solution.rounding for e in (last_change, change))
            return coarse if last_change < change else solution
    return solution


def _at_level(solve: Callable[[int], Solution], level: int) -> Solution:
    found = solve(level)
    found.refine = partial(_at_level, solve, level + 1)
    return found


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
        self.rounding = model.rounding(x, np.zeros(len(x), dtype=bool))
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
