"""The summary of a run in words: its outcome, its margins, and how far to trust it."""

from __future__ import annotations

from common import quantity_text
from coupling.case import INERTIA
from coupling.report.details import details
from coupling.report.margins import margin_lines
from coupling.report.warnings import MAX_QUASI_STATIC_SHARE
from coupling.report.wording import MICRO, MILLI, by_theory, count, in_percent, percent, quantity, unit_of
from coupling.summary import PlateSummary, Summary
from particle import Outcome


def lines(summary: Summary, verbose: bool = False) -> list[tuple[str, str]]:
    """Rows (label, text) to print; verbose: with how it was computed."""
    rows = _outcome(summary) + margin_lines(summary) + _trust(summary)
    return rows + (details(summary) if verbose else [])


def trust(summary: Summary) -> str:
    """How far to trust a run, in one line: the rows of that name."""
    return "; ".join(text for _, text in _trust(summary))


def _outcome(s: Summary) -> list[tuple[str, str]]:
    rest = "" if s.at_rest_since is None else f" At rest since {s.at_rest_since * MILLI:.3f} ms."
    unit, per_metre = unit_of(s)
    x, y = (c * per_metre for c in s.end_position)
    cut = "" if s.end_time >= s.duration else f", of {s.duration * MILLI:g} ms"
    where = "" if s.origin == "the plate" else f", counted from {s.origin}"
    rows = [
        ("outcome", f"{_ended(s)}. {s.sentence}{rest}"),
        ("end", f"({x:.4f}, {y:.4f}) {unit} at {s.end_time * MILLI:.4f} ms{cut}{where}"),
        (
            "distance",
            f"{s.distance * per_metre:.4f} {unit} from the start, over a path of "
            f"{s.path_length * per_metre:.2f} {unit}",
        ),
        (
            "contact",
            f"stuck {s.time_stuck * MILLI:.3f} ms, slipping {s.time_slipping * MILLI:.3f} ms, {count(s.slips, 'slip')}",
        ),
    ]
    if s.flights:
        hops = f"{count(s.flights, 'flight')}, {count(s.landings, 'landing')}"
        rows.append(("", f"in flight {s.time_flying * MILLI:.3f} ms: {hops}"))
    return rows + ([("loads", ", ".join(loads))] if (loads := _loads(s)) else [])


def _ended(s: Summary) -> str:
    """The outcome; of a part that rests after it has gone somewhere, how far: the sentence says that it rests."""
    if s.outcome != Outcome.STUCK or s.path_length <= max(s.path_error, s.path_resolution):
        return s.outcome
    slips = f" in {count(s.slips, 'slip')}" if s.slips else ""
    return f"travelled {quantity(s.path_length, 'm', 4)}{slips}"


def _trust(s: Summary) -> list[tuple[str, str]]:
    ledger = f"the energy ledger closes to {s.energy_balance:.1e} of its largest entry"
    if not isinstance(s, PlateSummary):
        return [("trust", f"{_path_error(s)}; {ledger}")]
    strain = "" if s.largest_strain is None else f", strain {in_percent(s.largest_strain)}{by_theory(s)}"
    return [
        ("trust", f"{_path_error(s)}; {ledger}"),
        (
            "",
            f"deflection {s.deflection_over_thickness:.3g} times the thickness ({_theory(s)}), slope "
            f"{s.largest_slope:.3g}{strain}",
        ),
        ("", _dynamics(s)),
    ]


def _loads(s: Summary) -> list[str]:
    """The loads other than gravity towards the plate."""
    texts = []
    if isinstance(s.gravity, tuple):
        texts.append(f"gravity ({', '.join(f'{g:g}' for g in s.gravity)}) m/s^2")
    if s.squeeze:
        texts.append(f"squeezed by {s.squeeze * MICRO:g} uN")
    return texts


def _theory(s: PlateSummary) -> str:
    if s.linear_path_error is None:
        return "von Karman's theory"
    return f"path error of linear theory {percent(s.linear_path_error)}"


def _path_error(s: Summary) -> str:
    closer = "100 times tighter" if s.scheme == "events" else "with half the time step"
    events = "" if s.same_events else ", which has other events"
    unit, per_metre = unit_of(s)
    return f"the end point moves by {s.path_error * per_metre:.1e} {unit} in a run {closer}{events}"


def _dynamics(s: PlateSummary) -> str:
    if s.first_frequency is None or s.drive_over_first is None:
        return "first frequency unknown: plate.density is not given"
    if s.vibration:
        dynamics = "its inertia counts"
    elif s.quasi_static_error is None:
        dynamics = "it rings where a drive jumps"
    else:
        remedy = f" ({INERTIA} has none)" if s.can_vibrate and s.quasi_static_error > MAX_QUASI_STATIC_SHARE else ""
        dynamics = f"quasi-static error of the acceleration {percent(s.quasi_static_error)}{remedy}"
    return f"first frequency, actuators held: {quantity_text(s.first_frequency, 'Hz', 4)}; {dynamics}"
