"""The picture of a run: the path from above, height and speed over time, stick and slip marked.

Of a platform also the velocities of part and platform as seen by one at rest.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from coupling.case import Case
from coupling.drive_case import amplitude
from coupling.drives import stroke_heights
from coupling.rim import rim_curves
from fem_plate import PlateShapes
from particle import Samples, State, Trajectory

if TYPE_CHECKING:
    from coupling.scene import Ground, Scene

FloatArray = NDArray[np.float64]

MICRO, MILLI = 1e6, 1e3
SLIP_COLOUR, STICK_COLOUR, FLIGHT_COLOUR = "#c8371b", "#1b4f9c", "#606060"
SAMPLES = 4000
AXES_WIDTH = 330.0  # points, about
DOT = 2.0  # points, below which a marker is a dot
PATH_SHARE, PITCHES_SHOWN = 2.5, 4.5  # of the path's extent, and of the pitch, that the window around a path shows
LARGEST_WINDOW = 0.25  # of the plate's size: where it would be larger, all of the plate is shown
SMALLEST_MARKER, SMALL_MARKER, LARGEST_MARKER = 0.8, 4.0, 6.0  # points


class Unit(NamedTuple):
    """A unit of length."""

    name: str
    per_metre: float


def draw_run(case: Case, scene: Scene, trajectory: Trajectory, ground: Ground, path: Path) -> None:
    """Draws the run into a PNG file."""
    times = np.linspace(0, trajectory.time[-1], SAMPLES)
    samples = trajectory.at(times)
    unit, rise = _unit(ground.points), _unit(samples.height)
    curves = [
        (f"height of the part [{rise.name}]", {"": samples.height * rise.per_metre}),
        (f"speed {'on ' + scene.origin if scene.base else 'in the plane'} [m/s]", {"": np.hypot(*samples.velocity.T)}),
        *_seen_from_rest(scene, samples),
    ][0 if samples.height.any() else 1 :]
    figure = Figure(figsize=(12.0, max(6.0, 2.2 * len(curves) + 1.0)))
    FigureCanvasAgg(figure)
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.06)
    grid = figure.add_gridspec(len(curves), 2, width_ratios=(1.05, 1))
    _draw_path(figure, figure.add_subplot(grid[:, 0]), scene, ground, case, trajectory, unit)
    for k, (label, lines) in enumerate(curves):
        axes = figure.add_subplot(grid[k, 1])
        _draw_over_time(axes, trajectory, times, lines, label)
        axes.tick_params(labelbottom=k == len(curves) - 1)
        if k == len(curves) - 1:
            axes.set_xlabel("time [ms]")
    figure.suptitle(f"{case.name}: {trajectory.sentence}")
    partial = path.with_suffix(".partial.png")
    figure.savefig(partial, dpi=110)
    partial.replace(path)


def _unit(lengths: FloatArray) -> Unit:
    """The unit in which an array of lengths [m] has numbers of a usual size."""
    extent = float(np.abs(lengths).max())
    return Unit("µm", MICRO) if extent < 0.01 else Unit("mm", 1e3) if extent < 1 else Unit("m", 1.0)


def _seen_from_rest(scene: Scene, samples: Samples) -> list[tuple[str, dict[str, FloatArray]]]:
    """The velocities of part and platform along each axis in which the platform moves."""
    panels = []
    for name, drive, relative in zip("xy", scene.base, samples.velocity.T, strict=False):
        velocity = drive.evaluate(samples.time * (1 - 1e-12))[1]  # before a motion's end, not after it
        if velocity.any():
            panels.append((f"velocity along {name} [m/s]", {"part": velocity + relative, "platform": velocity}))
    return panels


def _draw_path(
    figure: Figure, axes: Axes, scene: Scene, ground: Ground, case: Case, trajectory: Trajectory, unit: Unit
) -> None:
    """The path over the surface from above."""
    window = None if scene.shapes is None else path_window(scene.shapes, trajectory.position)
    heights = np.array([amplitude(actuator) for actuator in case.actuators])
    if window is not None:
        heights = stroke_heights(scene.lifts, trajectory.time[-1:])[0]
    keys = scene.draw(figure, axes, ground, heights, unit, window)
    points = trajectory.position * unit.per_metre
    fine = np.linspace(0, trajectory.time[-1], SAMPLES)
    line = trajectory.at(fine).position * unit.per_metre
    axes.add_collection(LineCollection([line], colors=SLIP_COLOUR, linewidths=1.5))
    rests = trajectory.state == State.STICK
    axes.plot(*points[rests].T, "o", color=STICK_COLOUR, markersize=4, zorder=3)
    axes.plot(*points[0], "s", color="gold", markeredgecolor="black", markersize=8, zorder=5)
    axes.plot(*points[-1], "*", color="gold", markeredgecolor="black", markersize=14, zorder=5)
    axes.use_sticky_edges = False  # the rim is drawn whole
    axes.set_aspect("equal")
    where = f" on {scene.origin}" if scene.base else ""
    axes.set_xlabel(f"x{where} [{unit.name}]")
    axes.set_ylabel(f"y{where} [{unit.name}]")
    keys = [
        Line2D([], [], color=SLIP_COLOUR, label="path"),
        Line2D([], [], color=STICK_COLOUR, marker="o", linestyle="", markersize=5, label="rests here"),
        *keys,
        Line2D([], [], color="gold", marker="s", markeredgecolor="black", linestyle="", markersize=8, label="start"),
        Line2D([], [], color="gold", marker="*", markeredgecolor="black", linestyle="", markersize=13, label="end"),
    ]
    figure.legend(handles=keys, loc="outside lower center", ncols=5, frameon=False)


def draw_plate(
    figure: Figure,
    axes: Axes,
    shapes: PlateShapes,
    points: FloatArray,
    triangles: NDArray[np.int64],
    deflection: FloatArray,
    unit: Unit,
    window: FloatArray | None = None,
) -> list[Line2D]:
    """The plate from above: contours, its rim and the actuators; returns their keys.

    points (n, 2) [m], triangles (m, 3) and the deflection (n,) [m].
    window: (2, 2) m, the part of the plate to show, as it is at the end, with a small map of the whole; None: all of
    it, with all drives up at once.
    """
    if window is not None:
        seen = ((points > window[0] - np.ptp(window) / 10) & (points < window[1] + np.ptp(window) / 10)).all(axis=1)
        triangles = triangles[seen[triangles].any(axis=1)]
        used, rows = np.unique(triangles, return_inverse=True)
        points, deflection, triangles = points[used], deflection[used], rows.reshape(-1, 3)
    xy, w = points * unit.per_metre, deflection * MICRO
    low, high = w.min(), w.max()
    when = "with all drives up at once" if window is None else "at the end"
    if high > low:
        # Rounding and faint counter-deflection do not deserve a band below zero.
        levels = MaxNLocator(12).tick_values(0.0 if -low < 0.01 * high else low, high)
        filled = axes.tricontourf(*xy.T, triangles, w, levels=levels, cmap="Greys", alpha=0.75, extend="min")
        figure.colorbar(filled, ax=axes, label=f"deflection {when} [µm]", shrink=0.8, format="%.3g")
    rim = rim_curves(shapes.outline, shapes.size / 100)
    curves = [curve * unit.per_metre for curve in rim]
    axes.add_collection(LineCollection(curves, colors="black", linewidths=1.5))
    size = _marker_size(shapes.points, shapes.outline.box if window is None else window)
    marker: dict[str, Any] = {"marker": "^", "color": "white", "markeredgecolor": "black", "linestyle": ""}
    if size < DOT:
        marker = {"marker": ".", "color": "black", "markeredgecolor": "none", "linestyle": ""}
    edge = min(1.0, size / SMALL_MARKER)
    axes.plot(*(shapes.points.T * unit.per_metre), **marker, markersize=size, markeredgewidth=edge, zorder=2.5)
    if window is not None:
        _draw_map(axes, curves, window * unit.per_metre)
    return [Line2D([], [], **marker, markersize=9, label="actuator")]


def path_window(shapes: PlateShapes, path: FloatArray) -> FloatArray | None:
    """The part of the plate (2, 2) [m] around a path (n, 2) [m] and the nearest actuators, if that is a small part."""
    if len(shapes.points) < 2:
        return None
    low, high = path.min(axis=0), path.max(axis=0)
    pitch = float(np.median(cKDTree(shapes.points).query(shapes.points, k=2)[0][:, 1]))
    half = max(PATH_SHARE * float((high - low).max()), PITCHES_SHOWN * pitch) / 2
    if half > LARGEST_WINDOW * shapes.size:
        return None
    return np.stack([(low + high) / 2 - half, (low + high) / 2 + half])


def _draw_map(axes: Axes, rim: list[FloatArray], window: FloatArray) -> None:
    """Show only the window (2, 2), and in a corner where it is on the plate."""
    axes.set_xlim(*window[:, 0])
    axes.set_ylim(*window[:, 1])
    chart = axes.inset_axes((0.015, 0.015, 0.22, 0.22), zorder=6)
    chart.add_collection(LineCollection(rim, colors="black", linewidths=1.0))
    (left, bottom), (width, height) = window[0], np.ptp(window, axis=0)
    chart.add_patch(Rectangle((left, bottom), width, height, color=SLIP_COLOUR))
    chart.autoscale_view()
    chart.set_aspect("equal")
    chart.set_xticks([])
    chart.set_yticks([])


def _marker_size(places: FloatArray, box: FloatArray) -> float:
    """The size [points] of markers at places (N, 2) [m] on a plate in a box (2, 2) [m], apart from each other."""
    if len(places) < 2:
        return LARGEST_MARKER
    apart = float(np.quantile(cKDTree(places).query(places, k=2)[0][:, 1], 0.1)) / float(np.ptp(box, axis=0).max())
    return float(np.clip(0.4 * AXES_WIDTH * apart, SMALLEST_MARKER, LARGEST_MARKER))


def _draw_over_time(
    axes: Axes, trajectory: Trajectory, times: FloatArray, lines: dict[str, FloatArray], label: str
) -> None:
    """Curves over time, by their names, with the stuck stretches shaded, and those in flight."""
    for (name, values), colour, style in zip(lines.items(), ("black", SLIP_COLOUR), ("-", "--"), strict=False):
        axes.plot(times * MILLI, values, color=colour, linestyle=style, linewidth=1.2, label=name)
    if len(lines) > 1:
        axes.legend(frameon=False, fontsize=9, loc="lower left", bbox_to_anchor=(0, 0.97), ncols=2, borderpad=0.1)
    edges = trajectory.time * MILLI
    for state, colour in ((State.STICK, STICK_COLOUR), (State.FLIGHT, FLIGHT_COLOUR)):
        for begin, end in _stretches(trajectory.state == state):
            axes.axvspan(edges[begin], edges[end], color=colour, alpha=0.18, linewidth=0)
    axes.set_xlim(0, edges[-1])
    axes.set_ylabel(label)
    axes.grid(alpha=0.3)
    shades = "blue: stuck, grey: in flight" if (trajectory.state == State.FLIGHT).any() else "shaded: stuck"
    axes.set_title(shades, loc="right", fontsize=9, color=STICK_COLOUR)


def _stretches(holds: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and last row of each stretch of rows during which something (n,) holds."""
    change = np.diff(np.concatenate([[0], holds[:-1].astype(int), [0]]))
    return list(zip(np.flatnonzero(change == 1).tolist(), np.flatnonzero(change == -1).tolist(), strict=True))
