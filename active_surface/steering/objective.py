"""Objective: how far from the target each of many settings of the knobs brings the part, and the best so far."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.steering.knobs import Knobs
from active_surface.steering.paths import Disturbance, Paths, cost
from active_surface.steering.scatter import SEARCHED, disturbances
from active_surface.steering.task import Task
from coupling import ProgressCallback

SAMPLES = 16  # disturbed runs of each trial, if a quantile is minimised


class Best(NamedTuple):
    """The best of several settings of the knobs."""

    cost: float = np.inf  # m
    values: FloatArray = np.zeros(0)  # of the knobs
    offset: FloatArray = np.zeros(2)  # (2,) m, from the target to the end


class Objective:
    """What a search minimises: the distance from the target, or the task's quantile of it over disturbed runs.

    `best` is the best setting of the knobs so far, `recent` the best since `forget` was called.
    """

    def __init__(
        self, task: Task, knobs: Knobs, paths: Paths, tell: ProgressCallback, max_paths: int, disturbed: bool = False
    ) -> None:
        """max_paths: number of paths after which the search ends."""
        self._task, self._knobs, self._paths, self._tell, self._max_paths = task, knobs, paths, tell, max_paths
        self.best = self.recent = Best()
        count = len(task.case.actuators)
        # The same for every trial, so that trials differ in nothing but their drives.
        self._ways = disturbances(SAMPLES, count, task.settings.seed, SEARCHED) if disturbed else [Disturbance()]
        self._quantile = task.settings.quantile if disturbed else None

    def forget(self) -> None:
        """Start `recent` anew."""
        self.recent = Best()

    @property
    def reached(self) -> bool:
        """Whether the most recent best is within the tolerance."""
        return self.recent.cost <= self._task.settings.tolerance

    @property
    def exhausted(self) -> bool:
        """Whether fewer paths are left than one trial takes."""
        return self._paths.count + len(self._ways) > self._max_paths

    def of(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """How far off the ends are (m, 2) [m], and the costs (m,) [m], of trials (m, n).

        Of disturbed runs the ends' mean counts. Trials beyond the paths that are left cost more than any other.
        """
        case, target = self._task.case, self._task.target
        room = max((self._max_paths - self._paths.count) // len(self._ways), 0 if np.isfinite(self.best.cost) else 1)
        if not room:
            return np.zeros((len(values), 2)), np.full(len(values), np.inf)
        trials = [self._knobs.actuators(row) for row in values[:room]]
        trajectories = self._paths.of([(actuators, way) for actuators in trials for way in self._ways])
        size, tolerance = self._paths.surface.size, self._task.settings.tolerance
        ends = np.array([path.position[-1] for path in trajectories]).reshape(len(trials), len(self._ways), 2)
        each = np.array([cost(path, target, case.run.duration, size, tolerance) for path in trajectories]).reshape(
            ends.shape[:2]
        )
        costs = each[:, 0] if self._quantile is None else np.quantile(each, self._quantile, axis=1)
        offsets = ends.mean(axis=1) - target
        nearest = int(np.argmin(costs))
        if costs[nearest] < self.recent.cost:
            self.recent = Best(float(costs[nearest]), values[nearest].copy(), offsets[nearest])
            self.best = min(self.best, self.recent, key=lambda one: one.cost)
        self._tell(min(self._paths.count, self._max_paths), self._max_paths)
        beyond = len(values) - len(trials)
        return np.pad(offsets, ((0, beyond), (0, 0))), np.pad(costs, (0, beyond), constant_values=np.inf)
