"""The plate as all pictures have it, whole and in a window: rim, actuators, heights, and the path over it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, LinearSegmentedColormap, Normalize
from matplotlib.patches import ConnectionPatch, Rectangle
from matplotlib.ticker import MaxNLocator, StrMethodFormatter
from matplotlib.tri import CubicTriInterpolator, Triangulation, UniformTriRefiner
from numpy.typing import NDArray

from common import NOTHING, STEPS, Unit, draw_rim, figure_of, quantity_text, unit_for
from coupling.pictures.figure import map_axes, put_label
from fem_plate import distance_drawn, extent, frame_around, mark_actuators, marked, marker_size, pitch
from meshes import Outline, rim_curves
from particle import HALO, PLACE, RING, Rows, draw_line

BoolArray = NDArray[np.bool_]
FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

SHORT = 1 / 6  # of the plate's longer side: a shorter path gets a window
VISIBLE = 1 / 1000  # of the plate's longer side: a shorter path is drawn as a point
MIN_LENGTHS, MAX_LENGTHS = 2.5, 4.0  # of the path's extent: the side of the window,
PITCHES = 2.2  # which shows so many pitches if it can
MAX_TRIANGLES = 30_000  # of a mesh that is refined to be drawn
MAX_HALVINGS = 4  # of its edges
AXES_WIDTH = 330.0  # points, about
MIN_MARKER = 1.5  # points, of actuators too many to be drawn apart where some of them move
MAX_NUMBERED = 100  # actuators
NUMBERS: dict[str, Any] = {"color": "#606060", "fontsize": 9, "path_effects": HALO}
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


@dataclass(frozen=True, eq=False)
class Relief:
    """A plate at one moment, as heights of a triangle mesh."""

    points: FloatArray  # (n, 2) m
    triangles: IntArray  # (m, 3)
    deflection: FloatArray  # (n,) m
    exact: Callable[[FloatArray], FloatArray] | None = None  # deflections (k,) [m] at points (k, 2); None: cubics

    def within(self, frame: FloatArray) -> tuple[FloatArray, IntArray, FloatArray]:
        """Points, triangles and deflections within a frame (2, 2) [m], refined until contours look smooth."""
        lowest, highest = (f(self.points[self.triangles], axis=1) for f in (np.min, np.max))
        inside = ((highest > frame[0]) & (lowest < frame[1])).all(axis=1)
        used, rows = np.unique(self.triangles[inside], return_inverse=True)
        points, triangles, w = self.points[used], rows.reshape(-1, 3), self.deflection[used]
        halvings = min(int(math.log(max(MAX_TRIANGLES / max(len(triangles), 1), 1), 4)), MAX_HALVINGS)
        if not halvings:
            return points, triangles, w
        mesh = Triangulation(*points.T, triangles)
        fine = UniformTriRefiner(mesh).refine_triangulation(subdiv=halvings)
        xy = np.stack([fine.x, fine.y], axis=1)
        if self.exact is None:
            heights = CubicTriInterpolator(mesh, w, kind="geom")(fine.x, fine.y).filled(0.0)
        else:
            heights = self.exact(xy)
        return xy, fine.triangles.astype(np.int64), heights


@dataclass(frozen=True, eq=False)
class PlateView:
    """A plate as pictures show it."""

    outline: Outline
    actuators: FloatArray  # (N, 2) m
    relief: Relief | None = None  # None: without heights
    moving: BoolArray | None = None  # (N,), which actuators look as moving ones; None: all look the same
    numbered: bool = False  # whether actuators have their numbers, which `clear_labels` moves

    @property
    def frame(self) -> FloatArray:
        """The corners (2, 2) [m] of a picture of all of it."""
        return frame_around(self.outline.box)


def draw_plate(
    axes: Axes,
    view: PlateView,
    unit: Unit,
    frame: FloatArray | None = None,
    side: Literal["left", "right"] = "right",
    width: float = AXES_WIDTH,
) -> list[Artist]:
    """Draw a plate within a frame (2, 2) [m], by default all of it, into axes so wide [points]; return keys.

    side: of the axes, at which the bar of heights stands.
    """
    frame = view.frame if frame is None else frame
    if view.relief is not None:
        _draw_heights(axes, view.relief, unit, frame, side, distance_drawn(view.actuators, frame, width))
    map_axes(axes, unit)
    draw_rim(axes, rim_curves(view.outline, extent(frame) / 200), unit.per_si)
    axes.set_xlim(*(frame[:, 0] * unit.per_si))
    axes.set_ylim(*(frame[:, 1] * unit.per_si))
    places = view.actuators
    size = marker_size(places, frame, width) or MIN_MARKER
    if view.moving is None:
        keys = mark_actuators(axes, places, frame, unit.per_si, width)
    else:
        keys = []
        kinds = (view.moving, "#7fa8c9", "moving actuator"), (~view.moving, "white", "actuator at rest")
        for some, colour, label in kinds:
            look: dict[str, Any] = {"size": size, "colour": colour, "label": label}
            keys += mark_actuators(axes, places[some], frame, unit.per_si, width, **look)
    numbered = marked(places, frame, size, width) if view.numbered and len(places) <= MAX_NUMBERED else ()
    for number in np.flatnonzero(numbered).tolist():
        put_label(axes, str(number), places[number] * unit.per_si, (0, -6), **NUMBERS)
    return keys


def _draw_heights(
    axes: Axes, relief: Relief, unit: Unit, frame: FloatArray, side: Literal["left", "right"], apart: float
) -> None:
    """Draw bands of equal height with lines between them, or shades without lines, with their bar at a side.

    apart: how far apart actuators stand [points].
    """
    scale, figure = Scale.of(relief.deflection), figure_of(axes)
    points, triangles, w = relief.within(frame)
    x, y, w = *(points * unit.per_si).T, w * scale.unit.per_si
    if scale.colours is UPWARDS:
        w = np.maximum(w, 0.0)
    if np.ptp(w) <= FLAT * scale.highest:
        return
    bar: dict[str, Any] = {"ax": axes, "label": f"deflection [{scale.unit.name}]", "shrink": 0.75, "location": side}
    bar["format"] = StrMethodFormatter("{x:.6g}")
    colours: dict[str, Any] = {"cmap": scale.colours, "norm": scale.norm}
    if apart < LINES_APART:
        shades = axes.tripcolor(x, y, triangles, w, shading="gouraud", **colours)
        figure.colorbar(shades, **bar).ax.set_ylim(w.min(), w.max())
        return
    levels = np.asarray(MaxNLocator(BANDS, steps=STEPS).tick_values(w.min(), w.max()))
    labelled = np.rint(levels / (levels[1] - levels[0])) % (1 + len(levels) // LABELS) == 0  # 0 among them
    filled = axes.tricontourf(x, y, triangles, w, levels=levels, **colours)
    lines = axes.tricontour(x, y, triangles, w, levels=levels[1:-1], colors="#404040", linewidths=0.4)
    figure.colorbar(filled, ticks=levels[labelled], **bar).add_lines(lines)


def draw_window(axes: Axes, unit: Unit, window: FloatArray) -> Artist:
    """Show on a map where a window (2, 2) [m] is; return its key."""
    corner, sides = window[0] * unit.per_si, np.ptp(window, axis=0) * unit.per_si
    look: dict[str, Any] = {"fill": False, "edgecolor": "black", "linewidth": 1.2, "zorder": 4}
    return axes.add_patch(Rectangle(tuple(corner), *sides, **look, label="frame of the close-up"))


def draw_maps(axes: Sequence[Axes], view: PlateView, window: FloatArray | None) -> tuple[list[Artist], Unit]:
    """Draw a plate, and what is in a window (2, 2) [m] into the second axes; return keys and the last axes' unit."""
    unit = unit_for(view.outline.box, "m")
    keys = draw_plate(axes[0], view, unit, side="right" if window is None else "left")
    if window is not None:
        draw_window(axes[0], unit, window)
        _join(axes, unit, window)
        unit = unit_for(window, "m")
        keys += draw_plate(axes[1], view, unit, window)
        axes[1].yaxis.tick_right()
        axes[1].yaxis.set_label_position("right")
    return keys, unit


def _join(axes: Sequence[Axes], unit: Unit, window: FloatArray) -> None:
    """Join a window (2, 2) [m] on a map in the first axes to the second ones, on its right."""
    for k in (0, 1):
        place = np.array([window[1, 0], window[k, 1]]) * unit.per_si
        ends: dict[str, Any] = {"axesA": axes[0], "coordsA": "data", "axesB": axes[1], "coordsB": "axes fraction"}
        line = ConnectionPatch(tuple(place), (0, k), **ends, linewidth=0.7, clip_on=False)
        line.set_in_layout(False)
        axes[0].add_artist(line)
    axes[0].set_zorder(axes[1].zorder + 1)  # drawn after the second ones, whose place their drawing settles
    axes[0].title.set(zorder=line.zorder + 1, bbox={"facecolor": "white", "edgecolor": "none", "pad": 1})


def draw_path(axes: Axes, rows: Rows, line: FloatArray, unit: Unit, box: FloatArray) -> list[Artist]:
    """Draw the path through points (n, 2) [m] on a plate with a box (2, 2) [m], or its start if it is no longer."""
    if is_visible(line, box):
        return draw_line(axes, rows, line, unit.per_si)
    where = f"within {quantity_text(extent(line), 'm', 2)}" if extent(line) > NOTHING else "where it is"
    look: dict[str, Any] = RING | PLACE | {"label": f"the part, which stays {where}"}
    return [*axes.plot(*(rows.position[:1] * unit.per_si).T, **look)]


def is_visible(path: FloatArray, box: FloatArray) -> bool:
    """Whether a path (n, 2) [m] is more than a point on a plate with a box (2, 2) [m]."""
    return extent(path) > VISIBLE * extent(box)


def path_window(path: FloatArray, box: FloatArray, actuators: FloatArray) -> FloatArray | None:
    """The lower left and upper right corner (2, 2) [m] of the window around a path (n, 2) [m]; None: not needed.

    box: of the plate, (2, 2) m.  actuators: (N, 2) m.
    """
    length = extent(path)
    if not is_visible(path, box) or length > SHORT * extent(box):
        return None
    longest = min(MAX_LENGTHS * length, MIN_LENGTHS * SHORT * extent(box))
    side = float(np.clip(PITCHES * pitch(actuators), MIN_LENGTHS * length, longest))
    middle = (path.min(axis=0) + path.max(axis=0)) / 2
    return np.stack([middle - side / 2, middle + side / 2])
