"""Legs: the way to a target in as few of them as possible, and the schedule of legs that follow each other.

Where the case's own drives end near the target, their neighbourhood is searched. Otherwise probes tell which actuators
move the part towards it, and drives with one frequency are sought around the best of them, in a time that suffices. If
this leg misses, another starts where the part rests. Then each actuator gets a frequency of its own: a short leg takes
few paths to find, and as a last resort one leg takes the whole duration.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Final, NamedTuple

from active_surface.arrays import FloatArray
from active_surface.steering.knobs import Knobs, Stop, at_rest, is_schedulable, own_drives, shortest
from active_surface.steering.paths import Paths, affordable, cost, driven, path_of, settled
from active_surface.steering.probes import LEAST, MAX_PROBES, Probes, Unmoved
from active_surface.steering.search import Search
from active_surface.steering.task import Task
from common import quantity
from coupling import ProgressCallback, answers_drives, build_drive, doing
from coupling.case import ActuatorCase, Case, SegmentCase, amplitude
from particle import SurfaceMotion, Trajectory, unbroken

PAUSE: Final = 5e-4  # s, at rest between legs
STEP: Final = 1e-6  # s, of which times of legs are multiples
SHORTEST: Final = 1e-9  # s: shorter waits are left out
DIGITS: Final = 12  # decimals of times in s, as many as a file shows
MAX_PATHS: Final = (1000, 1500, 2500, 2500)  # for each leg
MAX_CYCLES: Final = 200_000  # in all paths, where a task does not say how many these are, except for LEAST_PATHS
LEAST_PATHS: Final = 400
LEGS, MAX_PATHS_TOGETHER = 8, 100  # with one frequency, and for each
PROBED: Final = 0.25  # of all paths, which probes may take where the case's own drives are not stuck
LONGEST: Final = 20.0  # times the case's duration, that legs last where it is too short
MAX_PATHS_AROUND: Final = 1000  # around the case's own drives
ROBUST_AROUND: Final = 0.25  # of all paths, of a robust search there
NEAR: Final = 0.5  # of the distance at the start: own drives that leave less are searched around
FIRST: Final = 0.5  # of the duration: longest first leg
CYCLES: Final = 3  # of the fastest drive allowed: shortest leg
NEARER: Final = 0.95  # of the distance before: a leg must leave less to be kept


class Leg(NamedTuple):
    """The drives of one leg."""

    start: float  # s
    actuators: tuple[ActuatorCase, ...]
    movers: tuple[int, ...]  # the numbers of those that move

    @property
    def end(self) -> float:
        """When the last of its drives has ended [s]."""
        return self.start + max((_end(self.actuators[k]) for k in self.movers), default=0.0)


class Way(NamedTuple):
    """Legs, the case with their drives, its path and how far from the target this ends."""

    legs: tuple[Leg, ...]
    case: Case
    path: Trajectory
    cost: float  # m
    stops: tuple[Stop, ...]  # knobs at a bound

    @property
    def end(self) -> float:
        """When another leg may begin [s]: a little after the last drive has ended and the part has come to rest."""
        rest = self.path.at_rest_since
        ended = max(self.legs[-1].end, float(self.path.time[-1]) if rest is None else rest)
        return round(math.ceil((ended + PAUSE) / STEP) * STEP, 9)


class Approach:
    """The legs that bring the part of a task to its target; `best` has the best of them so far, also after Ctrl-C."""

    def __init__(
        self, surface: SurfaceMotion, task: Task, threads: int | None, tell: ProgressCallback, joined: bool = False
    ) -> None:
        """tell: is called with the number of paths so far and its maximum.  joined: other legs follow in a schedule."""
        self._surface, self._task, self._threads, self._tell, self._joined = surface, task, threads, tell, joined
        self._own = self._horizon = task.case.run.duration  # s; legs may take longer
        self._searches = 0
        self._moves: bool | None = None  # whether the case's own drives move the part; None: beyond bounds, not tried
        self._under_way: Callable[[], Way | None] = lambda: None  # the way of the current search
        self.best: Way | None = None
        self.paths = 0  # followed, without those of the current search

    def run(self) -> None:
        """Search around the case's own drives, from probes, leg by leg and over the whole time, until one is enough.

        Raises Unmoved where no drives move the part.
        """
        max_paths, robust = self._max_paths, self._task.settings.is_robust
        if (max_paths > 1 or not robust) and self._follow_own() and max_paths > 1 and not self.reached:
            self._search(self._task, None, int(ROBUST_AROUND * max_paths) if robust else MAX_PATHS_AROUND, around=True)
        if not self.reached:  # disturbances of several legs add up
            self._chain([int(ROBUST_AROUND * max_paths)] if robust else LEGS * [MAX_PATHS_TOGETHER], together=True)
        if not robust and not self.reached and FIRST * self._horizon >= _min_duration(self._task):
            self._chain(MAX_PATHS)
        if not self.reached:
            self._search(self._task, None, max_paths, wide=True)

    def _chain(self, max_paths: Sequence[int], together: bool = False) -> None:
        """Search leg by leg, each from where the part rests, as long as they lead nearer to the target."""
        chain, task = None, None if together else self._task.within(FIRST * self._horizon)
        for at_most in max_paths:
            following = (task or self._task) if chain is None else self._next(chain)
            if self.reached or following is None:
                break
            way = self._probed(following, chain, at_most) if together else self._search(following, chain, at_most)
            if chain is not None and (way is None or way.cost > max(NEARER * chain.cost, following.settings.tolerance)):
                continue
            if way is None:
                break
            chain = way

    def _probed(self, task: Task, chain: Way | None, at_most: int) -> Way | None:
        """Search around the best probe of a leg, in a longer time where the leg takes that."""
        if (1.0 if chain or self._moves is False else PROBED) * (self._max_paths - self.paths) < MAX_PROBES:
            return None
        doing("runs to see which actuators move the part")
        case, left = self._task.case, task.case.run.duration
        try:
            probes = Probes(self._surface, task, self._threads)
        except Unmoved:
            if chain is not None or self._moves:
                return None
            raise
        self.paths += probes.count
        if not probes.best:
            return None
        ends = task.settings.cycles or any(case.actuators[k].cycles for k in task.together) or answers_drives(case)
        if probes.time > left and self._moves:  # at frequencies of their own they may be faster
            return None
        if probes.time > left and not ends:
            begin, self._horizon = self._horizon - left, min(self._horizon - left + probes.time, LONGEST * self._own)
            self._task, task = self._task.within(self._horizon), task.within(self._horizon - begin)
        start = probes.start(task)
        self.paths += len(probes.best)
        return self._search(task, chain, at_most, start=start)

    @property
    def reached(self) -> bool:
        """Whether the part comes to rest within the tolerance and no drive moves it again."""
        if self.best is None or self._task.settings.is_robust:
            return False
        return self.best.cost <= self._task.settings.tolerance

    def look(self) -> Trajectory | None:
        """The path of the drives that are best so far in the current search; None: there are none."""
        way = self._under_way() or self.best
        return way.path if way else None

    def _follow_own(self) -> bool:
        """Follow the path of the case's own drives; return whether to search around them."""
        task, settings = self._task, self._task.settings
        own = own_drives(task.case)
        moving = _moving(own)
        others = [k for k, one in enumerate(own) if amplitude(one) and k not in moving]
        if not moving or (others and (self._joined or settings.actuators)):
            return False
        if settings.actuators and not set(moving) <= set(settings.actuators):
            return False
        if Knobs(task.case, settings, moving, around=True).own is None:  # beyond bounds that the user states
            return False
        way = self._followed((Leg(0.0, own, moving),), ())
        self.paths += 1
        self._moves = way.path.distance > LEAST * task.away
        if not settled(way.path) or way.cost >= task.away:
            return False
        if not settings.is_robust:
            self._keep(way)
        return way.cost <= NEAR * task.away

    def _search(
        self,
        task: Task,
        chain: Way | None,
        at_most: int,
        around: bool = False,
        wide: bool = False,
        start: FloatArray | None = None,
    ) -> Way | None:
        """Search for the drives of a leg after a chain of legs, on so many paths at most; return them all.

        start: of knobs that all drives have together.
        """
        if (left := self._max_paths - self.paths) <= 0:
            return None
        movers = task.movers if start is None else task.together
        knobs = Knobs(task.case, task.settings, movers, around, wide, start is not None)
        paths = Paths(task.case, self._surface, self._threads)
        first = knobs.own if around else start

        def count(done: int, _: int) -> None:
            self._count(done)
            nearest = min(search.best.cost, self.best.cost if self.best else math.inf)
            doing(f"paths at most; {quantity(nearest, 'm')} from the target so far")

        search = Search(paths, task, knobs, count, min(at_most, left), self._searches, first)
        self._searches += 1
        self._under_way = partial(self._way, search, movers, chain)
        try:
            search.run()
        finally:
            with unbroken():
                way, self._under_way = self._under_way(), lambda: None
                self.paths += search.paths
                if way:
                    self._keep(way)
        return way

    def _way(self, search: Search, movers: tuple[int, ...], chain: Way | None) -> Way | None:
        """The legs of a chain and the best of a search; None: it has no drives yet."""
        best, knobs = search.best, search.knobs
        if not math.isfinite(best.cost):
            return None
        actuators = knobs.actuators(best.values)
        leg = Leg(chain.end if chain else 0.0, actuators, _moving(actuators) if knobs.around else movers)
        legs, stops = (chain.legs, chain.stops) if chain else ((), ())
        way = self._followed((*legs, leg), stops + knobs.stops(best.values))
        return way._replace(cost=best.cost) if self._task.settings.is_robust else way

    def _followed(self, legs: tuple[Leg, ...], stops: tuple[Stop, ...]) -> Way:
        """The way of legs."""
        case, task = self._task.case, self._task
        case = scheduled(case, legs, self._horizon) if len(legs) > 1 else driven(case, legs[0].actuators)
        path = path_of(case, self._surface)
        away = cost(path, task.target, self._horizon, self._surface.size, task.settings.tolerance, task.turn)
        return Way(legs, case, path, away, stops)

    def _keep(self, way: Way) -> None:
        if self.best is None or way.cost < self.best.cost:
            self.best = way

    def _next(self, chain: Way) -> Task | None:
        """The task of the leg after a chain of legs; None where there is none."""
        if not settled(chain.path):
            return None
        left = self._horizon - chain.end
        try:
            task = self._task.within(left, chain.path)
        except ValueError:  # no way leads on from here, as from above the only actuator
            return None
        return task if left >= _min_duration(task) else None

    @property
    def _max_paths(self) -> int:
        """How many paths are followed at most."""
        settings = self._task.settings
        if settings.paths is not None or settings.is_robust:
            return settings.max_paths
        return affordable(self._task.case, self._horizon, MAX_CYCLES, LEAST_PATHS, settings.max_paths)

    def _count(self, done: int) -> None:
        self._tell(min(self.paths + done, self._max_paths), self._max_paths)


def _min_duration(task: Task) -> float:
    """The shortest time for a leg [s]."""
    return CYCLES * shortest(task.case, task.settings, task.movers)


def _moving(actuators: tuple[ActuatorCase, ...]) -> tuple[int, ...]:
    """The numbers of actuators whose strokes go up and down."""
    return tuple(k for k, actuator in enumerate(actuators) if is_schedulable(actuator) and actuator.stroke)


def scheduled(case: Case, legs: Sequence[Leg], duration: float) -> Case:
    """The case of a duration [s] in which the drives of legs follow each other, as segments of each actuator."""
    actuators = tuple(_over_time(k, actuator, legs) for k, actuator in enumerate(case.actuators))
    run = case.run.model_copy(update={"duration": duration})
    return case.model_copy(update={"actuators": actuators, "run": run, "source": None})


def _over_time(k: int, actuator: ActuatorCase, legs: Sequence[Leg]) -> ActuatorCase:
    """Actuator k in all legs: waits and cycles, or at rest."""
    segments: list[SegmentCase] = []
    now = 0.0
    for leg in legs:
        if k in leg.movers:
            own = leg.actuators[k]
            wait = round(leg.start + own.delay - now, DIGITS)
            if wait > SHORTEST:
                segments.append(SegmentCase(cycle="hold", dwell=wait))
            cycles = own.cycles or 1
            segments.append(SegmentCase(stroke=own.stroke, frequency=own.frequency, cycles=cycles, dwell=own.dwell))
            now = leg.start + _end(own)
    if not segments:
        return at_rest(actuator)
    unset = dict.fromkeys(("stroke", "force", "frequency", "table", "cycles"))
    same = {"cycle": "up-down", "dwell": 0.0, "repeats": 1, "delay": 0.0, "phase": 0.0, "ramp": 0.0}
    return actuator.model_copy(update=unset | same | {"segments": tuple(segments)})


def _end(actuator: ActuatorCase) -> float:
    """When a drive with a number of cycles ends [s]."""
    return actuator.delay + build_drive(actuator).segments().duration
