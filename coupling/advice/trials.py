"""Trials: runs of a case with other drives, less friction or another start."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np

from coupling.case import Case, PlateCase, friction_scales, more_plastic, ramped_case, with_index
from coupling.part import build_part, friction_law
from coupling.progress import doing, silent
from coupling.scene import PlateScene, Scene, lifts_of, plate_scene
from coupling.thresholds import FAR, LEAST, Factors, at_rest, driven, factors_of, stretches, strokes_alone
from particle import (
    Micropart,
    Outcome,
    PartAtRest,
    State,
    SurfaceMotion,
    interruptible,
    simulate,
)
from particle.friction import Contact, ScaledFriction

# Factors of the strokes, in the order in which they are tried.
STROKES: Final = 2.0, 4.0, 8.0, 0.5, 16.0, 32.0, 0.25, 64.0
FRICTION: Final = 0.7, 0.5, 0.35, 0.25, 0.15, 0.1, 0.05  # likewise, of what friction holds
SHARES: Final = 0.5, 0.25, 0.75  # of the way from slipping to coming off, in logarithms
WIDE: Final = 4.0  # where nothing comes off: up to so many times the frequency from which it slips
ROOM: Final = 1.05  # ratio of both thresholds below which a trial counts only where there is no other
NEAR: Final = 3e-5  # of the surface's size: by what a trial must move the part
ENOUGH: Final = 2e-4  # likewise: by what one within the bounds ends the search beyond them
FARTHER: Final = 1.2  # times the motion of the case itself, that a trial must make
LEVEL: Final = 1e-6  # of what friction holds: nothing pulls
TURNS: Final = 2  # of the fastest drive, that a trial run has at least
TRIED: Final = 300  # of the shortest, that a trial run lasts at most
RAMP: Final = 3.0  # cycles over which forces grow
RADII, ANGLES = (0.25, 0.5), (0.3, 1.9, 3.4, 5.0)  # of other places around the nearest actuator: of its gap, rad


@dataclass(frozen=True)
class Trial:
    """A run with other drives, or from another place, that moved the part and kept it."""

    frequency: float  # over the case's own
    stroke: float
    friction: float  # of what friction holds
    place: tuple[float, float] | None  # m, where it began; None: at the case's start
    distance: float  # m
    duration: float  # s, at most that of the case
    smallest_load: float  # N
    plasticity_index: float | None = None  # of Kogut and Etsion's law; None: the case's own
    ramp: float | None = None  # cycles over which forces grow that begin at once in the case; None: as there


class Setting(NamedTuple):
    """What a trial changes besides what its thresholds are of."""

    stroke: float = 1.0  # over the case's own
    friction: float = 1.0  # of what friction holds
    plasticity: float | None = None  # its index; None: the case's own
    ramp: float | None = None  # cycles, of forces that begin at once; None: the case's own
    pulled: bool = True  # whether the plate may pull at the part where the law bears any load


OWN: Final = Setting()


class Trials:
    """Runs of a case with other drives or less friction.

    largest_stroke: the factor of strokes up to which the model holds.  moved: m, by the case itself.
    """

    def __init__(
        self,
        case: Case,
        scene: Scene,
        friction: Contact,
        largest_stroke: float,
        moved: float = 0.0,
    ) -> None:
        self.case, self.scene, self.friction = case, scene, friction
        self.least = max(NEAR * scene.surface.size, FARTHER * moved)  # m, by which a trial must move the part
        self.rings, self.stretches = strokes_alone(scene), stretches(scene)
        self.largest_stroke, self.part, self.count = largest_stroke, build_part(case), 0
        self._laws: dict[float, Contact] = {}
        shortest = float(scene.surface.stroke_times.min(initial=case.run.duration))
        # A drive that does not even repeat itself once carries nothing along.
        self.least_factor = LEAST if self.rings else min(1.0, TURNS * 2 * shortest / case.run.duration)

    @property
    def level(self) -> bool:
        """Whether nothing pulls the part aside on a plate."""
        return isinstance(self.scene, PlateScene) and self._rest(self.part).slip().value < LEVEL

    def _law(self, setting: Setting) -> Contact:
        if setting.plasticity is None:
            return ScaledFriction(self.friction, setting.friction)
        if setting.plasticity not in self._laws:  # tabulating one takes a while
            self._laws[setting.plasticity] = friction_law(with_index(self.case.friction, setting.plasticity))
        return self._laws[setting.plasticity]

    def _rest(self, part: Micropart, setting: Setting = OWN) -> PartAtRest:
        return at_rest(self.case, self._surface(setting), part, self._law(setting))

    def _surface(self, setting: Setting) -> SurfaceMotion:
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

    def thresholds(self, part: Micropart, setting: Setting = OWN) -> Factors:
        """The thresholds of a part that stays at its start."""
        rest = self._rest(part, setting)
        return factors_of(lambda factor: driven(self.scene, rest, factor, setting.stroke))

    def best(self) -> Trial | None:
        """The trial within the model's bounds that goes far enough, or the farthest of these and of those beyond.

        First from the case's start, unless nothing pulls there, then from places around the nearest actuator.
        """
        found = list[Trial]()
        groups = [list(self._within()), [Setting(stroke) for stroke in self._strokes(self.largest_stroke, math.inf)]]
        if math.isinf(self.friction.pull_off):
            groups = [[one._replace(pulled=False) for one in group] for group in groups] + groups
        for settings in groups:
            trial = None if self.level else self._farthest(self.part, settings)
            if trial is None and isinstance(self.scene, PlateScene):
                trial = self._elsewhere(self.scene, [*filter(_keeps_friction, settings), *settings[-1:]])
            if trial is not None:
                found.append(trial)
                if trial.distance > ENOUGH * self.scene.surface.size:
                    return trial
        return max(found, key=lambda trial: trial.distance, default=None)

    def _farthest(self, part: Micropart, settings: Sequence[Setting]) -> Trial | None:
        """The trial that goes farthest of the first setting in which one goes far, or of all."""
        size, doubtful = self.scene.surface.size, list[Trial]()
        for setting in settings:
            thresholds = self.thresholds(part, setting)
            trials = [
                self.trial(part, factor, setting) for factor in _between(thresholds, self.least_factor, self._most)
            ]
            farthest = max(trials, key=lambda trial: trial.distance, default=None)
            if farthest is None or farthest.distance < self.least:
                continue
            if farthest.distance > FAR * size and thresholds.comes_off > ROOM * thresholds.slips:
                return farthest
            doubtful.append(farthest)
        return max(doubtful, key=lambda trial: trial.distance, default=None)

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

    @property
    def _most(self) -> float:
        """The largest factor of what varies."""
        return self.largest_stroke if self.rings else math.inf

    def trial(self, part: Micropart, factor: float, setting: Setting) -> Trial:
        """A run; its distance is negative where the part is lost."""
        frequency, stroke = (1.0, factor) if self.rings else (factor, setting.stroke)
        surface, run = self._surface(setting).scaled(frequency, stroke), self.case.run
        duration = min(run.duration, TRIED * float(surface.stroke_times.min(initial=run.duration)))
        self.count += 1
        doing(f"Trial run {self.count}")
        path = interruptible(simulate, surface, part, self._law(setting), duration, run.gravity, run.tolerance)
        loads = path.normal_force[path.state != State.FLIGHT]
        least = float(loads.min()) if len(loads) else 0.0
        kept = path.outcome in (Outcome.STUCK, Outcome.MOVING) and (setting.pulled or least >= 0)
        distance = path.distance if kept else -1.0
        return Trial(
            frequency, stroke, setting.friction, None, distance, duration, least, setting.plasticity, setting.ramp
        )

    def _elsewhere(self, scene: PlateScene, settings: Sequence[Setting]) -> Trial | None:
        """A trial from another place, around the actuator nearest to the start."""
        points, outline = scene.shapes.points, scene.shapes.outline
        nearest = points[np.argmin(np.hypot(*(points - self.part.position).T))]
        gap, found = float(outline.gap(nearest[None])[0]), list[Trial]()
        for radius in RADII:
            for angle in ANGLES:
                x, y = nearest + radius * gap * np.array([math.cos(angle), math.sin(angle)])
                place = float(f"{x:.3g}"), float(f"{y:.3g}")
                if outline.gap(np.array([place]))[0] <= 0:  # a rim may be nearer than three digits tell
                    continue
                if trial := self._farthest(replace(self.part, position=place), settings):
                    found.append(replace(trial, place=place))
                    if trial.distance > FAR * scene.surface.size:
                        return found[-1]
        return max(found, key=lambda trial: trial.distance, default=None)


def _keeps_friction(setting: Setting) -> bool:
    return setting.friction == 1 and setting.plasticity is None


def _between(thresholds: Factors, least: float, most: float) -> Iterator[float]:
    """Factors from the least to the largest, of three digits, at which a part at rest slips and does not come off."""
    low = max(thresholds.slips, least)
    high = min(thresholds.comes_off, WIDE * low, most)
    if low < high < math.inf:
        yield from dict.fromkeys(float(f"{low * (high / low) ** share:.3g}") for share in SHARES)
