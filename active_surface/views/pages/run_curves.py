"""The curves of a run as its page has them: what is drawn over time, with the moments of the smallest margins."""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

from active_surface.arrays import FloatArray, IntArray
from active_surface.views.geometry import cut_in
from active_surface.views.pages.packed import packed
from common import Unit, unit_for
from coupling import Margin, Summary, build_friction, least_pressure, report, silent, summary_of
from coupling.case import PlatformCase
from coupling.pictures import chosen_drives
from coupling.results import SavedRun
from coupling.scene import lifts_of, platform_scene
from particle import EventKind, State

MAX_POINTS: Final = 20_000  # of a curve
BEND: Final = 2e-3  # of the largest velocity: less is not seen
MAX_PIECES: Final = 16  # of a curve between two rows
PLATE: Final = "the plate"


def curves_of(run: SavedRun, along: Unit) -> dict[str, Any]:
    """What is drawn over time: `panels`, one pair of axes each, and their `times`; along: the unit of positions."""
    panels = _panels(run, along)
    times = list({panel["time"]["bytes"]: panel["time"] for panel in panels}.values())
    return {"times": times, "panels": [panel | {"time": times.index(panel["time"])} for panel in panels]}


def _panels(run: SavedRun, along: Unit) -> list[dict[str, Any]]:
    summary = summary_of(run.summary)
    times, position, velocity = smooth_path(run)
    over = f"of the part over {run.summary['origin']}" if counted(run) else "of the part, in fixed axes"
    panels = [
        _panel("Position", along, *_fewer(times, {f"{c}{counted(run)}": position[:, k] for k, c in enumerate("xy")})),
        _panel("Velocity", "m/s", *_fewer(times, {f"along {c}": velocity[:, k] for k, c in enumerate("xy")}), over),
    ]
    moments, slip, contact = run.margins
    margins = summary.margins
    lifts = [platform_scene(plate, silent).lifts[0]] if isinstance(plate := run.case.plate, PlatformCase) else None
    drives = chosen_drives(run.case, lifts or lifts_of(run.case), margins)
    heights = {name: drive.evaluate(moments)[0] for name, drive in drives.items()}
    if any(height.any() for height in heights.values()):
        panels.append(_panel("Strokes", "m", *_fewer(moments, heights)))
    if np.isfinite(slip).any():
        pull = _panel("Pull", Unit("of limit", 1.0), *_fewer(moments, {"while stuck, over the friction limit": slip}))
        panels.append(pull | {"limit": 1.0} | _marked(run, summary, "slip", margins.slip))
    if np.isfinite(contact).any():
        unit = Unit("of pull-off" if margins.by_pull_off else "of weight", 1.0)
        distance = _panel("Distance", unit, *_fewer(moments, {"from coming off": contact}))
        panels.append(distance | {"limit": 0.0} | _marked(run, summary, "contact", margins.contact))
    else:
        panels.append(_panel("Load", "N", *_fewer(*_rows(run, "normal_force", "normal"))))
    if run.heading is not None:
        turned = _fewer(*_rows(run, "heading", "counter-clockwise from x"))
        panels.insert(1, _panel("Heading", Unit("degrees", math.degrees(1.0)), *turned))
        pull_off, (moments, order) = build_friction(run.case).pull_off, _merged(run)
        found = [(np.asarray(one.pressure_margin), one.normal_force, one.air_force) for one in (run, run.rows)]
        least = np.concatenate([least_pressure(*one, pull_off) for one in found])[order]
        if np.isfinite(least).any():
            under = _fewer(moments, {"least under the part": least})
            panels.append(_panel("Pressure", Unit("of mean", 1.0), *under) | {"limit": 0.0})
    panels.append(_panel("Friction", "N", *_fewer(*_rows(run, "friction_force", "on the part"))))
    return panels


def counted(run: SavedRun) -> str:
    """What positions are counted from, if it is not the plate."""
    origin = run.summary.get("origin", PLATE)
    return "" if origin == PLATE else f" on {origin}"


def smooth_path(run: SavedRun) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Times (k,) [s], positions (k, 2) [m] and velocities (k, 2) [m/s], so many that lines between them look smooth.

    They are the stored steps and the integrator's rows. Between two of these the position is the cubic with the
    positions and velocities at both, and the velocity is its derivative: so the mean velocity is right.
    """
    times, order = _merged(run)
    p = np.concatenate([run.position[:, :2], run.rows.position])[order]
    v = np.concatenate([run.velocity[:, :2], run.rows.velocity])[order]
    state = np.concatenate([run.state, run.rows.state])[order]
    span = np.diff(times)[:, None]
    bend = 6 * (np.diff(p, axis=0) / span - (v[1:] + v[:-1]) / 2)  # the quadratic's part of the velocity
    largest = float(np.abs(v).max(initial=0.0)) or 1.0
    known = 6 * float(run.summary["path_resolution"]) / span[:, 0] < BEND * largest  # not from the error of a position
    bend[(state[:-1] != State.SLIP) | ~known] = 0.0
    counts = np.ceil(np.sqrt(np.abs(bend).max(axis=1) / (4 * BEND * largest))).clip(1, MAX_PIECES).astype(np.int64)
    number, share = cut_in(counts)
    s, h = share[:, None], span[number]
    velocity = v[number] * (1 - s) + v[number + 1] * s + bend[number] * s * (1 - s)
    gone = v[number] * (s - s**2 / 2) + v[number + 1] * s**2 / 2 + bend[number] * (s**2 / 2 - s**3 / 3)
    held = (state == State.FLIGHT) | ((state == State.STICK) & ~v.any(axis=1))  # at one velocity up to the next row
    jumps = held[:-1] & (np.abs(np.diff(v, axis=0)).max(axis=1) > BEND * largest)
    before = np.cumsum(counts)[jumps]
    columns = (
        (times[number] + share * h[:, 0], times, times[1:][jumps]),
        (p[number] + h * gone, p, p[1:][jumps]),
        (velocity, v, v[:-1][jumps]),
    )
    t, x, u = (np.insert(np.concatenate([cut, row[-1:]]), before, last, axis=0) for cut, row, last in columns)
    return t, x, u


def _merged(run: SavedRun) -> tuple[FloatArray, IntArray]:
    """The times (k,) [s] of the steps and then of the rows, in order, and their numbers; of equal ones the last."""
    times = np.concatenate([run.time, run.rows.time])
    order = np.argsort(times, kind="stable")
    order = order[times[order] <= run.time[-1]]
    order = order[np.append(np.diff(times[order]) > 0, True)]
    return times[order], order


def _rows(run: SavedRun, name: str, text: str) -> tuple[FloatArray, dict[str, FloatArray]]:
    """A number of the part at steps and rows."""
    times, order = _merged(run)
    return times, {text: np.concatenate([getattr(run, name), getattr(run.rows, name)])[order]}


def _marked(run: SavedRun, summary: Summary, which: str, margin: Margin | None) -> dict[str, Any]:
    """The moment of the smallest margin, slip or contact, as a mark on its curve, and what the report says of it."""
    if margin is None or not np.isfinite(margin.value) or margin.time > run.time[-1]:
        return {}
    if which == "slip":
        name = "first slip" if any(event.kind is EventKind.SLIPS for event in run.events) else "nearest to slipping"
    else:
        name = "nearest to coming off" if margin.value > 0 else "comes off"
    said = next((line for _, line in report.margin_lines(summary) if line.startswith(which)), "")
    return {"least": {"time": margin.time, "value": margin.value, "name": name, "text": report.with_micro_signs(said)}}


def _panel(
    label: str, unit: str | Unit, times: FloatArray, values: dict[str, FloatArray], note: str = ""
) -> dict[str, Any]:
    """Axes with curves (k,) at times (k,) [s] in SI units; unit: of these, or the one that is shown."""
    if isinstance(unit, str):
        everything = np.concatenate(list(values.values()))
        unit = unit_for(everything, unit)
    lines = [{"name": name, "values": packed(v * unit.per_si, "f4")} for name, v in values.items()]
    return {"label": label, "unit": unit.name, "note": note, "lines": lines, "time": packed(times, "f8")}


def _fewer(times: FloatArray, values: dict[str, FloatArray]) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Curves with at most MAX_POINTS points: of the points of each piece of time its lowest and highest."""
    if len(times) <= MAX_POINTS:
        return times, values
    size = -(-2 * len(times) // MAX_POINTS)
    starts = np.arange(0, len(times), size)
    low, high = ({name: limit.reduceat(v, starts) for name, v in values.items()} for limit in (np.fmin, np.fmax))
    both = {name: np.stack([low[name], high[name]], axis=1).ravel() for name in values}
    ends = np.append(starts[1:], len(times)) - 1
    return np.stack([times[starts], times[ends]], axis=1).ravel(), both
