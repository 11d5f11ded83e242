"""The picture of an identification: tracks beside paths, over the plane and over time, and what is left."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from active_surface.arrays import FloatArray
from active_surface.identification.estimate import TrackFit
from active_surface.identification.result import Identified
from common import Drawing, draw, figure_of, unit_for
from coupling.pictures import map_axes, put_title

SAMPLES: Final = 2000  # of the path
MEASURED: Final[dict[str, Any]] = {
    "linestyle": "",
    "marker": "o",
    "markersize": 3.5,
    "markeredgewidth": 0,
    "alpha": 0.7,
}
COLOURS: Final = ("#1b4f9c", "#c8371b", "#2d7d46")  # of x, y and heading
FEW_TICKS: Final = 3  # along x of the narrow map, where a small part of a large place takes long numbers
ROW, LEAST_HEIGHT = 2.6, 3.8  # in, of one of several tracks, and of all
WORDS: Final[dict[str, Any]] = {"fontsize": 9, "parse_math": False}


@draw.register(Identified)
def draw_identified(result: Identified, axes: Axes | None = None) -> Figure:
    """Draw a result: a row for each track, over the plane and over time; with axes in m, all over the plane."""
    if axes is not None:
        for fit in result.fits:
            _draw_plane(axes, fit, 1.0)
        axes.legend(frameon=False)
        return figure_of(axes)
    count = len(result.fits)
    figure = Drawing(figsize=(13.0, 0.8 + max(ROW * count, LEAST_HEIGHT)))
    grid = figure.add_gridspec(count, 3, width_ratios=(1, 1.6, 1.2))
    for row, fit in enumerate(result.fits):
        plane, places, rest = (figure.add_subplot(grid[row, column]) for column in range(3))
        _draw_map(plane, fit, legend=not row)
        _draw_times(places, rest, fit, legend=not row)
        if count > 1:
            plane.set_title(fit.name, **WORDS)
        own = [f"{one.field} = {one.text}" for one in result.estimates if one.case == fit.name]
        places.set_title("\n".join(own), **WORDS)
    name = result.fits[0].case.name if count == 1 else ", ".join(fit.name for fit in result.fits)
    lines = [f"{one.field} = {one.text}" for one in result.estimates if one.case is None]
    put_title(figure, "\n".join([name, *lines]), fontsize=10)
    return figure


def _draw_map(axes: Axes, fit: TrackFit, legend: bool) -> None:
    unit = unit_for(fit.track.position[np.isfinite(fit.track.position)], "m")
    _draw_plane(axes, fit, unit.per_si)
    if legend:
        axes.legend(frameon=False)
    map_axes(axes, unit)
    axes.locator_params("x", nbins=FEW_TICKS)
    axes.set_aspect("equal", adjustable="datalim")


def _draw_plane(axes: Axes, fit: TrackFit, per_si: float) -> None:
    """Draw the path and the places over the plane; those whose x or y is not measured are left out."""
    times = np.linspace(0, fit.track.time[-1], SAMPLES)
    axes.plot(*(fit.trajectory.at(times).position * per_si).T, color="black", linewidth=1.2, label="path")
    axes.plot(*(fit.track.position * per_si).T, color=COLOURS[0], **MEASURED, label="track")


def _draw_times(places: Axes, rest: Axes, fit: TrackFit, legend: bool) -> None:
    """Draw x, y and heading over time, and path minus track, headings as lengths."""
    track, path = fit.track, fit.trajectory
    times = np.linspace(0, track.time[-1], SAMPLES)
    clock, unit = unit_for(times, "s"), unit_for(track.position[np.isfinite(track.position)], "m")
    left = unit_for(fit.residuals, "m")
    line, away = path.at(times).position, fit.away
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
    keys = places.get_lines()
    if track.heading is not None:
        keys += _draw_headings(places, fit, times, clock.per_si)
        rest.plot(track.time * clock.per_si, away[:, 2] * left.per_si, color=COLOURS[2], **MEASURED)
    rest.axhline(0, color="black", linewidth=0.8)
    places.set_ylabel(f"place [{unit.name}]")
    rest.set_ylabel(f"path - track [{left.name}]")
    if legend:
        places.legend(handles=keys, frameon=False, fontsize=8)
    for axes in (places, rest):
        axes.set_xlabel(f"time [{clock.name}]")
        axes.grid(alpha=0.3)


def _draw_headings(places: Axes, fit: TrackFit, times: FloatArray, per_second: float) -> list[Line2D]:
    """Draw the heading over time on a scale at the right, that of the track in the path's whole turns; return keys."""
    turned, exact = fit.trajectory.at(times).heading, fit.trajectory.at(fit.track.time).heading
    assert turned is not None and exact is not None
    measured = exact - fit.away[:, 2] / fit.track.lever(fit.case.part.gyration)
    axes = places.twinx()
    look: dict[str, Any] = {"color": COLOURS[2]}
    axes.plot(times * per_second, np.degrees(turned), linewidth=1.2, **look, label="heading of the path")
    axes.plot(fit.track.time * per_second, np.degrees(measured), **look, **MEASURED, label="heading of the track")
    axes.set_ylabel("heading [deg]", **look)
    return [*axes.get_lines()]
