"""Pictures of a plate: its rim by supports, its mesh, its actuators and their shapes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from scipy.spatial import cKDTree

from common import axes_or_new, draw, draw_rim, figure_of, label_axis, label_places, legend_below
from fem_plate.plate import Plate
from fem_plate.shapes import Shapes
from fem_plate.types import BoolArray, FloatArray
from meshes import Outline, PlateMesh, delaunay, rim_curves

ALONG_EDGE = np.linspace(0, 1, 9)
SUPPORTS: dict[str, tuple[str, float]] = {  # colour and width in points; they differ in grey, too
    "clamped": ("black", 2.5),
    "simply-supported": ("#1b4f9c", 1.5),
    "free": ("#808080", 0.8),
}
CELLS = 80  # of the grid, along the longer side of a plate's box
CLEARANCE = 0.6  # of a cell: no grid point lies closer to the rim
DIGITS = 9  # to which two points of the grid are the same
LEVELS = 10  # about
FLAT = 1e-6  # of the largest level: smaller levels are 0
MARGIN = 0.04  # of the longer side
ACTUATOR: dict[str, Any] = {"marker": "^", "markeredgecolor": "black", "linestyle": ""}
FEW = 25  # actuators: so many are always marked
AXES_WIDTH = 330.0  # points, about
MIN_DISTANCE = 4.0  # points: closer markers would merge
MARKER_SIZES = (1.5, 6.0)  # points, the smallest and the largest


@draw.register(Plate)
def draw_cells(plate: Plate, axes: Axes | None = None) -> Figure:
    """Draw the rim of a plate by its supports, and its mesh."""
    axes = axes_or_new(axes)
    axes.triplot(*plate.mesh.points.T, plate.mesh.triangles, color="#b0b0b0", linewidth=0.4)
    legend_below(axes, handles=draw_supports(axes, plate.mesh, plate.supports), ncols=len(SUPPORTS))
    label_places(axes)
    return figure_of(axes)


def draw_supports(axes: Axes, mesh: PlateMesh, supports: Mapping[str, str]) -> list[Artist]:
    """Draw the boundaries of a mesh, each by its support; return keys."""
    for name in mesh.boundaries:
        colour, width = SUPPORTS[supports[name]]
        draw_rim(axes, mesh.arcs(name, ALONG_EDGE)[0], colors=colour, linewidths=width, capstyle="round")
    leave_room(axes)
    used = [support for support in SUPPORTS if support in set(supports.values())]
    return [Line2D([], [], color=SUPPORTS[name][0], linewidth=SUPPORTS[name][1], label=name) for name in used]


def mark_actuators(
    axes: Axes,
    places: FloatArray,
    frame: FloatArray | None = None,
    per_metre: float | FloatArray = 1.0,
    width: float = AXES_WIDTH,
    *,
    size: float | None = None,
    colour: str = "white",
    label: str = "actuator",
) -> list[Artist]:
    """Mark the actuators at places (N, 2) [m] whose markers lie entirely within a frame (2, 2) [m]; return a key.

    frame: None marks all.  width: of the axes [points].  size: of the markers [points]; None is as large as fits.
    """
    if not len(places):
        return []
    inside = places
    if frame is not None:
        size = marker_size(places[marked(places, frame, 0.0)], frame, width) if size is None else size
        if not size:
            return [Line2D([], [], linestyle="", label=f"{len(places)} actuators, not marked")]
        inside = places[marked(places, frame, size, width)]
    size = size or MARKER_SIZES[1]
    look = ACTUATOR | {"color": colour}
    axes.plot(*(inside * per_metre).T, **look, markersize=size, markeredgewidth=size / MARKER_SIZES[1], zorder=2.5)
    return [Line2D([], [], **look, label=label)] if len(inside) else []


def marked(places: FloatArray, frame: FloatArray, size: float, width: float = AXES_WIDTH) -> BoolArray:
    """Which markers of a size [points] at places (N, 2) [m] lie entirely within a frame (2, 2) [m] of such a width."""
    reach = size / width * extent(frame)
    return np.asarray(((places > frame[0] + reach) & (places < frame[1] - reach)).all(axis=1))


def marker_size(places: FloatArray, frame: FloatArray, width: float = AXES_WIDTH) -> float:
    """The size [points] of markers at places (N, 2) [m] that stay apart from each other; 0: they would merge.

    frame: (2, 2) m, that of axes so wide [points].
    """
    distance = distance_drawn(places, frame, width)
    return float(np.clip(0.3 * distance, *MARKER_SIZES)) if distance >= MIN_DISTANCE else 0.0


def distance_drawn(places: FloatArray, frame: FloatArray, width: float = AXES_WIDTH) -> float:
    """How far apart [points] places (N, 2) [m] are in a frame (2, 2) [m] so wide [points]; inf where they are few."""
    return width * pitch(places) / extent(frame) if len(places) > FEW else math.inf


def pitch(places: FloatArray) -> float:
    """The distance [m] from a place to the nearest other one, the median of (N, 2) [m]; 0 where there is one."""
    if len(places) < 2:
        return 0.0
    return float(np.median(cKDTree(places).query(places, k=2)[0][:, 1]))


def frame_around(box: FloatArray) -> FloatArray:
    """The corners (2, 2) of a frame with a margin around a box (2, 2)."""
    return box + MARGIN * extent(box) * np.array([[-1.0], [1.0]])


def extent(points: FloatArray) -> float:
    """The longer side [m] of the box around points (n, 2) [m]."""
    return float(np.ptp(points, axis=0).max())


@draw.register(Shapes)
def draw_shapes(shapes: Shapes, axes: Axes | None = None, weights: FloatArray | None = None) -> Figure:
    """Draw the sum of shapes with weights (N,); None: the shape of the actuator in the middle."""
    axes = axes_or_new(axes)
    if weights is None:
        middle = int(np.argmin(np.hypot(*(shapes.points - shapes.points.mean(axis=0)).T)))
        weights = np.eye(1, len(shapes.points), middle)[0]
        label, unit = f"shape of actuator {middle}", "" if shapes.springs[middle] > 0 else "m/N"
    else:
        label, unit = "deflection", "m"
    points = grid_on(shapes.outline)
    w = shapes.values(points, weights[:, None])[:, 0]
    triangles = delaunay(points, shapes.outline)
    levels = MaxNLocator(LEVELS).tick_values(w.min(), w.max())
    filled = axes.tricontourf(*points.T, triangles, w, levels=levels, cmap="Blues")
    lines = levels[np.abs(levels) > FLAT * np.abs(levels).max()]  # the line of 0 would meander where w is 0
    axes.tricontour(*points.T, triangles, w, levels=lines, colors="#404040", linewidths=0.3)
    bar = axes.figure.colorbar(filled, ax=axes, label=label, shrink=0.8)
    if unit:
        label_axis(bar.ax.yaxis, label, unit)
    draw_rim(axes, rim_curves(shapes.outline))
    leave_room(axes)
    mark_actuators(axes, shapes.points, frame_around(shapes.outline.box))
    label_places(axes)
    return figure_of(axes)


def leave_room(axes: Axes) -> None:
    """Leave a margin around all."""
    axes.use_sticky_edges = False
    axes.margins(MARGIN)
    axes.autoscale_view()


def grid_on(outline: Outline) -> FloatArray:
    """Points (n, 2) [m] of a grid on a plate and of its rim."""
    low, high = outline.box
    step = float((high - low).max()) / CELLS
    sides = [np.arange(low[k] + step / 2, high[k], step) for k in (0, 1)]
    grid = np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 2)
    rim = np.concatenate(rim_curves(outline, step))
    points = np.concatenate([rim, grid[outline.gap(grid) > CLEARANCE * step]])
    _, rows = np.unique(np.round(points / (step * CELLS), DIGITS), axis=0, return_index=True)
    return np.asarray(points[np.sort(rows)])
