"""Margins and thresholds in words."""

from __future__ import annotations

from typing import Final

from coupling.margins import Margin
from coupling.report.wording import MILLI, quantity, unit_of
from coupling.summary import Summary
from coupling.thresholds import BEFORE, LEAST, RANGE, Thresholds

NONE = 1e-9  # of what friction holds: rounding
PULLS: Final = "adds most to the pull"
LIFTS: Final = "takes most off the load"
SLIPS = 1 - 1e-6  # of what friction holds: rounding must not decide whether it slips


def margin_lines(s: Summary) -> list[tuple[str, str]]:
    """Rows (label, text)."""
    margins, texts = s.margins, []
    if margins.slip is not None:
        texts.append(_slip(s, margins.slip))
    if margins.contact is not None:
        texts.append(_contact(s, margins.contact))
    elif margins.smallest_load < 0:
        texts.append(
            f"contact: the load falls to {_force(margins.smallest_load)}, which only a law without pull-off bears"
        )
    rows = [("margins" if n == 0 else "", text) for n, text in enumerate(texts)]
    return rows if s.thresholds is None else [*rows, ("thresholds", threshold_text(s.thresholds))]


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


def threshold_text(t: Thresholds) -> str:
    """From where a part at rest slips and comes off, in a sentence."""
    return "At rest, with this friction, it " + _thresholds(t)


def _thresholds(t: Thresholds) -> str:
    slips, off, knob = t.slips_from, t.comes_off_from, f"the {t.knob}"
    if slips is None and off is None:
        return f"neither slips nor comes off at up to {RANGE:g} times {knob}."
    if slips is not None and off is None:
        slip = f"slips at any {t.knob}" if slips == 0 else f"slips from {slips:.4g} times {knob} on"
        return f"{slip} and does not come off at up to {RANGE:g} times."
    if off is None or off == 0:
        return f"comes off even at {LEAST:.1g} times {knob}."
    if t.holds is not None:
        before = "before it slips" if slips is None or slips > off else "as soon as it slips"
        just = f"at {BEFORE:g} of that, the pull is {t.holds:.2g} of what friction holds"
        return f"comes off {before}, from {off:.4g} times {knob} on; {just}."
    slip = f"slips at any {t.knob}" if slips == 0 else f"slips from {slips:.4g} times {knob} on"
    return f"{slip}, and comes off from {off:.4g} times."
