"""Shared surface: what many runs of a case with different drives move over, solved once for all of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from threading import Lock
from typing import Any

from coupling.case import Case, PlateCase
from coupling.drives import reach
from coupling.progress import Progress, silent
from coupling.run import build_scene
from coupling.scene import PlateScene, actuator_stiffness, build_plate, stretch_model, vibration_model
from coupling.stretch import Response, Stretch, StretchModel, room_beyond
from coupling.surface import ActuatedSurface
from coupling.vibration import Vibration, VibrationModel, always_running
from fem_plate import PlateShapes
from particle import AnyDrive, SurfaceMotion


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class VibratingSurface(ActuatedSurface):
    """The moving surface of a plate with inertia."""

    model: VibrationModel

    @staticmethod
    def under(
        model: VibrationModel, drives: Sequence[AnyDrive], tolerance: float, half_thickness: float
    ) -> VibratingSurface:
        """The surface of a model under drives, one an actuator."""
        surface = Vibration.under(model, drives).surface(tolerance, half_thickness)
        return VibratingSurface.of(surface, model=model)

    def until(self, end: float) -> VibratingSurface:
        """The same surface, for drives up to another end [s]."""
        return replace(self, model=replace(self.model, end=end))

    def driven_by(self, drives: Sequence[AnyDrive], in_plane_drives: Sequence[AnyDrive] = ()) -> SurfaceMotion:
        """The same surface with other drives of its actuators, sharing its cells; raises as `SurfaceMotion` does.

        Also ValueError where a mode without damping resonates in the steady state.
        """
        return self._moved_by(self._vibration(drives))

    def scene(self, drives: Sequence[AnyDrive], shapes: PlateShapes) -> PlateScene:
        """The scene of a case with these drives; shapes: of the plate.  Raises as `driven_by` does."""
        vibration = self._vibration(drives)
        return PlateScene(shapes.plate, shapes, vibration.drives, self._moved_by(vibration), vibration=vibration)

    def _vibration(self, drives: Sequence[AnyDrive]) -> Vibration:
        if wrong := self.drive_faults({"drives": drives}):
            raise ValueError("; ".join(wrong))
        return Vibration.under(self.model, [always_running(one) for one in drives] if self.model.steady else drives)

    def _moved_by(self, vibration: Vibration) -> SurfaceMotion:
        return self.moved_by([*vibration.drives, *vibration.modal_drives])


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class StretchedSurface(ActuatedSurface):
    """The moving surface of a plate that stretches."""

    model: StretchModel
    end: float  # s, of the time that is needed

    _lock: Lock = field(default_factory=Lock)  # of the response

    @staticmethod
    def under(
        model: StretchModel, drives: Sequence[AnyDrive], end: float, tolerance: float, half_thickness: float
    ) -> StretchedSurface:
        """The surface of a model under drives, one an actuator."""
        surface = Stretch.under(model, drives, end).surface(tolerance, half_thickness)
        return StretchedSurface.of(surface, model=model, end=end)

    def until(self, end: float) -> StretchedSurface:
        """The same surface, for drives up to another end [s]."""
        return replace(self, end=end)

    def driven_by(self, drives: Sequence[AnyDrive], in_plane_drives: Sequence[AnyDrive] = ()) -> SurfaceMotion:
        """The same surface with other drives of its actuators, sharing its cells; raises as `SurfaceMotion` does.

        Also ValueError where these pass the heights that its model is good for, or find no equilibrium.
        """
        return self._moved_by(self._stretch(drives))

    def scene(self, drives: Sequence[AnyDrive], shapes: PlateShapes) -> PlateScene:
        """The scene of a case with these drives; shapes: of the plate.  Raises as `driven_by` does."""
        stretch = self._stretch(drives)
        return PlateScene(shapes.plate, shapes, stretch.drives, self._moved_by(stretch), stretch)

    def _stretch(self, drives: Sequence[AnyDrive]) -> Stretch:
        if wrong := self.drive_faults({"drives": drives}) or self._strokes_beyond(drives):
            raise ValueError("; ".join(wrong))
        lifts = [always_running(drive) for drive in drives] if self.model.steady else drives
        return Stretch(self.model, lifts, self.model.corrections(lifts, self.end, self._response), self.end)

    def _moved_by(self, stretch: Stretch) -> SurfaceMotion:
        return self.moved_by(stretch.moving_drives, stretch.corrections.in_plane)

    @property
    def _response(self) -> Response | None:
        """What the plate answers to heights, found once for all drives."""
        with self._lock:
            return self.model.response

    def _strokes_beyond(self, drives: Sequence[AnyDrive]) -> list[str]:
        low, high = self.model.heights.min(axis=0), self.model.heights.max(axis=0)
        room, wrong = room_beyond(low, high), []
        for k, drive in enumerate(drives):
            least, most = reach(drive)
            if least < low[k] - room[k] or most > high[k] + room[k]:
                wrong.append(
                    f"drive {k} must stay within the heights that the stretching plate is solved for, {low[k]:g} to "
                    f"{high[k]:g}; it goes from {least:g} to {most:g}"
                )
        return wrong


def answers_drives(case: Case) -> bool:
    """Whether a case has a plate that does more than its actuators hold it to: it stretches or vibrates."""
    return isinstance(case.plate, PlateCase) and (case.plate.theory == "von-karman" or case.plate.inertia)


def shared_surface(
    case: Case,
    sets: Sequence[Sequence[AnyDrive]],
    duration: float,
    progress: Progress = silent,
    shapes: PlateShapes | None = None,
) -> SurfaceMotion:
    """The moving surface of a case whose drives are exchanged by `driven_by`.

    sets: of drives that stand for all that are to come, one an actuator each; they count where the plate stretches or
        vibrates.
    duration: s, of the longest run.  shapes: of the plate, where they are known; one that stretches makes its own.
    Raises ValueError where the plate cannot be solved, or its heights take too many full solutions.
    """
    plate = case.plate
    if not isinstance(plate, PlateCase) or not answers_drives(case):
        return build_scene(case, progress).surface
    longest = case.model_copy(update={"run": case.run.model_copy(update={"duration": duration})})
    top = plate.thickness / 2 if plate.top_face else 0.0
    options: dict[str, Any] = {"tolerance": case.run.surface_tolerance, "half_thickness": top}
    running = [_running(case, drives) for drives in sets]
    if plate.theory == "linear":
        return _vibrating(longest, plate, shapes or plate_shapes(case, progress), running, options, progress)
    with progress("Solving the stretching plate") as tell:
        model = stretch_model(longest, plate, build_plate(plate), running, tell)
    with progress("Fitting the surface"):
        return StretchedSurface.under(model, running[0], duration, **options)


def _running(case: Case, drives: Sequence[AnyDrive]) -> list[AnyDrive]:
    """Drives of a run; in a steady state they have always been running."""
    return [always_running(drive) for drive in drives] if case.run.start == "steady" else list(drives)


def plate_shapes(case: Case, progress: Progress) -> PlateShapes:
    """The influence shapes of a case with a plate that answers its drives."""
    assert isinstance(case.plate, PlateCase)
    with progress("Solving the plate") as tell:
        points = [one.position for one in case.actuators]
        return build_plate(case.plate).influence(points, actuator_stiffness(case), tell=tell)


def _vibrating(
    case: Case,
    plate_case: PlateCase,
    shapes: PlateShapes,
    sets: Sequence[Sequence[AnyDrive]],
    options: Mapping[str, Any],
    progress: Progress,
) -> VibratingSurface:
    with progress("Finding the modes") as tell:
        model = vibration_model(case, plate_case, shapes.plate, shapes, sets, tell)
    with progress("Fitting the surface"):
        return VibratingSurface.under(model, sets[0], **options)
