"""Solved plates: those of earlier cases, so that none is solved twice."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Sequence
from threading import Lock
from typing import TypeVar

from coupling.case import Case
from coupling.drives import build_drives
from coupling.progress import Progress, silent
from coupling.run import build_scene
from coupling.scene import PlateScene, Scene, actuator_stiffness, lifts_of
from coupling.shared import AnsweringSurface, answers_drives, plate_shapes, shared_surface
from fem_plate import PlateShapes
from particle import AnyDrive, SurfaceMotion

Kept = TypeVar("Kept")
DriveSets = Callable[[], Sequence[Sequence[AnyDrive]]]
"""Makes the sets of drives, one an actuator each, that stand for all which a plate is to answer."""


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
        self._shapes: OrderedDict[str, PlateShapes] = OrderedDict()
        self._scenes: OrderedDict[str, Scene] = OrderedDict()  # of what does not answer its drives
        self._surfaces: OrderedDict[str, SurfaceMotion] = OrderedDict()  # of plates that do

    def scene(self, case: Case, progress: Progress | None = None) -> Scene:
        """The scene of a case, with the bits of `build_scene`, which raises likewise.

        It shares its plate's shapes, and its cells where the plate only bends.  progress: in place of that of all.
        """
        shared = None if answers_drives(case) else self._known(self._scenes, ground_key(case))
        if isinstance(shared, PlateScene):
            drives = lifts_of(case)
            pressed = shared.pressed and shared.pressed.driven_by(drives)
            return PlateScene(shared.plate, shared.shapes, drives, shared.surface.driven_by(drives), pressed=pressed)
        if shared is not None:
            return shared
        scene = build_scene(case, progress or self._progress, self._known(self._shapes, _plate_key(case)))
        if isinstance(scene, PlateScene):
            self._take(self._shapes, _plate_key(case), scene.shapes)
        if not answers_drives(case):
            self._take(self._scenes, ground_key(case), scene)
        return scene

    def surface(self, case: Case, sets: DriveSets, end: float, progress: Progress | None = None) -> SurfaceMotion:
        """The moving surface of all cases with the plate of this one, which exchange its drives by `driven_by`.

        sets: asked where the plate stretches or vibrates and is not known yet.  end: s, of the longest run.
        Raises as `shared_surface` does.
        """
        if not answers_drives(case):
            known = self._known(self._scenes, ground_key(case)) or self.scene(case, progress)
            return known.surface
        surface = self.known_surface(case, end)
        if surface is None:
            progress = progress or self._progress
            shapes = self._shapes_of(case, progress) if case.plate.theory == "linear" else None  # type: ignore[union-attr]
            surface = shared_surface(case, sets(), end, progress, shapes)
            self._take(self._surfaces, _end_key(case, end), surface)
        return surface

    def scene_among(self, case: Case, sets: DriveSets, end: float) -> Scene:
        """The scene of one of many cases, over the surface that they share; raises as `surface` does."""
        if not answers_drives(case):
            return self.scene(case)
        surface = self.surface(case, sets, end)
        assert isinstance(surface, AnsweringSurface)
        return surface.scene(build_drives(case), self._shapes_of(case, self._progress))

    def known_surface(self, case: Case, end: float) -> SurfaceMotion | None:
        """The shared surface of a plate that stretches or vibrates, up to an end [s]; None: it is not made yet."""
        return self._known(self._surfaces, _end_key(case, end))

    def knows(self, case: Case) -> bool:
        """Whether the plate of a case that only bends is solved, and some of its cells are made."""
        with self._lock:
            return ground_key(case) in self._scenes

    def _shapes_of(self, case: Case, progress: Progress) -> PlateShapes:
        shapes = self._known(self._shapes, _plate_key(case))
        if shapes is None:
            shapes = plate_shapes(case, progress)
            self._take(self._shapes, _plate_key(case), shapes)
        return shapes

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


def ground_key(case: Case) -> str:
    """What the cells of a moving surface follow from, drives left aside."""
    return f"{_plate_key(case)} {case.run.surface_tolerance!r} {case.run.start} {case.plate.model_dump_json()}"


def _end_key(case: Case, end: float) -> str:
    return f"{ground_key(case)} {end!r}"


def _plate_key(case: Case) -> str:
    """What shapes follow from, beyond the plate's own table."""
    places = [(one.position, spring) for one, spring in zip(case.actuators, actuator_stiffness(case), strict=True)]
    no_matter = {"top_face", "density", "inertia", "damping", "pressure"}
    return f"{case.plate.model_dump_json(exclude=no_matter)} {places}"
