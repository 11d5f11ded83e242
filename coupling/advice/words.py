"""What a search for advice found, in words."""

from __future__ import annotations

from collections.abc import Sequence

from coupling.advice.advise import Advice
from coupling.advice.setting import Trial
from coupling.plate_figures import MAX_STRAIN
from coupling.report import MAX_DEFLECTION, MAX_QUASI_STATIC_ERROR, MICRO, in_percent, joined, percent, quantity
from coupling.summary import PlateSummary, Summary

NOTHING = 1e-9  # m


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
