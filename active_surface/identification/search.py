"""The search for parameters: Gauss-Newton steps from many starts, each start's steps and differences in one batch.

A path is a smooth function of its parameters but for jumps, where the part rests once more or once less, and for the
tolerance of the integrator. So slopes are differences over a width that falls from 2 % of the bounds, the points of
the differences count as trials too, as in a compass search, and nothing is accepted that does not lower the cost.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from active_surface.arrays import BoolArray, FloatArray
from active_surface.identification.trials import Trial, Trials
from coupling import ProgressCallback, no_progress

POINTS: Final = 32  # for each parameter, anywhere within the bounds
STARTS: Final = 6  # of these, from which steps are made
WIDTH: Final = 0.02  # of the bounds: the first width of differences
NARROWER: Final = 0.2  # the next width over one that led nowhere
NARROWEST: Final = 1e-5
DAMPINGS: Final = (0.0, 0.01, 0.1, 1.0, 10.0)  # of a step, over the diagonal of its matrix
NEGLIGIBLE: Final = 1e-2  # of a cost that one residual adds: less is no progress
MAX_ROUNDS: Final = 40
APART: Final = 0.05  # of the bounds: starts that are closer are one


def search(trials: Trials, seed: int, tell: ProgressCallback = no_progress) -> None:
    """Minimise the cost of trials, from many starts within the bounds; equal seeds give equal trials.

    tell: gets how many of the starts have settled.
    """
    from scipy.stats.qmc import Sobol

    count = len(trials.parameters)
    power = int(np.ceil(np.log2(POINTS * count)))
    points = trials.of(Sobol(count, rng=seed).random_base2(power))
    good = sorted((trial for trial in points if np.isfinite(trial.cost)), key=lambda trial: trial.cost)
    if not good:
        raise ValueError(
            f"Input bounds of identify must have values with which the case runs; it says: {trials.refusal}"
        )
    starts: list[Trial] = []
    for trial in good:
        if all(np.abs(trial.shares - other.shares).max() > APART for other in starts):
            starts.append(trial)
    free = np.ones((min(len(starts), STARTS), count), dtype=bool)
    descend(trials, starts[:STARTS], free, tell=tell)


def descend(
    trials: Trials,
    starts: Sequence[Trial],
    free: BoolArray,
    rounds: int = MAX_ROUNDS,
    tell: ProgressCallback = no_progress,
) -> list[Trial]:
    """The best trial that is reached from each start.

    free: (starts, n) which parameters may change.  tell: gets how many of the starts have settled.
    """
    now, width = list(starts), np.full(len(starts), WIDTH)
    for _ in range(rounds):
        active = [k for k in range(len(now)) if width[k] >= NARROWEST and free[k].any() and 0 < now[k].cost < np.inf]
        tell(len(now) - len(active), len(now))
        if not active:
            break
        around = [differences(now[k].shares, free[k], width[k]) for k in active]
        tried = _split(trials.of(np.concatenate(around)), [len(rows) for rows in around])
        steps = [
            _steps(now[k], pair, free[k], trials.weights(now[k].residuals))
            for k, pair in zip(active, tried, strict=True)
        ]
        ahead = _split(trials.of(np.concatenate(steps)), [len(rows) for rows in steps])
        for k, pairs, further in zip(active, tried, ahead, strict=True):
            best = min([now[k], *pairs, *further], key=lambda trial: trial.cost)
            if best.cost > now[k].cost * (1 - NEGLIGIBLE / trials.size):
                width[k] *= NARROWER
            now[k] = best
    return now


def differences(shares: FloatArray, free: BoolArray, width: float | FloatArray) -> FloatArray:
    """Two points (2 f, n) for each free parameter, below and above the shares (n,) as far as the bounds allow."""
    widths = np.broadcast_to(width, shares.shape)
    rows = []
    for k in np.flatnonzero(free):
        for side in (-1, 1):
            rows.append(np.array(shares))
            rows[-1][k] = np.clip(shares[k] + side * widths[k], 0, 1)
    return np.array(rows).reshape(-1, len(shares))


def slopes(pairs: Sequence[Trial], free: BoolArray) -> FloatArray:
    """The derivatives (m, f) of the residuals, from trials at `differences`; 0 where one cannot be run."""
    columns = []
    for k, (low, high) in zip(np.flatnonzero(free), zip(pairs[::2], pairs[1::2], strict=True), strict=True):
        known = np.isfinite(low.cost) and np.isfinite(high.cost)
        rise = (high.residuals - low.residuals) if known else np.zeros_like(low.residuals)
        columns.append(rise / (high.shares[k] - low.shares[k]))
    return np.array(columns).T


def _steps(trial: Trial, pairs: Sequence[Trial], free: BoolArray, weights: FloatArray) -> FloatArray:
    """Shares (d, n) after Gauss-Newton steps with each damping, within the bounds."""
    slope = slopes(pairs, free)
    matrix, pull = slope.T @ (weights[:, None] * slope), slope.T @ (weights * trial.residuals)
    scale = np.maximum(np.diag(matrix), 1e-12 * max(float(np.diag(matrix).max()), np.finfo(float).tiny))
    rows = np.repeat(trial.shares[None], len(DAMPINGS), axis=0)
    for row, damping in zip(rows, DAMPINGS, strict=True):
        row[free] -= np.linalg.lstsq(matrix + damping * np.diag(scale), pull, rcond=1e-10)[0]
    return np.clip(rows, 0, 1)


def _split(trials: list[Trial], sizes: Sequence[int]) -> list[list[Trial]]:
    ends = np.cumsum(sizes).tolist()
    return [trials[end - size : end] for end, size in zip(ends, sizes, strict=True)]
