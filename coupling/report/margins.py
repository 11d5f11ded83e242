"""Margins and advice in words."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from coupling.advice import BEFORE, LEAST, MAX_STRAIN, RANGE, Advice, Trial
from coupling.margins import Margin
from coupling.report.warnings import MAX_DEFLECTION, MAX_QUASI_STATIC_ERROR
from coupling.report.wording import MICRO, MILLI, in_percent, joined, percent, quantity, unit_of
from coupling.summary import PlateSummary, Summary

NOTHING = 1e-9  # m
NONE = 1e-9  # of what friction holds: rounding
PULLS: Final = "adds most to the pull"
LIFTS: Final = "takes most off the load"
SLIPS = 1 - 1e-6  # of what friction holds: rounding must not decide whether it slips


def margin_lines(s: Summary) -> list[tuple[str, str]]:
    """Rows (label, text)."""
    margins, rows = s.margins, []
    if margins.slip is not None:
        rows.append(_slip(s, margins.slip))
    if margins.contact is not None:
        rows.append(_contact(s, margins.contact))
    elif margins.smallest_load < 0:
        rows.append(
            f"contact: the load falls to {_force(margins.smallest_load)}, which only a law without pull-off bears"
        )
    advice = [] if s.advice is None else [("advice", advice_text(s, s.advice))]
    return [("margins" if n == 0 else "", text) for n, text in enumerate(rows)] + advice


def _slip(s: Summary, margin: Margin) -> str:
    if margin.value >= SLIPS:
        return f"slip: first {_when(s, margin, PULLS)}"
    if margin.value < NONE:
        return "slip: nothing pulls the part aside"
    return f"slip: the pull reaches {margin.value:.3g} of what friction holds, {_when(s, margin, PULLS)}"


def _contact(s: Summary, margin: Margin) -> str:
    if margin.value <= 0:
        return f"contact: comes off {_when(s, margin, LIFTS)}"
    scale = f"{'pull-off force' if s.margins.by_pull_off else 'weight'} {_force(s.margins.scale)}"
    return f"contact: {_force(margin.value * s.margins.scale)} from coming off ({scale}) {_when(s, margin, LIFTS)}"


def _when(s: Summary, margin: Margin, does: str) -> str:
    unit, per_metre = unit_of(s)
    x, y = (c * per_metre for c in margin.position)
    by = "" if margin.actuator is None else f"; actuator {margin.actuator} {does}"
    return f"at {round(margin.time * MILLI, 9):.4g} ms, ({x:.4g}, {y:.4g}) {unit}{by}"


def _force(force: float) -> str:
    return quantity(force, "N")


def advice_text(s: Summary, a: Advice) -> str:
    """What thresholds and trial runs show, in sentences."""
    writes = not a.measured and a.trial is not None
    command = ["Add --advised FILE to the command to write that case."] if writes else []
    return " ".join(["At rest, with this friction, it " + _thresholds(a), trial_text(s), *command])


def _thresholds(a: Advice) -> str:
    slips, off, knob = a.slips_from, a.comes_off_from, f"the {a.knob}"
    if slips is None and off is None:
        return f"neither slips nor comes off at up to {RANGE:g} times {knob}."
    if slips is not None and off is None:
        slip = f"slips at any {a.knob}" if slips == 0 else f"slips from {slips:.4g} times {knob} on"
        return f"{slip} and does not come off at up to {RANGE:g} times."
    if off is None or off == 0:
        return f"comes off even at {LEAST:.1g} times {knob}."
    if a.holds is not None:
        before = "before it slips" if slips is None or slips > off else "as soon as it slips"
        just = f"at {BEFORE:g} of that, the pull is {a.holds:.2g} of what friction holds"
        return f"comes off {before}, from {off:.4g} times {knob} on; {just}."
    slip = f"slips at any {a.knob}" if slips == 0 else f"slips from {slips:.4g} times {knob} on"
    return f"{slip}, and comes off from {off:.4g} times."


def trial_text(s: Summary) -> str:
    """What the trial run of the advice did, in a sentence; raises ValueError without advice."""
    a = s.advice
    if a is None:
        raise ValueError("Input s of trial_text must be of a run with advice")
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
        out.append(f"a load of {_force(trial.smallest_load)}, at which the plate would have to pull at it")
    return f", with {joined(out)}" if out else ""


def _friction(a: Advice, trial: Trial) -> str:
    """The keys of the law with their values in a trial."""
    values = [
        f"{key} = {_force(trial.friction * value) if key == 'limit' else f'{trial.friction * value:.3g}'}"
        for key, value in a.friction.items()
    ]
    return f" ({joined(values)})" if values else ""


def _values(own: Sequence[float], factor: float, unit: str | None) -> str:
    """The values that a factor makes of a few own ones."""
    if unit is None:
        return ""
    texts = list(dict.fromkeys(quantity(factor * value, unit, 6) for value in own))
    return f" ({joined(texts)})" if 0 < len(texts) <= 3 else ""  # a measured motion has none
