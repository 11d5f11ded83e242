"""Random or listed points of a sweep: how far parts went over the first two axes, and what became of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from scipy.spatial import KDTree

from active_surface.arrays import FloatArray, IntArray
from active_surface.studies.pictures.heat import COLOURS, add_key, frame
from active_surface.studies.pictures.selection import Scale, Selection
from active_surface.studies.record import OUTCOMES
from common import draw_rim
from fem_plate import mark_actuators

LARGEST, SMALLEST = 40.0, 3.0  # square points, of a marker
FEW_POINTS = 20  # more have the colours of the nearest around them
CELLS = 240  # along each side, that are coloured
MAX_VECTORS = 2000  # markers that are not drawn as pixels in files of lines


def draw_points(figure: Figure, axes: Axes, selection: Selection) -> None:
    """Draw a column of the results over two axes, or over one."""
    values, (across, *others), unit = selection.mean_value, selection.axes, selection.unit
    known = np.isfinite(values)
    heights = _heights(axes, selection)
    shades, places = values[known] * unit.per_si, np.stack([across.drawn, heights], axis=1)[known]
    span: dict[str, Any] = {"cmap": "viridis"} | ({"vmin": shades.min(), "vmax": shades.max()} if len(shades) else {})
    if len(others) and len(places) > FEW_POINTS:
        _draw_nearest(axes, selection.axes[:2], places, shades, span)
    marks = axes.scatter(places[:, 0], places[:, 1], c=shades, **span, **_look(len(values), bool(others)))
    figure.colorbar(marks, ax=axes).set_label(selection.label, parse_math=False)


def draw_outcomes(axes: Axes, selection: Selection) -> None:
    """Draw what became of the part over two axes; over one, at the values of the column."""
    outcome, heights = selection.usual_outcome, _heights(axes, selection)
    norm = BoundaryNorm(np.arange(len(OUTCOMES) + 1) - 0.5, len(OUTCOMES))
    colours = ListedColormap(list(COLOURS))
    across, *others = selection.axes
    look: dict[str, Any] = {"cmap": colours, "norm": norm}
    places = np.stack([across.drawn, heights], axis=1)
    if others and len(places) > FEW_POINTS:
        _draw_nearest(axes, [across, others[0]], places, outcome, look)
    axes.scatter(places[:, 0], places[:, 1], c=outcome, **look, **_look(len(heights), bool(others)))
    add_key(axes, outcome, OUTCOMES, COLOURS)


def draw_ends(axes: Axes, selection: Selection) -> None:
    """Draw where parts ended over the start's x and y, for all repeats, and the plate's rim."""
    across, up = selection.axes
    order = [int(axis.axis.field.path[-1]) for axis in (across, up)]  # of x and y
    scale = np.array([across.unit.per_si, up.unit.per_si])
    ends = selection.end.reshape(-1, 2)[:, order] * scale
    frame(axes, across, up)
    draw_rim(axes, [curve[:, order] for curve in selection.findings.rim], scale)
    mark_actuators(axes, selection.findings.actuators[:, order], per_metre=scale)
    axes.scatter(ends[:, 0], ends[:, 1], c="black", **_look(len(ends)))
    axes.set_aspect("equal")


def _heights(axes: Axes, selection: Selection) -> FloatArray:
    """How high points (n,) stand in axes, which are labelled."""
    across, *others = selection.axes
    frame(axes, across, *others)
    if others:
        return others[0].drawn
    axes.set_ylabel(selection.label)
    return selection.mean_value * selection.unit.per_si


def _draw_nearest(
    axes: Axes, scales: Sequence[Scale], places: FloatArray, values: FloatArray | IntArray, look: dict[str, Any]
) -> None:
    """Colour the box around places (n, 2) by the value (n,) of the nearest, distances taken over the box's sides."""
    logarithmic = [scale.logarithmic for scale in scales]
    flat = np.where(logarithmic, np.log(np.where(logarithmic, places, 1.0)), places)
    low, sides = flat.min(axis=0), np.ptp(flat, axis=0)
    if not sides.all():
        return
    edges = np.linspace(0, 1, CELLS + 1)
    middles = (edges[1:] + edges[:-1]) / 2
    nearest = KDTree((flat - low) / sides).query(np.stack(np.meshgrid(middles, middles), axis=-1))[1]
    x, y = (np.exp(low[k] + edges * sides[k]) if logarithmic[k] else low[k] + edges * sides[k] for k in range(2))
    axes.pcolormesh(x, y, values[nearest], rasterized=True, zorder=0, linewidth=0, **look)


def _look(count: int, over_colours: bool = False) -> dict[str, Any]:
    """Markers of count points; over_colours: small ones with an edge, on colours that say the same."""
    size = float(np.clip(2e4 / count, SMALLEST, LARGEST))
    if over_colours and count > FEW_POINTS:
        return {"s": min(size, 10.0), "linewidths": 0.3, "edgecolors": "black", "rasterized": count > MAX_VECTORS}
    return {"s": size, "linewidths": 0, "rasterized": count > MAX_VECTORS}
