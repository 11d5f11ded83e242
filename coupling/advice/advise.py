"""What would have a part move and stay on, and the case that does."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from coupling.advice.setting import Trial
from coupling.advice.trials import FAR, Trials
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
from coupling.scene import PlateScene, Scene
from particle import Drive, Outcome, Trajectory
from particle.friction import Contact

ADVISED: Final = "_advised"  # the end of the name of such a case
ENDS: Final = Outcome.STUCK, Outcome.MOVING, Outcome.DETACHED, Outcome.OVERLOADED


@dataclass(frozen=True)
class Advice:
    """What thresholds and trial runs show."""

    knob: str  # "frequency" or "stroke": what the thresholds are of
    slips_from: float | None  # times the case's own: a part at rest slips at its start; None: at none up to 64
    comes_off_from: float | None  # likewise from where it comes off, or is overloaded
    holds: float | None  # the pull over what friction holds just before it comes off, where it does not slip before
    trial: Trial | None  # None: none moved the part and kept it
    friction: dict[str, float]  # keys of the case's law in proportion to which friction is; none: its list of limits
    frequencies: tuple[float, ...]  # Hz, the case's own, of the drives that move
    strokes: tuple[float, ...]  # m, or N of actuators that are forces
    unit: str | None  # of these; None: of either kind
    plate: bool  # whether the drives are those of a plate
    delayed: bool  # whether drives have times besides their frequency
    measured: bool = False  # whether the motion is a measured one, which no case scales


def advise(
    case: Case, scene: Scene, trajectory: Trajectory, friction: Contact, largest_stroke: float = math.inf
) -> Advice | None:
    """What would have the part move and stay on.

    largest_stroke: factor of the strokes up to which the model holds.
    None where it moved far and stayed on, where no drive moves, and with inertia in large deflection: no factor scales
    that.
    """
    kept = trajectory.outcome in (Outcome.STUCK, Outcome.MOVING)
    moving = [drive for drive in (*scene.lifts, *scene.base) if travel(drive) > 0]
    if moves(scene, trajectory) or trajectory.outcome not in ENDS or any(case.part.velocity) or not moving:
        return None
    stretches = isinstance(scene, PlateScene) and scene.stretch is not None
    rings = bool(scene.fits) or (isinstance(scene, PlateScene) and scene.has_inertia)
    if stretches and rings:
        return None
    trials = Trials(case, scene, friction, rings, stretches, largest_stroke, trajectory.distance if kept else 0.0)
    own = trials.thresholds(trials.part)
    driven = [(one, abs(amplitude(one))) for one in _drives(case)]
    units = {"N" if getattr(one, "force", None) is not None else "m" for one, most in driven if most > 0} or {"m"}
    return Advice(
        knob="stroke" if rings else "frequency",
        slips_from=None if math.isinf(own.slips) else own.slips,
        comes_off_from=None if math.isinf(own.comes_off) else own.comes_off,
        holds=trials.holds(own),
        trial=trials.best(),
        friction=friction_scales(case.friction) or {},
        frequencies=tuple(dict.fromkeys(drive.frequency for drive in moving)),
        strokes=tuple(dict.fromkeys(most for _, most in driven if most > 0)),
        unit=units.pop() if len(units) == 1 else None,
        plate=isinstance(scene, PlateScene),
        delayed=any(drive.delay > 0 or not isinstance(drive, Drive) for drive in moving),
        measured=bool(scene.fits),
    )


def moves(scene: Scene, trajectory: Trajectory) -> bool:
    """Whether a part was carried far and stayed on, so that there is nothing to advise."""
    kept = trajectory.outcome in (Outcome.STUCK, Outcome.MOVING)
    return kept and trajectory.distance > FAR * scene.surface.size


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


def advice_from(figures: Mapping[str, Any]) -> Advice:
    """The advice that was written as JSON."""
    trial = figures["trial"]
    if trial is not None:
        trial = Trial(**trial | {"place": trial["place"] and tuple(trial["place"])})
    lists = {name: tuple(figures[name]) for name in ("frequencies", "strokes")}
    return Advice(**{**figures, **lists, "trial": trial})
