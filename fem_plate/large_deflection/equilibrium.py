"""Equilibrium: Newton's method for the plate that bends and stretches, with a line search on its energy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import bmat, coo_matrix, csc_matrix

from fem_plate.large_deflection.membrane import Membrane, Samples, strains, times
from fem_plate.large_deflection.trial import BorderedSolver, Trial
from fem_plate.types import FloatArray

MAX_STEPS = 40
CONVERGED = 1e-8  # of the largest deflection: what the last step may change; Newton's next would change its square
# Newton's next step would square so small a change. Where it does not, the rest is rounding, and so may be what the
# energy changes by.
NEAR = 1e-5
# A step's matrix, the costliest part of it, also serves the steps after one that changes w by less than this, as long
# as each is so much smaller than the last.
KEEP, SLOW = 0.1, 0.1
MAX_HALVINGS = 12  # of a step, while the energy grows
ROUNDING = 1e-12  # of the energy


class NotConverged(ValueError):
    """No equilibrium was found, or no model that is good enough."""


@dataclass(frozen=True, eq=False)
class Loads:
    """Strokes (J,) of the actuators that hold the plate and forces of the others, over the thickness; the pressure."""

    strokes: FloatArray
    pressure: float


@dataclass(frozen=True, eq=False)
class Coefficients:
    """A deflected plate by the coefficients of its trial functions, with the membrane at rest."""

    v: FloatArray  # (unknowns,)
    extra: FloatArray  # (J + r,)
    pressure: float
    slopes: list[FloatArray]  # (k, 2 n) at each set of samples
    membrane: FloatArray  # (m,)
    stretching: float  # energy

    @property
    def columns(self) -> tuple[FloatArray, FloatArray]:
        """v and the extra coefficients as one column each."""
        return self.v[:, None], self.extra[:, None]


@dataclass(frozen=True, eq=False)
class Solution:
    """A plate in equilibrium."""

    state: Coefficients
    forces: FloatArray  # (J,), of the actuators, up
    solver: BorderedSolver  # of small changes about a state that is within KEEP of it


class Equilibrium:
    """The plate on one mesh.

    compliance: (J,) of the actuators: 0 rigid, inf where the force is prescribed.
    """

    def __init__(self, trial: Trial, membrane: Membrane, compliance: FloatArray) -> None:
        self.trial, self.membrane, self.compliance = trial, membrane, compliance
        self.held = np.isfinite(compliance)
        self.space = trial.model.space
        self.bending = self.space.stiffness(trial.model.law, trial.model.tension)
        self._pins = trial.model.pins
        self.known = [trial.slopes(samples) for samples in membrane.samples]
        points = self.space.points
        self._values = self.space.point_values(points)
        self._extra_values = trial.extra.values(points)[:, :-1]

    def solve(self, loads: Loads, start: Coefficients | None = None) -> Solution:
        """The plate in equilibrium.

        start: where to begin, at the heights of the loads; by default the linear plate.
        """
        now = self.linear(loads) if start is None else start
        energy, change, solver = self.energy(now, loads), np.inf, None
        for _ in range(MAX_STEPS):
            fresh = solver is None
            solver = solver or self.solver(now)
            dv, de, forces = self._step(solver, now, loads)
            last_change, change = change, self._change(now, dv, de)
            if not fresh and change > SLOW * last_change:
                solver, change = None, last_change
                continue
            now, energy, share = self._searched(now, energy, dv, de, loads, change < NEAR)
            if share == 1.0 and (change < CONVERGED or (fresh and last_change / 10 < change < NEAR)):
                return Solution(now, forces, solver)
            if share < 1.0 or change > KEEP:
                solver = None
        raise NotConverged(
            f"The stretching plate has no equilibrium after {MAX_STEPS} steps; the last one changed w by {change:.1e} "
            "of itself. Lower the strokes"
        )

    def _searched(
        self, now: Coefficients, energy: float, dv: FloatArray, de: FloatArray, loads: Loads, rounding: bool
    ) -> tuple[Coefficients, float, float]:
        """The plate after a step, its energy, and the share of the step: halved while the energy grows.

        rounding: whether all that the energy may grow by is rounding.
        """
        share = 1.0
        for _ in range(MAX_HALVINGS):
            there = self.at(now.v + share * dv, now.extra + share * de, loads.pressure)
            new_energy = self.energy(there, loads)
            if rounding or new_energy <= energy + ROUNDING * abs(energy):
                break
            share /= 2
        return there, new_energy, share

    def linear(self, loads: Loads) -> Coefficients:
        """The plate without stretching."""
        return self.at(np.zeros(self.space.unknowns), self.linear_extra(loads), loads.pressure)

    def linear_extra(self, loads: Loads) -> FloatArray:
        """The extra coefficients (J + r,) of the plate without stretching, of which the first are the forces."""
        trial, held = self.trial, self.held
        count, r = len(held), trial.count - len(held)
        forces = np.where(held, 0.0, loads.strokes)
        yielding = trial.heights[held][:, :count][:, held] + np.diag(self.compliance[held])
        motions = trial.heights[held][:, count:]
        matrix = np.block([[yielding, motions], [motions.T, np.zeros((r, r))]])
        missing = loads.strokes - trial.heights[:, :count] @ forces - loads.pressure * trial.pressure_heights
        balance = loads.pressure * trial.extra_load[count:] - trial.heights[:, count:].T @ forces
        solution = np.linalg.solve(matrix, np.concatenate([missing[held], balance]))
        forces[held] = solution[: held.sum()]
        return np.concatenate([forces, solution[held.sum() :]])

    def slopes_at(self, sets: Sequence[Samples], state: Coefficients) -> list[FloatArray]:
        """The slopes (k, 2 n) of a state at other samples."""
        known = [self.trial.slopes(samples) for samples in sets]
        return self._slopes(sets, known, state.v, state.extra, state.pressure)

    def change(self, v: FloatArray, extra: FloatArray) -> float:
        """The largest |w| of coefficients, at the mesh's points."""
        return float(np.abs(self._values @ v + self._extra_values @ extra).max())

    def bending_energy(self, state: Coefficients) -> float:
        """The energy of bending alone."""
        points, weights = self.space.quadrature
        values = self.trial.extra.values(points)
        of_v, of_extra = self.bending @ state.v + self.trial.cross @ state.extra, self.trial.inner @ state.extra
        unpressed = 0.5 * (state.v @ (of_v + self.trial.cross @ state.extra) + state.extra @ of_extra)
        # With phi a bending energy is a mean height, except for what rigid motions bear.
        raised = weights @ (
            self.space.point_values(points, self.space.quadrature_triangles) @ state.v + values[:, :-1] @ state.extra
        )
        raised += self.trial.load @ state.v + self.trial.extra_load @ state.extra
        own = weights @ values[:, -1] - self.trial.borne @ self.trial.borne
        return float(unpressed + state.pressure * raised + 0.5 * state.pressure**2 * own)

    def at(self, v: FloatArray, extra: FloatArray, pressure: float) -> Coefficients:
        """The plate with given coefficients."""
        slopes = self._slopes(self.membrane.samples, self.known, v, extra, pressure)
        membrane, stretching = self.membrane.respond(slopes)
        return Coefficients(v, extra, pressure, slopes, membrane, stretching)

    def _slopes(
        self,
        sets: Sequence[Samples],
        known: Sequence[FloatArray],
        v: FloatArray,
        extra: FloatArray,
        pressure: float,
    ) -> list[FloatArray]:
        everything, weights = self.space.element_dofs(v), np.append(extra, pressure)
        return [
            (samples.gradient @ everything[self.space.dofs[samples.triangle]][..., None])[..., 0] + slopes @ weights
            for samples, slopes in zip(sets, known, strict=True)
        ]

    def heights(self, state: Coefficients) -> FloatArray:
        """w at the actuators (J,)."""
        trial = self.trial
        return np.asarray(
            trial.at_actuators @ state.v + trial.heights @ state.extra + state.pressure * trial.pressure_heights
        )

    def bending_forces(self, state: Coefficients) -> tuple[FloatArray, FloatArray]:
        """The bending energy's derivative, less the pressure's work, in v and in the extra coefficients."""
        trial = self.trial
        return (
            self.bending @ state.v + trial.cross @ state.extra + state.pressure * trial.load,
            trial.cross.T @ state.v + trial.inner @ state.extra + state.pressure * trial.extra_load,
        )

    def energy(self, state: Coefficients, loads: Loads) -> float:
        """The energy of plate, springs and loads, up to a constant."""
        trial = self.trial
        of_v, of_extra = self.bending_forces(state)
        linear = state.pressure * (trial.load @ state.v + trial.extra_load @ state.extra)
        bending = 0.5 * (state.v @ of_v + state.extra @ of_extra + linear)
        heights = self.heights(state)
        springs = self.held & (self.compliance > 0)
        stretched = (loads.strokes - heights)[springs] ** 2 / self.compliance[springs]
        work = loads.strokes[~self.held] @ heights[~self.held]
        return float(bending + state.stretching + 0.5 * stretched.sum() - work)

    def imbalance(self, state: Coefficients, forces: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What drives v and the extra coefficients: forces (J,) less the energy's derivatives."""
        of_v, of_extra = np.zeros(self.space.all_count), np.zeros(self.trial.count)
        everything = self.membrane.expand(state.membrane)
        for samples, known, p in zip(self.membrane.samples, self.known, state.slopes, strict=True):
            of_p = samples.weighted(times(self.membrane.force(samples, everything, p), p[..., None]))[..., 0]
            element = np.einsum("kni,kn->ki", samples.gradient, of_p, optimize=True)
            np.add.at(of_v, self.space.dofs[samples.triangle], element)
            of_extra += np.einsum("knj,kn->j", known[..., :-1], of_p, optimize=True)
        bent_v, bent_extra = self.bending_forces(state)
        return (
            self.trial.at_actuators.T @ forces - bent_v - self.space.to_independent(of_v),
            self.trial.heights.T @ forces - bent_extra - of_extra,
        )

    def tangent(self, state: Coefficients) -> tuple[csc_matrix, FloatArray, FloatArray]:
        """The energy's second derivatives: of v and membrane, of these with the extra functions, of the extra ones."""
        membrane, dofs, count = self.membrane, self.space.dofs, self.trial.count
        everything = membrane.expand(state.membrane)
        all_w, all_m = self.space.all_count, len(everything)
        element = np.zeros((len(dofs), dofs.shape[1], dofs.shape[1]))
        couplings = np.zeros((len(dofs), membrane.dofs.shape[1], dofs.shape[1]))
        with_w, with_m, inner = np.zeros((all_w, count)), np.zeros((all_m, count)), np.zeros((count, count))
        for samples, with_pressure, p in zip(membrane.samples, self.known, state.slopes, strict=True):
            known, transposed = with_pressure[..., :-1], samples.gradient.transpose(0, 2, 1)
            stiff = samples.weighted(membrane.force(samples, everything, p) + membrane.stiffening(p))
            np.add.at(element, samples.triangle, transposed @ times(stiff, samples.gradient))
            of_known = times(stiff, known)
            np.add.at(with_w, dofs[samples.triangle], transposed @ of_known)
            inner += np.einsum("kni,knj->ij", known, of_known, optimize=True)
            operator = samples.weighted(samples.operator).transpose(0, 2, 1)
            np.add.at(couplings, samples.triangle, operator @ strains(p, samples.gradient))
            np.add.at(with_m, membrane.dofs[samples.triangle], operator @ strains(p, known))
        stiffness = self.bending + self._pins.T @ self._pins + self.space.assembled(element)
        coupling = membrane.reduce(self.space.to_independent(self._assembled(couplings, all_m, all_w).T).T)
        block = bmat([[stiffness, coupling.T], [coupling, membrane.sign * membrane.stiffness]], format="csc")
        border = np.concatenate([self.space.to_independent(with_w) + self.trial.cross, membrane.reduce(with_m)])
        return block, border, inner + self.trial.inner

    def _assembled(self, element: FloatArray, rows: int, columns: int) -> csc_matrix:
        """The sum of element matrices from all unknowns of w to all of the membrane."""
        row = np.broadcast_to(self.membrane.dofs[:, :, None], element.shape)
        column = np.broadcast_to(self.space.dofs[:, None, :], element.shape)
        return coo_matrix((element.ravel(), (row.ravel(), column.ravel())), shape=(rows, columns)).tocsc()

    def solver(self, now: Coefficients) -> BorderedSolver:
        """What solves for small changes about a state."""
        return BorderedSolver(self.trial, *self.tangent(now), self.held, self.compliance)

    def _step(
        self, solver: BorderedSolver, now: Coefficients, loads: Loads
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Newton's step in v and in the extra coefficients, and the actuators' forces after it."""
        given = np.where(self.held, 0.0, loads.strokes)
        of_v, of_extra = self.imbalance(now, given)
        missing = (loads.strokes - self.heights(now))[self.held]
        dv, de, given[self.held] = solver.solve(of_v, of_extra, missing)
        return dv, de, given

    def _change(self, now: Coefficients, dv: FloatArray, de: FloatArray) -> float:
        """The largest change of w over the largest w, at the mesh's points."""
        return self.change(dv, de) / max(self.change(now.v, now.extra), 1e-300)
