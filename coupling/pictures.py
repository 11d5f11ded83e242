"""The picture of a run: the plate from above with the path, height and speed over time, stick and slip marked."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from coupling.case import Case
from coupling.rim import rim_curves
from fem_plate import InfluenceShapes
from particle import State, Trajectory

FloatArray = NDArray[np.float64]

MICRO, MILLI = 1e6, 1e3
SLIP_COLOUR, STICK_COLOUR = "#c8371b", "#1b4f9c"
SAMPLES = 4000


Plate = tuple[FloatArray, NDArray[np.int64], FloatArray]
"""Points (n, 2) [m], triangles (m, 3) and the deflection (n,) [m] with all drives up at once."""


def draw_run(case: Case, shapes: InfluenceShapes, trajectory: Trajectory, plate: Plate, path: Path) -> None:
    """Draws the run into a PNG file."""
    figure = Figure(figsize=(12.0, 6.0))
    FigureCanvasAgg(figure)
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.06)
    grid = figure.add_gridspec(2, 2, width_ratios=(1.05, 1))
    _draw_path(figure, figure.add_subplot(grid[:, 0]), shapes, plate, trajectory)
    height, speed = figure.add_subplot(grid[0, 1]), figure.add_subplot(grid[1, 1])
    times = np.linspace(0, trajectory.time[-1], SAMPLES)
    samples = trajectory.at(times)
    _draw_over_time(height, trajectory, times, samples.height * MICRO, "height of the part [µm]")
    _draw_over_time(speed, trajectory, times, np.hypot(*samples.velocity.T), "speed in the plane [m/s]")
    height.tick_params(labelbottom=False)
    speed.set_xlabel("time [ms]")
    figure.suptitle(f"{case.name}: {trajectory.outcome.sentence}")
    partial = path.with_suffix(".partial.png")
    figure.savefig(partial, dpi=110)
    partial.replace(path)


def _draw_path(figure: Figure, axes: Axes, shapes: InfluenceShapes, plate: Plate, trajectory: Trajectory) -> None:
    """The plate from above: contours with all drives up at once, its rim, the actuators and the path."""
    xy, triangles, w = plate[0] * MICRO, plate[1], plate[2] * MICRO
    low, high = w.min(), w.max()
    if high > low:
        # Rounding and faint counter-deflection do not deserve a band below zero.
        levels = MaxNLocator(12).tick_values(0.0 if -low < 0.01 * high else low, high)
        filled = axes.tricontourf(*xy.T, triangles, w, levels=levels, cmap="Greys", alpha=0.75, extend="min")
        figure.colorbar(filled, ax=axes, label="deflection with all drives up at once [µm]", shrink=0.8, format="%.3g")
    rim = rim_curves(shapes.outline, shapes.size / 100)
    axes.add_collection(LineCollection([curve * MICRO for curve in rim], colors="black", linewidths=1.5))
    points = trajectory.position * MICRO
    fine = np.linspace(0, trajectory.time[-1], SAMPLES)
    line = trajectory.at(fine).position * MICRO
    axes.add_collection(LineCollection([line], colors=SLIP_COLOUR, linewidths=1.5))
    rests = trajectory.state == State.STICK
    axes.plot(*points[rests].T, "o", color=STICK_COLOUR, markersize=4, zorder=3)
    axes.plot(*(shapes.points.T * MICRO), "^", color="white", markeredgecolor="black", markersize=6, zorder=6)
    axes.plot(*points[0], "s", color="gold", markeredgecolor="black", markersize=8, zorder=5)
    axes.plot(*points[-1], "*", color="gold", markeredgecolor="black", markersize=14, zorder=5)
    axes.use_sticky_edges = False  # the rim is drawn whole
    axes.set_aspect("equal")
    axes.set_xlabel("x [µm]")
    axes.set_ylabel("y [µm]")
    keys = [
        Line2D([], [], color=SLIP_COLOUR, label="path"),
        Line2D([], [], color=STICK_COLOUR, marker="o", linestyle="", markersize=5, label="rests here"),
        Line2D(
            [], [], color="white", marker="^", markeredgecolor="black", linestyle="", markersize=9, label="actuator"
        ),
        Line2D([], [], color="gold", marker="s", markeredgecolor="black", linestyle="", markersize=8, label="start"),
        Line2D([], [], color="gold", marker="*", markeredgecolor="black", linestyle="", markersize=13, label="end"),
    ]
    figure.legend(handles=keys, loc="outside lower center", ncols=5, frameon=False)


def _draw_over_time(axes: Axes, trajectory: Trajectory, times: FloatArray, values: FloatArray, label: str) -> None:
    """A curve over time with the stuck stretches shaded."""
    axes.plot(times * MILLI, values, color="black", linewidth=1.2)
    stuck = trajectory.state == State.STICK
    edges = trajectory.time * MILLI
    for begin, end in _stretches(stuck):
        axes.axvspan(edges[begin], edges[end], color=STICK_COLOUR, alpha=0.18, linewidth=0)
    axes.set_xlim(0, edges[-1])
    axes.set_ylabel(label)
    axes.grid(alpha=0.3)
    axes.set_title("shaded: stuck", loc="right", fontsize=9, color=STICK_COLOUR)


def _stretches(stuck: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and last row of each stretch of rows during which the part is stuck."""
    change = np.diff(np.concatenate([[0], stuck[:-1].astype(int), [0]]))
    return list(zip(np.flatnonzero(change == 1).tolist(), np.flatnonzero(change == -1).tolist(), strict=True))
