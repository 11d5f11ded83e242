"""The picture of a feasibility: a chart over frequency and stroke, a map of the plate, and areas over frequency."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from active_surface.arrays import FloatArray
from active_surface.studies.feasibility.area import Feasible
from active_surface.studies.feasibility.result import Feasibility
from common import Drawing, draw, quantity_text, unit_for
from coupling.pictures import PlateView, draw_plate, put_title

GREEN, PALE_RED, RED, BLUE, GREY, UNKNOWN = "#8cc7a1", "#e8b0a4", "#c8371b", "#40719c", "#8a8a8a", "#d6d6d6"
PARTS: Final = 12  # of the way from one column of the chart to the next
AROUND: Final = 1.8  # times what is drawn: the ends of the axis of strokes, at most to those looked at and the case
ABOVE: Final = 1.2  # times the case: room for its mark below the title
CURVES: Final = 2.0  # times the largest useful area: the end of the axis, at most
SMALLEST: Final = 1e-6  # m: areas are in the square of this at least


@draw.register(Feasibility)
def draw_feasibility(feasibility: Feasibility, picked: tuple[float, float] | None = None) -> Figure:
    """Draw a feasibility, with a picked frequency [Hz] and stroke [m or N]."""
    areas = feasibility.areas
    figure = Drawing(figsize=(6.5, 6.2) if areas is None else (13.0, 9.4))
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.08)
    if areas is None:
        _draw_chart(figure.add_subplot(), feasibility, picked)
    else:
        grid = figure.add_gridspec(2, 2, height_ratios=(1.9, 1), width_ratios=(1, 1))
        _draw_chart(figure.add_subplot(grid[0, 0]), feasibility, picked)
        _draw_map(figure, figure.add_subplot(grid[0, 1]), feasibility, areas)
        _draw_curves(figure.add_subplot(grid[1, 0]), figure.add_subplot(grid[1, 1]), feasibility, areas)
    put_title(
        figure,
        f"{feasibility.case.name}: fastest drive {quantity_text(feasibility.frequency, 'Hz', 4)}, largest stroke "
        f"{quantity_text(feasibility.stroke, feasibility.stroke_unit, 4)}",
    )
    return figure


def _draw_chart(axes: Axes, feasibility: Feasibility, picked: tuple[float, float] | None = None) -> None:
    """Draw the chart with its case, and a picked frequency [Hz] and stroke [m or N], as points."""
    chart, own = feasibility.chart, (feasibility.frequency, feasibility.stroke)
    ends = [one.frequency for one in chart.columns]
    within = [np.geomspace(a, b, PARTS + 1)[:-1] for a, b in zip(ends, ends[1:], strict=False)]
    factors = np.append(np.concatenate(within), ends[-1])
    limits = [chart.limits(k) for k in factors.tolist()]
    strokes = feasibility.stroke * np.array([(*one.slips, *one.lost) for one in limits])  # (n, 4)
    columns = feasibility.stroke * np.array([(one.slips, one.all_lost) for one in chart.columns])
    looked_at = feasibility.stroke * np.array(chart.strokes)
    low, high = _ends(columns, own[1], looked_at)
    unit, length = unit_for(feasibility.frequency * factors, "Hz"), unit_for(high, feasibility.stroke_unit)
    x, y = feasibility.frequency * factors * unit.per_si, np.clip(strokes, low / 2, 2 * high) * length.per_si
    bottom, top = low * length.per_si, high * length.per_si
    # From the upper of what slip may begin at to the lower of what losses may begin at it moves for certain.
    axes.fill_between(x, y[:, 1], np.maximum(y[:, 2], y[:, 1]), color=GREEN, linewidth=0)
    axes.fill_between(x, np.maximum(y[:, 3], y[:, 1]), 2 * top, color=PALE_RED, linewidth=0)
    undecided: dict[str, Any] = {"facecolor": PALE_RED, "edgecolor": "white", "hatch": "////"}
    either = y[:, 1::2] > 1.011 * y[:, ::2]  # (n, 2): whether it slips, and whether it is lost
    for n in (0, 1):
        axes.fill_between(x, y[:, 2 * n], y[:, 2 * n + 1], where=either[:, n], **undecided, linewidth=0, step="mid")
    axes.plot(x, y[:, 1], color="black", linewidth=1.4)
    axes.plot(x, y[:, 2], color=RED, linewidth=1.4)
    keys: list[Artist] = [
        Patch(facecolor=GREEN, label="it moves"),
        Patch(facecolor=PALE_RED, label="it is lost"),
        Line2D([], [], color="black", linewidth=1.4, label="it slips from here"),
        Line2D([], [], color=RED, linewidth=1.4, label="it is lost from here"),
    ]
    if either.any():
        keys.append(Patch(**undecided, label="undecided"))
    keys += _draw_validity(axes, feasibility, np.array(ends), (bottom, top), unit.per_si, length.per_si)
    if low < looked_at[0] or high > looked_at[1]:
        for beyond in ((bottom / 2, looked_at[0] * length.per_si), (looked_at[1] * length.per_si, 2 * top)):
            axes.axhspan(*beyond, color=UNKNOWN, linewidth=0, zorder=2.4)  # over lines, below the frame
        keys.append(Patch(facecolor=UNKNOWN, label="not looked at"))
    keys.append(_point(axes, own, unit.per_si, length.per_si, "o", "white", "the case"))
    if picked is not None:
        keys.append(_point(axes, picked, unit.per_si, length.per_si, "*", "gold", "picked"))
    _scales(axes, (x[0], x[-1]), (bottom, top))
    axes.set_xlabel(f"frequency of the fastest drive [{unit.name}]")
    axes.set_ylabel(f"{'force' if feasibility.stroke_unit == 'N' else 'stroke'} of the largest drive [{length.name}]")
    axes.set_title(f"from the case's start, {quantity_text(feasibility.ground.duration, 's', 4)}", fontsize=10)
    axes.legend(
        handles=keys,
        loc="upper center",
        bbox_to_anchor=(0.5, -0.12),
        ncols=3,
        frameon=False,
        fontsize=8,
        handleheight=1.2,
    )


def _ends(columns: FloatArray, own: float, strokes: FloatArray) -> tuple[float, float]:
    """The least and the largest stroke drawn: around the borders and the case, of those looked at and to the case."""
    drawn = np.append(columns[np.isfinite(columns)], own)
    return max(drawn.min() / AROUND, min(strokes[0], own)), min(drawn.max() * AROUND, max(strokes[1], own * ABOVE))


def _draw_validity(
    axes: Axes, feasibility: Feasibility, ends: FloatArray, view: tuple[float, float], per_hertz: float, per_si: float
) -> list[Artist]:
    """Dots above a dashed line, up to which strokes the model is valid; returns their key."""
    valid = np.clip(feasibility.stroke * feasibility.valid * per_si, view[0] / 2, 2 * view[1])
    if (valid >= view[1] * (1 - 1e-9)).all():
        return []
    x = ends * feasibility.frequency * per_hertz
    axes.fill_between(x, valid, 2 * view[1], facecolor="none", edgecolor="#00000055", hatch=".", linewidth=0.0)
    axes.plot(x, valid, "--", color="#333333", linewidth=1.0)
    linear = feasibility.ground.linear
    what = "deflection > 0.2 thickness, slope > 0.2" if linear else "slope > 0.2"
    look: dict[str, Any] = {"facecolor": "none", "edgecolor": "#333333", "hatch": "...", "linestyle": "--"}
    return [Patch(**look, label=f"beyond the model:\n{what}")]


def _point(
    axes: Axes, point: tuple[float, float], per_hertz: float, per_si: float, marker: str, colour: str, label: str
) -> Artist:
    """Mark a frequency [Hz] and a stroke; returns the key."""
    style: dict[str, Any] = {"marker": marker, "color": colour, "markeredgecolor": "black", "linestyle": "none"}
    size = 14 if marker == "*" else 9
    axes.plot(point[0] * per_hertz, point[1] * per_si, markersize=size, zorder=5, clip_on=False, **style)
    return Line2D([], [], markersize=size * 0.8, label=label, **style)


def _scales(axes: Axes, x: tuple[float, float], y: tuple[float, float]) -> None:
    """Logarithmic axes with plain numbers."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(*x)
    axes.set_ylim(*y)
    for axis, ends in ((axes.xaxis, x), (axes.yaxis, y)):
        axis.set_major_locator(LogLocator(subs=(1, 2, 5) if ends[1] / ends[0] < 1000 else (1,)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())
    axes.grid(alpha=0.25)


def _draw_map(figure: Figure, axes: Axes, feasibility: Feasibility, areas: Feasible) -> None:
    unit = unit_for(feasibility.outline.box, "m")
    x, y, share = _grid(areas, np.where(areas.own.lost, np.nan, 100 * areas.own.shares))
    half = areas.spacing / 2
    edges = [np.append(side - half, side[-1] + half) * unit.per_si for side in (x, y)]
    slipping = np.ma.masked_where(~(share > 0), share)
    mesh = axes.pcolormesh(*edges, slipping.T, cmap="viridis", vmin=0)
    lost = _grid(areas, np.where(areas.own.lost, 1.0, np.nan))[2]
    axes.pcolormesh(*edges, np.ma.masked_invalid(lost).T, cmap=ListedColormap([RED]), vmin=0, vmax=1)
    if slipping.count():
        figure.colorbar(mesh, ax=axes, label="share of the time in which the part slips [%]", shrink=0.8)
    keys: list[Artist] = [Patch(facecolor="white", edgecolor="black", label="the part stays at rest")]
    if areas.own.lost.any():
        keys.append(Patch(facecolor=RED, label="it comes off at some moment"))
    keys += draw_plate(axes, PlateView(feasibility.outline, feasibility.actuators), unit)
    axes.set_title(f"any start, at the case's drives, {quantity_text(areas.window, 's', 4)}", fontsize=10)
    axes.legend(handles=keys, loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=3, frameon=False, fontsize=9)


def _grid(areas: Feasible, values: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The squares' centres along x (n,) and y (m,) and values (n, m), nan where there is no plate."""
    low = areas.points.min(axis=0)
    rows = np.rint((areas.points - low) / areas.spacing).astype(int)
    table = np.full(rows.max(axis=0) + 1, np.nan)
    table[rows[:, 0], rows[:, 1]] = values
    x, y = (low[k] + areas.spacing * np.arange(table.shape[k]) for k in (0, 1))
    return x, y, table


def _draw_curves(peak: Axes, integral: Axes, feasibility: Feasibility, areas: Feasible) -> None:
    frequencies = areas.factors * feasibility.frequency
    unit, side = unit_for(frequencies, "Hz"), unit_for(max(float(areas.slipping.peak.max()) ** 0.5, SMALLEST), "m")
    per_si, area, square = unit.per_si, side.per_si**2, f"{side.name}²"
    across = frequencies * per_si
    peak.plot(across, areas.slipping.peak * area, "--", color=GREY, linewidth=1.1, label="it slips, attached then")
    peak.plot(across, areas.feasible.peak * area, color=BLUE, linewidth=1.6, label="it slips and never comes off")
    peak.plot(across, areas.lost_area * area, ":", color=RED, linewidth=1.6, label="it comes off at some moment")
    integral.plot(across, areas.slipping.integral * area * 1e3, "--", color=GREY, linewidth=1.1)
    integral.plot(across, areas.feasible.integral * area * 1e3, color=BLUE, linewidth=1.6)
    peak.set_ylabel(f"largest area [{square}]")
    integral.set_ylabel(f"time integral [{square} ms]")
    for axes, useful in ((peak, areas.feasible.peak * area), (integral, areas.feasible.integral * area * 1e3)):
        axes.set_xlabel(f"frequency of the fastest drive [{unit.name}]")
        axes.axvline(feasibility.frequency * per_si, color="black", linewidth=0.8, alpha=0.6)
        axes.set_xscale("log")
        axes.grid(alpha=0.3, which="both")
        # The useful curve fills the picture, also where the others are far above it.
        axes.set_ylim(0, min(axes.get_ylim()[1], CURVES * float(useful.max())) if useful.max() > 0 else None)
        axes.set_xlim(across[0], across[-1])
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter(NullFormatter())
    peak.set_ylim(top=1.45 * max(peak.get_ylim()[1], 1e-9))
    peak.legend(frameon=False, fontsize=8, loc="upper left")
