"""Pictures of a run for print: its path over the plate, what is around a short one, and its course over time."""

from __future__ import annotations

from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from active_surface.arrays import FloatArray
from active_surface.views.prints.sheet import MM, Picture
from common import unit_for
from coupling.pictures import (
    Portrait,
    all_curves_of,
    draw_events,
    draw_over_time,
    draw_path,
    draw_plate,
    draw_way,
    draw_window,
    path_window,
    put_keys,
)
from particle import PATH_COLOUR, State, shade_keys, stretches

SHARE = 0.75  # of the width is a map's, about
PANEL, STRIP, REST = 27.0, 3.5, 16.0  # mm: the height of a panel, of the strip of events, of labels and keys


def run_pictures(portrait: Portrait) -> list[Picture]:
    """The pictures that tell of a run; that around its path only where the path is short beside the plate."""
    line, plate = portrait.samples.position, portrait.plate
    window = path_window(line, portrait.box, plate.actuators) if plate else None
    surface = f"the plate at {portrait.when}, {portrait.most}" if plate else portrait.summary.origin
    pictures = [
        Picture(
            "path", f"The path over {surface}. {portrait.sentence}", lambda figure: _draw_all(figure, portrait, window)
        )
    ]
    if window is not None:
        text = f"The path and what is around it: {surface}."
        pictures.append(Picture("closeup", text, lambda figure: _draw_window(figure, portrait, window)))
    names = ", ".join(curves.label for curves in all_curves_of(portrait))
    pictures.append(Picture("time", f"Over time: {names}.", lambda figure: _draw_course(figure, portrait)))
    return pictures


def _draw_all(figure: Figure, portrait: Portrait, window: FloatArray | None) -> None:
    unit, axes, width = unit_for(portrait.box, "m"), figure.add_subplot(), SHARE * 72 * figure.get_figwidth()
    if window is None or portrait.plate is None:
        keys = draw_way(axes, portrait, unit, width)
    else:  # whose picture has start and end, which would cover the frame here
        keys = draw_plate(axes, portrait.plate, unit, width=width)
        line = portrait.samples.position * unit.per_si
        keys += axes.plot(*line.T, color=PATH_COLOUR, linewidth=1.2, label="path")
        keys.append(draw_window(axes, unit, window))
    put_keys(figure, keys)


def _draw_window(figure: Figure, portrait: Portrait, window: FloatArray) -> None:
    unit, axes = unit_for(window, "m"), figure.add_subplot()
    assert portrait.plate
    keys = draw_plate(axes, portrait.plate, unit, window, width=SHARE * 72 * figure.get_figwidth())
    put_keys(figure, draw_path(axes, portrait.rows, portrait.samples.position, unit, portrait.box) + keys)


def _draw_course(figure: Figure, portrait: Portrait) -> None:
    every, rows, unit = all_curves_of(portrait), portrait.rows, unit_for(portrait.samples.time, "s")
    figure.set_figheight((PANEL * len(every) + STRIP + REST) * MM)
    strip, *panels = figure.subplots(len(every) + 1, sharex=True, height_ratios=[STRIP, *[PANEL] * len(every)])
    bands: list[Artist] = []
    for panel, curves in zip(panels, every, strict=True):
        bands += draw_over_time(panel, rows, curves, unit, cycles=portrait.cycles)
    panels[-1].set_xlabel(f"time [{unit.name}]")
    figure.align_ylabels(panels)
    keys = bands + shade_keys(rows)
    if stretches(rows.state == State.SLIP):
        keys.append(Patch(facecolor="white", edgecolor="#808080", linewidth=0.5, label="slipping"))
    put_keys(figure, keys + draw_events(strip, portrait, unit.per_si, 72 * SHARE * figure.get_figwidth()))
