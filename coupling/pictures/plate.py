"""The plate in the picture of a run: heights as colours and lines, rim and actuators, whole and in the window."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Colormap, LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import ConnectionPatch, Rectangle
from matplotlib.ticker import MaxNLocator, StrMethodFormatter
from matplotlib.tri import Triangulation, UniformTriRefiner
from numpy.typing import NDArray

from coupling.display import onto_plate
from coupling.pictures.prefixes import STEPS, Unit, readable
from coupling.pictures.window import extent, pitch
from fem_plate import PlateShapes
from meshes import rim_curves

if TYPE_CHECKING:
    from coupling.display import DisplaySurface

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Patch = tuple[FloatArray, IntArray, FloatArray]
"""Points (n, 2) [m], triangles (m, 3) and deflections (n,) [m] that cover a piece of a plate."""

MOST_TRIANGLES = 60_000  # of a mesh that is made finer to be drawn
FINEST = 4  # times that its edges are halved
AXES_WIDTH = 330.0  # points, about
MARGIN = 0.04  # of the plate's longer side, around it
FEW = 25  # actuators, which are always marked
LEAST_APART, LINES_APART = 4.0, 8.0  # points, where many are nearer markers or lines of equal height merge
MARKERS = (1.5, 6.0)  # points, the smallest and largest
FLAT = 1e-9  # of the largest height: smaller differences are none
BELOW = 0.01  # of the largest height: shallower hollows are not told from 0
BANDS, LABELS = 12, 8  # about, of a bar
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
        """A new one each time: a bar whose norm others use as well loses its limits."""
        return Normalize(self.lowest, self.highest)

    @staticmethod
    def of(deflection: FloatArray) -> Scale:
        """For the deflections (n,) [m] of the whole plate: white at 0, a colour below it where that matters."""
        unit = readable(deflection, "m")
        high, low = (float(w) * unit.per_si for w in (deflection.max(), deflection.min()))
        if -low > BELOW * high:
            return Scale(unit, -max(high, -low), max(high, -low), BOTH_WAYS)
        return Scale(unit, 0.0, high, UPWARDS)


class Relief(NamedTuple):
    """A plate as it is at one moment, to be drawn."""

    box: FloatArray  # (2, 2) m, around it
    actuators: FloatArray  # (N, 2) m
    deflection: FloatArray  # (n,) m, of all of it
    within: Callable[[FloatArray], Patch]  # what covers it within a frame (2, 2) [m]
    rim: Callable[[float], list[FloatArray]]  # its curves (k, 2) [m], with points so far apart [m]

    @property
    def frame(self) -> FloatArray:
        """The corners (2, 2) [m] of a picture of all of it."""
        return self.box + MARGIN * extent(self.box) * np.array([[-1.0], [1.0]])


def relief_of(shapes: PlateShapes, surface: DisplaySurface, heights: FloatArray) -> Relief:
    """The plate of some shapes with its drives at heights (N,) [m]."""
    return Relief(
        shapes.outline.box,
        shapes.points,
        surface.deflection(heights[None])[0],
        lambda frame: fine_field(shapes, surface, heights, frame),
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
    """Draw what of a plate is in a frame (2, 2) [m] into axes so wide [points], with its bar at a side; return keys."""
    scale = Scale.of(relief.deflection)
    points, triangles, w = relief.within(frame)
    lined = apart(relief.actuators, frame, width) >= LINES_APART
    _draw_heights(figure, axes, points * unit.per_si, triangles, w * scale.unit.per_si, scale, side, lined)
    curves = [curve * unit.per_si for curve in relief.rim(extent(frame) / 200)]
    axes.add_collection(LineCollection(curves, colors="black", linewidths=1.5))
    axes.set_xlim(*(frame[:, 0] * unit.per_si))
    axes.set_ylim(*(frame[:, 1] * unit.per_si))
    return _mark_actuators(axes, relief.actuators, frame, unit, width)


def fine_field(shapes: PlateShapes, surface: DisplaySurface, heights: FloatArray, frame: FloatArray) -> Patch:
    """What covers the plate within a frame (2, 2) [m].

    The triangles are those of the drawn plate, divided until they are so small that contours look smooth.
    """
    points, triangles, used = cut_out(surface.points, surface.triangles, frame)
    fine = divided(points, triangles)
    if fine is None:
        return points, triangles, surface.deflection(heights[None])[0][used]
    points = np.stack([fine.x, fine.y], axis=1)
    w = shapes.values(onto_plate(shapes.outline, points), heights[:, None])[:, 0]
    return points, fine.triangles.astype(np.int64), w


def cut_out(points: FloatArray, triangles: IntArray, frame: FloatArray) -> tuple[FloatArray, IntArray, IntArray]:
    """Points, the triangles of a mesh that reach into a frame (2, 2) [m], and the rows of the points in the mesh."""
    lowest, highest = (f(points[triangles], axis=1) for f in (np.min, np.max))
    triangles = triangles[((highest > frame[0]) & (lowest < frame[1])).all(axis=1)]
    used, rows = np.unique(triangles, return_inverse=True)
    return points[used], rows.reshape(-1, 3), used


def divided(points: FloatArray, triangles: IntArray) -> Triangulation | None:
    """Triangles divided until they are so small that contours look smooth; None: they are."""
    halvings = min(int(math.log(max(MOST_TRIANGLES / max(len(triangles), 1), 1), 4)), FINEST)
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
    """Bands of equal height and the lines between them, or shades without lines, with their bar at a side."""
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


def apart(places: FloatArray, frame: FloatArray, width: float = AXES_WIDTH) -> float:
    """How far apart [points] places (N, 2) [m] are in a frame (2, 2) [m] so wide [points]; inf where they are few."""
    return width * pitch(places) / extent(frame) if len(places) > FEW else math.inf


def marker_size(places: FloatArray, frame: FloatArray, width: float = AXES_WIDTH) -> float:
    """The size [points] of markers at places (N, 2) [m], apart from each other; 0: they merge.

    frame: (2, 2) m, that of axes so wide [points].
    """
    distance = apart(places, frame, width)
    return float(np.clip(0.3 * distance, *MARKERS)) if distance >= LEAST_APART else 0.0


def _mark_actuators(axes: Axes, actuators: FloatArray, frame: FloatArray, unit: Unit, width: float) -> list[Artist]:
    """Mark the actuators (N, 2) [m] whose markers lie within a frame whole; return a key of these."""
    seen = actuators[((actuators > frame[0]) & (actuators < frame[1])).all(axis=1)]
    size = marker_size(seen, frame, width)
    if not size:
        return [Line2D([], [], linestyle="", label=f"{len(actuators)} actuators, too many to be marked")]
    edge = size / width * extent(frame)
    seen = seen[((seen > frame[0] + edge) & (seen < frame[1] - edge)).all(axis=1)]
    look: dict[str, Any] = {"color": "white", "marker": "^", "markeredgecolor": "black", "linestyle": ""}
    axes.plot(*(seen.T * unit.per_si), **look, markersize=size, markeredgewidth=size / MARKERS[1], zorder=2.5)
    return [Line2D([], [], **look, label="actuator")] if len(seen) else []


def draw_window(axes: Axes, unit: Unit, window: FloatArray) -> None:
    """Show on a map where a window (2, 2) [m] is."""
    corner, sides = window[0] * unit.per_si, np.ptp(window, axis=0) * unit.per_si
    axes.add_patch(Rectangle(tuple(corner), *sides, fill=False, edgecolor="black", linewidth=1.2, zorder=4))


def join(figure: Figure, axes: list[Axes], unit: Unit, window: FloatArray) -> None:
    """Join a window (2, 2) [m] on a map in the first axes to the second ones, on its right."""
    for k in (0, 1):
        place = np.array([window[1, 0], window[k, 1]]) * unit.per_si
        ends: dict[str, Any] = {"axesA": axes[0], "coordsA": "data", "axesB": axes[1], "coordsB": "axes fraction"}
        figure.add_artist(ConnectionPatch(tuple(place), (0, k), **ends, linewidth=0.7))
    axes[1].yaxis.tick_right()
    axes[1].yaxis.set_label_position("right")
