"""The summary of a run in words: its outcome, its margins, how far to trust it, and how it was computed."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from common import Unit, count, percent, quantity, quantity_text
from coupling.air import AirFigures
from coupling.borders import BEFORE, LEAST, RANGE, Thresholds
from coupling.case import INERTIA
from coupling.margins import Margin
from coupling.measured import MotionFit
from coupling.plate_figures import StretchError, VibrationFigures
from coupling.report.warnings import MAX_QUASI_STATIC_SHARE, about, by_theory
from coupling.summary import PlateSummary, Summary
from particle import Outcome

MAX_LISTED = 8  # jumps of a measured motion
NONE = 1e-9  # of the friction limit: rounding
PULLS: Final = "adds most to the pull"
LIFTS: Final = "takes most off the load"
MICRO, MILLI = 1e6, 1e3
MICRO_UNITS: Final = re.compile(r"(?<=[\d)] )u(?=(?:m|N|s|g|Pa|J)\b)|\bu(?=m\b)")
"""The letter u of "2 um", which terminals can print, where it stands for the prefix."""
PRESSURES: Final = {
    "linear": "linear over the face, to bear the moments",
    "uniform": "uniform over the face, whatever the moments",
    "local": "by the gap at each point of the face, which tilts to bear the moments",
}
LETS_GO = 1 - 1e-3  # of the pull-off force
SLIPS = 1 - 1e-6  # of the friction limit: rounding must not decide whether it slips


def lines(summary: Summary, verbose: bool = False) -> list[tuple[str, str]]:
    """Rows (label, text) to print; verbose: with how it was computed."""
    rows = _outcome(summary) + margin_lines(summary) + _trust(summary)
    return rows + (details(summary) if verbose else [])


def lines_of_parts(summaries: Mapping[str, Summary], verbose: bool = False) -> list[tuple[str, str]]:
    """Rows (label, text) to print of many parts by their names; verbose: with all that `lines` has of each."""
    rows: list[tuple[str, str]] = []
    for name, summary in summaries.items():
        rows += [("part", name), *(lines(summary, True) if verbose else [*_outcome(summary), *_trust(summary)[:1]])]
    return rows if verbose else rows + [("plate", text) for _, text in _trust(summary)[1:]]


def trust(summary: Summary) -> str:
    """How far to trust a run, in one line: the rows of that name."""
    return "; ".join(text for _, text in _trust(summary))


def with_micro_signs(text: str) -> str:
    """A text of the report as pages and pictures have it, "2.3 µm" for "2.3 um"."""
    return MICRO_UNITS.sub("\N{MICRO SIGN}", text)


def _unit(s: Summary) -> Unit:
    """The unit of length in which the path has handy numbers."""
    return Unit("um", MICRO) if s.path_length < 0.01 else Unit("mm", MILLI) if s.path_length < 1 else Unit("m", 1.0)


def _outcome(s: Summary) -> list[tuple[str, str]]:
    rest = "" if s.at_rest_since is None else f" At rest since {s.at_rest_since * MILLI:.3f} ms."
    unit, per_metre = _unit(s)
    x, y = (c * per_metre for c in s.end_position)
    cut = "" if s.end_time >= s.duration else f", of {s.duration * MILLI:g} ms"
    where = "" if s.origin == "the plate" else f", counted from {s.origin}"
    rows = [
        ("outcome", f"{_ended(s)}. {s.sentence}{rest}"),
        ("end", f"({x:z.4f}, {y:z.4f}) {unit} at {s.end_time * MILLI:.4f} ms{cut}{where}"),
        (
            "distance",
            f"{s.distance * per_metre:.4f} {unit} from the start, over a path of "
            f"{s.path_length * per_metre:.2f} {unit}",
        ),
        *_turn(s),
        (
            "contact",
            f"stuck {s.time_stuck * MILLI:.3f} ms, slipping {s.time_slipping * MILLI:.3f} ms, {count(s.slips, 'slip')}",
        ),
    ]
    if s.flights:
        hops = f"{count(s.flights, 'flight')}, {count(s.landings, 'landing')}"
        rows.append(("", f"in flight {s.time_flying * MILLI:.3f} ms: {hops}"))
    if s.air is not None and s.air.end_without is not None:
        x, y = (c * per_metre for c in s.air.end_without)
        rows.append(("film", f"without it the part would end at ({x:z.4f}, {y:z.4f}) {unit}, {s.air.outcome_without}"))
    return rows + ([("loads", ", ".join(loads))] if (loads := _loads(s)) else [])


def _turn(s: Summary) -> list[tuple[str, str]]:
    """How far a part with a face has turned, and how evenly it presses."""
    if s.end_heading is None or s.turned is None:
        return []
    turned, heading = math.degrees(s.turned), math.degrees(s.end_heading)
    pressure = None if s.least_pressure is None else round(s.least_pressure, 6)  # of which 0 is found to rounding
    least = "" if pressure is None else f"; least pressure under the part {pressure:z.2g} of the mean"
    return [("turn", f"{turned:+z.4f} degrees, to a heading of {heading:z.4f} degrees{least}")]


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
    strain = "" if s.largest_strain is None else f", strain {percent(s.largest_strain)}{by_theory(s)}"
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
    return f"path error of linear theory {about(s.linear_path_error)}"


def _path_error(s: Summary) -> str:
    closer = "100 times tighter" if s.scheme == "events" else "with half the time step"
    events = "" if s.same_events else ", which has other events"
    unit, per_metre = _unit(s)
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
        dynamics = f"quasi-static error of the acceleration {about(s.quasi_static_error)}{remedy}"
    return f"first frequency, actuators held: {quantity_text(s.first_frequency, 'Hz', 4)}; {dynamics}"


def margin_lines(s: Summary) -> list[tuple[str, str]]:
    """Rows (label, text)."""
    margins, texts = s.margins, []
    if margins.slip is not None:
        texts.append(_slip(s, margins.slip))
    if margins.contact is not None:
        texts.append(_contact(s, margins.contact))
    elif s.air is not None and s.air.largest_gap is not None:
        load, gap, rest = quantity(margins.smallest_load, "N"), s.air.largest_gap, quantity(s.air.gap, "m")
        lets_go = not s.load_unbounded and margins.smallest_load <= -LETS_GO * margins.scale
        all_of_it = ", all of the pull-off force" if lets_go else ""
        opens = f"the film of air opens to {quantity(gap, 'm')} from {rest} at rest"
        texts.append(f"contact: the load on the asperities falls to {load}{all_of_it}; {opens}")
    elif margins.smallest_load < 0:
        load = quantity(margins.smallest_load, "N")
        texts.append(f"contact: the load falls to {load}, which only a law without pull-off bears")
    rows = [("margins" if n == 0 else "", text) for n, text in enumerate(texts)]
    return rows if s.thresholds is None else [*rows, ("thresholds", threshold_text(s.thresholds, s.turned is not None))]


def _slip(s: Summary, margin: Margin) -> str:
    if margin.value >= SLIPS:
        return f"slip: first {_when(s, margin, PULLS)}"
    if margin.value < NONE:
        return "slip: nothing pulls the part aside"
    return f"slip: the pull reaches {margin.value:.3g} of the friction limit, {_when(s, margin, PULLS)}"


def _contact(s: Summary, margin: Margin) -> str:
    if margin.value <= 0:
        return f"contact: comes off {_when(s, margin, LIFTS)}"
    force = s.margins.pull_off or s.margins.scale
    left, scale = (quantity(one, "N") for one in (margin.value * s.margins.scale, force))
    over = "pull-off force" if s.margins.by_pull_off else "weight"
    return f"contact: {left} from coming off ({over} {scale}) {_when(s, margin, LIFTS)}"


def _when(s: Summary, margin: Margin, does: str) -> str:
    unit, per_metre = _unit(s)
    x, y = (c * per_metre for c in margin.position)
    by = "" if margin.actuator is None else f"; actuator {margin.actuator} {does}"
    return f"at {round(margin.time * MILLI, 9):.4g} ms, ({x:.4g}, {y:.4g}) {unit}{by}"


def threshold_text(t: Thresholds, tips: bool) -> str:
    """From where a part at rest slips and comes off, or tips, in a sentence."""
    slips, off, knob = t.slips_from, t.comes_off_from, f"the {t.knob}"
    comes, come = ("comes off or tips", "come off or tip") if tips else ("comes off", "come off")
    slip = f"slips from {slips or 0.0:.4g} times {knob} on" if slips != 0 else f"slips at any {t.knob}"
    if off is None and slips is None:
        does = f"neither slips nor {comes} at up to {RANGE:g} times {knob}"
    elif off is None:
        does = f"{slip} and does not {come} at up to {RANGE:g} times"
    elif off == 0:
        does = f"{comes} even at {LEAST:.1g} times {knob}"
    elif t.holds is not None:
        before = "before it slips" if slips is None or slips > off else "as soon as it slips"
        just = f"at {BEFORE:g} of that, the pull is {t.holds:.2g} of the friction limit"
        does = f"{comes} {before}, from {off:.4g} times {knob} on; {just}"
    else:
        does = f"{slip}, and {comes} from {off:.4g} times"
    return f"At rest, with this friction, it {does}."


def details(s: Summary) -> list[tuple[str, str]]:
    """Rows (label, text) on how the run was computed, and where it is in the model's bounds."""
    tabulated = f"; friction tabulated to {s.contact_error:.1e}" if s.contact_error > 0 else ""
    if isinstance(s, PlateSummary):
        rows = [
            (
                "plate",
                f"{s.plate_unknowns} unknowns; unit shapes good to {s.plate_error:.1e} (estimated), "
                f"strokes met at the actuators to {s.hold_residual:.1e}",
            ),
            *([("", _stretching(s.stretch_error, s.stretch_solutions or 0))] if s.stretch_error else []),
            *([("", _vibrating(s.vibration))] if s.vibration else []),
            ("surface", f"fitted to {s.surface_error:.1e} of a unit stroke{tabulated}"),
        ]
    else:
        rows = [("surface", f"a flat, rigid platform{tabulated}")]
    rows += [("", text) for fit in s.motion_fits for text in _fit(fit)]
    if s.drive_error > 0:
        rows.append(("", f"drives follow their motion to {s.drive_error:.1e} of the stroke"))
    if s.pressure is not None:
        rows.append(("pressure", PRESSURES[s.pressure]))
    if s.air is not None:
        rows += [("air", text) for text in _air(s.air)]
    rows.append(("integrator", count(s.evaluations, "evaluation")))
    return rows + (_model(s) if isinstance(s, PlateSummary) else [])


def _air(air: AirFigures) -> Iterator[str]:
    """What the air under the part does."""
    if air.pressure == 0:
        yield "none: in a vacuum"
        return
    gap, at = quantity(air.gap, "m"), f"At {quantity(air.pressure, 'Pa', 4)} "
    by = ", assumed, as the friction law states none" if air.assumed else ""
    shares = {"load share": air.load_share, "breathing": air.breathing}
    share = "".join(f"; {name} {value:.2g}" for name, value in shares.items() if value is not None)
    yield f"{at}over a gap of {gap}{by}{share}"
    settles = "" if air.settle_time is None else f", settles in {quantity(air.settle_time, 's')}"
    drags = ", left out" if air.included == "nothing" else ""
    yield f"escapes from {quantity(air.escape_speed, 'm/s')}{settles}; drag rate {air.drag_rate:.3g} per second{drags}"
    if air.film_balance is not None:
        ledger = f"its energy ledger closes to {air.film_balance:.1e} of its largest entry"
        yield f"a film carries part of the load; {ledger}"


def _model(s: PlateSummary) -> list[tuple[str, str]]:
    rows = [
        *([("dynamics", _drives(s))] if s.drives_over_first else []),
        *([] if s.top_face_share is None else [("", _top_face(s.top_face_share))]),
        ("", f"the part's own force deflects the plate by {s.part_sag * MICRO:.1e} um"),
    ]
    if s.tipping:
        unless = ", if nothing adheres" if s.tipping > 1 and not s.tips else ""
        rows.append(("", f"centre of pressure shifts by {s.tipping:.2g} times half the part's size{unless}"))
    if s.part_curvature is not None:
        sag = s.part_sag_over_roughness
        under = "" if sag is None else f"; the plate sags under it by {sag:.2g} times the roughness"
        rows.append(("", f"part size times curvature {s.part_curvature:.2g}{under}"))
    return rows


def _stretching(error: StretchError, solutions: int) -> str:
    """How exact a plate that stretches is."""
    pieces = "" if error.pieces is None else f", its pieces in time {error.pieces:.1e}"
    return (
        f"stretching from {count(solutions, 'full solution')}, good to {error.mesh:.1e} (estimated); the reduced "
        f"model adds {error.reduction:.1e}{pieces}"
    )


def _vibrating(figures: VibrationFigures) -> str:
    """How exact a plate with inertia is."""
    share = f"{figures.uncoupled:.1e} of the acceleration"
    coupled = f", the lowest {figures.coupled} coupled by the membrane, the others {share}" if figures.coupled else ""
    return (
        f"{count(figures.modes, 'mode')} up to {quantity_text(figures.highest, 'Hz', 4)}{coupled}; acceleration good "
        f"to {figures.mode_error:.1e} (estimated), over time to {figures.piece_error:.1e}"
    )


def _fit(fit: MotionFit) -> Iterator[str]:
    rms, largest = fit.rms * MICRO, fit.largest * MICRO
    yield f"measured {fit.axis} followed to {rms:.1e} um (root mean square), {largest:.1e} um at most"
    if fit.cutoff is None or fit.freedom is None:
        yield f"{fit.axis} goes through every position, which have no noise to be seen"
        return
    noises = [(fit.noise, "m"), (fit.velocity_noise, "m/s"), (fit.acceleration_noise, "m/s^2")]
    noise = ", ".join(quantity(size, unit) for size, unit in noises if size is not None)
    by = "plate.smoothing" if fit.named else "cross-validation"
    yield (
        f"noise of {fit.axis} {noise}; smoothed by {by}: up to {quantity(fit.cutoff, 'Hz')}, "
        f"{fit.freedom:.0f} degrees of freedom of {fit.samples}"
    )
    if fit.jumps:
        first = "; ".join(f"{quantity(size, 'm/s')} at {time * MILLI:.2f} ms" for time, size in fit.jumps[:MAX_LISTED])
        more = len(fit.jumps) - MAX_LISTED
        yield f"velocity of {fit.axis} jumps: {first}{f'; {more} more' if more > 0 else ''}"


def _drives(s: PlateSummary) -> str:
    drives, strokes = (_range(ratios or ()) for ratios in (s.drives_over_first, s.strokes_over_first))
    return f"drive frequency / first frequency: {drives}; stroke rate / first frequency: {strokes}"


def _range(ratios: Sequence[float]) -> str:
    """The smallest and the largest ratio, or one where they are equal."""
    return "-".join(dict.fromkeys(f"{ratio:.2g}" for ratio in ratios))


def _top_face(share: float) -> str:
    added = f"{percent(share)} of" if share < 2 else f"{share:.3g} times"
    return f"top face and centre of mass add {added} the mid-plane's pull on the part"
