"""The plate in the picture of a run, whole and in the window: colours and lines of heights, rim and actuators."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import ConnectionPatch, Rectangle
from matplotlib.ticker import MaxNLocator, StrMethodFormatter
from matplotlib.tri import Triangulation, UniformTriRefiner
from numpy.typing import NDArray

from common import STEPS, Unit, draw_rim, unit_for
from coupling.display import onto_plate
from fem_plate import Shapes, distance_drawn, extent, frame_around, mark_actuators
from meshes import rim_curves

if TYPE_CHECKING:
    from coupling.display import DisplaySurface

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Piece = tuple[FloatArray, IntArray, FloatArray]
"""Points (n, 2) [m], triangles (m, 3) and deflections (n,) [m] that cover a piece of a plate."""

MAX_TRIANGLES = 60_000  # of a mesh that is refined to be drawn
MAX_HALVINGS = 4  # of its edges
AXES_WIDTH = 330.0  # points, about
LINES_APART = 8.0  # points: where actuators stand closer together, contour lines would merge
FLAT = 1e-9  # of the largest height: smaller differences are 0
SHALLOW = 0.01  # of the largest height: shallower hollows get no colour of their own
BANDS, LABELS = 12, 8  # of a colour bar, about
UPWARDS = LinearSegmentedColormap.from_list("upwards", ["#ffffff", "#c6d9e8", "#7fa8c9", "#40719c"])
BOTH_WAYS = LinearSegmentedColormap.from_list("both ways", ["#b8862d", "#ead7a6", "#ffffff", "#c6d9e8", "#40719c"])


class Scale(NamedTuple):
    """How heights become colours, the same in all of the picture."""

    unit: Unit
    lowest: float
    highest: float
    colours: Colormap

    @property
    def norm(self) -> Normalize:
        """A new norm at each access: a colour bar that shares its norm loses its limits."""
        return Normalize(self.lowest, self.highest)

    @staticmethod
    def of(deflection: FloatArray) -> Scale:
        """The scale for deflections (n,) [m] of the whole plate: white at 0, another colour below 0 if need be."""
        unit = unit_for(deflection, "m")
        high, low = (float(w) * unit.per_si for w in (deflection.max(), deflection.min()))
        if -low > SHALLOW * high:
            return Scale(unit, -max(high, -low), max(high, -low), BOTH_WAYS)
        return Scale(unit, 0.0, high, UPWARDS)


class Relief(NamedTuple):
    """A plate at one moment."""

    box: FloatArray  # (2, 2) m, around it
    actuators: FloatArray  # (N, 2) m
    deflection: FloatArray  # (n,) m, of all of it
    within: Callable[[FloatArray], Piece]  # the piece within a frame (2, 2) [m]
    rim: Callable[[float], list[FloatArray]]  # its curves (k, 2) [m], with points so far apart [m]

    @property
    def frame(self) -> FloatArray:
        """The corners (2, 2) [m] of a picture of all of it."""
        return frame_around(self.box)


def relief_of(shapes: Shapes, surface: DisplaySurface, heights: FloatArray) -> Relief:
    """The plate with its moving drives at heights (K,) [m]."""
    return Relief(
        shapes.outline.box,
        shapes.points,
        surface.deflection(heights[None])[0],
        lambda frame: fine_piece(shapes, surface, heights, frame),
        lambda spacing: rim_curves(shapes.outline, spacing),
    )


def draw_plate(
    figure: Figure,
    axes: Axes,
    relief: Relief,
    unit: Unit,
    frame: FloatArray,
    side: Literal["left", "right"] = "right",
    width: float = AXES_WIDTH,
) -> list[Artist]:
    """Draw a plate within a frame (2, 2) [m] into axes so wide [points], with its bar at a side; return keys."""
    scale = Scale.of(relief.deflection)
    points, triangles, w = relief.within(frame)
    lined = distance_drawn(relief.actuators, frame, width) >= LINES_APART
    _draw_heights(figure, axes, points * unit.per_si, triangles, w * scale.unit.per_si, scale, side, lined)
    draw_rim(axes, relief.rim(extent(frame) / 200), unit.per_si)
    axes.set_xlim(*(frame[:, 0] * unit.per_si))
    axes.set_ylim(*(frame[:, 1] * unit.per_si))
    return mark_actuators(axes, relief.actuators, frame, unit.per_si, width)


def fine_piece(shapes: Shapes, surface: DisplaySurface, heights: FloatArray, frame: FloatArray) -> Piece:
    """The plate within a frame (2, 2) [m]: the display mesh, refined until contours look smooth."""
    points, triangles, used = cut_out(surface.points, surface.triangles, frame)
    fine = refined(points, triangles)
    if fine is None:
        return points, triangles, surface.deflection(heights[None])[0][used]
    points = np.stack([fine.x, fine.y], axis=1)
    w = shapes.values(onto_plate(shapes.outline, points), heights[:, None])[:, 0]
    return points, fine.triangles.astype(np.int64), w


def cut_out(points: FloatArray, triangles: IntArray, frame: FloatArray) -> tuple[FloatArray, IntArray, IntArray]:
    """The points and triangles of a mesh that reach into a frame (2, 2) [m], and the rows of the points in the mesh."""
    lowest, highest = (f(points[triangles], axis=1) for f in (np.min, np.max))
    triangles = triangles[((highest > frame[0]) & (lowest < frame[1])).all(axis=1)]
    used, rows = np.unique(triangles, return_inverse=True)
    return points[used], rows.reshape(-1, 3), used


def refined(points: FloatArray, triangles: IntArray) -> Triangulation | None:
    """Refine triangles until contours look smooth; None where they already do."""
    halvings = min(int(math.log(max(MAX_TRIANGLES / max(len(triangles), 1), 1), 4)), MAX_HALVINGS)
    if not halvings:
        return None
    return UniformTriRefiner(Triangulation(*points.T, triangles)).refine_triangulation(subdiv=halvings)


def _draw_heights(
    figure: Figure,
    axes: Axes,
    points: FloatArray,
    triangles: NDArray[np.int64],
    w: FloatArray,
    scale: Scale,
    side: Literal["left", "right"],
    lined: bool,
) -> None:
    """Draw bands of equal height with lines between them, or shades without lines, with their bar at a side."""
    if scale.colours is UPWARDS:
        w = np.maximum(w, 0.0)
    if np.ptp(w) <= FLAT * scale.highest:
        return
    bar: dict[str, Any] = {"ax": axes, "label": f"deflection [{scale.unit.name}]", "shrink": 0.75, "location": side}
    bar["format"] = StrMethodFormatter("{x:.6g}")
    colours: dict[str, Any] = {"cmap": scale.colours, "norm": scale.norm}
    if not lined:
        shades = axes.tripcolor(*points.T, triangles, w, shading="gouraud", **colours)
        figure.colorbar(shades, **bar).ax.set_ylim(w.min(), w.max())
        return
    levels = np.asarray(MaxNLocator(BANDS, steps=STEPS).tick_values(w.min(), w.max()))
    labelled = np.rint(levels / (levels[1] - levels[0])) % (1 + len(levels) // LABELS) == 0  # 0 among them
    filled = axes.tricontourf(*points.T, triangles, w, levels=levels, **colours)
    lines = axes.tricontour(*points.T, triangles, w, levels=levels[1:-1], colors="#404040", linewidths=0.4)
    figure.colorbar(filled, ticks=levels[labelled], **bar).add_lines(lines)


def draw_window(axes: Axes, unit: Unit, window: FloatArray) -> Artist:
    """Show on a map where a window (2, 2) [m] is; return its key."""
    corner, sides = window[0] * unit.per_si, np.ptp(window, axis=0) * unit.per_si
    look: dict[str, Any] = {"fill": False, "edgecolor": "black", "linewidth": 1.2, "zorder": 4}
    return axes.add_patch(Rectangle(tuple(corner), *sides, **look, label="frame of the close-up"))


def join(figure: Figure, axes: list[Axes], unit: Unit, window: FloatArray) -> None:
    """Join a window (2, 2) [m] on a map in the first axes to the second ones, on its right."""
    for k in (0, 1):
        place = np.array([window[1, 0], window[k, 1]]) * unit.per_si
        ends: dict[str, Any] = {"axesA": axes[0], "coordsA": "data", "axesB": axes[1], "coordsB": "axes fraction"}
        figure.add_artist(ConnectionPatch(tuple(place), (0, k), **ends, linewidth=0.7))
    axes[1].yaxis.tick_right()
    axes[1].yaxis.set_label_position("right")
