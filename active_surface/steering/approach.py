"""Approach: the way to a target in as few legs as possible.

A short leg takes few paths to find. If it misses, another starts where the part rests, nearer to the target. As a last
resort one leg takes the whole duration. Where the case's own drives end near the target, their neighbourhood is
searched before all this.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from active_surface.steering.knobs import Knobs, Stop, own_drives, shortest
from active_surface.steering.objectives import Objective, Trials
from active_surface.steering.paths import Paths, cost, path_of, settled
from active_surface.steering.schedule import Leg, lasting, scheduled
from active_surface.steering.search import NEWTON_RANGE, search, search_robust
from active_surface.steering.task import Task, is_schedulable
from coupling import ProgressCallback
from coupling.case import ActuatorCase, Case, amplitude
from particle import SurfaceMotion, Trajectory

Place = tuple[float, float]

PAUSE: Final = 5e-4  # s, at rest between legs
STEP: Final = 1e-6  # s, of which times of legs are multiples
MAX_PATHS: Final = (1000, 1500, 2500, 2500)  # for each leg
MAX_PATHS_AROUND: Final = 1000  # around the case's own drives
ROBUST_AROUND: Final = 0.25  # of all paths, of a robust search there
NEAR: Final = 0.5  # of the distance at the start: own drives that leave less are searched around
FIRST: Final = 0.5  # of the duration: longest first leg
CYCLES: Final = 3  # of the fastest drive allowed: shortest leg
NEARER: Final = 0.95  # of the distance before: a leg must leave less to be kept


class Way(NamedTuple):
    """Legs, the case with their drives, its path and how far from the target this ends."""

    legs: tuple[Leg, ...]
    case: Case
    path: Trajectory
    cost: float  # m
    stops: tuple[Stop, ...]  # knobs at a bound


class Approach:
    """Collects the legs that bring the part of a task to its target."""

    def __init__(
        self, surface: SurfaceMotion, task: Task, threads: int | None, tell: ProgressCallback, joined: bool = False
    ) -> None:
        """tell: is called with the number of paths so far and its maximum.  joined: other legs follow in a schedule."""
        self._surface, self._task, self._threads, self._tell = surface, task, threads, tell
        self._horizon, self._before, self._searches = task.case.run.duration, 0, 0
        self._joined = joined
        self._search: tuple[LegSearch, float] | None = None
        self._chain: Way | None = None  # legs to which another may be added
        self._best: Way | None = None

    def run(self) -> None:
        """Search; after Ctrl-C `close` has the best so far."""
        task, max_paths = self._task, self._task.settings.max_paths
        robust = task.settings.is_robust
        several = max_paths > 1
        if (several or not robust) and self._follow_own() and several and not self.reached:
            share = int(ROBUST_AROUND * max_paths) if robust else min(MAX_PATHS_AROUND, max_paths - self.paths)
            self._try(task, 0.0, share, around=True)
        self._chain = None
        if not robust and not self.reached and FIRST * self._horizon >= self._min_duration(task):
            self._extend()
        if not self.reached and self.paths < max_paths:
            self._try(task, 0.0, max_paths - self.paths, wide=True)

    def _extend(self) -> None:
        """Search for legs, one after the other."""
        max_paths = self._task.settings.max_paths
        if self.paths < max_paths:
            self._try(self._task.within(FIRST * self._horizon), 0.0, min(MAX_PATHS[0], max_paths - self.paths))
        for paths in MAX_PATHS[1:]:
            task, start = self._next()
            if self.reached or task is None or self.paths >= max_paths:
                return
            self._try(task, start, min(paths, max_paths - self.paths))

    @property
    def paths(self) -> int:
        """How many have been followed."""
        return self._before + (self._search[0].paths if self._search else 0)

    @property
    def reached(self) -> bool:
        """Whether the part comes to rest within the tolerance and no drive moves it again."""
        if self._best is None or self._task.settings.is_robust:
            return False
        return self._best.cost <= self._task.settings.tolerance

    def close(self) -> Way:
        """The best way; KeyboardInterrupt where there is none."""
        self._end_leg()
        if self._best is None:
            raise KeyboardInterrupt
        return self._best

    def _follow_own(self) -> bool:
        """Follow the path of the case's own drives; return whether to search around them."""
        task = self._task
        own = own_drives(task.case)
        moving = _moving(own)
        others = [k for k, one in enumerate(own) if amplitude(one) and k not in moving]
        if not moving or (others and (self._joined or task.settings.actuators)):
            return False
        if task.settings.actuators and not set(moving) <= set(task.settings.actuators):
            return False
        if Knobs(task.case, task.settings, moving, around=True).own is None:  # beyond bounds that the user states
            return False
        case = task.case.model_copy(update={"actuators": own, "source": None})
        path = self._follow(case)
        self._before += 1
        away, distance = math.dist(task.case.part.position, task.target), self._cost(path)
        if not settled(path) or distance >= away:
            return False
        if not task.settings.is_robust:
            self._keep(Way((Leg(0.0, own, moving),), case, path, distance, ()))
        return distance <= NEAR * away

    def _try(self, task: Task, start: float, max_paths: int, around: bool = False, wide: bool = False) -> None:
        """Search for the drives of a leg that begins at a time [s]."""
        knobs = Knobs(task.case, task.settings, task.movers, around, wide)
        search = LegSearch(self._surface, task, knobs, self._threads, self._count, max_paths, self._searches)
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
        legs, stops = self._with_leg(search, start)
        task, case = self._task, self._case_of(legs)
        path = self._follow(case)
        way = Way(legs, case, path, search.cost if task.settings.is_robust else self._cost(path), stops)
        before = self._chain.cost if self._chain else math.inf
        if way.cost <= max(NEARER * before, task.settings.tolerance) or self._chain is None:
            self._chain = way
        self._keep(way)

    def look(self) -> Trajectory | None:
        """The path of the drives that are best so far in the current search; None: there are none."""
        if self._search is None or not self._search[0].has_drives:
            return None if self._best is None else self._best.path
        return self._follow(self._case_of(self._with_leg(*self._search)[0]))

    def _with_leg(self, search: LegSearch, start: float) -> tuple[tuple[Leg, ...], tuple[Stop, ...]]:
        """The legs before a time [s] and that of a search, and the knobs of these at a bound."""
        leg, chain = search.leg(start), self._chain if start > 0 else None
        return ((*chain.legs, leg), chain.stops + search.stops) if chain else ((leg,), search.stops)

    def _case_of(self, legs: tuple[Leg, ...]) -> Case:
        """The case with the drives of legs."""
        case = self._task.case
        if len(legs) > 1:
            return scheduled(case, legs, self._horizon)
        return case.model_copy(update={"actuators": legs[0].actuators, "source": None})

    def _keep(self, way: Way) -> None:
        if self._best is None or way.cost < self._best.cost:
            self._best = way

    def _follow(self, case: Case) -> Trajectory:
        return path_of(Paths(case, self._surface, self._threads), case)

    def _cost(self, path: Trajectory) -> float:
        return cost(path, self._task.target, self._horizon, self._surface.size, self._task.settings.tolerance)

    def _next(self) -> tuple[Task | None, float]:
        """The task of the next leg, None where there is none, and when it begins [s]."""
        if self._chain is None or not settled(self._chain.path):
            return None, 0.0
        start = next_start(self._chain.legs, self._chain.path)
        x, y = self._chain.path.position[-1].tolist()
        try:
            task = self._task.within(self._horizon - start, (x, y))
        except ValueError:  # no way leads on from here, as from above the only actuator
            return None, start
        return (task if self._horizon - start >= self._min_duration(task) else None), start

    def _min_duration(self, task: Task) -> float:
        return CYCLES * shortest(task.case, task.settings, task.movers)

    def _count(self, done: int, _: int) -> None:
        max_paths = self._task.settings.max_paths
        self._tell(min(self._before + done, max_paths), max_paths)


def _moving(actuators: tuple[ActuatorCase, ...]) -> tuple[int, ...]:
    """The numbers of actuators whose strokes go up and down."""
    return tuple(k for k, actuator in enumerate(actuators) if is_schedulable(actuator) and actuator.stroke)


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
        knobs: Knobs,
        threads: int | None,
        tell: ProgressCallback,
        max_paths: int,
        number: int = 0,
    ) -> None:
        """number: of the search; each number has its own stream of random numbers."""
        self._newton_range, self._movers = NEWTON_RANGE * surface.size, task.movers
        self._seed = task.settings.seed, number
        self._paths, self._knobs = Paths(task.case, surface, threads), knobs
        self._robust: Trials | None = None
        if task.settings.is_robust:
            self._robust = Trials(task, Objective(task, knobs, self._paths, is_robust=True), tell, max_paths)
            max_paths = max(max_paths // 2, 1)
        self._nominal = Trials(task, Objective(task, knobs, self._paths), tell, max_paths)

    def run(self) -> None:
        """Search until the target is reached or the paths are used up; after Ctrl-C the best so far counts."""
        start = self._knobs.own if self._knobs.around else None
        if self._robust is not None:
            search_robust(self._knobs, self._nominal, self._robust, self._newton_range, self._seed, start)
        else:
            search(self._knobs, self._nominal, self._newton_range, self._seed, start)

    @property
    def paths(self) -> int:
        """How many have been followed."""
        return self._paths.count

    @property
    def has_drives(self) -> bool:
        """Whether there are drives."""
        return bool(np.isfinite(self._trials.best.cost))

    @property
    def cost(self) -> float:
        """That of the best drives [m]."""
        return self._trials.best.cost

    @property
    def stops(self) -> tuple[Stop, ...]:
        """The knobs of the best drives that stand at a bound."""
        return self._knobs.stops(self._trials.best.values)

    def leg(self, start: float) -> Leg:
        """The best drives, from a time [s] on."""
        actuators = self._knobs.actuators(self._trials.best.values)
        return Leg(start, actuators, _moving(actuators) if self._knobs.around else self._movers)

    @property
    def _trials(self) -> Trials:
        if self._robust is not None and np.isfinite(self._robust.best.cost):
            return self._robust
        return self._nominal
