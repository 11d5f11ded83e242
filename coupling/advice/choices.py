"""Choices: which actuators of an array run, and how far each line of them is behind the one before."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from coupling.case import Case, PlateCase, groups_of, running_case
from coupling.drives import travel
from coupling.plate_figures import MAX_SLOPE, MAX_STRAIN
from coupling.progress import silent
from coupling.scene import PlateScene, lifts_of, plate_scene

WAVES: Final = "columns", "rows"
QUARTER: Final = 0.25  # of a period: what each line of a wave is behind the one before
MAX_ALONE: Final = 25  # actuators that are tried one by one
MOST: Final = 40  # choices of a plate that follows its drives at once
MOST_MODELS: Final = 6  # of others, each of which needs a model


class Choice(NamedTuple):
    """Which actuators run, and how far each is behind."""

    name: str  # such as "column 0"; of a wave "columns" or "rows"
    running: tuple[int, ...]

    def of(self, case: Case) -> Case:
        """The case with drives chosen like this."""
        if self.name not in WAVES:
            return running_case(case, self.running)
        actuators = list(case.actuators)
        for number, line in enumerate(groups_of(case, self.name).values()):
            for k in line:
                behind = number * QUARTER / (actuators[k].frequency or math.inf)
                actuators[k] = actuators[k].model_copy(update={"delay": actuators[k].delay + behind})
        return case.model_copy(update={"actuators": tuple(actuators)})


def choices_of(case: Case, scene: PlateScene, place: tuple[float, float]) -> list[Choice]:
    """Waves over lines that move, and columns, rows and actuators that run alone, nearest to a place [m] first."""
    moving = {k for k, drive in enumerate(scene.lifts) if travel(drive) > 0}
    lines = {kind: groups_of(case, kind) for kind in WAVES}
    groups = [*lines.values(), groups_of(case, "each") if len(case.actuators) <= MAX_ALONE else {}]
    alone: dict[tuple[int, ...], Choice] = {}  # a line may be of one actuator
    for name, running in (pair for group in groups for pair in group.items()):
        if 0 < len(moving.intersection(running)) < len(moving):
            alone.setdefault(running, Choice(name, running))

    def distance(choice: Choice) -> float:
        return float(np.hypot(*(scene.shapes.points[list(choice.running)] - place).T).min())

    waves = [
        Choice(kind, tuple(sorted(moving)))
        for kind in WAVES
        if len(lines[kind]) > 2 and sum(not moving.isdisjoint(line) for line in lines[kind].values()) > 1
    ]
    return [*waves, *sorted(alone.values(), key=distance)][: MOST_MODELS if _needs_model(scene) else MOST]


def chosen_scene(case: Case, scene: PlateScene, choice: Choice) -> tuple[Case, PlateScene]:
    """The case and the scene with drives chosen like this, over the same plate."""
    chosen = choice.of(case)
    if _needs_model(scene) or scene.pressed is not None:
        assert isinstance(chosen.plate, PlateCase)
        return chosen, plate_scene(chosen, chosen.plate, silent, scene.shapes)
    lifts = lifts_of(chosen)
    return chosen, replace(scene, lifts=lifts, surface=scene.surface.driven_by(lifts))


def stroke_room(slope: float, strain: float | None, stretches: bool) -> float:
    """The factor of strokes up to which a plate's slope and strain stay in bounds, at most 1 where it stretches."""
    rooms = [bound / value for bound, value in ((MAX_SLOPE, slope), (MAX_STRAIN, strain or 0.0)) if value > 0]
    return min([1.0 if stretches else math.inf, *rooms])


def _needs_model(scene: PlateScene) -> bool:
    return scene.stretch is not None or scene.has_inertia
