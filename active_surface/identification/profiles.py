"""Profiles: how far each parameter may go while the others follow, until the data contradict."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.identification.search import NEGLIGIBLE, descend, differences, slopes
from active_surface.identification.trials import Trial, Trials
from coupling import ProgressCallback, no_progress

FIRST_WIDTH: Final = 1e-3  # of the bounds: that of the first differences
WIDTHS: Final = 1e-6, 0.05  # of the bounds: the least and the largest
FOLLOWING: Final = 8  # rounds in which other parameters follow
NEAR_ENOUGH: Final = 0.03  # of half an interval: how exact its ends are
LEAST: Final = 1e-9  # of the bounds: ends are not sought closer
MAX_STEPS: Final = 40
AGAIN: Final = 3  # times that a better optimum, found meanwhile, begins anew


@dataclass
class _End:
    """One end of the interval of a parameter."""

    number: int
    side: int  # -1 the lower, 1 the upper
    step: float  # of the bounds
    inside: Trial  # whose cost is below the threshold, farthest out
    outside: Trial | None = None

    def out(self, trial: Trial) -> float:
        """How far out a trial is."""
        return self.side * float(trial.shares[self.number])

    @property
    def at_bound(self) -> bool:
        return self.out(self.inside) >= (1 if self.side > 0 else 0)


def covariance(trials: Trials) -> FloatArray:
    """The covariance (n, n) of the shares by the slopes at the optimum, where these are known to lie within the bounds.

    A parameter of which the data say nothing has that of an even distribution over its bounds, 1/12.
    """
    best, count = trials.best, len(trials.parameters)
    free, width = np.ones(count, dtype=bool), np.full(count, FIRST_WIDTH)
    weights = trials.weights(best.residuals)
    for _ in range(2):
        slope = slopes(trials.of(differences(best.shares, free, width)), free)
        variance = float(weights @ best.residuals**2) / (trials.size - count) + np.finfo(float).tiny
        matrix = slope.T @ (weights[:, None] * slope) / variance
        found = np.linalg.inv(matrix + 12 * np.eye(count))
        width = np.clip(np.sqrt(np.diag(found)) / 2, *WIDTHS)
    return np.asarray(found)


def profiled(trials: Trials, tell: ProgressCallback = no_progress) -> list[tuple[float, float]]:
    """The lower and upper end of each parameter's interval, as shares of its bounds; 0 or 1 where it does not end.

    An end is sought from the trial farthest out that is below the threshold, in steps that double until one is above,
    then between both. All ends are sought side by side.

    tell: gets how many of the ends are known.
    """
    for _ in range(AGAIN):
        before, spread = trials.best.cost, covariance(trials)
        ends = [
            _End(number, side, float(np.sqrt(spread[number, number])), trials.best)
            for number in range(len(trials.parameters))
            for side in (-1, 1)
        ]
        for _ in range(MAX_STEPS):
            unsettled = _unsettled(ends, trials)
            tell(len(ends) - len(unsettled), len(ends))
            if not unsettled:
                break
            _advance(unsettled, trials, spread)
        if trials.best.cost >= before * (1 - NEGLIGIBLE / trials.size):
            break
        descend(trials, [trials.best], np.ones((1, len(trials.parameters)), dtype=bool))
    _unsettled(ends, trials)
    least = trials.best.cost
    shares = [_crossing(end, trials.threshold(least), least) for end in ends]
    return list(zip(shares[::2], shares[1::2], strict=True))


def _unsettled(ends: Sequence[_End], trials: Trials) -> list[_End]:
    """The ends that are not known well enough yet, brought up to date with all trials."""
    best = trials.best
    threshold = trials.threshold(best.cost)
    below = [trial for trial in trials.all if trial.cost <= threshold] or [best]
    unsettled = []
    for end in ends:
        end.inside = max(below, key=end.out)
        if end.outside and (end.out(end.outside) <= end.out(end.inside) or end.outside.cost <= threshold):
            end.outside = None
        half = end.out(end.inside) - end.out(best)
        far = end.outside is None or end.out(end.outside) - end.out(end.inside) > max(NEAR_ENOUGH * half, LEAST)
        if not end.at_bound and far:
            unsettled.append(end)
    return unsettled


def _advance(ends: Sequence[_End], trials: Trials, spread: FloatArray) -> None:
    """Try a value for each end, with the others as they are or following along the slopes, and then by descent."""
    threshold, best, rows = trials.threshold(trials.best.cost), trials.best, []
    free = np.ones((len(ends), len(trials.parameters)), dtype=bool)
    for k, end in enumerate(ends):
        here = float(end.inside.shares[end.number])
        if end.outside is None:
            there = float(np.clip(here + end.side * end.step, 0, 1))
            end.step *= 2
        else:
            there = _crossing(end, threshold, best.cost)
        following = end.inside.shares + spread[end.number] / spread[end.number, end.number] * (there - here)
        for row in (np.clip(following, 0, 1), np.array(end.inside.shares)):
            row[end.number], free[k, end.number] = there, False
            rows.append(row)
    tried = trials.of(np.array(rows))
    starts = [min(pair, key=lambda trial: trial.cost) for pair in zip(tried[::2], tried[1::2], strict=True)]
    for end, trial in zip(ends, descend(trials, starts, free, FOLLOWING), strict=True):
        if trial.cost > threshold:
            end.outside = trial


def _crossing(end: _End, threshold: float, least: float) -> float:
    """Where the profile crosses the threshold, if the root of its rise is straight between both trials."""
    here = float(end.inside.shares[end.number])
    if end.outside is None:
        return here
    if not np.isfinite(end.outside.cost):
        share = 0.5
    else:
        low, middle, high = (max(cost - least, 0.0) ** 0.5 for cost in (end.inside.cost, threshold, end.outside.cost))
        share = float(np.clip((middle - low) / max(high - low, np.finfo(float).tiny), 0.1, 0.9))
    return here + share * (float(end.outside.shares[end.number]) - here)
