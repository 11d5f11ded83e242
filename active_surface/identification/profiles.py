"""Profiles: how far each parameter may go while the others follow, until the data contradict."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.special import fdtri

from active_surface.arrays import FloatArray
from active_surface.identification.search import descend, slopes
from active_surface.identification.trials import Trial, Trials
from coupling import ProgressCallback, no_progress

LEVEL: Final = 0.95  # of intervals
FIRST_WIDTH: Final = 1e-3  # of the bounds: that of the first differences
WIDTHS: Final = 1e-6, 0.05  # of the bounds: the least and the largest
NARROWEST: Final = 0.1  # of half a deviation: the last differences by which other parameters follow
NEAR_ENOUGH: Final = 0.03  # of half an interval: how exact its ends are
LONGER: Final = 4.0  # a step over the one before
LEAST: Final = 1e-9  # of the bounds: ends are not sought closer
MAX_STEPS: Final = 40
AGAIN: Final = 3  # times that a better optimum, found meanwhile, begins anew


@dataclass
class _End:
    """One end of the interval of a parameter."""

    number: int
    side: int  # -1 the lower, 1 the upper
    step: float  # of the bounds
    rise: float  # of -2 log likelihood, there
    inside: Trial  # whose cost is below the threshold, farthest out
    outside: Trial | None = None
    further: bool = False  # whether it is sought beyond where residuals that are linear would have it

    def out(self, trial: Trial) -> float:
        """How far out a trial is."""
        return self.side * float(trial.shares[self.number])

    @property
    def at_bound(self) -> bool:
        return self.out(self.inside) >= (1 if self.side > 0 else 0)


@dataclass(frozen=True)
class Spread:
    """How far the n parameters may be off, by the slopes at the optimum."""

    covariance: FloatArray  # (n, n) of shares
    rises: FloatArray  # (n,) of -2 log likelihood, at the ends of each parameter's interval
    reaches: FloatArray  # (n,) of shares: where these would be, were residuals linear


def spread_of(trials: Trials) -> Spread:
    """The spread at the optimum, where parameters are known to lie within the bounds.

    A parameter of which the data say nothing has that of an even distribution over its bounds, 1/12. The rise is that
    of the ratio of likelihoods of residuals of unknown deviation: Student's, exact for one track with normal residuals
    that are linear in the parameters. With several tracks the degrees of freedom are those of the mean that an estimate
    is of them (Satterthwaite 1946, Biometrics Bulletin 2, 110): near those of its own track for an own field.
    """
    best, blocks = trials.best, trials.blocks
    free, width = np.ones(blocks.count, dtype=bool), np.full(blocks.count, FIRST_WIDTH)
    curvature, variance = trials.curvature()
    unknown = 12 * np.eye(blocks.count)
    for _ in range(2):
        slope = slopes(trials, trials.of(blocks.differences(best.shares, free, width)), free)
        inverse = np.linalg.inv(blocks.information(slope, curvature).sum(axis=0) + unknown)
        width = np.clip(np.sqrt(np.diag(inverse)) / 2, *WIDTHS)
    from_tracks = inverse @ blocks.information(slope, variance) @ inverse
    covariance = from_tracks.sum(axis=0) + inverse @ unknown @ inverse
    parts = np.diagonal(from_tracks, axis1=1, axis2=2) + np.finfo(float).tiny ** 0.25  # (N, n)
    freedom = parts.sum(axis=0) ** 2 / (parts**2 / trials.freedom[:, None]).sum(axis=0)
    stretch = np.diag(covariance) / np.diag(inverse)
    rises = freedom * np.log1p(fdtri(1, freedom, LEVEL) / freedom) * stretch
    return Spread(covariance, rises, np.sqrt(rises * np.diag(inverse)))


def profiled(trials: Trials, tell: ProgressCallback = no_progress) -> list[tuple[float, float]]:
    """The lower and upper end of each parameter's interval, as shares of its bounds; 0 or 1 where it does not end.

    An end is sought just below and above where linear residuals would have it, then from the trial farthest out that is
    below the threshold, in growing steps until one is above, and between both. All ends are sought side by side.

    tell: gets how many of the ends are known.
    """
    for _ in range(AGAIN):
        before, spread = trials.best.cost, spread_of(trials)
        ends = [
            _End(number, side, (1 - NEAR_ENOUGH / 2) * reach, rise, trials.best)
            for number, (rise, reach) in enumerate(zip(spread.rises.tolist(), spread.reaches.tolist(), strict=True))
            for side in (-1, 1)
        ]
        for _ in range(MAX_STEPS):
            unsettled = _unsettled(ends, trials)
            tell(len(ends) - len(unsettled), len(ends))
            if not unsettled:
                break
            _advance(unsettled, trials, spread.covariance)
        if trials.alike(trials.best.cost, before):
            break
        descend(trials, [trials.best], np.ones((1, trials.blocks.count), dtype=bool))
    _unsettled(ends, trials)
    least = trials.best.cost
    shares = [_crossing(end, trials.threshold(end.rise), least) for end in ends]
    return list(zip(shares[::2], shares[1::2], strict=True))


def _unsettled(ends: Sequence[_End], trials: Trials) -> list[_End]:
    """The ends that are not known well enough yet, brought up to date with all trials."""
    best, unsettled = trials.best, []
    costs = np.array([trial.cost for trial in trials.all])
    for end in ends:
        threshold = trials.threshold(end.rise)
        below = [trials.all[k] for k in np.flatnonzero(costs <= threshold)]
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
    least, rows = trials.best.cost, []
    free = np.ones((len(ends), trials.blocks.count), dtype=bool)
    for k, end in enumerate(ends):
        here = float(end.inside.shares[end.number])
        if end.outside is None:
            there = float(np.clip(here + end.side * end.step, 0, 1))
            end.step = LONGER * end.step if end.further else 0.9 * NEAR_ENOUGH * end.step
            end.further = True
        else:
            there = _crossing(end, trials.threshold(end.rise), least)
        following = end.inside.shares + spread[end.number] / spread[end.number, end.number] * (there - here)
        for row in (np.clip(following, 0, 1), np.array(end.inside.shares)):
            row[end.number], free[k, end.number] = there, False
            rows.append(row)
    tried = trials.of(np.array(rows))
    starts = [min(pair, key=lambda trial: trial.cost) for pair in zip(tried[::2], tried[1::2], strict=True)]
    enough = [trials.threshold(end.rise) for end in ends]
    widths = np.clip(np.sqrt(np.diag(spread)) / 2, *WIDTHS)
    for end, trial in zip(ends, descend(trials, starts, free, enough, widths, NARROWEST), strict=True):
        if trial.cost > trials.threshold(end.rise):
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
