"""Curves over time in the picture of a run, with shades where the part is stuck or in flight."""

from __future__ import annotations

from dataclasses import dataclass, field
from textwrap import fill
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from common import NOTHING, Unit, unit_for
from coupling.pictures.figure import plain_ticks
from coupling.pictures.portrait import Portrait
from particle import PATH_COLOUR, Rows, shade

FloatArray = NDArray[np.float64]
Span = tuple[float, float]

MARGIN = 0.05  # of the values' range, above and below
LOOKS: Final[tuple[tuple[str, Any], ...]] = (
    ("black", "-"),
    (PATH_COLOUR, "--"),
    ("#1b4f9c", "-."),
    ("#2d7d46", ":"),
    ("#7a4b94", (0, (6, 1.5))),
)
NARROW = 4.0  # inches: a figure with two keys a line
LETTERS = 18  # of a line of a label
CROWDED, STEP = 2.0, 2.5  # points: between turns of a curve that becomes a band; the width of a step of this


@dataclass(frozen=True, eq=False)
class Curves:
    """What one pair of axes shows over time."""

    label: str
    si: str  # unit, or in words what numbers are over
    values: dict[str, FloatArray]  # by name, (k,) each
    times: FloatArray  # (k,) s
    marked: float | None = None  # of numbers, the limit, with a line across
    right: Curves | None = field(default=None)  # on a scale of its own, at the right


def curves_of(portrait: Portrait) -> list[Curves]:
    """What explains the motion, from the top: strokes, margins, friction, and speed or a platform's velocities."""
    samples, times = portrait.samples, portrait.samples.time
    curves = [strokes_of(portrait), margins_over_time(portrait)]
    if samples.friction_force.any():
        curves.append(Curves("friction", "N", {"": samples.friction_force}, times))
    moving = velocities_of(portrait)
    speed = f"speed {'on ' + portrait.origin if portrait.base else 'in the plane'}"
    curves += moving or [Curves(speed, "m/s", {"": np.hypot(*samples.velocity.T)}, times)]
    return [one for one in curves if one is not None]


def strokes_of(portrait: Portrait) -> Curves | None:
    """The heights of drives and part; None: neither leaves 0."""
    samples = portrait.samples
    times = samples.time * (1 - 1e-12)  # just before the end of a motion, where it may jump
    values = {name: drive.evaluate(times)[0] for name, drive in portrait.drives.items()}
    values["part"] = samples.height
    values = {name: height for name, height in values.items() if height.any()}
    return Curves("height", "m", values, samples.time) if values else None


def margins_over_time(portrait: Portrait) -> Curves | None:
    """The pull over what friction holds and, on a scale of its own, the distance from pull-off; None: there is none."""
    times, slip, contact = portrait.margins
    unit = "pull-off force" if portrait.by_pull_off else "weight"
    off = Curves("distance from coming off", unit, {"distance from coming off": contact}, times, marked=0.0)
    has_slip, has_contact = np.isfinite(slip).any(), np.isfinite(contact).any()
    if not has_slip:
        return off if has_contact else None
    return Curves("pull", "friction limit", {"pull": slip}, times, marked=1.0, right=off if has_contact else None)


def velocities_of(portrait: Portrait) -> list[Curves]:
    """Where the surface moves in its plane, the velocities of part and platform along its axes."""
    samples, curves = portrait.samples, []
    for name, drive, relative in zip("xy", portrait.base, samples.velocity.T, strict=False):
        velocity = drive.evaluate(samples.time * (1 - 1e-12))[1]
        if velocity.any():
            values = {"part": velocity + relative, "platform": velocity}
            curves.append(Curves(f"velocity along {name}", "m/s", values, samples.time))
    return curves


def draw_over_time(axes: Axes, rows: Rows, curves: Curves, time_unit: Unit, span: Span | None = None) -> Axes | None:
    """Draw curves over a span of time [s], with shades where the part does not slip; None: all of it.

    Returns the axes of curves with a scale of their own.
    """
    begin, end = span or (0.0, float(rows.time[-1]))
    _draw_lines(axes, curves, time_unit, (begin, end), 0)
    shade(axes, rows, time_unit.per_si)
    axes.set_xlim(begin * time_unit.per_si, end * time_unit.per_si)
    axes.grid(alpha=0.3)
    if curves.right is None:
        return None
    other = axes.twinx()
    _draw_lines(other, curves.right, time_unit, (begin, end), 1)
    for side, colour in ((axes, LOOKS[0][0]), (other, LOOKS[1][0])):
        side.yaxis.label.set_color(colour)
        side.tick_params(axis="y", colors=colour)
    return other


def _draw_lines(axes: Axes, curves: Curves, time_unit: Unit, span: Span, first: int) -> None:
    everything = np.concatenate(list(curves.values.values()))
    everything = everything[np.isfinite(everything)]
    unit = Unit(curves.si, 1.0) if curves.marked is not None else unit_for(everything, curves.si)
    for (name, values), (colour, style) in zip(curves.values.items(), LOOKS[first:], strict=False):
        look: dict[str, Any] = {"color": colour, "linestyle": style, "linewidth": 1.2, "label": name}
        _draw_line(axes, curves.times * time_unit.per_si, values * unit.per_si, np.array(span) * time_unit.per_si, look)
    if len(curves.values) > 1:
        axes.legend(
            frameon=False,
            fontsize="small",
            loc="lower left",
            bbox_to_anchor=(0, 0.97),
            ncols=2 if axes.figure.bbox.width < NARROW * axes.figure.dpi else len(curves.values),
            borderpad=0.1,
            handlelength=1.6,
            columnspacing=1.0,
        )
    if curves.marked is not None:
        axes.axhline(curves.marked, color=LOOKS[first][0], linestyle=":", linewidth=1.0, label="limit")
        everything = np.append(everything, curves.marked)
    plain_ticks(axes)
    axes.set_ylim(*limits(everything * unit.per_si))
    if np.abs(everything).max() < NOTHING:
        axes.set_yticks([0])
    text = f"{curves.label} [{unit.name}]"
    axes.set_ylabel(text if len(text) <= LETTERS else f"{fill(curves.label, LETTERS)}\n[{unit.name}]")


def _draw_line(axes: Axes, times: FloatArray, values: FloatArray, span: FloatArray, look: dict[str, Any]) -> None:
    """Draw a curve, or of one that turns too often to be followed, the band that it fills."""
    inside = (times >= span[0]) & (times <= span[1])
    turns = int(np.count_nonzero(np.diff(np.sign(np.diff(values[inside & np.isfinite(values)])))))
    width = 72 * axes.get_position().width * axes.figure.bbox.width / axes.figure.dpi
    if turns * CROWDED < width:
        axes.plot(times, values, **look)
        return
    bins = int(width / STEP)
    edges = np.linspace(span[0], span[1], bins + 1)
    number = np.clip(np.searchsorted(edges, times[inside], side="right") - 1, 0, bins - 1)
    low, high = np.full(bins, np.inf), np.full(bins, -np.inf)
    known = np.isfinite(values[inside])
    np.minimum.at(low, number[known], values[inside][known])
    np.maximum.at(high, number[known], values[inside][known])
    low[np.isinf(low)] = high[np.isinf(high)] = np.nan
    low, high = np.append(low, low[-1:]), np.append(high, high[-1:])
    axes.fill_between(edges, low, high, step="post", color=look["color"], alpha=0.35, linewidth=0)
    axes.plot([], [], **look)  # its key


def limits(values: FloatArray) -> tuple[float, float]:
    """The limits of an axis for values in a suitable unit; 0 lies between them."""
    low, high = min(float(values.min()), 0.0), max(float(values.max()), 0.0)
    if high - low < NOTHING:
        high = 1.0
    return low - MARGIN * (high - low), high + MARGIN * (high - low)
