"""Trials: runs of a case with other drives or starts, and where none of these moves the part with less friction."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial
from itertools import islice
from typing import Final, NamedTuple

import numpy as np

from coupling.advice.choices import Choice, choices_of, chosen_scene, stroke_room
from coupling.borders import FAR, KEPT, LEAST, Factors, at_rest, driven, factors_of, stretches, strokes_alone, why_none
from coupling.case import PlateCase, friction_scales, more_plastic, ramped_case, with_index
from coupling.part import build_friction, build_part, friction_law, friction_of, local_size
from coupling.plate_figures import largest
from coupling.progress import doing, silent
from coupling.report import MAX_QUASI_STATIC_ERROR
from coupling.result import Result
from coupling.scene import PlateScene, lifts_of, plate_scene
from coupling.summary import PlateSummary, Summary
from particle import Body, Micropart, State, SurfaceMotion, interruptible, simulate
from particle.friction import Contact, ScaledFriction

# Factors of the strokes, in the order in which they are tried.
STROKES: Final = 2.0, 4.0, 8.0, 0.5, 16.0, 32.0, 0.25, 64.0
FRICTION: Final = 0.7, 0.5, 0.35, 0.25, 0.15, 0.1, 0.05  # likewise, of the friction limit
SHARES: Final = 0.5, 0.25, 0.75  # of the way from slipping to coming off, in logarithms
WIDE: Final = 4.0  # where nothing comes off: up to so many times the frequency from which it slips
ROOM: Final = 1.05  # ratio of both thresholds below which a trial counts only where there is no other
NEAR: Final = 3e-5  # of the surface's size: by what a trial must move the part
ENOUGH: Final = 2e-4  # likewise: by what one within the bounds ends the search beyond them
FARTHER: Final = 1.2  # times the motion of the case itself, that a trial must make
LEVEL: Final = 1e-6  # of the friction limit: nothing pulls
WHOLE: Final = 2.0  # ratio of both thresholds from which on a trial counts in full
LISTED: Final = 3  # trials
TURNS: Final = 2  # of the fastest drive, that a trial run has at least
TRIED: Final = 300  # of the shortest, that a trial run lasts at most
RAMP: Final = 3.0  # cycles over which forces grow
RADII, ANGLES = (0.25, 0.5), (0.3, 1.9, 3.4, 5.0)  # of other places around the nearest actuator: of its gap, rad


@dataclass(frozen=True)
class Trial:
    """A run with other drives, or from another place, that moved the part and kept it."""

    frequency: float  # over the case's own
    stroke: float
    friction: float  # of the friction limit
    place: tuple[float, float] | None  # m, where it began; None: at the case's start
    distance: float  # m
    duration: float  # s, at most that of the case
    smallest_load: float  # N
    plasticity_index: float | None = None  # of Kogut and Etsion's law; None: the case's own
    ramp: float | None = None  # cycles over which forces grow that begin at once in the case; None: as there
    choice: Choice | None = None  # of actuators; None: as in the case
    room: float = math.inf  # the factor from which it comes off over that from which it slips

    @property
    def score(self) -> float:
        """The speed [m/s], less where thresholds are close to each other."""
        return self.distance / self.duration * min(1.0, math.log(max(self.room, 1.0)) / math.log(WHOLE))


def advise(result: Result, largest_stroke: float | None = None) -> list[Trial]:
    """Search for what would have the part of a run move and stay on, by trial runs; the best first.

    largest_stroke: the factor of strokes up to which the model holds [that of the summary].
    Empty where no trial does, and where `no_advice` says why none is made.
    """
    if no_advice(result):
        return []
    most = _largest_stroke(result.summary) if largest_stroke is None else largest_stroke
    return Trials(result, most).ranked()


def no_advice(result: Result) -> str:
    """Why no trials are made, in a sentence: the part moves already, say; empty where they are."""
    return why_none(result.case, result.scene, result.trajectory)


def _largest_stroke(summary: Summary) -> float:
    """The factor of strokes up to which slope and strain of a plate stay in bounds; 1 where it stretches."""
    if not isinstance(summary, PlateSummary):
        return math.inf
    return stroke_room(summary.largest_slope, summary.largest_strain, summary.theory != "linear")


class Setting(NamedTuple):
    """What a trial changes besides what its thresholds are of."""

    stroke: float = 1.0  # over the case's own
    friction: float = 1.0  # of the friction limit
    plasticity: float | None = None  # its index; None: the case's own
    ramp: float | None = None  # cycles, of forces that begin at once; None: the case's own
    pulled: bool = True  # whether the plate may pull at the part where the law bears any load


class Trials:
    """Runs of a result's case with other drives, less friction or from other places.

    largest_stroke: the factor of strokes up to which the model holds; None: it is found.  choice: of actuators.
    """

    def __init__(self, result: Result, largest_stroke: float | None, choice: Choice | None = None) -> None:
        self.result, self.choice, self._largest = result, choice, largest_stroke
        self.case, self.scene, self.count = result.case, result.scene, 0
        self.friction, self.part = build_friction(self.case), build_part(self.case)
        path, self.size = result.trajectory, self.scene.surface.size
        moved = path.distance if path.outcome in KEPT else 0.0
        self.least = max(NEAR * self.size, FARTHER * moved)  # m, by which a trial must move the part
        self.rings, self.stretches = strokes_alone(self.scene), stretches(self.scene)
        shortest = float(self.scene.surface.stroke_times.min(initial=self.case.run.duration))
        error = getattr(result.summary, "quasi_static_error", None) or 0.0
        # The factor of the frequencies up to which the plate follows its drives at once.
        self.valid = MAX_QUASI_STATIC_ERROR / error if error else math.inf
        # A drive that does not even repeat itself once carries nothing along.
        self.least_factor = LEAST if self.rings else min(1.0, TURNS * 2 * shortest / self.case.run.duration)
        # Tabulating a law takes a while.
        table, size = friction_of(self.case), local_size(self.case)
        self.law_of_index = cache(lambda index: friction_law(with_index(table, index), size))

    def law(self, setting: Setting) -> Contact:
        """The friction of a setting."""
        if setting.plasticity is None:
            return ScaledFriction(self.friction, setting.friction)
        return self.law_of_index(setting.plasticity)

    def surface(self, setting: Setting) -> SurfaceMotion:
        """The surface of a setting, under the case's own frequencies and strokes."""
        return self.scene.surface if setting.ramp is None else self._ramped or self.scene.surface

    @cached_property
    def _ramped(self) -> SurfaceMotion | None:
        """The surface under forces that grow; None where none begins at once, and where the plate stretches."""
        scene, case = self.scene, self.case
        if self.stretches or not isinstance(scene, PlateScene) or (ramped := ramped_case(case, RAMP)) is None:
            return None
        if not scene.has_inertia:
            return scene.surface.driven_by(lifts_of(ramped))
        assert isinstance(case.plate, PlateCase)
        return plate_scene(ramped, case.plate, silent, scene.shapes).surface

    def thresholds(self, part: Micropart | Body, setting: Setting) -> Factors:
        """The thresholds of a part that stays at its start."""
        rest = at_rest(self.case, self.surface(setting), part, self.law(setting))
        return factors_of(lambda factor: driven(self.scene, rest, factor, setting.stroke))

    def ranked(self) -> list[Trial]:
        """The best LISTED of the trials that go far enough, the best first, or the one that goes farthest of all.

        First drives within the model's bounds, all and chosen ones, from the case's start and then from places around
        the nearest actuator; then friction; last strokes beyond the bounds.
        """
        every = [self, *self._chosen()]
        for look in (Trials._from_start, Trials._from_elsewhere):
            found = [(trial, one) for one in every if (trial := look(one, False))]
            found.sort(key=lambda pair: -pair[0].score)
            # Of the best it is looked whether their own strokes are in bounds, as that takes a while.
            within = [trial if one._holds(trial) else look(one, True) for trial, one in found[: 2 * LISTED]]
            best = [trial for trial in within if trial and trial.distance > ENOUGH * self.size]
            if best:
                return sorted(best, key=lambda trial: -trial.score)[:LISTED]
        last = self._last()
        return [] if last is None else [last]

    def _chosen(self) -> Iterator[Trials]:
        """Trials with each choice of actuators."""
        if isinstance(self.scene, PlateScene):
            for choice in choices_of(self.case, self.scene, self.part.position):
                case, scene = chosen_scene(self.case, self.scene, choice)
                yield Trials(replace(self.result, case=case, scene=scene), None, choice)

    @cached_property
    def largest_stroke(self) -> float:
        """The factor of strokes up to which slope and strain stay in bounds."""
        if self._largest is not None:
            return self._largest
        assert isinstance(self.scene, PlateScene)
        _, slope, strain = largest(self.scene, self.case.run.duration)
        return stroke_room(slope, strain, self.stretches)

    def _holds(self, trial: Trial) -> bool:
        """Whether the stroke of a trial is in bounds, or the case's own."""
        return self.choice is None or trial.stroke <= self.largest_stroke

    def _drives_alone(self, other: bool) -> Iterator[Setting]:
        """The case's own strokes, unless others are asked for, and others that are in bounds."""
        pulled = not math.isinf(self.friction.pull_off)
        if not other:
            yield Setting(pulled=pulled)
        yield from [Setting(stroke, pulled=pulled) for stroke in self._strokes(0.0, self.largest_stroke)]

    def _from_start(self, other: bool) -> Trial | None:
        return None if self._is_level else self._farthest(self.part, self._drives_alone(other), self.valid)

    def _from_elsewhere(self, other: bool) -> Trial | None:
        settings = list(islice(self._drives_alone(other), 1))
        return self._elsewhere(settings, self.valid) if isinstance(self.scene, PlateScene) else None

    @cached_property
    def _is_level(self) -> bool:
        """Whether nothing pulls at the start."""
        plate = isinstance(self.scene, PlateScene)
        return plate and at_rest(self.case, self.scene.surface, self.part, self.friction).slip().value < LEVEL

    def _last(self) -> Trial | None:
        """The trial with other friction, or beyond the bounds, that goes far enough, or the farthest of all."""
        groups = [list(self._within()), [Setting(stroke) for stroke in self._strokes(self.largest_stroke, math.inf)]]
        if math.isinf(self.friction.pull_off):
            groups = [[one._replace(pulled=False) for one in group] for group in groups] + groups
        found = list[Trial]()
        for settings in groups:
            trial = None if self._is_level else self._farthest(self.part, settings)
            if trial is None and isinstance(self.scene, PlateScene):
                own = [one for one in settings if one.friction == 1 and one.plasticity is None]
                trial = self._elsewhere([*own, *settings[-1:]])
            if trial is not None:
                found.append(trial)
                if trial.distance > ENOUGH * self.size:
                    return trial
        return _farthest(found)

    def _farthest(self, part: Micropart | Body, settings: Iterable[Setting], fastest: float = math.inf) -> Trial | None:
        """The trial that goes farthest of the first setting in which one goes far, or of all; up to a frequency."""
        doubtful, most = list[Trial](), self.largest_stroke if self.rings else math.inf
        for setting in settings:
            slips, comes_off = self.thresholds(part, setting)
            low = max(slips, self.least_factor)
            high = min(comes_off, WIDE * low, most if self.rings else max(fastest, low))
            if not low < high < math.inf:
                continue
            factors = dict.fromkeys(float(f"{low * (high / low) ** share:.3g}") for share in SHARES)
            farthest = _farthest([self.trial(part, factor, setting) for factor in factors])
            if farthest is None or farthest.distance < self.least:
                continue
            farthest = replace(farthest, room=comes_off / slips if slips > 0 else math.inf)
            if farthest.distance > FAR * self.size and comes_off > ROOM * slips:
                return farthest
            doubtful.append(farthest)
        return _farthest(doubtful)

    def _strokes(self, above: float, most: float) -> list[float]:
        """Factors of the strokes above one and up to another."""
        varies = not (self.rings or self.stretches)
        return [stroke for stroke in STROKES if varies and above < stroke <= most]

    def _within(self) -> Iterator[Setting]:
        """What to try within the model's bounds."""
        within = self._strokes(0.0, self.largest_stroke)
        yield from [Setting(stroke) for stroke in (1.0, *within)]
        if self._ramped is not None:
            yield from [Setting(stroke, ramp=RAMP) for stroke in (1.0, *within)]
        scales = FRICTION if friction_scales(self.case.friction) is not None else ()
        for stroke in dict.fromkeys([1.0, max(within, default=1.0)]):
            yield from [Setting(stroke, friction) for friction in scales]
            yield from [Setting(stroke, plasticity=index) for index in more_plastic(self.case.friction)]

    def trial(self, part: Micropart | Body, factor: float, setting: Setting) -> Trial:
        """A run; its distance is negative where the part is lost."""
        frequency, stroke = (1.0, factor) if self.rings else (factor, setting.stroke)
        surface, run = self.surface(setting).scaled(frequency, stroke), self.case.run
        duration = min(run.duration, TRIED * float(surface.stroke_times.min(initial=run.duration)))
        self.count += 1
        doing(f"Trial run {self.count}")
        follow = partial(simulate, after_tipping=run.after_tipping)
        path = interruptible(follow, surface, part, self.law(setting), duration, run.gravity, run.tolerance)
        load = float(path.normal_force[path.state != State.FLIGHT].min(initial=math.inf))
        load = 0.0 if math.isinf(load) else load
        kept = path.outcome in KEPT and (setting.pulled or load >= 0)
        place = None if part is self.part else part.position
        return Trial(
            frequency, stroke, setting.friction, place, path.distance if kept else -1.0, duration, load,
            setting.plasticity, setting.ramp, self.choice,
        )  # fmt: skip

    def _elsewhere(self, settings: Sequence[Setting], fastest: float = math.inf) -> Trial | None:
        """A trial from another place, around the actuator nearest to the start."""
        assert isinstance(self.scene, PlateScene)
        points, outline, found = self.scene.shapes.points, self.scene.shapes.outline, list[Trial]()
        nearest = points[np.argmin(np.hypot(*(points - self.part.position).T))]
        gap, face = float(outline.gap(nearest[None])[0]), self.case.part.face
        reach = face.reach if face else 0.0
        for x, y in [(r * math.cos(angle), r * math.sin(angle)) for r in RADII for angle in ANGLES]:
            place = float(f"{nearest[0] + gap * x:.3g}"), float(f"{nearest[1] + gap * y:.3g}")
            if outline.gap(np.array([place]))[0] <= reach:  # a rim may be nearer than three digits tell
                continue
            if trial := self._farthest(build_part(self.case, place), settings, fastest):
                found.append(trial)
                if trial.distance > FAR * self.size:
                    return trial
        return _farthest(found)


def _farthest(trials: Sequence[Trial]) -> Trial | None:
    return max(trials, key=lambda trial: trial.distance, default=None)
