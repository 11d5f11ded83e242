"""The picture of many parts: all paths and outlines from above, and how far each part is from its start over time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import cycle
from typing import Any, Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from common import Drawing, Unit, count, draw, figure_of, label_places, unit_for
from coupling.display import display_surface
from coupling.parts import PartsResult
from coupling.pictures.figure import map_axes, plain_ticks, put_keys, put_title
from coupling.pictures.plate import draw_maps, draw_plate, path_window
from coupling.pictures.portrait import SAMPLES, Portrait, even_times, portrait_of
from coupling.pictures.run import draw_outlines, outlines_of
from particle import HALO, RING, Samples

FloatArray = NDArray[np.float64]
Lines = Mapping[str, Samples]
"""Paths by name."""

PANEL, ROW = 5.0, 2.0  # inches: the side of a map, and the height of what is drawn over time
END: Final[dict[str, Any]] = RING | {"marker": "x"}
PARTS_COLOURS: Final = ("#c8371b", "#1b4f9c", "#2d7d46", "#b8862d", "#7a4b94", "#00838a", "#d0579c", "#555555")
"""Of the paths of parts, one after the other and then again."""


@draw.register(PartsResult)
def draw_parts(result: PartsResult, axes: Axes | None = None) -> Figure:
    """Draw all paths over the surface, and distances over time; with axes in m, only the paths, into these."""
    first, lines = next(iter(result.results.values())), _lines(result)
    portrait, outlines = portrait_of(first), _outlines(result, lines)
    if axes is not None:
        return draw_paths_into(axes, portrait, lines, outlines)
    box = portrait.box
    if not portrait.plate:
        box = display_surface(first.scene, *(one.trajectory for one in result.results.values())).points
    figure, place, keys = draw_paths_over(portrait, lines, outlines, box, ROW)
    _draw_distances(figure.add_subplot(place), lines)
    met = f", {count(len(result.overlaps), 'pair')} overlap" if result.overlaps else ""
    put_title(figure, f"{result.name}: {count(len(lines), 'part')} that do not feel each other{met}")
    put_keys(figure, keys)
    return figure


def draw_paths_into(axes: Axes, portrait: Portrait, lines: Lines, outlines: Sequence[FloatArray]) -> Figure:
    """Draw paths over a plate, if there is one, into axes in m; return their figure."""
    if portrait.plate:
        draw_plate(axes, portrait.plate, Unit("m", 1.0))
    _draw_paths(axes, lines, outlines, Unit("m", 1.0))
    label_places(axes)
    return figure_of(axes)


def draw_paths_over(
    portrait: Portrait, lines: Lines, outlines: Sequence[FloatArray], box: FloatArray, below: float
) -> tuple[Figure, SubplotSpec, list[Artist]]:
    """A figure with paths over the surface of a portrait, whole and around them; the place below, and keys.

    box: points (n, 2) [m] of a platform that are shown.  below: the height of that place [inches].
    """
    plate, figure = portrait.plate, Drawing()
    points = np.concatenate([line.position for line in lines.values()] + [some.reshape(-1, 2) for some in outlines])
    window = path_window(points, portrait.box, plate.actuators) if plate else None
    maps = 1 if window is None else 2
    figure.set_size_inches(PANEL * max(maps, 1.5) + 1.6, PANEL + below + 1.2)
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.05)
    grid = figure.add_gridspec(2, 1, height_ratios=[PANEL, below])
    places = grid[0].subgridspec(1, maps)
    panels = [figure.add_subplot(places[k]) for k in range(maps)]
    if plate:
        panels[0].set_title(f"The plate at {portrait.when}, {portrait.most}", fontsize=10)
        keys, unit = draw_maps(panels, plate, window)
    else:
        keys, unit = [], unit_for(box, "m")
        map_axes(panels[0], unit, portrait.where)
        panels[0].set_xlim(*(unit.per_si * np.array([box[:, 0].min(), box[:, 0].max()])))
        panels[0].set_ylim(*(unit.per_si * np.array([box[:, 1].min(), box[:, 1].max()])))
        panels[0].grid(alpha=0.3)
    if window is not None:
        panels[1].set_title(f"Around the paths, also at {portrait.when}", fontsize=10)
    return figure, grid[1], _draw_paths(panels[-1], lines, outlines, unit) + keys


def _lines(result: PartsResult) -> Lines:
    """The paths by the names of the parts, at as many moments as make smooth lines."""
    paths = {name: one.trajectory for name, one in result.results.items()}
    return {name: path.at(even_times(path.time, SAMPLES, path.events)) for name, path in paths.items()}


def _outlines(result: PartsResult, lines: Lines) -> list[FloatArray]:
    return [outlines_of(one.case, lines[name], one.trajectory) for name, one in result.results.items()]


def _draw_paths(axes: Axes, lines: Lines, outlines: Sequence[FloatArray], unit: Unit) -> list[Artist]:
    """Draw the paths with their outlines, starts and ends, each in its colour; return keys."""
    keys: list[Artist] = []
    for (name, line), some, colour in zip(lines.items(), outlines, cycle(PARTS_COLOURS), strict=False):
        places = line.position * unit.per_si
        keys += axes.plot(*places.T, color=colour, linewidth=1.4, path_effects=HALO, zorder=3, label=name)
        draw_outlines(axes, some, unit, colour)
        axes.plot(*places[:1].T, **RING | {"markersize": 5}, color=colour, linestyle="", zorder=5)
        axes.plot(*places[-1:].T, **END | {"markersize": 5}, color=colour, linestyle="", zorder=5)
    marks = {"start": RING, "end": END}
    return keys + [Line2D([], [], color="black", linestyle="", label=label, **mark) for label, mark in marks.items()]


def _draw_distances(axes: Axes, lines: Lines) -> None:
    """Draw how far each part is from where it started, over time."""
    away = {name: np.hypot(*(line.position - line.position[0]).T) for name, line in lines.items()}
    unit = unit_for(np.concatenate(list(away.values())), "m")
    clock = unit_for(max(line.time[-1] for line in lines.values()), "s")
    for (name, line), colour in zip(lines.items(), cycle(PARTS_COLOURS), strict=False):
        axes.plot(line.time * clock.per_si, away[name] * unit.per_si, color=colour, linewidth=1.4)
    plain_ticks(axes)
    axes.margins(x=0)
    axes.grid(alpha=0.3)
    axes.set_xlabel(f"time [{clock.name}]")
    axes.set_ylabel(f"distance from\nthe start [{unit.name}]")
