"""Trials: the paths of a case with many values of its parameters, and how far they are from a track."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal, NamedTuple

import numpy as np
from scipy.special import fdtri

from active_surface.arrays import FloatArray
from active_surface.identification.parameters import Parameter, case_with
from active_surface.identification.track import Track
from coupling import build_friction, build_part
from coupling.case import Case
from particle import Micropart, SurfaceMotion, Trajectory, simulate_many
from particle.friction import Contact
from particle.surface import rim_gap

Loss = Literal["squares", "absolute"]

LEVEL: Final = 0.95  # of intervals
MIDDLE: Final = 0.15  # on both sides of the median: the residuals from which their density there is estimated


class Trial(NamedTuple):
    """One path beside the track."""

    shares: FloatArray  # (n,) of the parameters' bounds
    residuals: FloatArray  # (m,) m, path minus track
    cost: float  # of the loss, m^2 or m; inf where the case cannot be run


class Trials:
    """All that were followed so far."""

    def __init__(
        self,
        case: Case,
        surface: SurfaceMotion,
        track: Track,
        parameters: Sequence[Parameter],
        loss: Loss,
        threads: int | None,
    ) -> None:
        self.case, self.parameters = case, parameters
        self._surface, self._track, self._loss, self._threads = surface, track, loss, threads
        self._measured = np.isfinite(track.position)
        self.size = int(self._measured.sum())  # m, residuals of a path
        self.all: list[Trial] = []  # without their residuals, which may be many
        self.best = Trial(np.zeros(len(parameters)), np.zeros(self.size), np.inf)
        self.refusal = ""  # why a case could not be run

    def of(self, rows: FloatArray) -> list[Trial]:
        """Trials at shares (k, n), followed side by side."""
        runs = [self._run(shares) for shares in rows]
        paths = iter(self.paths([run for run in runs if run is not None]))
        found = []
        for shares, run in zip(rows, runs, strict=True):
            residuals = np.full(self.size, np.inf) if run is None else self._residuals(next(paths))
            found.append(Trial(np.array(shares), residuals, self._cost(residuals)))
        self.all += [trial._replace(residuals=np.zeros(0)) for trial in found]
        self.best = min([self.best, *found], key=lambda trial: trial.cost)
        return found

    def paths(self, runs: Sequence[tuple[Micropart, Contact]]) -> list[Trajectory]:
        """The paths of parts with their friction, until the track ends."""
        if not runs:
            return []
        run, parts, laws = self.case.run, [part for part, _ in runs], [law for _, law in runs]
        end = float(self._track.time[-1])
        options = run.gravity, run.tolerance, run.after_detachment, None, self._threads
        return simulate_many(self._surface, parts, laws, end, *options)

    def threshold(self, best: float) -> float:
        """The cost below which a profile is within the interval, where `best` is the least.

        Squares: the ratio of likelihoods of normal residuals of unknown deviation, exact where residuals are linear.
        Absolute: that of median regression, whose scale is the density of residuals at their median (Koenker and
        Machado 1999, J. Am. Stat. Assoc. 94, 1296).
        """
        freedom = self.size - len(self.parameters)
        ratio = float(fdtri(1, freedom, LEVEL))
        if self._loss == "squares":
            return best * (1 + ratio / freedom)
        low, high = np.quantile(self.best.residuals, (0.5 - MIDDLE, 0.5 + MIDDLE))
        return best + ratio * float(high - low) / (8 * MIDDLE)

    def weights(self, residuals: FloatArray) -> FloatArray:
        """The weights (m,) with which least squares step towards the least cost."""
        if self._loss == "squares":
            return np.ones_like(residuals)
        size = np.abs(residuals)
        return np.asarray(1 / np.maximum(size, 1e-2 * np.median(size) + np.finfo(float).tiny))

    def _run(self, shares: FloatArray) -> tuple[Micropart, Contact] | None:
        """The part and its friction; None where the case contradicts itself or the part is not on the plate."""
        try:
            case = case_with(self.case, self.parameters, shares)
            part, law = build_part(case), build_friction(case)
            if not rim_gap(self._surface.record, *part.position) >= 0:
                raise ValueError("the part must lie on the plate")
        except ValueError as error:
            self.refusal = str(error)
            return None
        return part, law

    def _residuals(self, path: Trajectory) -> FloatArray:
        away = path.at(self._track.time).position - self._track.position
        return np.asarray(away[self._measured])

    def _cost(self, residuals: FloatArray) -> float:
        return float(residuals @ residuals if self._loss == "squares" else np.abs(residuals).sum())
