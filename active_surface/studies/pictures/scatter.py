"""Random or listed points of a sweep: how far parts went over the first two axes, and what became of them."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure

from active_surface.arrays import FloatArray
from active_surface.studies.pictures.heat import COLOURS, add_key, frame
from active_surface.studies.pictures.selection import Selection
from active_surface.studies.record import OUTCOMES
from fem_plate import mark_actuators
from meshes import draw_rim

LARGEST, SMALLEST = 40.0, 3.0  # square points, of a marker
MAX_VECTORS = 2000  # markers that are not drawn as pixels in files of lines


def draw_points(figure: Figure, axes: Axes, selection: Selection) -> None:
    """Draw a column of the results over two axes, or over one."""
    values, (across, *_), unit = selection.mean_value, selection.axes, selection.unit
    known = np.isfinite(values)
    heights = _heights(axes, selection)
    shades = values[known] * unit.per_si
    marks = axes.scatter(across.drawn[known], heights[known], c=shades, cmap="viridis", **_look(len(values)))
    figure.colorbar(marks, ax=axes).set_label(selection.label, parse_math=False)


def draw_outcomes(axes: Axes, selection: Selection) -> None:
    """Draw what became of the part over two axes; over one, at the values of the column."""
    outcome, heights = selection.usual_outcome, _heights(axes, selection)
    norm = BoundaryNorm(np.arange(len(OUTCOMES) + 1) - 0.5, len(OUTCOMES))
    colours = ListedColormap(list(COLOURS))
    axes.scatter(selection.axes[0].drawn, heights, c=outcome, cmap=colours, norm=norm, **_look(len(heights)))
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


def _look(count: int) -> dict[str, Any]:
    size = float(np.clip(2e4 / count, SMALLEST, LARGEST))
    return {"s": size, "linewidths": 0, "rasterized": count > MAX_VECTORS}
