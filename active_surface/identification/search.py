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
    good = sorted((trial for trial in _points(trials, seed) if np.isfinite(trial.cost)), key=lambda trial: trial.cost)
    if not good:
        raise ValueError(
            f"Input bounds of identify must have values with which the case runs; it says: {trials.refusal}"
        )
    starts: list[Trial] = []
    for trial in good:
        if all(np.abs(trial.shares - other.shares).max() > APART for other in starts):
            starts.append(trial)
    free = np.ones((min(len(starts), STARTS), trials.blocks.count), dtype=bool)
    descend(trials, starts[:STARTS], free, tell=tell)


def _points(trials: Trials, seed: int) -> list[Trial]:
    """Trials all over the bounds, as many for each track as if there were no other."""
    from scipy.stats.qmc import Sobol

    blocks, slots = trials.blocks, trials.blocks.columns.shape[1]
    points = Sobol(slots, rng=seed).random_base2(int(np.ceil(np.log2(POINTS * slots))))
    tried = trials.of(blocks.everywhere(points))
    return [*tried, *trials.of(_joined(trials, points, tried))] if blocks.several else tried


def _joined(trials: Trials, points: FloatArray, tried: Sequence[Trial]) -> FloatArray:
    """The likeliest shares (k, n) of the shared values of points (p, s), with own values that suit each track there.

    These are the best of the points that are nearest in the shared values: as many as a cell has, if even cells divide
    all directions alike.
    """
    blocks, count = trials.blocks, len(points)
    shared = points[:, : blocks.shared]
    apart = np.abs(shared[:, None] - shared[None]).max(axis=2, initial=0)
    near = np.argsort(apart, axis=1, kind="stable")[:, : round(count ** (1 - blocks.shared / points.shape[1]))]
    sizes = np.log([trials.losses(trial.residuals) for trial in tried])  # (p, N)
    shares, likely = blocks.everywhere(points), np.zeros(count)
    for columns, freedom, size in zip(blocks.columns, trials.freedom, sizes.T, strict=True):
        best = near[np.arange(count), np.argmin(size[near], axis=1)]
        shares[:, columns[blocks.shared :]] = points[best, blocks.shared :]
        likely += freedom * size[best]
    return shares[np.argsort(likely, kind="stable")[:POINTS]]


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
    now, width, blocks = list(starts), np.full(len(starts), WIDTH), trials.blocks
    for _ in range(rounds):
        active = [k for k in range(len(now)) if width[k] >= NARROWEST and free[k].any() and np.isfinite(now[k].cost)]
        tell(len(now) - len(active), len(now))
        if not active:
            break
        around = [blocks.differences(now[k].shares, free[k], width[k]) for k in active]
        tried = _split(trials.of(np.concatenate(around)), [len(rows) for rows in around])
        steps = [_steps(trials, now[k], pairs, free[k]) for k, pairs in zip(active, tried, strict=True)]
        ahead = _split(trials.of(np.concatenate(steps)), [len(rows) for rows in steps])
        for k, pairs, further in zip(active, tried, ahead, strict=True):
            best = min([_around(trials, now[k], pairs), *further], key=lambda trial: trial.cost)
            if best.cost > now[k].cost * (1 - NEGLIGIBLE / trials.size):
                width[k] *= NARROWER
            now[k] = best
    return now


def _around(trials: Trials, trial: Trial, pairs: list[Trial]) -> Trial:
    """The best of a trial and the pairs about it, of which each track takes own values that suit it."""
    best = min([trial, *pairs], key=lambda one: one.cost)
    if not trials.blocks.several:
        return best
    shared = slice(trials.blocks.shared)
    same = [one for one in pairs if np.array_equal(one.shares[shared], trial.shares[shared])]
    return min(best, trials.mixed([trial, *same]), key=lambda one: one.cost)


def _steps(trials: Trials, trial: Trial, pairs: Sequence[Trial], free: BoolArray) -> FloatArray:
    """Shares (d, n) after Gauss-Newton steps with each damping, within the bounds."""
    slope, weights = trials.blocks.slopes(pairs, free), trials.weights(trial.residuals)
    rows = [trial.shares + trials.blocks.step(slope, trial.residuals, weights, damping) for damping in DAMPINGS]
    return np.clip(np.array(rows), 0, 1)


def _split(trials: list[Trial], sizes: Sequence[int]) -> list[list[Trial]]:
    ends = np.cumsum(sizes).tolist()
    return [trials[end - size : end] for end, size in zip(ends, sizes, strict=True)]
