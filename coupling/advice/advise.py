"""What would have a part move and stay on, the case that does, and what it did in words."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

from coupling.advice.trials import Trial, Trials
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
from coupling.report import MAX_DEFLECTION, MAX_QUASI_STATIC_ERROR, MICRO, in_percent, joined, percent, quantity
from coupling.result import Result
from coupling.summary import PlateSummary, Summary
from coupling.thresholds import kept, lacks_motion
from particle import Drive

ADVISED: Final = "_advised"  # the end of the name of such a case
NOTHING: Final = 1e-9  # m


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


def trial_text(s: Summary, a: Advice) -> str:
    """What the trial run of the advice on a run did, in a sentence."""
    if a.trial is None:
        return f"No trial run kept it and carried it {'farther' if s.distance > NOTHING else 'along'}."
    trial, changes, place = a.trial, list[str](), ""
    if trial.place is not None:
        x, y = (MICRO * c for c in trial.place)
        place = f" from ({x:g}, {y:g}) um"
    if trial.stroke != 1:
        changes.append(f"{trial.stroke:g} times the stroke{_values(a.strokes, trial.stroke, a.unit)}")
    if trial.ramp is not None:
        changes.append(f"forces that grow over {trial.ramp:g} cycles (ramp = {trial.ramp:g})")
    if trial.friction != 1:
        changes.append(f"{trial.friction:g} times the friction{_friction(a, trial)}")
    if trial.plasticity_index is not None:
        changes.append(f"friction.plasticity_index = {trial.plasticity_index:g}")
    if trial.frequency != 1 or not (changes or place):
        times = " and all times of the drives divided alike" if a.delayed and trial.frequency != 1 else ""
        changes.append(f"{trial.frequency:g} times the frequency{_values(a.frequencies, trial.frequency, 'Hz')}{times}")
    changed = f" with {joined(changes)}" if changes else ""
    speed = quantity(trial.distance / trial.duration, "m/s", 2)
    moved = (
        f"by {quantity(trial.distance, 'm')} in {quantity(trial.duration, 's')}, {speed} on average{_beyond(s, trial)}"
    )
    return f"A trial run{place}{changed} moves it {moved}."


def _beyond(s: Summary, trial: Trial) -> str:
    """What the model leaves out in a trial."""
    if not isinstance(s, PlateSummary):
        return ""
    out, error = list[str](), (s.quasi_static_error or 0.0) * trial.frequency
    over, strain = s.deflection_over_thickness * trial.stroke, (s.largest_strain or 0.0) * trial.stroke
    if s.theory == "linear" and over > MAX_DEFLECTION:
        out.append(f"linear theory at {over:.2g} times the thickness")
    if strain > MAX_STRAIN:
        out.append(f"{in_percent(strain)} of strain")
    if error > MAX_QUASI_STATIC_ERROR:
        out.append(f"an acceleration error of {percent(error)}")
    if s.load_unbounded and trial.smallest_load < 0:
        out.append(f"a load of {quantity(trial.smallest_load, 'N')}, at which the plate would have to pull at it")
    return f", with {joined(out)}" if out else ""


def _friction(a: Advice, trial: Trial) -> str:
    """The keys of the law with their values in a trial."""
    values = [
        f"{key} = {quantity(trial.friction * value, 'N') if key == 'limit' else f'{trial.friction * value:.3g}'}"
        for key, value in a.friction.items()
    ]
    return f" ({joined(values)})" if values else ""


def _values(own: Sequence[float], factor: float, unit: str | None) -> str:
    """The values that a factor makes of a few own ones."""
    if unit is None:
        return ""
    texts = list(dict.fromkeys(quantity(factor * value, unit, 6) for value in own))
    return f" ({joined(texts)})" if 0 < len(texts) <= 3 else ""  # a measured motion has none
