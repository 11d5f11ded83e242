"""The picture of an identification: the track beside the path, over the plane and over time, and what is left."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from active_surface.identification.result import Identified
from coupling.pictures import map_axes, save_picture
from meshes import Drawing, plotted, unit_for

SAMPLES: Final = 2000  # of the path
MEASURED: Final[dict[str, Any]] = {
    "linestyle": "",
    "marker": "o",
    "markersize": 3.5,
    "markeredgewidth": 0,
    "alpha": 0.7,
}
COLOURS: Final = ("#1b4f9c", "#c8371b")  # of x and y


def draw_identified(result: Identified, path: Path) -> Path:
    """Draw a result into a PNG file; return its path."""
    return save_picture(_drawing(result), path)


def plot_identified(result: Identified, axes: Axes | None) -> Figure:
    """Draw a result into a figure of its own, or the path and the track over the plane into axes in m."""
    return _drawing(result) if axes is None else plotted(lambda given: _draw_plane(given, result, 1.0), axes)


def _drawing(result: Identified) -> Figure:
    figure = Drawing(figsize=(12.0, 5.6))
    grid = figure.add_gridspec(2, 2, width_ratios=(1, 1.3), height_ratios=(2, 1))
    plane = figure.add_subplot(grid[:, 0])
    unit = unit_for(result.track.position[np.isfinite(result.track.position)], "m")
    _draw_plane(plane, result, unit.per_si)
    map_axes(plane, unit)
    plane.set_aspect("equal", adjustable="datalim")
    over_time = figure.add_subplot(grid[0, 1])
    _draw_times(over_time, figure.add_subplot(grid[1, 1], sharex=over_time), result)
    lines = [f"{one.field} = {one.text}" for one in result.estimates]
    figure.suptitle("\n".join([result.case.name, *lines]), parse_math=False, fontsize=10)
    return figure


def _draw_plane(axes: Axes, result: Identified, per_si: float) -> None:
    """Draw the path and the places over the plane; those whose x or y is not measured are left out."""
    times = np.linspace(0, result.track.time[-1], SAMPLES)
    axes.plot(*(result.trajectory.at(times).position * per_si).T, color="black", linewidth=1.2, label="path")
    axes.plot(*(result.track.position * per_si).T, color=COLOURS[0], **MEASURED, label="track")
    axes.legend(frameon=False)


def _draw_times(places: Axes, rest: Axes, result: Identified) -> None:
    """Draw x and y over time, and path minus track."""
    track, path = result.track, result.trajectory
    times = np.linspace(0, track.time[-1], SAMPLES)
    clock, unit = unit_for(times, "s"), unit_for(track.position[np.isfinite(track.position)], "m")
    left = unit_for(result.residuals, "m")
    line, away = path.at(times).position, path.at(track.time).position - track.position
    for axis, name in enumerate(("x", "y")):
        if np.isnan(track.position[:, axis]).all():
            continue
        colour = COLOURS[axis]
        places.plot(
            times * clock.per_si, line[:, axis] * unit.per_si, color=colour, linewidth=1.2, label=f"{name} of the path"
        )
        measured = track.time * clock.per_si
        places.plot(
            measured, track.position[:, axis] * unit.per_si, color=colour, **MEASURED, label=f"{name} of the track"
        )
        rest.plot(measured, away[:, axis] * left.per_si, color=colour, **MEASURED)
    rest.axhline(0, color="black", linewidth=0.8)
    places.set_ylabel(f"place [{unit.name}]")
    rest.set_ylabel(f"path - track [{left.name}]")
    rest.set_xlabel(f"time [{clock.name}]")
    places.legend(frameon=False, fontsize=8)
    for axes in (places, rest):
        axes.grid(alpha=0.3)
