"""Probes: short runs in which some of the actuators move alike, to see what moves the part, which way and how fast.

The actuators that move are those behind a line across the array, seen along the way to the target, aslant or aside.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.steering.knobs import Knobs
from active_surface.steering.paths import Paths, driven
from active_surface.steering.robustness import Disturbance
from active_surface.steering.task import Task, offset, offset_of
from common import quantity
from coupling import answers_drives, run_case
from coupling.case import ActuatorCase
from particle import Outcome, SurfaceMotion, Trajectory, interruptible

TURNS: Final = (0, 45, -45, 90, -90)  # deg, of the views from the way to the target
ONE_LINE: Final = 0.01  # of the array's size: groups seen at the same distance
LINES: Final = 4  # in each, at most
LEVELS: Final = 5  # of the frequency, the highest within the bounds and
RANGE: Final = 4.0  # times lower ones, by equal factors
CYCLES: Final = 20  # of the lowest of them: a probe's duration
ASIDE: Final = 0.5  # what motion aside counts of that along the way
LEAST: Final = 1e-3  # of the way: a part that goes less far in every probe is not moved
BEST: Final = 3  # probes that are followed over the whole way
SLACK: Final = 1.5  # times as long as the fastest probe would take
MAX_PROBES: Final = len(TURNS) * LINES * LEVELS + BEST
KEPT: Final = (Outcome.STUCK, Outcome.MOVING)


class Unmoved(ValueError):
    """No drives within the bounds of a search move the part."""


class Probe(NamedTuple):
    """Which actuators move and how often a second, and the path."""

    running: frozenset[int]
    actuators: tuple[ActuatorCase, ...]
    frequency: float  # Hz
    path: Trajectory
    moved: FloatArray  # (2,) m; with a heading to reach (3,)


class Probes:
    """The probes of a task. Raises Unmoved where none moves the part."""

    def __init__(self, surface: SurfaceMotion, task: Task, threads: int | None) -> None:
        self._surface, self._threads, self.count = surface, threads, 0
        lowest, highest = (_frequency(task, end) for end in (0.0, math.inf))
        frequencies = np.unique(np.geomspace(max(lowest, highest / RANGE), highest, LEVELS)).tolist()
        duration = CYCLES / frequencies[0] + (task.settings.delay or (0.0, 0.0))[0]
        # A plate that answers its drives is solved up to the case's duration.
        self._task = task.within(min(duration, task.case.run.duration) if answers_drives(task.case) else duration)
        way = offset(task.target, task.turn, task.case.part.position, task.case.part.heading)
        probes = self._of([(running, one) for running in self._sides() for one in frequencies], self._task)
        if all(np.hypot.reduce(one.moved) < LEAST * task.away for one in probes if one.path.outcome in KEPT):
            raise Unmoved(self._why(probes))
        ahead = -way / np.hypot.reduce(way)
        speeds = [
            float(one.moved @ ahead) - ASIDE * float(np.hypot.reduce(one.moved - one.moved @ ahead * ahead))
            for one in probes
        ]
        fit = [k for k in np.argsort(speeds)[::-1].tolist() if speeds[k] > 0 and probes[k].path.outcome in KEPT]
        self.best = [probes[k] for k in fit[:BEST]]
        self.time = SLACK * task.away / speeds[fit[0]] * self._task.case.run.duration if fit else math.inf
        """How long the whole way will take [s]."""

    def start(self, task: Task) -> FloatArray | None:
        """The setting of the knobs of a task, the same within another duration, whose path comes nearest its target."""
        found = []
        for one in self._of([(probe.running, probe.frequency) for probe in self.best], task):
            first = one.actuators[task.together[0]]
            period = 1 / one.frequency + 2 * first.dwell
            cycles = np.arange(1, max(1, math.floor((one.path.time[-1] - first.delay) / period)) + 1)
            at = one.path.at(np.minimum(first.delay + cycles * period, one.path.time[-1]))
            headings = np.zeros(len(cycles)) if at.heading is None else at.heading
            away = [
                float(np.hypot.reduce(offset(task.target, task.turn, *there)))
                for there in zip(at.position, headings, strict=True)
            ]
            nearest = int(np.argmin(away))
            found.append((away[nearest], _row(_knobs(task), one.running, one.frequency, float(cycles[nearest]))))
        return min(found, key=lambda pair: pair[0])[1] if found else None

    def _sides(self) -> list[frozenset[int]]:
        """The actuators behind each line."""
        task, groups = self._task, _knobs(self._task).groups
        places = np.array([np.mean([task.case.actuators[k].position for k in group], axis=0) for group in groups])
        unit = ONE_LINE * float(np.ptp(places, axis=0).max()) or 1.0
        sides: dict[frozenset[int], None] = {}
        away = np.subtract(task.target, task.case.part.position)
        for turn in TURNS:
            angle = math.atan2(away[1], away[0]) + math.radians(turn)
            along = np.round(places @ (math.cos(angle), math.sin(angle)) / unit)
            lines = np.unique(along)
            for line in lines[np.unique(np.linspace(0, len(lines) - 1, LINES).astype(int))]:
                sides[frozenset(k for one in np.flatnonzero(along <= line).tolist() for k in groups[one])] = None
        return list(sides)

    def _of(self, settings: list[tuple[frozenset[int], float]], task: Task) -> list[Probe]:
        """The probes of settings, within the duration of a task."""
        knobs, paths = _knobs(task), Paths(task.case, self._surface, self._threads)
        sets = [knobs.actuators(_row(knobs, *setting)) for setting in settings]
        followed = paths.of([(actuators, Disturbance()) for actuators in sets])
        self.count += paths.count
        start = offset(task.target, task.turn, task.case.part.position, task.case.part.heading)
        return [
            Probe(
                running,
                actuators,
                actuators[task.together[0]].frequency or 0.0,
                path,
                offset_of(path, task.target, task.turn) - start,
            )
            for (running, _), actuators, path in zip(settings, sets, followed, strict=True)
        ]

    def _why(self, probes: list[Probe]) -> str:
        """Why the part does not move."""
        case, kept = self._task.case, [one for one in probes if one.path.outcome in KEPT]
        runs, lost = f"{len(probes)} trial runs within the search's bounds", len(probes) - len(kept)
        advice = f". `active-surface advise {case.name}.toml` looks for drives that move it and keep it"
        advice = "" if case.air is not None and case.air.film else advice  # which refuses a film
        if not kept:
            return f"the part comes off in each of {runs}{advice}"
        most = max(kept, key=lambda one: (one.path.distance, one.frequency, len(one.running)))
        slip = interruptible(run_case, driven(case, most.actuators)).summary.margins.slip
        pull = "it slips to and fro" if slip is None else f"the pull reaches {slip.value:.3g} of the friction limit"
        far = f"it goes {quantity(most.path.distance, 'm')} of {quantity(self._task.away, 'm')} at the most"
        off = f"; in {lost} of them it comes off" if lost else ""
        return f"nothing moves the part far: in {runs} {far}; {pull}{off}{advice}"


def _knobs(task: Task) -> Knobs:
    return Knobs(task.case, task.settings, task.together, together=True)


def _frequency(task: Task, wanted: float) -> float:
    """The frequency [Hz] within the bounds that is nearest to the one wanted."""
    knobs = _knobs(task)
    return knobs.actuators(_row(knobs, frozenset(), wanted))[task.together[0]].frequency or 0.0


def _row(knobs: Knobs, running: frozenset[int], frequency: float = math.inf, cycles: float = math.inf) -> FloatArray:
    """The setting of knobs in which some actuators move at a frequency [Hz], and the others rest or move least."""
    values = []
    for knob in knobs.knobs:
        largest = knob.high if knob.high > 0 else knob.low
        stroke = largest if running.intersection(knob.actuators) else 0.0
        wanted = {"frequency": frequency, "stroke": stroke, "delay": 0.0, "cycles": cycles}[knob.key]
        values.append(min(max(wanted, knob.low), knob.high))
    return np.array(values)
