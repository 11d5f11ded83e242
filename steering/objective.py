"""Objective: how far from the target each of many turns of the knobs brings the part, and the best one so far."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coupling.progress import Tell
from steering.knobs import Knobs
from steering.paths import Disturbance, Paths, cost
from steering.scatter import SEARCHED, disturbances
from steering.task import Task

FloatArray = NDArray[np.float64]

SAMPLES = 16  # disturbed runs of each trial, where a quantile of them is made small


class Best(NamedTuple):
    """A turn of the knobs, the best of several."""

    cost: float = np.inf  # m
    values: FloatArray = np.zeros(0)  # of the knobs
    off: FloatArray = np.zeros(2)  # (2,) m, from the target to the end


class Objective:
    """What a search makes small: the distance from the target, or a quantile of it over disturbed runs.

    `best` is the best turn of the knobs so far, `recent` that since `forget` was called.
    """

    def __init__(self, task: Task, knobs: Knobs, paths: Paths, tell: Tell) -> None:
        self._task, self._knobs, self._paths, self._tell = task, knobs, paths, tell
        self.best = self.recent = Best()
        self.trials = 0
        settings, count = task.settings, len(task.case.actuators)
        disturbed = settings.quantile is not None
        # The same for every trial, so that trials differ in nothing but their drives.
        self._ways = disturbances(SAMPLES, count, settings.seed, SEARCHED) if disturbed else [Disturbance()]

    def forget(self) -> None:
        """Makes what comes next the best of its own, whatever there was before."""
        self.recent = Best()

    @property
    def reached(self) -> bool:
        """Whether the best is within the tolerance."""
        return self.best.cost <= self._task.settings.tolerance

    @property
    def exhausted(self) -> bool:
        """Whether there have been as many trials as there may be."""
        return self.trials >= self._task.settings.trials

    def of(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """How far off the ends are (m, 2) [m], and the costs (m,) [m], of trials (m, n).

        Of disturbed runs the ends' mean counts.
        """
        case, target, quantile = self._task.case, self._task.target, self._task.settings.quantile
        turned = [self._knobs.actuators(row) for row in values]
        found = self._paths.of([(actuators, way) for actuators in turned for way in self._ways])
        size = self._paths.surface.size
        ends = np.array([path.position[-1] for path in found]).reshape(len(values), len(self._ways), 2)
        each = np.array([cost(path, target, case.run.duration, size) for path in found]).reshape(ends.shape[:2])
        costs = each[:, 0] if quantile is None else np.quantile(each, quantile, axis=1)
        off = ends.mean(axis=1) - target
        least = int(np.argmin(costs))
        if costs[least] < self.recent.cost:
            self.recent = Best(float(costs[least]), values[least].copy(), off[least])
            self.best = min(self.best, self.recent, key=lambda one: one.cost)
        self.trials += len(values)
        self._tell(min(self.trials, self._task.settings.trials), self._task.settings.trials)
        return off, costs
