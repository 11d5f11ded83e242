"""FullSolutions: the full solutions that a reduced model is made of, with their changes under each stroke."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

import numpy as np

from fem_plate.large_deflection.membranes import Membrane
from fem_plate.large_deflection.reduction.snapshots import Columns, linear_shapes, slopes, stacked, tangents
from fem_plate.large_deflection.solution import BorderedSolver, Coefficients, DiscretePlate, Loads, Solution
from fem_plate.types import FloatArray

TANGENT = 0.3  # of each stroke's largest height: how much of a change counts beside a full solution
MATRICES = 8  # factorised ones of the last solutions that are kept; with 25 actuators each takes 0.2 GB
FEW = 4  # actuators with which each stroke's change is added, too


class FullSolutions:
    """Full solutions of a plate, dimensionless, and what they differ in from the linear plate.

    spread: (N,) the largest strokes.
    """

    def __init__(self, discrete: DiscretePlate, spread: FloatArray) -> None:
        self.discrete, self.linear = discrete, linear_shapes(discrete)
        self.corrections: list[Columns] = []
        self.forces: list[FloatArray] = []  # of the membrane, at all its samples in a row
        self.motions: list[FloatArray] = []  # in the plane
        self._spread, self._membranes = spread, _membranes(discrete)
        self._solvers: deque[tuple[FloatArray, BorderedSolver]] = deque(maxlen=MATRICES)
        self._count = 0

    def __len__(self) -> int:
        return self._count

    def add(self, strokes: FloatArray, start: Coefficients | None) -> Coefficients:
        """The plate under strokes (N,), found from a start, by default the linear plate; it is known from then on."""
        solution = self.discrete.equilibrium.solve(Loads(strokes, 0.0), start)
        changes, weights = self._changes(solution)
        self._learn_shapes(strokes, solution.state, changes, weights)
        scaled = changes.weighted(np.diag(weights))
        self.forces += self._learned(self._force, 0, solution.state, scaled)
        self.motions += self._learned(self._motion, 1, solution.state, scaled)
        self._solvers.append((strokes, solution.solver))
        self._count += 1
        return solution.state

    def nearest(self, strokes: FloatArray) -> BorderedSolver:
        """What solves for small changes about the last solution with similar strokes, or opposite ones."""
        return min(
            self._solvers, key=lambda known: min(np.abs(known[0] - strokes).max(), np.abs(known[0] + strokes).max())
        )[1]

    def slopes(self, i: int, columns: Columns) -> list[FloatArray]:
        """Slopes of functions at the samples of the membrane, i = 0, or of that of in-plane motion, 1."""
        membrane, known = self._membranes[i]
        return slopes(self.discrete, membrane.samples, known, columns)

    def membrane(self, i: int) -> Membrane:
        """The membrane, or that of in-plane motion."""
        return self._membranes[i][0]

    def _changes(self, solution: Solution) -> tuple[Columns, FloatArray]:
        """How a solution changes with each stroke, and how much of that counts; nothing where strokes are many."""
        count = len(self._spread)
        if count > FEW:
            return self.linear.weighted(np.zeros((count, 0))), np.zeros(0)
        return tangents(self.discrete, solution), TANGENT * self._spread

    def _learn_shapes(self, strokes: FloatArray, state: Coefficients, changes: Columns, weights: FloatArray) -> None:
        linear = self.linear.weighted(strokes[:, None])
        self.corrections.append(Columns(state.v[:, None] - linear.v, state.extra[:, None] - linear.extra))
        if len(weights):
            v, extra = changes.v - self.linear.v, changes.extra - self.linear.extra
            self.corrections.append(Columns(v * weights, extra * weights))

    def _learned(
        self, answer: Callable[[list[FloatArray]], FloatArray], i: int, state: Coefficients, changes: Columns
    ) -> list[FloatArray]:
        """What the membrane answers to a state, and by how much more to each change of it."""
        now = [p[..., 0] for p in self.slopes(i, Columns(*state.columns))]
        rows, steps = [answer(now)], self.slopes(i, changes)
        for j in range(changes.v.shape[1]):
            ahead, behind = ([p + sign * q[..., j] for p, q in zip(now, steps, strict=True)] for sign in (1, -1))
            rows.append(0.5 * (answer(ahead) - answer(behind)))
        return rows

    def _force(self, p: list[FloatArray]) -> FloatArray:
        """The membrane force under slopes, at all samples."""
        membrane = self.discrete.membrane
        everything = membrane.expand(membrane.respond(p)[0])
        pairs = zip(membrane.samples, p, strict=True)
        return stacked([membrane.force(samples, everything, q)[..., None] for samples, q in pairs])[:, 0]

    def _motion(self, p: list[FloatArray]) -> FloatArray:
        return self.discrete.plane_stress.membrane.respond(p)[0]


def _membranes(discrete: DiscretePlate) -> list[tuple[Membrane, list[FloatArray]]]:
    """The membrane and that of in-plane motion, each with the slopes of the extra functions at its samples."""
    equilibrium, in_plane = discrete.equilibrium, discrete.plane_stress.membrane
    known = equilibrium.known
    if in_plane is discrete.membrane:
        return [(in_plane, known), (in_plane, known)]
    return [(discrete.membrane, known), (in_plane, [equilibrium.trial.slopes(samples) for samples in in_plane.samples])]
