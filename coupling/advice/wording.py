"""What a trial run did in words, and the case of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from common import joined, percent, quantity
from coupling.advice.choices import WAVES, Choice
from coupling.advice.trials import Trial, no_advice
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
from coupling.plate_figures import MAX_STRAIN
from coupling.report import MAX_DEFLECTION, MAX_QUASI_STATIC_ERROR, about
from coupling.result import Result
from coupling.summary import PlateSummary, Summary
from particle import Drive

ADVISED: Final = "_advised"  # the end of the name of such a case
NOTHING: Final = 1e-9  # m


def advised_case(case: Case, trial: Trial) -> Case:
    """The case of a trial run, named NAME_advised; it lasts as long as the case.

    Raises ValueError for a platform whose motion is measured.
    """
    if isinstance(case.plate, PlatformCase) and isinstance(case.plate.motion, str):
        raise ValueError(
            f"Input case of advised_case must have drives; the motion of its platform is measured, {case.plate.motion}"
        )
    update: dict[str, Any] = {"name": f"{case.name.removesuffix(ADVISED)}{ADVISED}", "source": None}
    if trial.choice is not None:
        case = trial.choice.of(case)
    if trial.ramp is not None:
        case = ramped_case(case, trial.ramp) or case
    if trial.friction != 1:
        update["friction"] = scaled_friction(case.friction, trial.friction)
    if trial.plasticity_index is not None:
        update["friction"] = with_index(case.friction, trial.plasticity_index)
    if trial.place is not None:
        update["part"] = case.part.model_copy(update={"position": trial.place})
    return scaled_case(case, trial.frequency, trial.stroke, shortly=True).model_copy(update=update)


def advice_text(result: Result, trial: Trial | None) -> str:
    """What the trial run that `advise` found did, or why there is none, in a sentence."""
    if trial is None:
        along = "farther" if result.summary.distance > NOTHING else "along"
        return no_advice(result) or f"No trial run kept it and carried it {along}."
    changes = [] if trial.choice is None else [_chosen(trial.choice)]
    if trial.stroke != 1:
        changes.append(f"{trial.stroke:g} times the stroke{_strokes(result.case, trial.stroke)}")
    if trial.ramp is not None:
        changes.append(f"forces that grow over {trial.ramp:g} cycles (ramp = {trial.ramp:g})")
    if trial.friction != 1:
        scales = (friction_scales(result.case.friction) or {}).items()
        values = [
            f"{key} = {quantity(own, 'N') if key == 'limit' else f'{own:.3g}'}"
            for key, own in ((key, trial.friction * value) for key, value in scales)
        ]
        changes.append(f"{trial.friction:g} times the friction{f' ({joined(values)})' if values else ''}")
    if trial.plasticity_index is not None:
        changes.append(f"friction.plasticity_index = {trial.plasticity_index:g}")
    if trial.frequency != 1 or not (changes or trial.place):
        lifts = result.scene.lifts if trial.choice is None else [result.scene.lifts[k] for k in trial.choice.running]
        drives = [drive for drive in (*lifts, *result.scene.base) if travel(drive) > 0]
        delayed = trial.frequency != 1 and any(drive.delay > 0 or not isinstance(drive, Drive) for drive in drives)
        own = _few([trial.frequency * drive.frequency for drive in drives], "Hz")
        times = " and all times of the drives divided alike" if delayed else ""
        changes.append(f"{trial.frequency:g} times the frequency{own}{times}")
    place = "" if trial.place is None else " from ({:g}, {:g}) um".format(*(1e6 * c for c in trial.place))
    changed = f" with {joined(changes)}" if changes else ""
    speed = quantity(trial.distance / trial.duration, "m/s", 2)
    return (
        f"A trial run{place}{changed} moves it by {quantity(trial.distance, 'm')} in {quantity(trial.duration, 's')}, "
        f"{speed} on average{_beyond(result.summary, trial)}.{_together(result, trial)}"
    )


def _chosen(choice: Choice) -> str:
    """Which actuators run."""
    if choice.name == "columns":
        return "each column a quarter of a period behind the one on its left"
    if choice.name == "rows":
        return "each row a quarter of a period behind the one below"
    return f"actuator{'s' * (len(choice.running) > 1)} {joined([str(k) for k in choice.running])} alone"


def _together(result: Result, trial: Trial) -> str:
    """How much all actuators pull together, where the trial has some of them run alone; else empty."""
    slip = result.summary.margins.slip
    if trial.choice is None or trial.choice.name in WAVES or slip is None or not slip.value < 1:
        return ""
    count = len(result.case.actuators)
    return f" {'Both' if count == 2 else f'All {count}'} together pull with {slip.value:.2g} of the friction limit."


def _beyond(s: Summary, trial: Trial) -> str:
    """What the model leaves out in a trial."""
    if not isinstance(s, PlateSummary):
        return ""
    out, error = list[str](), (s.quasi_static_error or 0.0) * trial.frequency
    over = s.deflection_over_thickness * trial.stroke
    strain = (s.largest_strain or 0.0) * trial.stroke if trial.choice is None else 0.0  # which is in bounds
    if s.theory == "linear" and over > MAX_DEFLECTION:
        out.append(f"linear theory at {over:.2g} times the thickness")
    if strain > MAX_STRAIN:
        out.append(f"{percent(strain)} of strain")
    if error > MAX_QUASI_STATIC_ERROR:
        out.append(f"an acceleration error of {about(error)}")
    if s.load_unbounded and trial.smallest_load < 0:
        out.append(f"a load of {quantity(trial.smallest_load, 'N')}, at which the plate would have to pull at it")
    return f", with {joined(out)}" if out else ""


def _strokes(case: Case, factor: float) -> str:
    """The strokes, or forces, that a factor makes of the case's; of both kinds together none."""
    drives: Sequence[DriveCase] = case.actuators
    if isinstance(case.plate, PlatformCase):
        axes = () if isinstance(case.plate.motion, str) else case.plate.motion or ()  # a measured motion has none
        drives = [drive for _, drive in axes if drive]
    moving = [(abs(amplitude(one)), getattr(one, "force", None) is not None) for one in drives if amplitude(one)]
    kinds = {forces for _, forces in moving}
    return _few([factor * most for most, _ in moving], "N" if True in kinds else "m") if len(kinds) == 1 else ""


def _few(values: Sequence[float], unit: str) -> str:
    """Different values [unit] in parentheses, as long as they are few."""
    texts = list(dict.fromkeys(quantity(value, unit, 6) for value in values))
    return f" ({joined(texts)})" if 0 < len(texts) <= 3 else ""
