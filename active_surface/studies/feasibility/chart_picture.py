"""The chart of a feasibility drawn: where runs slip, lose or leave the part at rest, over frequency and stroke."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from active_surface.arrays import FloatArray
from common import quantity_text, unit_for

if TYPE_CHECKING:
    from active_surface.studies.feasibility.result import Feasibility

MOVES, LOST, EDGE = "#8cc7a1", "#e8b0a4", "#c8371b"
PARTS: Final = 12  # of the way from one column to the next
AROUND: Final = 1.8  # times what is drawn: the ends of the axis of strokes


def draw_chart(axes: Axes, feasibility: Feasibility, picked: tuple[float, float] | None = None) -> None:
    """Draw the chart with its case, and a picked frequency [Hz] and stroke [m or N], as points."""
    chart, own = feasibility.chart, (feasibility.frequency, feasibility.stroke)
    ends = [one.frequency for one in chart.columns]
    within = [np.geomspace(a, b, PARTS + 1)[:-1] for a, b in zip(ends, ends[1:], strict=False)]
    factors = np.append(np.concatenate(within), ends[-1])
    limits = [chart.limits(k) for k in factors.tolist()]
    strokes = feasibility.stroke * np.array([(*one.slips, *one.lost) for one in limits])  # (n, 4)
    columns = feasibility.stroke * np.array([(one.slips, one.all_lost) for one in chart.columns])
    low, high = _ends(columns, own[1], feasibility.stroke * np.array(chart.strokes))
    unit, length = unit_for(feasibility.frequency * factors, "Hz"), unit_for(high, feasibility.stroke_unit)
    x, y = feasibility.frequency * factors * unit.per_si, np.clip(strokes, low / 2, 2 * high) * length.per_si
    bottom, top = low * length.per_si, high * length.per_si
    # From the upper of what slip may begin at to the lower of what losses may begin at it moves for certain.
    axes.fill_between(x, y[:, 1], np.maximum(y[:, 2], y[:, 1]), color=MOVES, linewidth=0)
    axes.fill_between(x, np.maximum(y[:, 3], y[:, 1]), 2 * top, color=LOST, linewidth=0)
    either = y[:, 3] > 1.011 * y[:, 2]
    axes.fill_between(
        x, y[:, 2], y[:, 3], where=either, facecolor=LOST, edgecolor="white", hatch="////", linewidth=0, step="mid"
    )
    axes.plot(x, y[:, 1], color="black", linewidth=1.4)
    axes.plot(x, y[:, 2], color=EDGE, linewidth=1.4)
    keys: list[Artist] = [
        Patch(facecolor=MOVES, label="it moves"),
        Patch(facecolor=LOST, label="it is lost"),
        Line2D([], [], color="black", linewidth=1.4, label="it slips from here"),
        Line2D([], [], color=EDGE, linewidth=1.4, label="it is lost from here"),
    ]
    if either.any():
        keys.append(Patch(facecolor=LOST, edgecolor="white", hatch="////", label="ragged: either"))
    keys += _draw_validity(axes, feasibility, np.array(ends), (bottom, top), unit.per_si, length.per_si)
    keys.append(_point(axes, own, unit.per_si, length.per_si, "o", "white", "the case"))
    if picked is not None:
        keys.append(_point(axes, picked, unit.per_si, length.per_si, "*", "gold", "picked"))
    _scales(axes, (x[0], x[-1]), (bottom, top))
    axes.set_xlabel(f"frequency of the fastest drive [{unit.name}]")
    axes.set_ylabel(f"{'force' if feasibility.stroke_unit == 'N' else 'stroke'} of the largest drive [{length.name}]")
    axes.set_title(f"from the case's start, {quantity_text(feasibility.ground.duration, 's', 4)}", fontsize=10)
    axes.legend(handles=keys, loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=3, frameon=False, fontsize=8)


def _ends(columns: FloatArray, own: float, strokes: FloatArray) -> tuple[float, float]:
    """The least and the largest stroke drawn: around the borders and the case."""
    drawn = np.append(columns[np.isfinite(columns)], own)
    return max(drawn.min() / AROUND, min(strokes[0], own)), min(drawn.max() * AROUND, max(strokes[1], own) * AROUND)


def _draw_validity(
    axes: Axes, feasibility: Feasibility, ends: FloatArray, view: tuple[float, float], per_hertz: float, per_si: float
) -> list[Artist]:
    """Dots above the strokes up to which the model is valid; returns their key."""
    valid = np.clip(feasibility.stroke * feasibility.valid * per_si, view[0] / 2, 2 * view[1])
    if (valid > view[1]).all():
        return []
    x = ends * feasibility.frequency * per_hertz
    style: dict[str, Any] = {"facecolor": "none", "edgecolor": "#00000055", "hatch": ".", "linewidth": 0.0}
    axes.fill_between(x, valid, 2 * view[1], **style)
    axes.plot(x, valid, "--", color="#333333", linewidth=1.0)
    linear = feasibility.ground.linear
    what = "deflection > 0.2 thickness, slope > 0.2" if linear else "slope > 0.2"
    return [Patch(**style | {"hatch": "..."}, label=f"beyond the model:\n{what}")]


def _point(
    axes: Axes, point: tuple[float, float], per_hertz: float, per_si: float, marker: str, colour: str, label: str
) -> Artist:
    """Mark a frequency [Hz] and a stroke; returns the key."""
    style: dict[str, Any] = {"marker": marker, "color": colour, "markeredgecolor": "black", "linestyle": "none"}
    size = 14 if marker == "*" else 9
    axes.plot(point[0] * per_hertz, point[1] * per_si, markersize=size, zorder=5, **style)
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
