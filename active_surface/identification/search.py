"""The search for parameters: Gauss-Newton steps from many starts, each start's steps and differences in one batch.

A path is a smooth function of its parameters but for jumps, where the part rests once more or once less, and for the
tolerance of the integrator. So slopes are differences over a width that falls from 2 % of the bounds, the points of
the differences count as trials too, as in a compass search, and nothing is accepted that does not lower the cost.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from active_surface.arrays import BoolArray, FloatArray
from active_surface.identification.trials import Trial, Trials
from coupling import ProgressCallback, no_progress

POINTS: Final = 32  # for each parameter, anywhere within the bounds
STARTS: Final = 6  # of these, from which steps are made
WIDTH: Final = 0.02  # of the bounds: the first width of differences
NARROWER: Final = 0.2  # the next width over one that led nowhere
NARROWEST: Final = 5e-4  # of the first: the last width
DAMPINGS: Final = (1e-4, 1e-3, 0.01, 0.1, 1.0)  # of a step that failed, over the diagonal of its matrix
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
    enough: Sequence[float] | None = None,
    widths: float | FloatArray = WIDTH,
    narrowest: float = NARROWEST,
    tell: ProgressCallback = no_progress,
) -> list[Trial]:
    """The best trial that is reached from each start.

    free: (starts, n) which parameters may change.  enough: (starts,) costs below which nothing more is sought; None:
    starts are after the same optimum, so one that comes as near to a better one as its differences are wide is given
    up.  widths: of the first differences.  narrowest: of the last ones, over these.  tell: gets how many have settled.
    """
    now, scale = list(starts), np.ones(len(starts))
    for _ in range(MAX_ROUNDS):
        least = enough or np.zeros(len(now))
        active = [
            k for k in range(len(now)) if scale[k] >= narrowest and free[k].any() and least[k] < now[k].cost < np.inf
        ]
        tell(len(now) - len(active), len(now))
        if not active:
            break
        around = [trials.blocks.differences(now[k].shares, free[k], scale[k] * np.asarray(widths)) for k in active]
        tried = _split(trials.of(np.concatenate(around)), [len(rows) for rows in around])
        models = [_Model.at(trials, now[k], pairs, free[k]) for k, pairs in zip(active, tried, strict=True)]
        for k, pairs, further, model in zip(active, tried, _stepped(trials, models), models, strict=True):
            best = min([_around(trials, now[k], pairs), *further], key=lambda trial: trial.cost)
            if trials.alike(best.cost, now[k].cost):
                scale[k] *= NARROWER
            elif model.holds(best):
                scale[k] = min(scale[k], float(np.max(np.abs(best.shares - now[k].shares) / widths)))
            now[k] = best
        if enough is None:
            _give_up(now, scale)
    return now


def _give_up(now: Sequence[Trial], scale: FloatArray) -> None:
    """Narrow the starts to nothing that are near a better one."""
    order = sorted(range(len(now)), key=lambda k: now[k].cost)
    for place, k in enumerate(order):
        if any(np.abs(now[k].shares - now[j].shares).max() <= scale[k] * WIDTH for j in order[:place]):
            scale[k] = 0


@dataclass(frozen=True)
class _Model:
    """Residuals that are linear in the shares about a trial."""

    trials: Trials
    trial: Trial
    slope: FloatArray  # (m, s)

    @classmethod
    def at(cls, trials: Trials, trial: Trial, pairs: Sequence[Trial], free: BoolArray) -> _Model:
        """That of a trial and the pairs about it."""
        return cls(trials, trial, slopes(trials, pairs, free))

    def optimum(self, damping: float) -> FloatArray:
        """Shares (n,) after a Gauss-Newton step, within the bounds."""
        weights = self.trials.weights(self.trial.residuals)
        change = self.trials.blocks.step(self.slope, self.trial.residuals, weights, damping)
        return np.clip(self.trial.shares + change, 0, 1)

    def cost(self, shares: FloatArray) -> float:
        """What it expects."""
        blocks, change = self.trials.blocks, shares - self.trial.shares
        return self.trials.cost(self.trial.residuals + blocks.along(self.slope, change))

    def holds(self, trial: Trial) -> bool:
        """Whether a trial gains at least half of what it expects of the undamped step."""
        return self.trial.cost - trial.cost >= (self.trial.cost - self.cost(self.optimum(0.0))) / 2


def slopes(trials: Trials, pairs: Sequence[Trial], free: BoolArray) -> FloatArray:
    """The derivatives (m, s) of residuals, from trials at differences."""
    return trials.blocks.slopes([one.shares for one in pairs], [one.residuals for one in pairs], free)


def _stepped(trials: Trials, models: Sequence[_Model]) -> list[list[Trial]]:
    """Trials after Gauss-Newton steps: the undamped one, and where it failed against expectation damped ones."""
    first = trials.of(np.array([model.optimum(0.0) for model in models]))
    found = [[trial] for trial in first]
    for own, model in zip(found, models, strict=True):
        expected = model.cost(own[0].shares)
        if not (model.holds(own[0]) or trials.alike(expected, model.trial.cost)):
            own += trials.of(np.array([model.optimum(damping) for damping in DAMPINGS]))
    return found


def _around(trials: Trials, trial: Trial, pairs: list[Trial]) -> Trial:
    """The best of a trial and the pairs about it, of which each track takes own values that suit it."""
    best = min([trial, *pairs], key=lambda one: one.cost)
    if not trials.blocks.several:
        return best
    shared = slice(trials.blocks.shared)
    same = [one for one in pairs if np.array_equal(one.shares[shared], trial.shares[shared])]
    return min(best, trials.mixed([trial, *same]), key=lambda one: one.cost)


def _split(trials: list[Trial], sizes: Sequence[int]) -> list[list[Trial]]:
    ends = np.cumsum(sizes).tolist()
    return [trials[end - size : end] for end, size in zip(ends, sizes, strict=True)]
