"""The search for a drive: the evolution strategy CMA-ES, then Newton's method near the target.

Over a few cycles the end point is a smooth function of strokes, frequencies and delays, except for jumps where the
part rests once more or once less. Evolution (Hansen 2016, arXiv:1604.00772) learns which knobs act together and finds
the smooth piece; Newton's method, with one difference for each smooth knob, finds the point on it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import lsq_linear

from active_surface.arrays import FloatArray
from active_surface.steering.knobs import Knobs
from active_surface.steering.objectives import Objective
from active_surface.steering.paths import Paths
from active_surface.steering.task import Task
from coupling import ProgressCallback

ANYWHERE = 0.3  # of the knobs' ranges: the first spread of a population
AROUND = 0.1  # likewise, around a setting
MARGIN = 1e-6  # of a knob's range: a population starts so far inside at least
NEWTON_RANGE = 0.1  # of the surface's size: cost below which Newton's method is tried
AGAIN = 0.5  # of the cost that Newton's method left: below it is tried again
PATIENCE = 30  # generations without PROGRESS before another population begins
MAX_STEPS = 8  # of Newton's method
DIFFERENCE = 1e-5  # of a knob's range: step of the differences
SHARES = (1.0, 0.7, 0.5, 0.35, 0.25, 0.12, 0.06, 0.03)  # of a Newton step; all are tried
DAMPING = 1e-3  # of the largest slope: among steps that meet the target it chooses a small one
ROUNDING = 1e-12  # of a knob's range
PROGRESS = 0.8  # of the previous cost; a step that leaves more ends the method
OPTIONS = {"bounds": [0, 1], "verbose": -9, "maxiter": 10_000, "tolfun": 1e-9, "tolx": 1e-7, "tolflatfitness": 5}


class Best(NamedTuple):
    """The best of several settings of the knobs."""

    cost: float = np.inf  # m
    values: FloatArray = np.zeros(0)  # of the knobs
    offset: FloatArray = np.zeros(2)  # (2,) m, from the target to the end; with a heading (3,)


class Trials:
    """The trials of a search: their number is limited, and the best are kept.

    `best` is the best setting of the knobs so far, `recent` the best since `forget` was called.
    """

    def __init__(self, goal: Objective, tell: ProgressCallback, max_paths: int) -> None:
        """max_paths: number of paths after which the search ends."""
        self._goal, self._tell, self._max_paths = goal, tell, max_paths
        self.best = self.recent = Best()

    def forget(self) -> None:
        """Start `recent` anew."""
        self.recent = Best()

    @property
    def reached(self) -> bool:
        """Whether the most recent best is within the tolerance."""
        return self.recent.cost <= self._goal.tolerance

    @property
    def exhausted(self) -> bool:
        """Whether fewer paths are left than one trial takes."""
        return self._goal.paths + self._goal.runs > self._max_paths

    def of(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """How far off the ends are (m, 2) [m], and the costs (m,) [m], of trials (m, n).

        Trials beyond the paths that are left cost more than any other.
        """
        left = (self._max_paths - self._goal.paths) // self._goal.runs
        room = min(max(left, 0 if np.isfinite(self.best.cost) else 1), len(values))
        if not room:
            return np.zeros((len(values), 2)), np.full(len(values), np.inf)
        offsets, costs = self._goal.evaluate(values[:room])
        nearest = int(np.argmin(costs))
        if costs[nearest] < self.recent.cost:
            self.recent = Best(float(costs[nearest]), values[nearest].copy(), offsets[nearest])
            self.best = min(self.best, self.recent, key=lambda one: one.cost)
        self._tell(min(self._goal.paths, self._max_paths), self._max_paths)
        beyond = len(values) - room
        return np.pad(offsets, ((0, beyond), (0, 0))), np.pad(costs, (0, beyond), constant_values=np.inf)


class Search:
    """Finds the drives that bring a part to a task's target within its case's duration; equal seeds, equal results.

    Newton's method is tried from a first setting, then populations evolve around it; without one anywhere. A robust
    search evolves undisturbed paths anywhere for half of the paths, then continues around the most robust of the best.
    """

    def __init__(
        self,
        paths: Paths,
        task: Task,
        knobs: Knobs,
        tell: ProgressCallback,
        max_paths: int,
        number: int,
        start: FloatArray | None = None,
    ) -> None:
        """max_paths: after which the search ends.  number: of the search; each has its own stream of random numbers.

        start: (n,) of the knobs.
        """
        self._start, self.knobs, self._paths, self._number, self._populations = start, knobs, paths, number, 0
        self._newton_range, self._seed = NEWTON_RANGE * paths.surface.size, task.settings.seed
        self._robust: Trials | None = None
        if task.settings.is_robust:
            self._robust = Trials(Objective(task, knobs, paths, is_robust=True), tell, max_paths)
            max_paths = max(max_paths // 2, 1)
        self._nominal = Trials(Objective(task, knobs, paths), tell, max_paths)

    @property
    def paths(self) -> int:
        """How many have been followed."""
        return self._paths.count

    @property
    def best(self) -> Best:
        """The best setting so far; its cost is infinite where there is none."""
        return self._robust.best if self._robust and np.isfinite(self._robust.best.cost) else self._nominal.best

    def run(self) -> None:
        """Search until the target is reached or the paths are used up; after Ctrl-C the best so far counts."""
        nominal, robust, start = self._nominal, self._robust, self._start
        if not self.knobs.knobs:
            (robust or nominal).of(np.zeros((1, 0)))
            return
        if start is not None:
            nominal.of(start[None])
            if not nominal.reached and nominal.recent.cost <= self._newton_range:
                _newton(self.knobs, nominal)
            if robust is not None:
                robust.of(nominal.best.values[None])
        while not nominal.exhausted and (robust is not None or not nominal.reached):
            self._evolve(nominal, self._newton_range, None if start is None or robust else nominal.best.values)
            if robust is not None:
                robust.of(nominal.recent.values[None])
        if robust is not None and not robust.exhausted:
            self._evolve(robust, 0.0, robust.best.values)

    def _evolve(self, trials: Trials, newton_range: float, middle: FloatArray | None = None) -> None:
        """Evolve a population, around `middle` (n,) or anywhere, until it makes no more progress.

        newton_range: m, the cost below which Newton's method is tried.
        """
        from cma import CMAEvolutionStrategy

        trials.forget()
        low, high = np.array(self.knobs.bounds).T
        width, generator = high - low, np.random.default_rng((self._seed, self._number, self._populations))
        self._populations += 1
        first = generator.random(len(low)) if middle is None else (middle - low) / width
        spread, options = ANYWHERE if middle is None else AROUND, OPTIONS | {"seed": int(generator.integers(1, 2**31))}
        strategy = CMAEvolutionStrategy(np.clip(first, MARGIN, 1 - MARGIN), spread, options)
        tried, before, idle = np.inf, np.inf, 0
        while not (trials.reached or trials.exhausted or idle == PATIENCE or strategy.stop()):
            samples = strategy.ask()
            _, costs = trials.of(low + width * np.array(samples))
            if not np.isfinite(costs).all():
                return
            strategy.tell(samples, costs)
            if not trials.reached and trials.recent.cost <= min(newton_range, AGAIN * tried):
                _newton(self.knobs, trials)
                tried = trials.recent.cost
            improved = trials.recent.cost < PROGRESS * before
            before, idle = (trials.recent.cost, 0) if improved else (before, idle + 1)


def _newton(knobs: Knobs, trials: Trials) -> None:
    """Newton's method from the best setting of a population, by the smallest step that should meet the target."""
    low, high = np.array(knobs.bounds).T
    smooth, width = knobs.smooth, high - low
    if not len(smooth):
        return
    for _ in range(MAX_STEPS):
        start = trials.recent
        side = np.where(start.values + DIFFERENCE * width > high, -DIFFERENCE, DIFFERENCE)[smooth]
        moved = np.repeat(start.values[None], len(smooth), axis=0)
        moved[np.arange(len(smooth)), smooth] += side * width[smooth]
        offsets, _ = trials.of(moved)
        if trials.exhausted:
            return
        slopes = ((offsets - start.offset) / side[:, None]).T  # (2 or 3, smooth) m, over the ranges of the knobs
        room = (np.array([low, high]) - start.values)[:, smooth] / width[smooth]
        step = _smallest_step(slopes, start.offset, room) * width[smooth]
        steps = np.repeat(start.values[None], len(SHARES), axis=0)
        steps[:, smooth] = np.clip(steps[:, smooth] + np.outer(SHARES, step), low[smooth], high[smooth])
        trials.of(steps)
        if trials.reached or trials.exhausted or trials.recent.cost > PROGRESS * start.cost:
            return


def _smallest_step(slopes: FloatArray, offset: FloatArray, room: FloatArray) -> FloatArray:
    """The smallest step (n,) within `room` (2, n) that brings an offset (k,) nearest to 0 with slopes (k, n)."""
    damping = DAMPING * max(float(np.linalg.norm(slopes, 2)), np.finfo(float).tiny)
    matrix = np.concatenate([slopes, damping * np.eye(len(slopes.T))])
    low, high = np.minimum(room[0], -ROUNDING), np.maximum(room[1], ROUNDING)  # scipy wants an interior
    return np.asarray(lsq_linear(matrix, np.pad(-offset, (0, len(slopes.T))), (low, high)).x)
