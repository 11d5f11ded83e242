"""Shared surface: what many runs of a case with different drives move over, solved once for all of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from threading import Lock

from coupling.case import Case, PlateCase
from coupling.drives import reach
from coupling.progress import Progress, silent
from coupling.run import build_scene
from coupling.scene import PlateScene, actuator_stiffness, build_plate, stretch_model, vibration_model
from coupling.stretch import Stretch, StretchModel, room_beyond
from coupling.surface import ActuatedSurface
from coupling.vibration import Vibration, VibrationModel, always_running
from fem_plate import PlateShapes
from particle import AnyDrive, SurfaceMotion


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class AnsweringSurface(ActuatedSurface):
    """The moving surface of a plate that answers its drives: it stretches or vibrates."""

    model: StretchModel | VibrationModel
    end: float  # s, of the time that is needed

    _lock: Lock = field(default_factory=Lock)  # of a plate's response to heights, which is found once for all drives

    def until(self, end: float) -> AnsweringSurface:
        """The same surface, for drives up to another end [s]."""
        model = replace(self.model, end=end) if isinstance(self.model, VibrationModel) else self.model
        return replace(self, model=model, end=end)

    def driven_by(self, drives: Sequence[AnyDrive], in_plane_drives: Sequence[AnyDrive] = ()) -> SurfaceMotion:
        """The same surface with other drives of its actuators, sharing its cells; raises as `SurfaceMotion` does.

        Also ValueError where these pass the heights that a model of a plate that stretches is good for, find no
        equilibrium, or have a mode without damping resonate in the steady state.
        """
        return self._moved(self._answer(drives))

    def scene(self, drives: Sequence[AnyDrive], shapes: PlateShapes) -> PlateScene:
        """The scene of a case with these drives; shapes: of the plate.  Raises as `driven_by` does."""
        answer = self._answer(drives)
        kinds = (None, answer) if isinstance(answer, Vibration) else (answer, None)
        return PlateScene(shapes.plate, shapes, answer.drives, self._moved(answer), *kinds)

    def _answer(self, drives: Sequence[AnyDrive]) -> Stretch | Vibration:
        if wrong := self.drive_faults({"drives": drives}) or self._strokes_beyond(drives):
            raise ValueError("; ".join(wrong))
        lifts = [always_running(drive) for drive in drives] if self.model.steady else drives
        if isinstance(self.model, VibrationModel):
            return Vibration.under(self.model, lifts)
        with self._lock:
            response = self.model.response
        return Stretch(self.model, lifts, self.model.corrections(lifts, self.end, response), self.end)

    def _moved(self, answer: Stretch | Vibration) -> SurfaceMotion:
        if isinstance(answer, Vibration):
            return self.moved_by([*answer.drives, *answer.modal_drives])
        return self.moved_by(answer.moving_drives, answer.corrections.in_plane)

    def _strokes_beyond(self, drives: Sequence[AnyDrive]) -> list[str]:
        if isinstance(self.model, VibrationModel):
            return []
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
    steady, top = case.run.start == "steady", plate.thickness / 2 if plate.top_face else 0.0
    running = [[always_running(drive) for drive in drives] if steady else list(drives) for drives in sets]
    model: StretchModel | VibrationModel
    if plate.theory == "linear":
        shapes = shapes or plate_shapes(case, progress)
        with progress("Finding the modes") as tell:
            model = vibration_model(longest, plate, shapes.plate, shapes, running, tell)
    else:
        with progress("Solving the stretching plate") as tell:
            model = stretch_model(longest, plate, build_plate(plate), running, tell)
    with progress("Fitting the surface"):
        answer: Stretch | Vibration
        if isinstance(model, VibrationModel):
            answer = Vibration.under(model, running[0])
        else:
            answer = Stretch.under(model, running[0], duration)
        surface = answer.surface(case.run.surface_tolerance, top)
        return AnsweringSurface.of(surface, model=model, end=duration)


def plate_shapes(case: Case, progress: Progress) -> PlateShapes:
    """The influence shapes of a case with a plate that answers its drives."""
    assert isinstance(case.plate, PlateCase)
    with progress("Solving the plate") as tell:
        points = [one.position for one in case.actuators]
        return build_plate(case.plate).influence(points, actuator_stiffness(case), tell=tell)
