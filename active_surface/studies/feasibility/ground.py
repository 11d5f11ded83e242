"""Ground: a case's surface under drives at any factors of frequency and stroke, the part on it, and what is valid."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.studies.feasibility.places import squares_within
from coupling import (
    AnsweringSurface,
    PathTask,
    Progress,
    answers_drives,
    build_drives,
    build_friction,
    build_part,
    build_scene,
    follow,
    shared_surface,
    silent,
)
from coupling.case import Case, PlateCase, scaled_case
from meshes import Outline
from particle import PartAtRest, SurfaceMotion, Trajectory, part_at_rest
from particle.drives import drive_table, horizon
from particle.friction import Contact

SETS: Final = 9  # frequencies whose drives stand for those of all
DEFLECTION, SLOPE = 0.2, 0.2  # of the thickness, in linear theory; everywhere: up to these the model is valid
ACROSS, MOMENTS = 40, 61  # places along the plate's longer side, and moments of the window, where that is seen
STROKES, FREQUENCIES = 5, 7  # at which a plate that stretches, and one with mass, is looked at


@dataclass(frozen=True, eq=False)
class Ground:
    """What the part of a case moves over, with all frequencies times k and all strokes times s.

    A surface that follows its actuators at once does the same in 1/k of the time; in linear theory heights grow by s.
    Those are exact; for the other factors the surface is driven anew.
    """

    case: Case
    surface: SurfaceMotion
    outline: Outline
    actuators: FloatArray  # (N, 2) m
    duration: float  # s, of its paths
    _rests: dict[tuple[float, float, float], PartAtRest] = field(default_factory=dict)

    @cached_property
    def friction(self) -> Contact:
        """The law between part and surface."""
        return build_friction(self.case)

    @property
    def follows(self) -> bool:
        """Whether the plate has no mass, so that faster drives only shorten times."""
        return not (isinstance(self.case.plate, PlateCase) and self.case.plate.inertia)

    @property
    def linear(self) -> bool:
        """Whether its deflection grows with the strokes."""
        return not (isinstance(self.case.plate, PlateCase) and self.case.plate.theory == "von-karman")

    def driven(self, frequency: float, stroke: float, end: float | None = None) -> SurfaceMotion:
        """The surface at these factors, good up to an end [s], by default that of the run."""
        surface, end = self.surface, self.duration if end is None else end
        if isinstance(surface, AnsweringSurface):
            surface = surface.until(end)
        return surface.driven_by(build_drives(scaled_case(self.case, frequency, stroke)))

    def rest(self, frequency: float, stroke: float) -> PartAtRest:
        """The part that stays at its start throughout a run at these factors."""
        case, duration = self.case, self.duration
        driven = 1.0 if self.follows else frequency, 1.0 if self.linear else stroke
        window = duration if not self.follows else duration * frequency
        if self.follows or case.run.start == "steady":
            again = horizon(drive_table(build_drives(scaled_case(case, *driven))), 0.0)
            window = window if again is None else min(window, again)
        key = (*driven, window)
        if key not in self._rests:
            surface = self.driven(*driven, window)
            self._rests[key] = part_at_rest(
                surface, build_part(case), self.friction, window, case.run.gravity, case.run.after_tipping == "stop"
            )
        return self._rests[key].scaled(frequency / driven[0], stroke / driven[1])

    def paths(self, factors: Sequence[tuple[float, float]], threads: int | None = None) -> list[Trajectory]:
        """The part's paths at factors (frequency, stroke); each ends where it comes off."""
        surface, part = self.surface, build_part(self.case)
        if isinstance(surface, AnsweringSurface):
            surface = surface.until(self.duration)
        run = self.case.run.model_copy(update={"duration": self.duration, "after_detachment": "stop"})
        drives = [build_drives(scaled_case(self.case, *pair)) for pair in factors]
        return follow([PathTask(surface, part, self.friction, run, own) for own in drives], threads)


def make_ground(
    case: Case,
    frequencies: tuple[float, float],
    strokes: tuple[float, float],
    duration: float,
    end: float,
    progress: Progress = silent,
) -> Ground:
    """The ground of a case with a plate.

    frequencies, strokes: the least and the largest factor.  duration: s, of its paths.
    end: s, of the longest time that surfaces are to hold.
    """
    if not answers_drives(case):
        scene = build_scene(case, progress)
        assert scene.shapes
        return Ground(case, scene.surface, scene.shapes.outline, scene.shapes.points, duration)
    pairs = [(k, s) for s in (strokes[1], 1.0) for k in np.geomspace(*frequencies, SETS).tolist()]
    sets = [build_drives(case)] + [build_drives(scaled_case(case, *pair)) for pair in pairs]
    surface = shared_surface(case, sets, end, progress)
    assert isinstance(surface, AnsweringSurface)
    shapes = surface.model.shapes
    return Ground(case, surface, shapes.outline, shapes.points, duration)


def valid_strokes(ground: Ground, frequencies: FloatArray, strokes: tuple[float, float], window: float) -> FloatArray:
    """The strokes' factors (n,) up to which slopes and, in linear theory, deflections are small, at ascending factors.

    window: s, of the drives' own times.
    """
    some = np.geomspace(frequencies[0], frequencies[-1], FREQUENCIES) if not ground.follows else np.ones(1)
    limits = [_valid_stroke(ground, float(k), strokes, window) for k in some]
    return np.exp(np.interp(np.log(frequencies), np.log(some), np.log(limits)))


def _valid_stroke(ground: Ground, frequency: float, strokes: tuple[float, float], window: float) -> float:
    tried = np.ones(1) if ground.linear else np.geomspace(strokes[1] / 2**STROKES, strokes[1], STROKES + 1)
    uses = np.array([_share(ground, frequency, float(stroke), window) for stroke in tried])
    if ground.linear:
        return float(1 / max(uses[0], 1e-9))
    uses = np.maximum.accumulate(np.maximum(uses, 1e-9))
    return float(math.exp(np.interp(0.0, np.log(uses), np.log(tried), right=np.log(tried[-1]))))


def _share(ground: Ground, frequency: float, stroke: float, window: float) -> float:
    """The largest slope, and in linear theory the largest deflection, over what is valid."""
    plate = ground.case.plate
    assert isinstance(plate, PlateCase)
    end = window if ground.follows else window / frequency
    surface = ground.driven(1.0 if ground.follows else frequency, stroke, end)
    points = np.concatenate([squares_within(ground.outline, ACROSS).centres, ground.actuators])
    share = 0.0
    for time in np.linspace(0.0, end, MOMENTS).tolist():
        state = surface.evaluate(points, time)
        share = max(share, float(np.hypot(*state.gradient.T).max()) / SLOPE)
        if ground.linear:
            share = max(share, float(np.abs(state.w).max()) / (DEFLECTION * plate.thickness))
    return share
