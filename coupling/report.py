"""The summary in words: the lines that a run prints, and its warnings."""

from __future__ import annotations

from collections.abc import Sequence

from coupling.case import INERTIA, MAX_STRETCHING, MAX_VIBRATING, VON_KARMAN
from coupling.measured import MotionFit
from coupling.plate_figures import StretchError, VibrationFigures
from coupling.summary import PlateSummary, Summary
from meshes import quantity_text

MICRO, MILLI = 1e6, 1e3

# The model holds to about a per cent up to these.
MAX_DEFLECTION = 0.2  # of the thickness
MAX_LINEAR_ERROR = 0.01  # of the path: beyond it a run names the theory that has stretching
MAX_SLOPE = 0.2
MAX_STRAIN = 0.005  # silicon breaks near twice that
MAX_CURVATURE = 0.1  # of one over the part's size
MAX_QUASI_STATIC_ERROR = 0.05  # of the acceleration
MAX_QUASI_STATIC_SHARE = 0.01  # of the acceleration: beyond it a run names the line that has inertia
MAX_FREQUENCY = 0.015  # of the first one: strokes up and down reach that error there
MAX_NUMERICAL_ERROR = 1e-6  # of a unit stroke, of the path
MAX_MODE_ERROR = 1e-2  # of the acceleration of a plate with inertia
MAX_STRETCH_ERROR = 1e-3  # of the deflection of a plate that stretches
MIN_STEPS_PER_CYCLE = 8
GROWTH = 100  # of the error of one step, that is no sign of chaos


def lines(summary: Summary) -> list[tuple[str, str]]:
    """Rows (label, text) to print."""
    s = summary
    rest = "" if s.at_rest_since is None else f" At rest since {s.at_rest_since * MILLI:.3f} ms."
    unit, per_metre = _unit(s)
    x, y = (c * per_metre for c in s.end_position)
    cut = "" if s.end_time >= s.duration else f", of {s.duration * MILLI:g} ms"
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
            *([("", _stretching(s.stretch_error, s.stretch_solutions or 0))] if s.stretch_error else []),
            *([("", _vibrating(s.vibration))] if s.vibration else []),
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
            f"deflection {s.deflection_over_thickness:.3g} times the thickness ({_theory(s)}), slope "
            f"{s.largest_slope:.3g}",
        ),
        *([] if s.largest_strain is None else [("", f"strain {_in_percent(s.largest_strain)}{_bending(s)}")]),
        ("", _dynamics(s)),
        *([("", _drives(s))] if s.drives_over_first else []),
        *([] if s.top_face_share is None else [("", _top_face(s.top_face_share))]),
        ("", f"the part's own force deflects the plate by {s.part_sag * MICRO:.1e} um"),
    ]
    if s.tipping:
        unless = ", if nothing adheres" if s.tipping > 1 and not s.tips else ""
        rows.append(("", f"centre of pressure shifts by {s.tipping:.2g} times half the part's size{unless}"))
    if s.part_curvature is not None:
        rows.append(("", f"part size times curvature {s.part_curvature:.2g}"))
    return rows


def _theory(s: PlateSummary) -> str:
    if s.linear_path_error is None:
        return "von Karman's theory"
    return f"path error of linear theory {_percent(s.linear_path_error)}"


def _in_percent(share: float) -> str:
    percent = 100 * share
    return f"{percent:.2g} %" if percent < 99.5 else f"{percent:.0f} %"


def _bending(s: PlateSummary) -> str:
    return " by bending alone" if s.theory == "linear" else ""


def _stretching(error: StretchError, solutions: int) -> str:
    """How exact a plate that stretches is."""
    pieces = "" if error.pieces is None else f", its pieces in time {error.pieces:.1e}"
    return (
        f"stretching from {_count(solutions, 'full solution')}, good to {error.mesh:.1e} (estimated); the reduced "
        f"model adds {error.reduction:.1e}{pieces}"
    )


def _vibrating(figures: VibrationFigures) -> str:
    """How exact a plate with inertia is."""
    share = f"{figures.uncoupled:.1e} of the acceleration"
    coupled = f", the lowest {figures.coupled} coupled by the membrane, the others {share}" if figures.coupled else ""
    return (
        f"{_count(figures.modes, 'mode')} up to {quantity_text(figures.highest, 'Hz', 4)}{coupled}; acceleration good "
        f"to {figures.mode_error:.1e} (estimated), over time to {figures.piece_error:.1e}"
    )


def warnings(summary: Summary) -> list[str]:
    """The limits of the model and of the numerics that the run passes."""
    s = summary
    texts = _of_solver(s) if isinstance(s, PlateSummary) else []
    finer = "run.tolerance" if s.scheme == "events" else "run.time_step"
    resolved = max(MAX_NUMERICAL_ERROR * s.path_length, GROWTH * s.path_resolution)
    if s.path_error is None or s.path_error > resolved:
        texts.append(
            "The path magnifies small errors: trust the statistics of many starts more than the digits of one."
            if s.scheme == "events"
            else "Fixed steps give the path to few digits; the error falls in proportion to run.time_step."
        )
    if s.frames_per_cycle is not None and s.frames_per_cycle < MIN_STEPS_PER_CYCLE:
        texts.append(
            f"The result files hold {s.frames_per_cycle:.2g} steps per cycle of the fastest drive: fast motion looks "
            "slow or frozen in them; a larger run.frames shows it."
        )
    jump = None if s.scheme == "events" else s.drive_jump
    if s.energy_balance > MAX_NUMERICAL_ERROR and jump is None:
        texts.append(
            f"The energy ledger closes only to {s.energy_balance:.1e} of its largest entry; "
            + (f"reduce {finer}." if s.scheme != "paper" else "no step improves that.")
        )
    if s.scheme == "paper":
        texts.append(
            'The paper\'s scheme drops terms of the equations of motion: its path is not that of scheme = "events", '
            "however small the step."
        )
    if jump is not None:
        texts.append(
            f"A drive's velocity jumps at {jump * MILLI:g} ms. Fixed steps leave out the impact, also in the energy "
            'ledger: the part\'s velocity jumps with the surface; scheme = "events" has the impact.'
        )
    return texts + (_of_model(s) if isinstance(s, PlateSummary) else [])


def _of_solver(s: PlateSummary) -> list[str]:
    texts = []
    if s.plate_error > MAX_NUMERICAL_ERROR:
        texts.append(
            f"The plate's shapes are accurate to {s.plate_error:.1e} of a stroke only; reduce plate.cell_size, or move "
            "actuators away from the rim."
        )
    if s.vibration and s.vibration.mode_error > MAX_MODE_ERROR:
        texts.append(
            f"The plate's acceleration is accurate to {s.vibration.mode_error:.1e} of its largest only, as a drive "
            "whose velocity or acceleration jumps excites modes without end; a ramp avoids that."
        )
    if s.stretch_error and (worst := s.stretch_error.largest) > MAX_STRETCH_ERROR:
        texts.append(
            f"The plate that stretches is accurate to {worst:.1e} of its deflection only; reduce "
            + ("plate.cell_size." if worst == s.stretch_error.mesh else "the strokes.")
        )
    if s.surface_error > max(MAX_NUMERICAL_ERROR, s.plate_error, s.vibration.mode_error if s.vibration else 0.0):
        texts.append(
            f"The fitted surface follows the plate's shapes to {s.surface_error:.1e} of a stroke only, as happens at "
            "re-entrant corners, where supports change, in narrow slots, and at actuators near the rim."
        )
    return texts


def _of_model(s: PlateSummary) -> list[str]:
    texts = []
    if s.linear_path_error is not None and s.deflection_over_thickness > MAX_DEFLECTION:
        remedy = (
            f" {VON_KARMAN} in [plate] has the plate stretch, with up to {MAX_STRETCHING} actuators."
            if s.linear_path_error > MAX_LINEAR_ERROR
            else ""
        )
        texts.append(
            f"The plate deflects by {s.deflection_over_thickness:.3g} times its thickness; small-deflection theory "
            f"holds to about {MAX_DEFLECTION}. Expect a path error of {_percent(s.linear_path_error)}.{remedy}"
        )
    if s.largest_slope > MAX_SLOPE:
        remedy = "; smaller strokes or a wider plate reduce it" if s.theory == "von-karman" else ""
        texts.append(
            f"The surface is as steep as {s.largest_slope:.2g}; small-slope theory holds to about {MAX_SLOPE}{remedy}."
        )
    if s.largest_strain is not None and s.largest_strain > MAX_STRAIN:
        texts.append(
            f"The plate is strained by {_in_percent(s.largest_strain)}{_bending(s)}; silicon breaks near 1 %, and "
            f"{100 * MAX_STRAIN:g} % is prudent."
        )
    if s.quasi_static_error is not None and s.quasi_static_error > MAX_QUASI_STATIC_ERROR:
        texts.append(
            f"The drive is at {s.drive_over_first:.2g} of the plate's first frequency; the quasi-static model holds up "
            f"to about {MAX_FREQUENCY}. Expect an acceleration error of {_percent(s.quasi_static_error)}."
            + (
                f" {INERTIA} in [plate] has the plate vibrate, with up to {MAX_VIBRATING} actuators."
                if s.theory == "linear"
                else ""
            )
        )
    if s.plate_rings:
        texts.append(
            "A drive's velocity or acceleration jumps, as at the end of a sine or cosine, or at its start after a "
            "delay; a ramp avoids both. The plate then rings, by as much as its acceleration jumps, until damping ends "
            "it. The quasi-static model leaves that out"
            + (f"; {INERTIA} in [plate] has it." if s.theory == "linear" else ".")
        )
    if s.tips:
        texts.append(
            f"The centre of pressure shifts by {s.tipping:.2g} times half the part's size: a part this high tips over, "
            "which the model leaves out."
        )
    if s.part_curvature is not None and s.part_curvature > MAX_CURVATURE:
        texts.append(
            f"Part size times curvature reaches {s.part_curvature:.2g}; the point-part model holds up to about "
            f"{MAX_CURVATURE}."
        )
    return texts


def _loads(s: Summary) -> list[str]:
    """The loads other than gravity towards the plate."""
    texts = []
    if isinstance(s.gravity, tuple):
        texts.append(f"gravity ({', '.join(f'{g:g}' for g in s.gravity)}) m/s^2")
    if s.squeeze:
        texts.append(f"squeezed by {s.squeeze * MICRO:g} uN")
    return texts


def _fit(fit: MotionFit) -> str:
    rms, largest = fit.rms * MICRO, fit.largest * MICRO
    return f"measured {fit.axis} followed to {rms:.1e} um (root mean square), {largest:.1e} um at most"


def _path_error(s: Summary) -> str:
    closer = "100 times tighter" if s.scheme == "events" else "with half the time step"
    if s.path_error is None:
        return f"a run {closer} has other events"
    unit, per_metre = _unit(s)
    return f"the end point moves by {s.path_error * per_metre:.1e} {unit} in a run {closer}"


def _unit(s: Summary) -> tuple[str, float]:
    """The unit of length in which the path has handy numbers, and how many make a metre."""
    return ("um", MICRO) if s.path_length < 0.01 else ("mm", 1e3) if s.path_length < 1 else ("m", 1.0)


def _dynamics(s: PlateSummary) -> str:
    if s.first_frequency is None or s.drive_over_first is None:
        return "first frequency unknown: plate.density is not given"
    if s.vibration:
        dynamics = "its inertia counts"
    elif s.quasi_static_error is None:
        dynamics = "it rings where a drive jumps"
    else:
        remedy = f" ({INERTIA} has none)" if s.quasi_static_error > MAX_QUASI_STATIC_SHARE else ""
        dynamics = f"quasi-static error of the acceleration {_percent(s.quasi_static_error)}{remedy}"
    return f"first frequency, actuators held: {quantity_text(s.first_frequency, 'Hz', 4)}; {dynamics}"


def _drives(s: PlateSummary) -> str:
    drives, strokes = (_range(ratios or ()) for ratios in (s.drives_over_first, s.strokes_over_first))
    return f"drive frequency / first frequency: {drives}; stroke rate / first frequency: {strokes}"


def _range(ratios: Sequence[float]) -> str:
    """The smallest and the largest ratio, or one where they are equal."""
    return "-".join(dict.fromkeys(f"{ratio:.2g}" for ratio in ratios))


def _top_face(share: float) -> str:
    added = f"{_in_percent(share)} of" if share < 2 else f"{share:.3g} times"
    return f"top face and centre of mass add {added} the mid-plane's pull on the part"


def _percent(share: float) -> str:
    return "more than 50 %" if share > 0.5 else f"about {100 * share:.2g} %"


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"
