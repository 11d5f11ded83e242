"""Curves over time in the picture of a run, with shades for rest and flight, and its events as marks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from textwrap import fill
from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from common import NOTHING, Unit, quantity_text, unit_for
from coupling.pictures.figure import plain_ticks
from coupling.pictures.portrait import Portrait
from particle import PATH_COLOUR, EventKind, Rows, shade

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
CROWDED, STEP = 2.0, 2.5  # points: between turns of a curve that becomes a band; the least width of a step of this
FAR = 3.0  # times its extent a path is from the origin: then displacements are shown
THIN = 0.06  # of the values' range: a band that is mostly lower is drawn as its line
MANY, BAND = 20, 0.35  # cycles of a drive whose steps are whole cycles; how opaque a band is


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
    samples = portrait.samples
    friction = Curves("friction", "N", {"": samples.friction_force}, samples.time)
    speed = f"speed {'on ' + portrait.summary.origin if portrait.base else 'in the plane'}"
    curves = [strokes_of(portrait), margins_over_time(portrait), *film_over_time(portrait)]
    curves += [friction] * bool(samples.friction_force.any())
    curves += velocities_of(portrait) or [Curves(speed, "m/s", {"": np.hypot(*samples.velocity.T)}, samples.time)]
    return [one for one in curves if one is not None]


def all_curves_of(portrait: Portrait) -> list[Curves]:
    """All that is known over time: where the part is and how fast, too, and the load."""
    samples, times = portrait.samples, portrait.samples.time
    way, relative = samples.position - samples.position[0], "relative " if portrait.base else ""
    moved = np.abs(samples.position).max() > FAR * max(float(np.ptp(samples.position, axis=0).max()), NOTHING)
    vectors = (
        (relative + ("displacement" if moved else "position"), "m", way if moved else samples.position),
        (f"{relative}velocity", "m/s", samples.velocity),
    )
    position, velocity = (
        Curves(label, si, dict(zip(("along x", "along y"), rows.T, strict=True)), times) for label, si, rows in vectors
    )
    forces = {"normal load": samples.normal_force, "friction": samples.friction_force}
    curves = [position, strokes_of(portrait), velocity, *velocities_of(portrait), margins_over_time(portrait)]
    curves += [Curves(label, "N", {"": force}, times) for label, force in forces.items()]
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
    """The pull over the friction limit and, on a scale of its own, the distance from pull-off; None: there is none."""
    times, slip, contact = portrait.margins
    unit = "pull-off force" if portrait.summary.margins.by_pull_off else "weight"
    off = Curves("distance from coming off", unit, {"distance from coming off": contact}, times, marked=0.0)
    has_slip, has_contact = np.isfinite(slip).any(), np.isfinite(contact).any()
    if not has_slip:
        return off if has_contact else None
    return Curves("pull", "friction limit", {"pull": slip}, times, marked=1.0, right=off if has_contact else None)


def film_over_time(portrait: Portrait) -> list[Curves]:
    """What asperities and a film of air bear, and the gap; none without a film."""
    samples = portrait.samples
    if samples.gap is None or samples.air_force is None:
        return []
    loads = {"asperities": samples.normal_force - samples.air_force, "air": samples.air_force}
    return [Curves("load", "N", loads, samples.time), Curves("gap", "m", {"": samples.gap}, samples.time)]


def velocities_of(portrait: Portrait) -> list[Curves]:
    """Where the surface moves in its plane, without a turn, the velocities of part and platform along its axes."""
    samples, curves = portrait.samples, []
    if len(portrait.base) > 2:  # which velocities relative to the platform turn with
        return []
    for name, drive, relative in zip("xy", portrait.base, samples.velocity.T, strict=False):
        velocity = drive.evaluate(samples.time * (1 - 1e-12))[1]
        if velocity.any():
            values = {"part": velocity + relative, "platform": velocity}
            curves.append(Curves(f"velocity along {name}", "m/s", values, samples.time))
    return curves


def draw_over_time(
    axes: Axes,
    rows: Rows,
    curves: Curves,
    time_unit: Unit,
    span: Span | None = None,
    cycles: Sequence[float] = (),
    labelled: tuple[bool, bool] = (True, True),
) -> list[Artist]:
    """Draw curves over a span of time [s], with shades where the part does not slip; None: all of it.

    cycles: of the drives [s].  labelled: whether the left and the right axis have their labels.
    Returns keys of what is not a line.
    """
    span = span or (0.0, float(rows.time[-1]))
    keys = _draw_lines(axes, curves, time_unit, span, cycles, 0)
    shade(axes, rows, time_unit.per_si)
    axes.set_xlim(span[0] * time_unit.per_si, span[1] * time_unit.per_si)
    axes.grid(alpha=0.3)
    sides = [axes]
    if curves.right is not None:
        sides.append(axes.twinx())
        keys += _draw_lines(sides[1], curves.right, time_unit, span, cycles, 1)
        for side, (colour, _) in zip(sides, LOOKS, strict=False):
            side.yaxis.label.set_color(colour)
            side.tick_params(axis="y", colors=colour)
    for side, shown in zip(sides, labelled, strict=False):
        if not shown:
            side.set_ylabel("")
    return keys


def _draw_lines(
    axes: Axes, curves: Curves, time_unit: Unit, span: Span, cycles: Sequence[float], first: int
) -> list[Artist]:
    everything = np.concatenate(list(curves.values.values()))
    everything = everything[np.isfinite(everything)]
    unit = Unit(curves.si, 1.0) if curves.marked is not None else unit_for(everything, curves.si)
    keys: list[Artist] = []
    for (name, values), (colour, style) in zip(curves.values.items(), LOOKS[first:], strict=False):
        look: dict[str, Any] = {"color": colour, "linestyle": style, "linewidth": 1.2, "label": name}
        width = _bin_width(axes, curves.times, values, span, cycles)
        if width and _draw_band(axes, curves.times, values * unit.per_si, time_unit, span, width, look):
            keys = [Patch(facecolor="#808080", alpha=BAND, label=_band_text(width, cycles, span))]
        else:
            axes.plot(curves.times * time_unit.per_si, values * unit.per_si, **look)
    if len(curves.values) > 1:
        axes.legend(
            handles=axes.get_lines(),
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
    return keys


def _bin_width(axes: Axes, times: FloatArray, values: FloatArray, span: Span, cycles: Sequence[float]) -> float:
    """How long [s] a step of the band is that a curve which turns too often to be followed fills; 0: it is followed.

    It is whole cycles of the slowest drive of those with many in the span: pieces of cycles would beat with the drive.
    """
    inside = values[(times >= span[0]) & (times <= span[1]) & np.isfinite(values)]
    turns = int(np.count_nonzero(np.diff(np.sign(np.diff(inside)))))
    points = 72 * axes.get_position().width * axes.figure.bbox.width / axes.figure.dpi
    if turns * CROWDED < points:
        return 0.0
    width = STEP * (span[1] - span[0]) / points
    cycle = _cycle(cycles, span)
    return cycle * math.ceil(width / cycle) if cycle else width


def _cycle(cycles: Sequence[float], span: Span) -> float:
    """The longest cycle [s] of those that a span has many of; 0: there is none."""
    return max((one for one in cycles if one * MANY <= span[1] - span[0]), default=0.0)


def _draw_band(
    axes: Axes, times: FloatArray, values: FloatArray, time_unit: Unit, span: Span, width: float, look: dict[str, Any]
) -> bool:
    """Draw from the lowest to the highest of a curve in each step of time so wide [s], unless that is thin."""
    bins = max(int((span[1] - span[0]) / width + 0.01), 1)  # the last one also has what is left over
    edges = np.append(span[0] + width * np.arange(bins), span[1])
    known = (times >= span[0]) & (times <= span[1]) & np.isfinite(values)
    number = np.clip(np.searchsorted(edges, times[known], side="right") - 1, 0, bins - 1)
    low, high = np.full(bins + 1, np.inf), np.full(bins + 1, -np.inf)
    np.minimum.at(low, number, values[known])
    np.maximum.at(high, number, values[known])
    low[np.isinf(low)] = np.nan
    high[np.isinf(high)] = np.nan
    if np.nanmedian(high[:-1] - low[:-1]) < THIN * np.ptp(values[known]):
        return False
    low[-1], high[-1] = low[-2], high[-2]
    band: dict[str, Any] = {"color": look["color"], "alpha": BAND, "linewidth": 0.5}  # seen where it is flat
    axes.fill_between(edges * time_unit.per_si, low, high, step="post", **band)
    axes.plot([], [], **look)  # its key
    return True


def _band_text(width: float, cycles: Sequence[float], span: Span) -> str:
    """What a band is, in words."""
    time = quantity_text(width, "s")
    cycle = _cycle(cycles, span)
    if not cycle:
        return f"lowest to highest in each {time}"
    count = round(width / cycle)
    of = " of the slowest drive" if len(cycles) > 1 else ""
    return f"lowest to highest in {'each cycle' if count == 1 else f'{count} cycles'}{of}, {time}"


def limits(values: FloatArray) -> tuple[float, float]:
    """The limits of an axis for values in a suitable unit; 0 lies between them."""
    low, high = min(float(values.min()), 0.0), max(float(values.max()), 0.0)
    if high - low < NOTHING:
        high = 1.0
    return low - MARGIN * (high - low), high + MARGIN * (high - low)


class Mark(NamedTuple):
    """How an event is drawn and named."""

    marker: str
    colour: str
    text: str
    afterwards: str = ""  # of a part that it lost


MARKS: Final[dict[EventKind, Mark]] = {
    EventKind.SLIPS: Mark(">", "black", "slips"),
    EventKind.STOPS: Mark("s", "black", "stops"),
    EventKind.REVERSES: Mark("D", "white", "turns back"),
    EventKind.DETACHES: Mark("*", "white", "comes off", "came off"),
    EventKind.LANDS: Mark("v", "white", "lands"),
    EventKind.LEAVES_PLATE: Mark("X", "white", "leaves the plate", "left the plate"),
    EventKind.OVERLOADS: Mark("P", "white", "overload", "overloaded"),
    EventKind.TIPS: Mark("p", "white", "tips", "tipped"),  # "^" is an actuator
}
APART = 3.5  # points: nearer to each other, marks of events merge
OFTEN = (EventKind.SLIPS, EventKind.STOPS)  # where shades begin and end in any case


def draw_events(
    axes: Axes, portrait: Portrait, per_second: float, width: float, span: tuple[float, float] | None = None
) -> list[Artist]:
    """Draw a strip of states with a mark for each event, or for rare ones where all would merge; return keys.

    width: of the axes [points].  span: of time that is shown [s]; None: all.
    """
    shade(axes, portrait.rows, per_second)
    axes.set_yticks([])
    axes.set_ylim(0, 1)
    axes.tick_params(bottom=False, labelbottom=False)
    begin, end = span or (0.0, float(portrait.rows.time[-1]))
    events = [event for event in portrait.events if begin <= event.time <= end]
    keys: list[Artist] = []
    for kind, (marker, colour, text, _) in MARKS.items():
        times = [event.time for event in events if event.kind is kind]
        if not times or (kind in OFTEN and len(events) > width / APART):
            continue
        look: dict[str, Any] = {"marker": marker, "color": colour, "markeredgecolor": "black", "linestyle": ""}
        look |= {"markersize": APART, "markeredgewidth": 0.6}
        axes.plot(np.array(times) * per_second, np.full(len(times), 0.5), **look, clip_on=False)
        keys.append(Line2D([], [], **look, label=text))
    return keys
