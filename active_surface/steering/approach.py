"""Approach: the way to a target in as few legs as possible.

A short leg takes few paths to find. If it misses, another starts where the part rests, nearer to the target. As a last
resort one leg takes the whole duration.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from active_surface.steering.knobs import Knobs, shortest
from active_surface.steering.objective import Objective
from active_surface.steering.paths import Paths, cost, path_of, settled
from active_surface.steering.schedule import Leg, lasting, scheduled
from active_surface.steering.search import NEWTON_RANGE, search, search_robust
from active_surface.steering.task import Task
from coupling import ProgressCallback
from coupling.case import Case
from particle import SurfaceMotion, Trajectory

Place = tuple[float, float]

PAUSE: Final = 5e-4  # s, at rest between legs
STEP: Final = 1e-6  # s, of which times of legs are multiples
MAX_PATHS: Final = (1000, 1500, 2500, 2500)  # for each leg
FIRST: Final = 0.5  # of the duration: longest first leg
CYCLES: Final = 3  # of the fastest drive allowed: shortest leg
NEARER: Final = 0.95  # of the distance before: a leg must leave less to be kept


class Approach:
    """Collects the legs that bring the part of a task to its target."""

    def __init__(self, surface: SurfaceMotion, task: Task, threads: int | None, tell: ProgressCallback) -> None:
        """tell: is called with the number of paths so far and its maximum."""
        self._surface, self._task, self._threads, self._tell = surface, task, threads, tell
        self._horizon, self._cost, self._before, self._searches = task.case.run.duration, math.inf, 0, 0
        self._search: tuple[LegSearch, float] | None = None
        self._best: tuple[Case, Trajectory] | None = None
        self.legs: tuple[Leg, ...] = ()

    def run(self) -> None:
        """Search; after Ctrl-C `close` has the best so far."""
        max_paths, first = self._task.settings.most, FIRST * self._horizon
        if self._task.settings.quantile is None and first >= self._min_duration(self._task):
            self._try(self._task.within(first), 0.0, min(MAX_PATHS[0], max_paths))
            for paths in MAX_PATHS[1:]:
                task, start = self._next()
                if self.reached or task is None or self.paths >= max_paths:
                    break
                self._try(task, start, min(paths, max_paths - self.paths))
        if not self.reached and self.paths < max_paths:
            self._try(self._task, 0.0, max_paths - self.paths)

    @property
    def paths(self) -> int:
        """How many have been followed."""
        return self._before + (self._search[0].paths if self._search else 0)

    @property
    def reached(self) -> bool:
        """Whether the part comes to rest within the tolerance and no drive moves it again."""
        return self._cost <= self._task.settings.tolerance

    def close(self) -> tuple[Case, Trajectory]:
        """The case with the drives of all legs and its path; KeyboardInterrupt where there are none."""
        self._end_leg()
        if self._best is None:
            raise KeyboardInterrupt
        return self._best

    def _try(self, task: Task, start: float, max_paths: int) -> None:
        """Search for the drives of a leg that begins at a time [s]."""
        search = LegSearch(self._surface, task, self._threads, self._count, max_paths, self._searches)
        self._searches += 1
        self._search = search, start
        search.run()
        self._end_leg()

    def _end_leg(self) -> None:
        """Keep the current leg if it brings the part near enough."""
        if self._search is None:
            return
        search, start = self._search
        self._before, self._search = self.paths, None
        if not search.has_drives:
            return
        leg, task = search.leg(start), self._task
        legs = (*self.legs, leg) if start > 0 else (leg,)
        if len(legs) > 1:
            case = scheduled(task.case, legs, self._horizon)
        else:
            case = task.case.model_copy(update={"actuators": leg.actuators, "source": None})
        path = path_of(Paths(case, self._surface, self._threads), case)
        distance = cost(path, task.target, self._horizon, self._surface.size, task.settings.tolerance)
        if distance <= max(NEARER * self._cost, task.settings.tolerance) or self._best is None:
            self.legs, self._cost, self._best = legs, distance, (case, path)

    def _next(self) -> tuple[Task | None, float]:
        """The task of the next leg, None where there is none, and when it begins [s]."""
        if self._best is None or not settled(self._best[1]):
            return None, 0.0
        start = next_start(self.legs, self._best[1])
        x, y = self._best[1].position[-1].tolist()
        try:
            task = self._task.within(self._horizon - start, (x, y))
        except ValueError:  # no way leads on from here, as from above the only actuator
            return None, start
        return (task if self._horizon - start >= self._min_duration(task) else None), start

    def _min_duration(self, task: Task) -> float:
        return CYCLES * shortest(task.case, task.settings, task.movers)

    def _count(self, done: int, _: int) -> None:
        max_paths = self._task.settings.most
        self._tell(min(self._before + done, max_paths), max_paths)


def next_start(legs: tuple[Leg, ...], path: Trajectory) -> float:
    """When another leg may begin [s]: a little after the last drive has ended and the part has come to rest."""
    last = legs[-1]
    drives = last.start + lasting(last.actuators, last.movers)
    rest = path.at_rest_since
    ended = max(drives, float(path.time[-1]) if rest is None else rest)
    return round(math.ceil((ended + PAUSE) / STEP) * STEP, 9)


class LegSearch:
    """Finds the drives that bring a part to a task's target within its case's duration, on few enough paths."""

    def __init__(
        self,
        surface: SurfaceMotion,
        task: Task,
        threads: int | None,
        tell: ProgressCallback,
        max_paths: int,
        number: int = 0,
    ) -> None:
        """number: of the search; each number has its own stream of random numbers."""
        self._newton_range, self._movers = NEWTON_RANGE * surface.size, task.movers
        self._seed = task.settings.seed, number
        self._paths, self._knobs = Paths(task.case, surface, threads), Knobs(task.case, task.settings, self._movers)
        self._robust: Objective | None = None
        if task.settings.quantile is not None:
            self._robust = Objective(task, self._knobs, self._paths, tell, max_paths, disturbed=True)
            max_paths = max(max_paths // 2, 1)
        self._nominal = Objective(task, self._knobs, self._paths, tell, max_paths)

    def run(self) -> None:
        """Search until the target is reached or the paths are used up; after Ctrl-C the best so far counts."""
        if self._robust is None:
            search(self._knobs, self._nominal, self._newton_range, self._seed)
        else:
            search_robust(self._knobs, self._nominal, self._robust, self._newton_range, self._seed)

    @property
    def paths(self) -> int:
        """How many have been followed."""
        return self._paths.count

    @property
    def has_drives(self) -> bool:
        """Whether there are drives."""
        return bool(np.isfinite(self._objective.best.cost))

    def leg(self, start: float) -> Leg:
        """The best drives, from a time [s] on."""
        actuators = self._knobs.actuators(self._objective.best.values)
        return Leg(start, actuators, self._movers)

    @property
    def _objective(self) -> Objective:
        if self._robust is not None and np.isfinite(self._robust.best.cost):
            return self._robust
        return self._nominal
