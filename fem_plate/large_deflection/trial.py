"""Trial functions: finite elements, the linear responses to actuators, rigid motions, and the response to pressure.

With v of the element space, psi_j the linear plate's response to a unit force at actuator j, R_k its rigid motions and
phi its response to a unit pressure,

    w = v + sum_j s_j psi_j + sum_k c_k R_k + pressure phi.

psi_j has the logarithm under a force; s_j is free, and the force itself is a multiplier. Bending energies with psi_j
are heights, a(v, psi_j) = v(x_j). Where the plate can move rigidly, psi_j is its response on springs spread evenly
under it, and what these bear is taken off again.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_matrix

from fem_plate.elements import PlateFunctions, PlateModel, factorised
from fem_plate.large_deflection.membrane import Samples
from fem_plate.types import BoolArray, FloatArray

CHUNK = 20_000  # points evaluated at a time, to bound memory


class Trial:
    """The trial functions of a plate with actuators at x (J, 2), dimensionless.

    Extra functions are the J responses, then the r rigid motions.
    """

    def __init__(self, model: PlateModel, x: FloatArray) -> None:
        self.model, self.x = model, x
        space = model.space
        responses = model.under_forces(x) if len(x) else np.zeros((model.unknowns, 0))
        pushed = model.under_pressure()
        self.motions = model.motions(x)  # (J, r)
        r = self.motions.shape[1]
        self.at_actuators = space.point_values(x)  # B
        green = model.infinite.point_value(x, x) + np.asarray(self.at_actuators @ responses)
        green = (green + green.T) / 2
        # Heights of the extra functions at the actuators, (J, J + r), and of phi, (J,).
        self.heights = np.concatenate([green, self.motions], axis=1)
        # All functions that are no finite elements, the last one of pressure.
        extra = len(x) + r
        self.extra = PlateFunctions(
            space,
            np.concatenate([responses, np.zeros((model.unknowns, r)), pushed], axis=1),
            x,
            np.concatenate([np.eye(len(x)), np.zeros((len(x), r + 1))], axis=1),
            np.concatenate([np.zeros((3, len(x))), model.rigid, np.zeros((3, 1))], axis=1),
            np.append(np.zeros(extra), 1.0),
            model.infinite,
        )
        self.pressure_heights = self.extra.values(x)[:, -1] if len(x) else np.zeros(0)
        # Bending energies: of finite elements with the extra functions, and of these.
        mean = model.mean
        self.cross = np.concatenate(
            [self.at_actuators.toarray().T - mean @ self.motions.T, np.zeros((len(mean), r))], axis=1
        )
        self.inner = np.zeros((extra, extra))
        self.inner[: len(x), : len(x)] = green - self.motions @ self.motions.T
        # What pressure does that phi leaves: the load that the spread springs bear.
        points, weights = space.quadrature
        self.borne = weights @ model.motions(points)  # (r,)
        self.load = -mean @ self.borne
        self.extra_load = -np.concatenate([self.motions @ self.borne, self.borne])

    @property
    def count(self) -> int:
        """Number of extra functions, without that of pressure."""
        return len(self.inner)

    def slopes(self, samples: Samples) -> FloatArray:
        """Slopes (k, 2 n, extra + 1) of the extra functions, and of that of pressure."""
        k, n, _ = samples.points.shape
        everything = self.model.space.element_dofs(self.extra.unknowns)
        slopes = samples.gradient @ everything[self.model.space.dofs[samples.triangle]]
        step = max(1, CHUNK // n)
        for start in range(0, k, step):
            part = slice(start, start + step)
            known = self.extra.known_slopes(samples.points[part].reshape(-1, 2))  # (points, 2, extra + 1)
            known = known.reshape(-1, n, 2, known.shape[-1]).transpose(0, 2, 1, 3)
            slopes[part] += known.reshape(len(known), 2 * n, -1)
        return np.asarray(slopes)

    def functions(self, v: FloatArray, extra: FloatArray, pressure: FloatArray | None = None) -> PlateFunctions:
        """k functions of their coefficients v (unknowns, k), extra (e, k) and pressure (k,), 0 by default."""
        pushed = np.zeros(extra.shape[1]) if pressure is None else pressure
        return self.extra.weighted(np.vstack([extra, pushed])).raised(v)


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
