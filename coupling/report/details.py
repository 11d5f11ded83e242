"""Details: the rest of the summary, as `--verbose` prints it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from common import quantity_text
from coupling.measured import MotionFit
from coupling.plate_figures import StretchError, VibrationFigures
from coupling.report.wording import MICRO, MILLI, count, in_percent, quantity
from coupling.summary import PlateSummary, Summary

MAX_LISTED = 8  # jumps of a measured motion


def details(s: Summary) -> list[tuple[str, str]]:
    """Rows (label, text) on how the run was computed, and where it is in the model's bounds."""
    tabulated = f"; friction tabulated to {s.contact_error:.1e}" if s.contact_error > 0 else ""
    if isinstance(s, PlateSummary):
        rows = [
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
        rows = [("surface", f"a flat, rigid platform{tabulated}")]
    rows += [("", text) for fit in s.motion_fits for text in _fit(fit)]
    if s.drive_error > 0:
        rows.append(("", f"drives follow their motion to {s.drive_error:.1e} of the stroke"))
    rows.append(("integrator", count(s.evaluations, "evaluation")))
    return rows + (_model(s) if isinstance(s, PlateSummary) else [])


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
        rows.append(("", f"part size times curvature {s.part_curvature:.2g}"))
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
    added = f"{in_percent(share)} of" if share < 2 else f"{share:.3g} times"
    return f"top face and centre of mass add {added} the mid-plane's pull on the part"
