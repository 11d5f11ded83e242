"""FullSolutions: what a reduced model is made of, with the changes under each stroke.

Columns are several functions of the trial space by their coefficients.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from fem_plate.large_deflection.discrete import DiscretePlate
from fem_plate.large_deflection.equilibrium import Coefficients, Loads, Solution
from fem_plate.large_deflection.membrane import Membrane, Samples
from fem_plate.large_deflection.reduced import ReducedPlate
from fem_plate.large_deflection.trial import BorderedSolver
from fem_plate.types import FloatArray

ReducedSolver = Callable[[ReducedPlate, FloatArray], FloatArray]  # the corrections (n,) under strokes (N,)

TANGENT = 0.3  # of each stroke's largest height: how much of a change counts beside a full solution
MATRICES = 8  # factorised ones of the last solutions that are kept; with 25 actuators each takes 0.2 GB
FEW = 4  # actuators with which each stroke's change is added, too


class FullSolutions:
    """Full solutions of a plate, dimensionless, and what they differ in from the linear plate.

    spread: (N,) the largest strokes.  solve: finds the equilibrium of a reduced plate.
    """

    def __init__(self, discrete: DiscretePlate, spread: FloatArray, solve: ReducedSolver) -> None:
        self.solve = solve
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


class Columns(NamedTuple):
    """k functions: v (unknowns, k) and extra coefficients (e, k)."""

    v: FloatArray
    extra: FloatArray

    def weighted(self, weights: FloatArray) -> Columns:
        """Their sums with weights (k, m)."""
        return Columns(self.v @ weights, self.extra @ weights)

    @staticmethod
    def joined(several: list[Columns]) -> Columns:
        """All functions of several."""
        return Columns(
            np.concatenate([c.v for c in several], axis=1), np.concatenate([c.extra for c in several], axis=1)
        )


def linear_shapes(discrete: DiscretePlate) -> Columns:
    """The plate under a unit of each stroke or force, without stretching."""
    equilibrium, count = discrete.equilibrium, len(discrete.equilibrium.held)
    extra = [equilibrium.linear_extra(Loads(unit, 0.0)) for unit in np.eye(count)]
    return Columns(np.zeros((discrete.model.unknowns, count)), np.stack(extra, axis=1))


def tangents(discrete: DiscretePlate, solution: Solution) -> Columns:
    """What a unit of each stroke or force adds to the plate."""
    equilibrium, trial = discrete.equilibrium, discrete.equilibrium.trial
    held, columns = equilibrium.held, []
    for unit in np.eye(len(held)):
        pushed = np.where(held, 0.0, unit)
        answer = solution.solver.solve(trial.at_actuators.T @ pushed, trial.heights.T @ pushed, unit[held])
        columns.append(answer[:2])
    return Columns(np.stack([v for v, _ in columns], axis=1), np.stack([e for _, e in columns], axis=1))


def bending_products(discrete: DiscretePlate, columns: Columns) -> FloatArray:
    """The bending energies, twice, of functions with each other, and those of the actuators' springs: (k, k)."""
    equilibrium, trial = discrete.equilibrium, discrete.equilibrium.trial
    v, extra = columns
    mixed = v.T @ (trial.cross @ extra)
    products = v.T @ (equilibrium.bending @ v) + mixed + mixed.T + extra.T @ trial.inner @ extra
    springs = equilibrium.held & (equilibrium.compliance > 0)
    heights = trial.at_actuators[springs] @ v + trial.heights[springs] @ extra
    products = products + heights.T @ (heights / equilibrium.compliance[springs, None])
    return np.asarray((products + products.T) / 2)


def slopes(
    discrete: DiscretePlate, sets: Sequence[Samples], known: Sequence[FloatArray], columns: Columns
) -> list[FloatArray]:
    """The slopes (k, 2 n, functions) at sets of samples; known: those of the extra functions there."""
    space, everything = discrete.model.space, discrete.model.space.element_dofs(columns.v)
    extra = np.concatenate([columns.extra, np.zeros((1, columns.extra.shape[1]))])
    return [
        samples.gradient @ everything[space.dofs[samples.triangle]] + at @ extra
        for samples, at in zip(sets, known, strict=True)
    ]


def stacked(parts: Sequence[FloatArray]) -> FloatArray:
    """Stacked quantities (k, j n, c) of all sets of samples in one column each."""
    return np.concatenate([part.reshape(-1, part.shape[-1]) for part in parts])


def unstacked(samples: Sequence[Samples], columns: FloatArray) -> list[FloatArray]:
    """Tensors (k, 3 n, c) at each set of samples."""
    ends = np.cumsum([3 * s.weights.size for s in samples])
    return [
        part.reshape(len(s.weights), -1, columns.shape[1])
        for s, part in zip(samples, np.split(columns, ends[:-1]), strict=True)
    ]
