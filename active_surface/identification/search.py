"""The search for parameters: least squares from many starts, with slopes over ever narrower differences.

A path is a smooth function of its parameters except for jumps, where the part rests once more or once less, and for the
tolerance of the integrator. So slopes begin as differences over 2 % of the bounds, and the points of the differences
count as trials too.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.optimize import least_squares
from scipy.stats.qmc import Sobol

from active_surface.arrays import FloatArray
from active_surface.identification.trials import NEGLIGIBLE, Trial, Trials
from coupling import ProgressCallback, no_progress

POINTS: Final = 32  # for each parameter, anywhere within the bounds
STARTS: Final = 6  # of these, from which steps are made
APART: Final = 0.05  # of the bounds: starts that are closer are one
WIDTH: Final = 0.02  # of the bounds: the first width of differences
NARROWER: Final = (2e-3, 1e-4, 1e-5)  # the next ones, at the best optimum
FLAT: Final = 1e-12  # of the cost, which changes no more over the bounds: the data say nothing


def search(trials: Trials, seed: int, tell: ProgressCallback = no_progress) -> None:
    """Minimise the cost of trials, from many starts within the bounds; equal seeds give equal trials.

    tell: gets how many of the starts have settled.
    """
    slots = trials.columns.shape[1]
    points, rows = Sobol(slots, rng=seed).random_base2(int(np.ceil(np.log2(POINTS * slots)))), []
    for point in points:
        rows.append(np.empty(trials.count))
        rows[-1][trials.columns] = point  # own fields of all tracks alike
    starts: list[Trial] = []
    for trial in sorted(trials.of(np.array(rows)), key=lambda trial: trial.cost):
        apart = all(np.abs(trial.shares - other.shares).max() > APART for other in starts)
        if apart and np.isfinite(trial.cost) and len(starts) < STARTS:
            starts.append(trial)
    if not starts:
        raise ValueError(
            f"Input bounds of identify must have values with which the case runs; it says: {trials.refusal}"
        )
    trials.side_by_side(lambda own, trial: fit(own, trial.shares, WIDTH), starts, tell)
    polish(trials)


def polish(trials: Trials) -> None:
    """Go on from the best trial, with slopes over ever narrower differences."""
    for width in NARROWER:
        fit(trials, trials.best.shares, width)


def fit(trials: Trials, start: FloatArray, width: float | FloatArray, fixed: int | None = None) -> Trial:
    """The optimum reached from shares (n,), one of which may be fixed, with slopes over a width of the bounds."""
    free = np.arange(trials.count) != fixed

    def trial(point: FloatArray) -> Trial:
        shares = np.array(start)
        shares[free] = point - 1
        return trials.of(shares[None])[0]

    first = trial(start[free] + 1)  # the first step may be as long as a point is far from 0
    if not (free.any() and np.isfinite(first.cost)):
        return first
    found = least_squares(
        lambda point: trial(point).residuals,
        start[free] + 1,
        lambda point: trials.slopes(trial(point), width, free)[:, free],
        bounds=(1, 2),
        loss=lambda squares: trials.robust(squares) / first.cost,
        ftol=NEGLIGIBLE / trials.size,
        xtol=1e-2 * float(np.min(width)),
        gtol=FLAT,
    )
    return min(first, trial(found.x), key=lambda one: one.cost)
