"""Trials: the paths of cases with many values of their parameters, and how far they are from their tracks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal, NamedTuple

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.identification.blocks import Blocks
from active_surface.identification.parameters import case_with
from active_surface.identification.track import Track
from active_surface.parameter import Parameter
from coupling import PathTask, build_friction, build_part, follow
from coupling.case import Case
from particle import Micropart, SurfaceMotion, Trajectory
from particle.friction import Contact
from particle.surface import rim_gap

Loss = Literal["squares", "absolute"]

MIDDLE: Final = 0.15  # on both sides of the median: the residuals from which their density there is estimated
NEGLIGIBLE: Final = 1e-2  # of a cost that one residual adds: less is no progress
EXACT: Final = 1e-12  # m: what is nearer cannot be told from a path


class Trial(NamedTuple):
    """The paths of all cases with one set of values, beside their tracks."""

    shares: FloatArray  # (n,) of the parameters' bounds
    residuals: FloatArray  # (m,) m, paths minus tracks
    cost: float  # m^2 or m; inf where a case cannot be run


class Recording(NamedTuple):
    """One track, with the case whose path it is."""

    case: Case
    surface: SurfaceMotion
    track: Track
    parameters: Sequence[Parameter]  # shared, then own

    @property
    def measured(self) -> int:
        """Of places along x and y."""
        return int(np.isfinite(self.track.position).sum())


class Trials:
    """All that were followed so far.

    Where residuals are normal, or of Laplace's distribution, with one unknown deviation for each track, their
    likelihood is greatest where the sum of freedom x log(loss) over tracks is least. The cost is the exponential of
    that over all freedom: the loss of one track, a geometric mean of several. So near the optimum a track counts by its
    own noise.
    """

    def __init__(self, recordings: Sequence[Recording], shared: int, loss: Loss, threads: int | None) -> None:
        self.recordings, self.loss, self._threads = list(recordings), loss, threads
        sizes = [recording.measured for recording in recordings]
        self.blocks = Blocks.of(sizes, shared, len(recordings[0].parameters) - shared)
        self.size = sum(sizes)  # m
        self.freedom = self.blocks.freedom  # (N,)
        self.all: list[Trial] = []  # without their residuals, which may be many
        self.best = Trial(np.zeros(self.blocks.count), np.zeros(self.size), np.inf)
        self.followed = 0  # paths
        self.refusal = ""  # why a case could not be run

    def of(self, rows: FloatArray) -> list[Trial]:
        """Trials at shares (k, n), followed side by side."""
        columns = [self._tried(number, rows[:, own]) for number, own in enumerate(self.blocks.columns)]
        return self._kept(rows, np.concatenate(columns, axis=1))

    def mixed(self, trials: Sequence[Trial]) -> Trial:
        """Of trials that share all shared values, for each track the own values of the nearest path."""
        nearest = np.argmin([self.losses(trial.residuals) for trial in trials], axis=0)
        shares, residuals = np.array(trials[0].shares), np.array(trials[0].residuals)
        for number, columns, rows in zip(nearest, self.blocks.columns, self.blocks.rows, strict=True):
            shares[columns], residuals[rows] = trials[number].shares[columns], trials[number].residuals[rows]
        return self._kept(shares[None], residuals[None])[0]

    def paths(self, number: int, runs: Sequence[tuple[Micropart, Contact]]) -> list[Trajectory]:
        """The paths of parts with their friction, until a track ends."""
        case, surface, track, _ = self.recordings[number]
        self.followed += len(runs)
        run = case.run.model_copy(update={"duration": float(track.time[-1])})
        return follow([PathTask(surface, part, law, run) for part, law in runs], self._threads)

    def losses(self, residuals: FloatArray) -> FloatArray:
        """Of each track (N,), m^2 or m."""
        sizes = residuals**2 if self.loss == "squares" else np.abs(residuals)
        least = EXACT**2 if self.loss == "squares" else EXACT
        return np.array([max(float(sizes[rows].sum()), least) for rows in self.blocks.rows])

    def cost(self, residuals: FloatArray) -> float:
        """Of residuals (m,)."""
        return float(np.exp(self.freedom @ np.log(self.losses(residuals)) / self.freedom.sum()))

    def weights(self, residuals: FloatArray) -> FloatArray:
        """The weights (m,) with which least squares step towards the least cost."""
        weights, scale = np.empty(len(residuals)), self.freedom / self.losses(residuals)
        for rows, one in zip(self.blocks.rows, scale, strict=True):
            size = np.abs(residuals[rows])
            least = 1e-2 * np.median(size) + np.finfo(float).tiny
            weights[rows] = one if self.loss == "squares" else one / np.maximum(size, least)
        return weights

    def curvature(self) -> tuple[FloatArray, FloatArray]:
        """With what weights (N,) tracks' slopes add to the curvature of - log likelihood at the optimum, and to the
        variance of its gradient, 1/m^2.

        Both are one over the variance of noise if it is normal. Of distances they follow from the density of residuals
        at their median, whatever their distribution (Koenker and Machado 1999, J. Am. Stat. Assoc. 94, 1296).
        """
        residuals = self.best.residuals
        weight = self.freedom / self.losses(residuals)
        if self.loss == "squares":
            return weight, weight
        ends = [np.quantile(residuals[rows], (0.5 - MIDDLE, 0.5 + MIDDLE)) for rows in self.blocks.rows]
        deviation = np.array([max(float(high - low), EXACT) / (4 * MIDDLE) for low, high in ends])
        return weight / deviation, weight**2

    def alike(self, cost: float, before: float) -> bool:
        """Whether a cost is no progress over that before."""
        return cost > before * (1 - NEGLIGIBLE / self.size)

    def threshold(self, rise: float) -> float:
        """The cost at which -2 log likelihood is by a rise above its least."""
        times = 1 if self.loss == "squares" else 2
        return self.best.cost * float(np.exp(rise / (times * self.freedom.sum())))

    def run(self, number: int, shares: FloatArray) -> tuple[Micropart, Contact] | None:
        """A part and its friction; None where the case contradicts itself or the part is not on the plate."""
        case, surface, _, parameters = self.recordings[number]
        try:
            case = case_with(case, parameters, shares)
            part, law = build_part(case), build_friction(case)
            if not rim_gap(surface.record, *part.position) >= 0:
                raise ValueError("the part must lie on the plate")
        except ValueError as error:
            self.refusal = str(error)
            return None
        return part, law

    def _tried(self, number: int, rows: FloatArray) -> FloatArray:
        """Residuals (k, m) of one track at shares (k, s), with equal ones followed once."""
        unlike, where = np.unique(rows, axis=0, return_inverse=True)
        runs, track = [self.run(number, shares) for shares in unlike], self.recordings[number].track
        measured = np.isfinite(track.position)
        residuals = np.full((len(runs), int(measured.sum())), np.inf)
        able = [k for k, run in enumerate(runs) if run is not None]
        for k, path in zip(able, self.paths(number, [run for run in runs if run is not None]), strict=True):
            residuals[k] = (path.at(track.time).position - track.position)[measured]
        return residuals[where.reshape(-1)]

    def _kept(self, rows: FloatArray, residuals: FloatArray) -> list[Trial]:
        found = [Trial(np.array(shares), away, self.cost(away)) for shares, away in zip(rows, residuals, strict=True)]
        self.all += [trial._replace(residuals=np.zeros(0)) for trial in found]
        self.best = min([self.best, *found], key=lambda trial: trial.cost)
        return found
