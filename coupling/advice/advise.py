"""What would have a part move and stay on, and the case that does."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

from coupling.advice.setting import Trial
from coupling.advice.trials import Trials
from coupling.case import (
    Case,
    DriveCase,
    PlatformCase,
    amplitude,
    friction_scales,
    ramped_case,
    scaled_case,
    scaled_friction,
    with_index,
)
from coupling.drives import travel
from coupling.part import build_friction
from coupling.plate_figures import MAX_SLOPE, MAX_STRAIN
from coupling.result import Result
from coupling.summary import PlateSummary, Summary
from coupling.thresholds import kept, lacks_motion
from particle import Drive

ADVISED: Final = "_advised"  # the end of the name of such a case


@dataclass(frozen=True)
class Advice:
    """What trial runs show."""

    trial: Trial | None  # None: none moved the part and kept it
    friction: dict[str, float]  # keys of the case's law in proportion to which friction is; none: its list of limits
    frequencies: tuple[float, ...]  # Hz, the case's own, of the drives that move
    strokes: tuple[float, ...]  # m, or N of actuators that are forces
    unit: str | None  # of these; None: of either kind
    delayed: bool  # whether drives have times besides their frequency
    measured: bool = False  # whether the motion is a measured one, which no case scales


def advise(result: Result, largest_stroke: float | None = None) -> Advice | None:
    """Search for what would have the part of a run move and stay on, by trial runs.

    largest_stroke: the factor of strokes up to which the model holds [that of the summary].
    None where it moved far and stayed on, where no drive moves, and with inertia in large deflection.
    """
    case, scene, trajectory = result.case, result.scene, result.trajectory
    if not lacks_motion(case, scene, trajectory):
        return None
    most = _largest_stroke(result.summary) if largest_stroke is None else largest_stroke
    trials = Trials(case, scene, build_friction(case), most, trajectory.distance if kept(trajectory) else 0.0)
    moving = [drive for drive in (*scene.lifts, *scene.base) if travel(drive) > 0]
    driven = [(one, abs(amplitude(one))) for one in _drives(case)]
    units = {"N" if getattr(one, "force", None) is not None else "m" for one, most in driven if most > 0} or {"m"}
    return Advice(
        trial=trials.best(),
        friction=friction_scales(case.friction) or {},
        frequencies=tuple(dict.fromkeys(drive.frequency for drive in moving)),
        strokes=tuple(dict.fromkeys(most for _, most in driven if most > 0)),
        unit=units.pop() if len(units) == 1 else None,
        delayed=any(drive.delay > 0 or not isinstance(drive, Drive) for drive in moving),
        measured=bool(scene.fits),
    )


def _largest_stroke(summary: Summary) -> float:
    """The factor of strokes up to which slope and strain of a plate stay in bounds; 1 where it stretches."""
    if not isinstance(summary, PlateSummary):
        return math.inf
    if summary.theory != "linear":
        return 1.0
    rooms = [(MAX_SLOPE, summary.largest_slope), (MAX_STRAIN, summary.largest_strain or 0.0)]
    return min((bound / value for bound, value in rooms if value > 0), default=math.inf)


def _drives(case: Case) -> list[DriveCase]:
    """What moves a plate, or a platform that no measured motion moves."""
    if not isinstance(case.plate, PlatformCase):
        return list(case.actuators)
    return [drive for _, drive in case.plate.motion or () if drive] if not isinstance(case.plate.motion, str) else []


def advised_case(case: Case, trial: Trial) -> Case:
    """The case of a trial run, named NAME_advised; it lasts as long as the case.

    Raises ValueError for a platform whose motion is measured.
    """
    if isinstance(case.plate, PlatformCase) and isinstance(case.plate.motion, str):
        raise ValueError(
            f"Input case of advised_case must have drives; the motion of its platform is measured, {case.plate.motion}"
        )
    update: dict[str, Any] = {"name": f"{case.name.removesuffix(ADVISED)}{ADVISED}", "source": None}
    if trial.ramp is not None:
        case = ramped_case(case, trial.ramp) or case
    if trial.friction != 1:
        update["friction"] = scaled_friction(case.friction, trial.friction)
    if trial.plasticity_index is not None:
        update["friction"] = with_index(case.friction, trial.plasticity_index)
    if trial.place is not None:
        update["part"] = case.part.model_copy(update={"position": trial.place})
    return scaled_case(case, trial.frequency, trial.stroke, shortly=True).model_copy(update=update)
