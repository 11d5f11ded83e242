"""Profiles: how far each parameter may go while the others follow, until the data contradict."""

from __future__ import annotations

from functools import cache
from typing import Final, NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.special import fdtri

from active_surface.arrays import FloatArray
from active_surface.identification.search import fit, polish
from active_surface.identification.trials import Trials
from coupling import ProgressCallback, no_progress

LEVEL: Final = 0.95  # of intervals
FIRST_WIDTH: Final = 1e-3  # of the bounds: that of the first differences
WIDTHS: Final = 1e-6, 0.05  # of the bounds: the least and the largest
NEAR_ENOUGH: Final = 0.03  # of half an interval: by how much the first try goes beyond where a line would end it
EXACT: Final = 0.01  # of half an interval: how exact its ends are
LONGER: Final = 4.0  # a step over the one before
LEAST: Final = 1e-9  # of the bounds: ends are not sought closer
STEEP: Final = 9.0  # times the rise at the end of an interval: higher ones count as this
AGAIN: Final = 3  # times that a better optimum, found meanwhile, begins anew


class Spread(NamedTuple):
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
    best, width = trials.best, np.full(trials.count, FIRST_WIDTH)
    curvature, variance = (weights[:, None, None] for weights in trials.curvature())
    unknown = 12 * np.eye(trials.count)
    for _ in range(2):
        slope = trials.slopes(best, width, np.ones(trials.count, dtype=bool))
        squares = np.array([slope[rows].T @ slope[rows] for rows in trials.rows])  # (N, n, n)
        inverse = np.linalg.inv((curvature * squares).sum(axis=0) + unknown)
        width = np.clip(np.sqrt(np.diag(inverse)) / 2, *WIDTHS)
    from_tracks = inverse @ (variance * squares) @ inverse
    covariance = from_tracks.sum(axis=0) + inverse @ unknown @ inverse
    parts = np.diagonal(from_tracks, axis1=1, axis2=2) + np.finfo(float).tiny ** 0.25  # (N, n)
    freedom = parts.sum(axis=0) ** 2 / (parts**2 / trials.freedom[:, None]).sum(axis=0)
    stretch = np.diag(covariance) / np.diag(inverse)
    rises = freedom * np.log1p(fdtri(1, freedom, LEVEL) / freedom) * stretch
    return Spread(covariance, rises, np.sqrt(rises * np.diag(inverse)))


def profiled(trials: Trials, tell: ProgressCallback = no_progress) -> list[tuple[float, float]]:
    """The lower and upper end of each parameter's interval, as shares of its bounds; 0 or 1 where it does not end.

    tell: gets how many of the ends are known.
    """
    for _ in range(AGAIN):
        before, spread = trials.best.cost, spread_of(trials)
        sought = [(spread, number, side) for number in range(trials.count) for side in (-1, 1)]
        ends = trials.side_by_side(lambda own, one: _end(own, *one), sought, tell)
        if trials.alike(trials.best.cost, before):
            break
        polish(trials)
    return list(zip(ends[::2], ends[1::2], strict=True))


def _end(trials: Trials, spread: Spread, number: int, side: int) -> float:
    """One end of an interval: where the profile of the likelihood crosses the threshold, beyond all trials below it."""
    best, threshold = trials.best, trials.threshold(spread.rises[number])
    following = spread.covariance[number] / spread.covariance[number, number]
    widths = np.clip(np.sqrt(np.diag(spread.covariance)) / 2, *WIDTHS)
    near = {float(best.shares[number]): best.shares}
    high = (threshold - best.cost) ** 0.5

    @cache
    def rise(share: float) -> float:
        """The root of the rise of the profile, which is straight where residuals are linear, less that at the end."""
        here = min(near, key=lambda place: abs(place - share))
        start = np.clip(near[here] + following * (share - here), 0, 1)
        start[number] = share
        trial = fit(trials, start, widths, number)
        if np.isfinite(trial.cost):
            near[share] = trial.shares
        return min(max(trial.cost - best.cost, 0.0) ** 0.5, STEEP * high) - high

    inside = max((shares for shares, cost in trials.seen if cost <= threshold), key=lambda one: side * one[number])
    share, reach = float(inside[number]), float(spread.reaches[number])
    near[share] = inside
    step = max((1 + NEAR_ENOUGH / 2) * reach - side * (share - float(best.shares[number])), NEAR_ENOUGH * reach)
    while rise(outer := float(np.clip(share + side * step, 0, 1))) <= 0:
        if outer in (0, 1):
            return outer
        share, step = outer, LONGER * step
    return float(brentq(rise, share, outer, xtol=max(EXACT * abs(outer - best.shares[number]), LEAST)))
