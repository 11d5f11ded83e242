"""Ground: the surface of a case under its drives at any factors of frequency and stroke, and the part on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final

import numpy as np

from active_surface.arrays import FloatArray
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
            self._rests[key] = part_at_rest(surface, build_part(case), self.friction, window, case.run.gravity)
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
