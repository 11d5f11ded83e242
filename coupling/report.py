"""The summary in words: the lines that a run prints, and its warnings."""

from __future__ import annotations

from collections.abc import Sequence

from coupling.measured import MotionFit
from coupling.summary import PlateSummary, Summary

MICRO, MILLI = 1e6, 1e3

# Where the model stops holding to about a per cent.
MOST_THICKNESSES, STEEPEST, MOST_CURVED = 0.2, 0.2, 0.1
MOST_RINGING, FASTEST = 0.01, 0.003  # of the acceleration; of the first frequency, where strokes up and down reach that
NUMERICAL_ERROR = 1e-6  # of a unit stroke, of the path
FEWEST_FRAMES = 8  # to a cycle
GROWTH = 100  # of the error of one step, that is no sign of chaos


def lines(summary: Summary) -> list[tuple[str, str]]:
    """Rows (label, text) to print."""
    s = summary
    rest = "" if s.at_rest_since is None else f" It has rested since {s.at_rest_since * MILLI:.3f} ms."
    unit, per_metre = _unit(s)
    x, y = (c * per_metre for c in s.end_position)
    cut = "" if s.end_time >= s.duration else f", of {s.duration * MILLI:g} ms asked for"
    where = "" if s.origin == "the plate" else f", counted from {s.origin}"
    rows = [
        ("outcome", f"{s.outcome}. {s.sentence}{rest}"),
        ("end", f"({x:.4f}, {y:.4f}) {unit} at {s.end_time * MILLI:.4f} ms{cut}{where}"),
        (
            "distance",
            f"{s.distance * per_metre:.4f} {unit} from the start, over a path of "
            f"{s.path_length * per_metre:.2f} {unit}",
        ),
        (
            "contact",
            f"stuck {s.time_stuck * MILLI:.3f} ms, slipping {s.time_slipping * MILLI:.3f} ms, "
            f"{_count(s.slips, 'slip')}",
        ),
    ]
    if s.flights:
        hops = f"{_count(s.flights, 'flight')}, {_count(s.landings, 'landing')}"
        rows.append(("", f"in flight {s.time_flying * MILLI:.3f} ms: {hops}"))
    rows += [("loads", ", ".join(loads))] if (loads := _loads(s)) else []
    tabulated = f"; friction tabulated to {s.contact_error:.1e}" if s.contact_error > 0 else ""
    if isinstance(s, PlateSummary):
        rows += [
            (
                "plate",
                f"{s.plate_unknowns} unknowns; unit shapes good to {s.plate_error:.1e} (estimated), "
                f"held at the actuators to {s.hold_residual:.1e}",
            ),
            ("surface", f"fitted to {s.surface_error:.1e} of a unit stroke{tabulated}"),
        ]
    else:
        rows += [("surface", f"a flat, rigid platform{tabulated}")]
    rows += [("", _fit(fit)) for fit in s.motion_fits]
    if s.drive_error > 0:
        rows.append(("", f"drives follow their motion to {s.drive_error:.1e} of the stroke"))
    rows += [
        ("integrator", f"{_path_error(s)}; {_count(s.evaluations, 'evaluation')}"),
        ("", f"the energy ledger closes to {s.energy_balance:.1e} of its largest entry"),
    ]
    return rows + (_model(s) if isinstance(s, PlateSummary) else [])


def _model(s: PlateSummary) -> list[tuple[str, str]]:
    rows = [
        (
            "model",
            f"deflection {s.deflection_over_thickness:.3g} times the thickness (path error of linear theory "
            f"{_percent(s.linear_path_error)}), slope {s.largest_slope:.3g}, "
            f"in-plane motion left out {s.in_plane_motion * MICRO:.3g} um",
        ),
        ("", _dynamics(s)),
        *([("", _drives(s))] if s.drives_over_first else []),
        ("", f"the plate gives {s.part_sag * MICRO:.1e} um under the part's own force"),
    ]
    if s.part_curvature is not None:
        rows.append(("", f"part size times curvature {s.part_curvature:.2g}"))
    return rows


def warnings(summary: Summary) -> list[str]:
    """What a user must know before trusting the numbers."""
    s = summary
    said = _of_solver(s) if isinstance(s, PlateSummary) else []
    finer = "run.tolerance" if s.scheme == "events" else "run.time_step"
    least = max(NUMERICAL_ERROR * s.path_length, GROWTH * s.path_resolution)
    if s.path_error is None or s.path_error > least:
        said.append(
            "The path magnifies small errors: trust the statistics of many starts more than the digits of one."
            if s.scheme == "events"
            else "Fixed steps follow the path to few digits; a smaller run.time_step gives more, in proportion."
        )
    if s.frames_per_cycle is not None and s.frames_per_cycle < FEWEST_FRAMES:
        said.append(
            f"The result files hold {s.frames_per_cycle:.2g} steps to a cycle of the fastest drive: what "
            "moves fast looks slow or still in them; a larger run.frames shows it."
        )
    jump = None if s.scheme == "events" else s.drive_jump
    if s.energy_balance > NUMERICAL_ERROR and jump is None:
        said.append(
            f"The energy ledger closes only to {s.energy_balance:.1e} of its largest entry; "
            + (
                f"a smaller {finer} follows the path more closely."
                if s.scheme != "paper"
                else "so it does at any step."
            )
        )
    if s.scheme == "paper":
        said.append(
            'The paper\'s scheme drops terms of the equations of motion: its path is not that of scheme = "events", '
            "however small the step."
        )
    if jump is not None:
        said.append(
            f"A drive's velocity jumps at {jump * MILLI:g} ms. With fixed steps the part goes on there as if its own "
            'velocity jumped as well: the impact is left out, also of the energy ledger; scheme = "events" has it.'
        )
    return said + (_of_model(s) if isinstance(s, PlateSummary) else [])


def _of_solver(s: PlateSummary) -> list[str]:
    said = []
    if s.plate_error > NUMERICAL_ERROR:
        said.append(
            f"The plate's shapes are only good to {s.plate_error:.1e} of a stroke; a smaller plate.cell_size, or "
            "actuators further from the rim, make them better."
        )
    if s.surface_error > max(NUMERICAL_ERROR, s.plate_error):
        said.append(
            f"The surface that the part sees follows the plate's shapes only to {s.surface_error:.1e} of a stroke: so "
            "it is at re-entrant corners and those where supports change, in narrow slots, at actuators near the rim."
        )
    return said


def _of_model(s: PlateSummary) -> list[str]:
    said = []
    if s.deflection_over_thickness > MOST_THICKNESSES:
        said.append(
            f"The plate deflects by {s.deflection_over_thickness:.3g} times its thickness; small-deflection theory "
            f"holds to about {MOST_THICKNESSES}. Expect a path error of {_percent(s.linear_path_error)}."
        )
    if s.largest_slope > STEEPEST:
        said.append(f"The surface is as steep as {s.largest_slope:.2g}; small-slope theory holds to about {STEEPEST}.")
    if s.quasi_static_error is not None and s.quasi_static_error > MOST_RINGING:
        said.append(
            f"The drive is at {s.drive_over_first:.2g} of the plate's first frequency; the plate follows at once up to "
            f"about {FASTEST}. Expect its acceleration to be off by {_percent(s.quasi_static_error)}."
        )
    if s.plate_rings:
        said.append(
            "A drive's velocity or acceleration jumps, as that of a sine or cosine does where it begins: a plate rings "
            "from then on, by as much as its acceleration jumps, until damping ends it. The model leaves that out."
        )
    if s.part_curvature is not None and s.part_curvature > MOST_CURVED:
        said.append(
            f"Part size times curvature reaches {s.part_curvature:.2g}; a part stands for a point up to about "
            f"{MOST_CURVED}."
        )
    return said


def _loads(s: Summary) -> list[str]:
    """What else pulls and presses than gravity towards the plate."""
    said = []
    if isinstance(s.gravity, tuple):
        said.append(f"gravity ({', '.join(f'{g:g}' for g in s.gravity)}) m/s^2")
    if s.squeeze:
        said.append(f"squeezed by {s.squeeze * MICRO:g} uN")
    return said


def _fit(fit: MotionFit) -> str:
    rms, largest = fit.rms * MICRO, fit.largest * MICRO
    return f"measured {fit.axis} followed to {rms:.1e} um (root mean square), {largest:.1e} um at most"


def _path_error(s: Summary) -> str:
    closer = "100 times tighter" if s.scheme == "events" else "with half the time step"
    if s.path_error is None:
        return f"a run {closer} sees other events"
    unit, per_metre = _unit(s)
    return f"the end point moves by {s.path_error * per_metre:.1e} {unit} in a run {closer}"


def _unit(s: Summary) -> tuple[str, float]:
    """The unit of length, with how many make a metre, in which the path has numbers of a usual size."""
    return ("um", MICRO) if s.path_length < 0.01 else ("mm", 1e3) if s.path_length < 1 else ("m", 1.0)


def _dynamics(s: PlateSummary) -> str:
    if s.first_frequency is None or s.drive_over_first is None:
        return "drive over the plate's first frequency not known: plate.density is not given"
    error = None if s.quasi_static_error is None else _percent(s.quasi_static_error)
    return (
        f"drive {s.drive_over_first:.2g} of the plate's first frequency with the actuators held, "
        f"{s.first_frequency / 1e3:.4g} kHz "
        + (f"(quasi-static error of the acceleration {error})" if error else "(it rings where a drive jumps)")
    )


def _drives(s: PlateSummary) -> str:
    drives, strokes = (_range(ratios or ()) for ratios in (s.drives_over_first, s.strokes_over_first))
    return f"drives over it {drives}; their strokes, at one over the time from rest to rest, {strokes}"


def _range(ratios: Sequence[float]) -> str:
    """The smallest and the largest ratio, or both at once."""
    return " to ".join(dict.fromkeys(f"{ratio:.2g}" for ratio in ratios))


def _percent(share: float) -> str:
    return "more than 50 %" if share > 0.5 else f"about {100 * share:.2g} %"


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"
