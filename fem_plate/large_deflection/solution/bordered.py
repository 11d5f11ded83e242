"""The linearised plate: a sparse matrix, bordered by actuators, held heights and rigid motions."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_matrix

from fem_plate.elements import factorised
from fem_plate.large_deflection.solution.trial import Trial
from fem_plate.types import BoolArray, FloatArray


class BorderedSolver:
    """Solves for the change of a plate about a state, with the heights at some actuators prescribed.

    block, border, inner: second derivatives of the energy, as `Equilibrium.tangent` gives them.
    held: (J,) the actuators whose heights are prescribed.  compliance: (J,) of these.
    """

    def __init__(
        self,
        trial: Trial,
        block: csc_matrix,
        border: FloatArray,
        inner: FloatArray,
        held: BoolArray,
        compliance: FloatArray,
    ) -> None:
        self._n, self._count = trial.model.unknowns, trial.count
        self._end = self._count + int(held.sum())
        pins = np.zeros((len(border), trial.model.pins.shape[0]))
        pins[: self._n] = trial.model.pins.toarray().T
        holds = np.zeros((len(border), int(held.sum())))
        holds[: self._n] = trial.at_actuators[held].toarray().T
        self._columns = np.concatenate([border, -holds, pins], axis=1)
        corner = np.zeros((self._columns.shape[1],) * 2)
        count, end = self._count, self._end
        corner[:count, :count] = inner
        corner[:count, count:end] = -trial.heights[held].T
        corner[count:end, :count] = -trial.heights[held]
        corner[count:end, count:end] = -np.diag(compliance[held])
        self._solve = factorised(block)
        self._solved = self._solve(self._columns)
        self._schur = np.linalg.inv(corner - self._columns.T @ self._solved)

    def solve(
        self, of_v: FloatArray, of_extra: FloatArray, heights: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """v, extra coefficients and the forces of the held actuators, under what drives these and given heights."""
        load = np.zeros(len(self._columns))
        load[: self._n] = of_v
        first = self._solve(load)
        rest = np.zeros(len(self._schur))
        rest[: self._count], rest[self._count : self._end] = of_extra, -heights
        outer = self._schur @ (rest - self._columns.T @ first)
        v = (first - self._solved @ outer)[: self._n]
        return v, outer[: self._count], outer[self._count : self._end]
