"""Pictures of a plate: its rim by supports and its cells; the shape of its actuators."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from meshes import Outline, PlateMesh, delaunay, in_unit, plan, put_below, rim_curves

if TYPE_CHECKING:
    from fem_plate.influence import Shapes
    from fem_plate.plate import Plate

FloatArray = NDArray[np.float64]

ALONG = np.linspace(0, 1, 9)  # an edge of the rim
RIMS: dict[str, tuple[str, float]] = {  # colour and width in points, told from each other in grey
    "clamped": ("black", 2.5),
    "simply-supported": ("#1b4f9c", 1.5),
    "free": ("#808080", 0.8),
}
ACROSS = 80  # points along the longer side of a plate's box
CLEAR = 0.6  # of their distance, from the rim
SAME = 9  # digits of the box to which points are the same
MOST_MARKED = 400  # actuators
LEVELS = 10  # about
FLAT = 1e-6  # of the largest level: nothing
MARGIN = 0.05  # of the frame
TRIANGLE: dict[str, Any] = {"marker": "^", "color": "white", "markeredgecolor": "black", "linestyle": ""}


def draw_cells(plate: Plate, axes: Axes) -> None:
    """Draw the rim of a plate by its supports, and its mesh."""
    axes.triplot(*plate.mesh.points.T, plate.mesh.triangles, color="#b0b0b0", linewidth=0.4)
    put_below(axes, handles=draw_rim(axes, plate.mesh, plate.supports), ncols=len(RIMS))
    plan(axes)


def draw_rim(axes: Axes, mesh: PlateMesh, supports: Mapping[str, str]) -> list[Artist]:
    """Draw the boundaries of a mesh, each by its support; return keys."""
    for name in mesh.boundaries:
        colour, width = RIMS[supports[name]]
        pieces = list(mesh.arcs(name, ALONG)[0])
        axes.add_collection(LineCollection(pieces, colors=colour, linewidths=width, capstyle="round"))
    leave_room(axes)
    used = [support for support in RIMS if support in set(supports.values())]
    return [Line2D([], [], color=RIMS[support][0], linewidth=RIMS[support][1], label=support) for support in used]


def mark_actuators(axes: Axes, places: FloatArray) -> list[Artist]:
    """Mark actuators at places (N, 2) [m], unless they are too many; return a key."""
    if not 0 < len(places) <= MOST_MARKED:
        return []
    size = float(np.clip(60 / len(places) ** 0.5, 2.0, 7.0))
    axes.plot(*places.T, **TRIANGLE, markersize=size, markeredgewidth=size / 8)
    return [Line2D([], [], **TRIANGLE, label="actuator")]


def draw_shapes(shapes: Shapes, weights: FloatArray | None, axes: Axes) -> None:
    """Draw the sum of shapes with weights (N,); None: the shape of the actuator in the middle."""
    if weights is None:
        middle = int(np.argmin(np.hypot(*(shapes.points - shapes.points.mean(axis=0)).T)))
        weights = np.eye(1, len(shapes.points), middle)[0]
        said, unit = f"shape of actuator {middle}", "" if shapes.springs[middle] > 0 else "m/N"
    else:
        said, unit = "deflection", "m"
    points = grid_on(shapes.outline)
    w = shapes.values(points, weights[:, None])[:, 0]
    triangles = delaunay(points, shapes.outline)
    levels = MaxNLocator(LEVELS).tick_values(w.min(), w.max())
    filled = axes.tricontourf(*points.T, triangles, w, levels=levels, cmap="Blues")
    lines = levels[np.abs(levels) > FLAT * np.abs(levels).max()]  # that of 0 winds about where nothing is deflected
    axes.tricontour(*points.T, triangles, w, levels=lines, colors="#404040", linewidths=0.3)
    bar = axes.figure.colorbar(filled, ax=axes, label=said, shrink=0.8)
    if unit:
        in_unit(bar.ax.yaxis, said, unit)
    step = float(np.ptp(shapes.outline.box, axis=0).max()) / (4 * ACROSS)
    axes.add_collection(LineCollection(rim_curves(shapes.outline, step), colors="black", linewidths=1.5))
    mark_actuators(axes, shapes.points)
    leave_room(axes)
    plan(axes)


def leave_room(axes: Axes) -> None:
    """Leave a margin around all."""
    axes.use_sticky_edges = False
    axes.margins(MARGIN)
    axes.autoscale_view()


def grid_on(outline: Outline) -> FloatArray:
    """Points (n, 2) [m] of a grid on a plate and of its rim."""
    low, high = outline.box
    step = float((high - low).max()) / ACROSS
    sides = [np.arange(low[k] + step / 2, high[k], step) for k in (0, 1)]
    grid = np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 2)
    rim = np.concatenate(rim_curves(outline, step))
    points = np.concatenate([rim, grid[outline.gap(grid) > CLEAR * step]])
    _, rows = np.unique(np.round(points / (step * ACROSS), SAME), axis=0, return_index=True)
    return np.asarray(points[np.sort(rows)])
