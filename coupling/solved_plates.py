"""Solved plates: those of earlier cases, so that none is solved twice."""

from __future__ import annotations

from collections import OrderedDict
from threading import Lock
from typing import TypeVar

from coupling.case import Case
from coupling.progress import Progress, silent
from coupling.run import build_scene
from coupling.scene import PlateScene, Scene, actuator_stiffness, lifts_of
from coupling.shared import answers_drives
from fem_plate import PlateShapes

Kept = TypeVar("Kept")


class SolvedPlates:
    """The plates that cases lie on, each solved when it is first needed; several threads may ask.

    Parameters
    ----------
    progress : Progress
        Reports the progress of a stage.
    keep : int, optional
        How many plates are kept, those that were used last; by default all.
    """

    def __init__(self, progress: Progress = silent, keep: int | None = None) -> None:
        self._progress, self._keep, self._lock = progress, keep, Lock()
        self._scenes: OrderedDict[str, PlateScene] = OrderedDict()
        self._shapes: OrderedDict[str, PlateShapes] = OrderedDict()

    def scene(self, case: Case, progress: Progress | None = None) -> Scene:
        """The scene of a case, which shares its plate's shapes, and its cells where it only bends.

        progress: in place of that of all.  Raises as `build_scene` does.
        """
        plate, ground = _plate_key(case), _ground_key(case)
        if (shared := self._known(self._scenes, ground)) is not None:
            drives = lifts_of(case)
            pressed = shared.pressed and shared.pressed.driven_by(drives)
            surface = shared.surface.driven_by(drives)
            return PlateScene(shared.plate, shared.shapes, drives, surface, pressed=pressed)
        scene = build_scene(case, progress or self._progress, self._known(self._shapes, plate))
        if isinstance(scene, PlateScene):
            self._take(self._shapes, plate, scene.shapes)
            if not answers_drives(case):
                self._take(self._scenes, ground, scene)
        return scene

    def knows(self, case: Case) -> bool:
        """Whether the plate of a case that only bends is solved, and some of its cells are made."""
        with self._lock:
            return _ground_key(case) in self._scenes

    def _known(self, kept: OrderedDict[str, Kept], key: str) -> Kept | None:
        with self._lock:
            if key not in kept:
                return None
            kept.move_to_end(key)
            return kept[key]

    def _take(self, kept: OrderedDict[str, Kept], key: str, value: Kept) -> None:
        with self._lock:
            kept[key] = value
            while self._keep is not None and len(kept) > self._keep:
                kept.popitem(last=False)


def _plate_key(case: Case) -> str:
    """What shapes follow from, beyond the plate's own table."""
    held = [(one.position, spring) for one, spring in zip(case.actuators, actuator_stiffness(case), strict=True)]
    unheard = {"top_face", "density", "inertia", "damping", "pressure"}
    return f"{case.plate.model_dump_json(exclude=unheard)} {held}"


def _ground_key(case: Case) -> str:
    """What the cells of a moving surface follow from."""
    return f"{_plate_key(case)} {case.run.surface_tolerance!r} {case.plate.model_dump_json()}"
