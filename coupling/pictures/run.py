"""The picture of a run: the path from above, whole and in a window, and the motion over time.

The plate is drawn at one moment: the time step of the result files at which it is deflected most.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec
from matplotlib.transforms import ScaledTranslation
from numpy.typing import NDArray

from common import Drawing, Unit, draw, figure_of, label_places, unit_for
from coupling.case import Case
from coupling.margins import LOSSES
from coupling.pictures.figure import map_axes, put_keys, put_title, save_picture
from coupling.pictures.plate import AXES_WIDTH, draw_maps, draw_path, draw_plate, path_window
from coupling.pictures.portrait import Portrait, portrait_of
from coupling.pictures.time import MARKS, Curves, Span, curves_of, draw_events, draw_over_time
from coupling.result import Result
from particle import HALO, Samples, Trajectory, shade_keys

FloatArray = NDArray[np.float64]

PANEL = 5.0  # inches, about: the side of a map
ROW, STRIP = 1.4, 0.16  # inches: the heights of a row over time, and of the strip of events
MIN_WIDTH = 0.6  # of a panel: the width of a map
LETTER, PADS = 6.0, 12.0  # points: the width of a digit on an axis, and of the space around its numbers
NARROWEST = 7.6  # inches, of the picture
OUTLINES = 7  # of a part with a face, from start to end
MANY, SHOWN = 30.0, 6.0  # cycles: a longer run is drawn twice over time, whole and around the decisive moment


def draw_run(run: object, path: Path) -> Path:
    """Draw a run into a PNG file; return its path."""
    return save_picture(draw(run), path)


@draw.register(Result)
def draw_result(result: Result, axes: Axes | None = None) -> Figure:
    """Draw a run; with axes in m, only the path over its surface, into these."""
    portrait = portrait_of(result)
    if axes is None:
        drawing = Drawing()
        compose(drawing, portrait)
        return drawing
    draw_way(axes, portrait, Unit("m", 1.0))
    label_places(axes)
    return figure_of(axes)


def compose(figure: Figure, portrait: Portrait) -> None:
    """Draw the run into an empty figure: maps, and below them what happens over time."""
    box, rows, line, plate = portrait.box, portrait.rows, portrait.samples.position, portrait.plate
    outlines = outlines_of(portrait.case, portrait.samples, rows)
    shown = np.concatenate([line, outlines.reshape(-1, 2)])
    window = path_window(shown, box, plate.actuators) if plate else None
    curves = curves_of(portrait)
    width, height = np.ptp(box, axis=0)
    columns = [float(np.clip(width / height, MIN_WIDTH, 1.0)), *([] if window is None else [1.0])]
    below = STRIP + ROW * len(curves)
    figure.set_size_inches(max(PANEL * sum(columns) + 1.6, NARROWEST), PANEL + below + 1.2)
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.05)
    grid = figure.add_gridspec(2, 1, height_ratios=[PANEL, below])
    maps = grid[0].subgridspec(1, len(columns), width_ratios=columns)
    axes = [figure.add_subplot(maps[k]) for k in range(len(columns))]
    if plate:
        axes[0].set_title(f"The plate at {portrait.when}, {portrait.most}", fontsize=10)
        keys, unit = draw_maps(axes, plate, window)
        keys = draw_path(axes[-1], rows, line, unit, box) + keys
        draw_outlines(axes[-1], outlines, unit)
    else:
        unit = unit_for(box, "m")
        keys = draw_way(axes[0], portrait, unit)
    if window is not None:
        axes[1].set_title(f"Around the path, also at {portrait.when}", fontsize=10)
    _draw_loss(axes[-1], portrait, unit)
    spans = _spans(portrait)
    rest = grid[1].subgridspec(len(curves) + 1, len(spans), height_ratios=[STRIP, *[ROW] * len(curves)])
    for k, span in enumerate(spans):
        keys += _draw_column(
            figure, [rest[n, k] for n in range(len(curves) + 1)], portrait, curves, span, span == spans[-1]
        )
    keys += shade_keys(rows)
    put_title(figure, f"{portrait.name}: {portrait.sentence}")
    put_keys(figure, keys)


def _spans(portrait: Portrait) -> list[Span]:
    """The spans of time that are drawn [s]: all, and of many cycles some around the decisive moment."""
    times = portrait.samples.time
    end = float(times[-1]) or portrait.case.run.duration  # of a part that is lost at once
    drives = (*portrait.drives.values(), *portrait.base)
    moving = [velocity[velocity != 0] for velocity in (drive.evaluate(times)[1] for drive in drives)]
    turns = [np.count_nonzero(np.diff(np.sign(velocity)) > 1) for velocity in moving]
    if max(turns, default=0) <= MANY:
        return [(0.0, end)]
    length = SHOWN * min(portrait.cycles, default=end / max(turns))
    begin = float(np.clip(portrait.decisive - length / 2, 0.0, end - length))
    return [(0.0, end), (begin, begin + length)]


def _draw_column(
    figure: Figure, places: list[SubplotSpec], portrait: Portrait, curves: list[Curves], span: Span, last: bool
) -> list[Artist]:
    """Draw a strip of events and the curves below it over a span of time [s]; last: the one at the right."""
    unit = unit_for(span[1], "s")
    strip, first = figure.add_subplot(places[0]), span[0] == 0 and span[1] == portrait.samples.time[-1]
    width = 72 * figure.get_figwidth() * places[0].get_position(figure).width
    keys = draw_events(strip, portrait, unit.per_si, width, span)
    strip.set_xlim(span[0] * unit.per_si, span[1] * unit.per_si)
    if not first:
        strip.set_title(f"Around {portrait.decisive * unit.per_si:.4g} {unit.name}, {portrait.why}", fontsize=10)
    lost = {event.kind: event.time for event in portrait.events if event.kind in LOSSES}  # the last of each kind
    panels = [figure.add_subplot(place) for place in places[1:]]
    for panel, some in zip(panels, curves, strict=True):
        keys += draw_over_time(panel, portrait.rows, some, unit, span, portrait.cycles, (first, last))
        for time in lost.values():
            panel.axvline(time * unit.per_si, color="black", linewidth=1.0, linestyle="--")
        panel.tick_params(labelbottom=panel is panels[-1])
    _align_labels(panels)
    panels[-1].set_xlabel(f"time [{unit.name}]")
    return keys


def _align_labels(panels: Sequence[Axes]) -> None:
    """Put the labels at the left of panels one below the other; `Figure.align_ylabels` takes ten times as long."""
    ticks = [(panel.yaxis.get_major_formatter(), panel.yaxis.get_majorticklocs().tolist()) for panel in panels]
    longest = max(len(text) for formatter, places in ticks for text in formatter.format_ticks(places))
    for panel in panels:
        left = ScaledTranslation(-(LETTER * longest + PADS) / 72, 0, panel.figure.dpi_scale_trans)
        panel.yaxis.set_label_coords(0, 0.5, panel.transAxes + left)


def outlines_of(case: Case, line: Samples, rows: Samples | Trajectory) -> FloatArray:
    """The outlines (OUTLINES, k, 2) [m] of a part's face from start to end; of a point none, (0, 0, 2)."""
    face, heading = case.part.face, rows.heading
    if face is None or heading is None:
        return np.empty((0, 0, 2))
    times = np.linspace(line.time[0], line.time[-1], OUTLINES)
    places = np.column_stack([np.interp(times, line.time, values) for values in line.position.T])
    return face.outline(places, np.interp(times, rows.time, heading))


def draw_outlines(axes: Axes, outlines: FloatArray, unit: Unit, colour: str = "black") -> None:
    """Draw the first and the last outline, and fainter those in between."""
    for k, corners in enumerate(outlines * unit.per_si):
        ends = k in (0, len(outlines) - 1)
        closed = np.concatenate([corners, corners[:1]])
        axes.plot(*closed.T, color=colour, linewidth=1.2 if ends else 0.6, alpha=1.0 if ends else 0.4, zorder=2.8)


def _draw_loss(axes: Axes, portrait: Portrait, unit: Unit) -> None:
    """Mark where the part was lost, and write at the last place of each kind when."""
    time = unit_for(portrait.samples.time[-1], "s")
    for kind in LOSSES:
        lost = [event for event in portrait.events if event.kind is kind]
        if not lost:
            continue
        marker, colour, text, _ = MARKS[kind]
        look: dict[str, Any] = {"marker": marker, "color": colour, "markeredgecolor": "black", "markersize": 9}
        places = np.array([event.position for event in lost]) * unit.per_si
        axes.plot(*places.T, **look, linestyle="", zorder=6)
        axes.annotate(
            f"{text} at {lost[-1].time * time.per_si:.4g} {time.name}",
            (places[-1, 0], places[-1, 1]),
            xytext=(8, 8),
            textcoords="offset points",
            path_effects=HALO,
            zorder=7,
        )


def draw_way(axes: Axes, portrait: Portrait, unit: Unit, width: float = AXES_WIDTH) -> list[Artist]:
    """Draw the path over the whole plate, or the extent of a platform, into axes so wide [points]; return keys."""
    line, keys = portrait.samples.position, []
    if portrait.plate:
        keys = draw_plate(axes, portrait.plate, unit, width=width)
    else:
        map_axes(axes, unit, portrait.where)
        (left, bottom), (right, top) = portrait.box * unit.per_si
        axes.set_xlim(left, right)
        axes.set_ylim(bottom, top)
        axes.grid(alpha=0.3)
    draw_outlines(axes, outlines_of(portrait.case, portrait.samples, portrait.rows), unit)
    return draw_path(axes, portrait.rows, line, unit, portrait.box) + keys
