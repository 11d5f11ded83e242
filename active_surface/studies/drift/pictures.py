"""The picture of a drift: arrows where it carries the part, and in colours where the part ends."""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from active_surface.arrays import BoolArray, FloatArray
from active_surface.studies.drift.basins import Fate
from active_surface.studies.drift.maps import DriftMap
from active_surface.studies.drift.result import Drift
from common import Drawing, Unit, draw, percent, unit_for
from coupling.pictures import PlateView, clear_labels, draw_plate, put_keys, put_label, put_title

SIDE: Final = {1: 7.2, 2: 5.2, 3: 4.4}  # inches, of a map, by how many there are across
COLUMNS: Final = 3
DEEP: Final = 30.0  # times the smallest displacement that has a colour of its own
LENGTHS: Final = 0.35, 0.95  # of the spacing: those of the shortest and longest arrows
SHADES: Final = "#cfe3f1", "#fbe3b9", "#d5ead0", "#e6d9ef", "#f6d5cf", "#e3e0d4"  # of ends, the largest shares first
STAYS: Final = "white"
LOST: Final = {Fate.COMES_OFF: ("#c0392b", "x", "comes off"), Fate.LEAVES: ("#7f5539", "+", "leaves the plate")}
LABELLED: Final = 5  # ends, of each map
LEAST: Final = 0.01  # share of an end that has a label


@draw.register(Drift)
def draw_drift(found: Drift) -> Figure:
    """Draw the maps of a drift, with one scale of speeds."""
    maps = found.maps
    columns = min(len(maps), COLUMNS)
    rows = math.ceil(len(maps) / columns)
    low, high = maps[0].outline.box
    tall = float(np.clip((high - low)[1] / (high - low)[0], 0.4, 1.6))
    side = SIDE[columns]
    figure = Drawing(figsize=(columns * side + 1.2, rows * (side * tall + 0.5) + 0.9))
    axes = np.asarray(figure.subplots(rows, columns, squeeze=False)).ravel()
    unit = unit_for(maps[0].outline.box, "m")
    fastest = max(one.speed for one in maps)
    speed = unit_for(fastest, "m/s")
    norm = LogNorm(fastest * speed.per_si / DEEP, fastest * speed.per_si) if fastest else None
    keys: list[Artist] = []
    for one, its in zip(maps, axes, strict=False):
        keys += _draw_map(its, one, unit, speed, norm, side * 72 * 0.8)
        its.set_title("All actuators" if one.name == "all" else f"{one.name.capitalize()} alone", fontsize=11)
    for its in axes[len(maps) :]:
        its.remove()
    if norm is not None:
        arrows = next(a for its in axes[: len(maps)] for a in its.collections if a.get_array() is not None)
        bar = figure.colorbar(arrows, ax=[*axes[: len(maps)]], shrink=0.7, extend="min", label=f"mean speed [{speed.name}]")
        bar.ax.yaxis.set_major_formatter("{x:g}")
        bar.ax.yaxis.set_minor_formatter("")
    put_title(figure, f"{found.case.name}: where a part at rest is carried in a period of the drives, and where it ends")
    put_keys(figure, keys)
    clear_labels(figure)
    return figure


def _draw_map(axes: Axes, one: DriftMap, unit: Unit, speed: Unit, norm: LogNorm | None, width: float) -> list[Artist]:
    """Draw a map into axes so wide [points]; return keys."""
    places, size, basins = one.starts * unit.per_si, one.field.spacing * unit.per_si, one.basins
    running = np.isin(np.arange(len(one.places)), one.actuators)
    keys = _shade(axes, one, unit)
    keys += draw_plate(axes, PlateView(one.outline, one.places, moving=running), unit, width=width)
    moves = one.fates == Fate.MOVES
    if norm is not None and moves.any():
        length = np.hypot(*one.moved[moves].T)
        rates = length / one.period * speed.per_si
        share = np.clip(np.log(rates / norm.vmin) / math.log(DEEP), 0.0, 1.0)
        ways = one.moved[moves] / length[:, None] * (size * (LENGTHS[0] + np.ptp(LENGTHS) * share))[:, None]
        look: dict[str, Any] = {"angles": "xy", "scale_units": "xy", "scale": 1, "pivot": "mid", "units": "xy"}
        heads: dict[str, Any] = {"width": 0.12 * size, "headwidth": 3.6, "headlength": 4.0, "headaxislength": 3.6}
        axes.quiver(*places[moves].T, *ways.T, rates, norm=norm, cmap="viridis_r", zorder=3, **look, **heads)
    mark = max(2.0, 0.5 * width / math.sqrt(len(places)))
    for fate, (colour, marker, label) in LOST.items():
        if (lost := one.fates == fate).any():
            dots: dict[str, Any] = {"color": colour, "marker": marker, "markersize": mark, "linestyle": "none"}
            axes.plot(*places[lost].T, **dots, label=f"{label} within a period")
            keys.append(Line2D([], [], **dots, label=f"{label} within a period"))
    ends = [end for end in basins.ends[:LABELLED] if end.share >= LEAST]
    if ends:
        look = {"color": "black", "marker": "o", "markersize": 6, "markeredgecolor": "white", "linestyle": "none"}
        axes.plot(*(np.array([end.place for end in ends]) * unit.per_si).T, **look, zorder=5)
        keys.append(Line2D([], [], **look, label="where parts end, with the share of starts"))
        for end in ends:
            put_label(axes, percent(end.share), np.array(end.place) * unit.per_si, (0, 10), fontsize=9, zorder=6)
    return keys


def _shade(axes: Axes, one: DriftMap, unit: Unit) -> list[Artist]:
    """Colour each place by where a part from there ends; return keys."""
    numbers, keys = one.basins.of_start, list[Artist]()
    lost = {-2: "#f3c6c0", -3: "#e5d3c3"}
    colours = {k: SHADES[min(k, len(SHADES) - 1)] for k in range(len(one.basins.ends))} | lost | {-1: STAYS}
    grid = np.ones((*one.field.numbers.shape, 4))
    grid[..., 3] = 0.0
    there = one.field.numbers >= 0
    shades = np.array([_rgb(colours[int(k)]) for k in numbers]).reshape(-1, 3)
    grid[there, :3], grid[there, 3] = shades[one.field.numbers[there]], 1.0
    low = (one.field.origin - one.field.spacing / 2) * unit.per_si
    high = low + np.array(one.field.numbers.shape) * one.field.spacing * unit.per_si
    axes.imshow(
        grid.transpose(1, 0, 2), origin="lower", extent=(low[0], high[0], low[1], high[1]), zorder=0, interpolation="nearest"
    )
    for k, label in ((-2, "from here it comes off in the end"), (-3, "from here it leaves the plate in the end")):
        if (numbers == k).any():
            keys.append(Patch(facecolor=lost[k], label=label))
    if (numbers == -1).any():
        keys.append(Patch(facecolor=STAYS, edgecolor="#b0b0b0", label="it stays"))
    return keys


def _rgb(colour: str) -> tuple[float, float, float]:
    from matplotlib.colors import to_rgb

    return to_rgb(colour)
