"""The picture of a drift: arrows where it carries the part, and in colours where the part ends."""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator, NullFormatter

from active_surface.arrays import FloatArray
from active_surface.studies.drifts.basins import Fate
from active_surface.studies.drifts.maps import DEEP, DriftMap
from active_surface.studies.drifts.result import Drift
from common import Drawing, Unit, draw, percent, unit_for
from coupling.pictures import PlateView, clear_labels, draw_plate, put_keys, put_label, put_title
from particle import HALO

SIDE: Final = {1: 7.2, 2: 5.2, 3: 4.4}  # inches, of a map, by how many there are across
COLUMNS: Final = 3
MOST_MAPS: Final = 12
FLATTEST: Final = 0.25  # height over width of a map, at least
FLAT: Final = 0.5  # below this the bar of speeds lies under the maps
PART: Final = 0.5  # of the plate's box: where less of it moves, this is what is drawn
SHADES: Final = "#cfe3f1", "#fbe3b9", "#d5ead0", "#e6d9ef", "#f2cfe0", "#e3e0d4"  # of ends, the largest shares first
LOST: Final = {-2: ("#f3b9ae", "from here it comes off in the end"), -3: ("#d9c2ae", "from here it leaves in the end")}
STAYS: Final = "white"
MARKS: Final = {Fate.COMES_OFF: ("#c0392b", "x", "comes off"), Fate.LEAVES: ("#7f5539", "+", "leaves the plate")}
END: Final[dict[str, Any]] = {"color": "black", "marker": "o", "markeredgecolor": "white", "linestyle": "none"}
LABELLED: Final = 5  # ends, of each map
LEAST: Final = 0.01  # share of an end that has a label


@draw.register(Drift)
def draw_drift(found: Drift) -> Figure:
    """Draw the maps of a drift, of many the first, with one scale of speeds."""
    maps = found.maps[:MOST_MAPS]
    columns = min(len(maps), COLUMNS)
    rows, side, frame = math.ceil(len(maps) / columns), SIDE[columns], _frame(found)
    tall = float((frame[1] - frame[0])[1] / (frame[1] - frame[0])[0])
    figure = Drawing(figsize=(columns * side + 1.2, rows * (side * tall + 0.8) + 1.4))
    axes = np.asarray(figure.subplots(rows, columns, squeeze=False)).ravel()
    unit, fastest = unit_for(maps[0].outline.box, "m"), max(one.speed for one in maps)
    speed = unit_for(fastest, "m/s")
    norm = LogNorm(fastest * speed.per_si / DEEP, fastest * speed.per_si) if fastest else None
    keys: list[Artist] = []
    for one, its in zip(maps, axes, strict=False):
        keys += _draw_map(its, one, unit, speed, norm, frame, side * 72 * 0.8)
        its.set_title("All actuators" if one.name == "all" else f"{one.name.capitalize()} alone", fontsize=11)
    for its in axes[len(maps) :]:
        its.remove()
    if norm is not None:
        arrows = next(a for its in axes[: len(maps)] for a in its.collections if a.get_array() is not None)
        flat = rows * tall < FLAT
        label = f"mean speed [{speed.name}]"
        look: dict[str, Any] = {"shrink": min(0.8, 1.6 / rows)}
        if flat:
            look = {"shrink": 0.6, "location": "bottom", "aspect": 40}
        bar = figure.colorbar(arrows, ax=[*axes[: len(maps)]], extend="min", label=label, **look)
        bar.long_axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        bar.long_axis.set_major_formatter("{x:g}")
        bar.long_axis.set_minor_formatter(NullFormatter())
    some = "" if len(maps) == len(found.maps) else f" (the first {len(maps)} of {len(found.maps)} groups)"
    what = "where a period of the drives carries a part, and where it ends"
    put_title(figure, f"{found.case.name}: {what}{some}")
    put_keys(figure, keys)
    for _ in range(2):  # the layout settles at the second
        figure.draw_without_rendering()
    spare = axes[0].get_position(original=True).height - axes[0].get_position().height  # white above and below maps
    figure.set_figheight(figure.get_figheight() * (1 - rows * spare))
    clear_labels(figure)
    return figure


def _frame(found: Drift) -> FloatArray:
    """The corners (2, 2) [m] of what is drawn: the plate, or where something moves on less than PART of it."""
    first = found.maps[0]
    whole = _tall(PlateView(first.outline, first.places).frame)
    moves = np.any([one.fates != Fate.STAYS for one in found.maps], axis=0)
    if not moves.any():
        return whole
    shown = np.concatenate([first.starts[moves], *(one.basins.reached[moves] for one in found.maps)])
    part = np.array([shown.min(axis=0), shown.max(axis=0)]) + 2 * first.field.spacing * np.array([[-1.0], [1.0]])
    part = _tall(np.array([np.maximum(part[0], whole[0]), np.minimum(part[1], whole[1])]))
    return part if np.ptp(part, axis=0).prod() < PART * np.ptp(whole, axis=0).prod() else whole


def _tall(frame: FloatArray) -> FloatArray:
    """A frame (2, 2) [m] that is as high as labels need."""
    more = max(0.0, FLATTEST * float(np.ptp(frame[:, 0])) - float(np.ptp(frame[:, 1]))) / 2
    return frame + np.array([[0.0, -more], [0.0, more]])


def _draw_map(
    axes: Axes, one: DriftMap, unit: Unit, speed: Unit, norm: LogNorm | None, frame: FloatArray, width: float
) -> list[Artist]:
    """Draw a map within a frame (2, 2) [m] into axes so wide [points]; return keys."""
    places, size = one.starts * unit.per_si, one.field.spacing * unit.per_si
    running = np.isin(np.arange(len(one.places)), one.actuators)
    keys = _shade(axes, one, unit)
    keys += draw_plate(axes, PlateView(one.outline, one.places, moving=running), unit, frame, width=width)
    moves = one.fates == Fate.MOVES
    if norm is not None and moves.any():
        rates = np.hypot(*one.moved[moves].T) / one.period * speed.per_si
        ways = one.arrows(float(norm.vmax or 0.0) / speed.per_si) * unit.per_si
        look: dict[str, Any] = {"angles": "xy", "scale_units": "xy", "scale": 1, "pivot": "mid", "units": "xy"}
        heads: dict[str, Any] = {"width": 0.12 * size, "headwidth": 3.6, "headlength": 4.0, "headaxislength": 3.6}
        axes.quiver(*places[moves].T, *ways.T, rates, norm=norm, cmap="viridis_r", zorder=3, **look, **heads)
    apart = width * one.field.spacing / float(np.ptp(frame[:, 0]))  # points
    for fate, (colour, marker, label) in MARKS.items():
        if (lost := one.fates == fate).any():
            dots: dict[str, Any] = {"color": colour, "marker": marker, "linestyle": "none"}
            axes.plot(*places[lost].T, markersize=max(2.0, min(6.0, 0.6 * apart)), **dots)
            keys.append(Line2D([], [], **dots, label=f"{label} within a period"))
    return keys + _draw_ends(axes, one, unit)


def _draw_ends(axes: Axes, one: DriftMap, unit: Unit) -> list[Artist]:
    """Draw where parts end, an area by all of their ends, with shares; return keys."""
    basins, keys = one.basins, list[Artist]()
    for k, end in enumerate(basins.ends[:LABELLED]):
        if end.share < LEAST:
            break
        area = basins.reached[basins.of_start == k]
        nearest = area[np.argmin(np.hypot(*(area - end.place).T))] * unit.per_si
        if one.is_point(end):
            axes.plot(*nearest, markersize=6, **END, zorder=5)
            keys.append(Line2D([], [], markersize=6, **END, label="where parts end, with the share of starts"))
        else:
            axes.plot(*(area * unit.per_si).T, markersize=3, markeredgewidth=0.4, **END, zorder=4)
            keys.append(Line2D([], [], markersize=3, **END, label="where parts end that end at many places"))
        put_label(axes, percent(end.share), nearest, (0, 10), fontsize=9, path_effects=HALO, zorder=6)
    return keys


def shades(one: DriftMap) -> dict[int, str]:
    """The colour of each number in `one.basins.of_start`."""
    ends = {k: SHADES[min(k, len(SHADES) - 1)] for k in range(len(one.basins.ends))}
    return ends | {-1: STAYS} | {k: colour for k, (colour, _) in LOST.items()}


def _shade(axes: Axes, one: DriftMap, unit: Unit) -> list[Artist]:
    """Colour each place by where a part from there ends; return keys."""
    numbers, field = one.basins.of_start, one.field
    colours = shades(one)
    there = field.numbers >= 0
    grid = np.zeros((*there.shape, 4))
    grid[there] = [to_rgba(colours[k]) for k in numbers[field.numbers[there]].tolist()]
    low = (field.origin - field.spacing / 2) * unit.per_si
    high = low + np.array(there.shape) * field.spacing * unit.per_si
    extent = (low[0], high[0], low[1], high[1])
    axes.imshow(grid.transpose(1, 0, 2), origin="lower", extent=extent, zorder=0, interpolation="nearest")
    keys: list[Artist] = [Patch(facecolor=LOST[k][0], label=LOST[k][1]) for k in LOST if (numbers == k).any()]
    if (numbers == -1).any():
        keys.append(Patch(facecolor=STAYS, edgecolor="#b0b0b0", label="it stays"))
    return keys
