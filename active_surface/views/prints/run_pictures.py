"""Pictures of a run for print: its path over the plate, what is around a short one, and its course over time."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from active_surface.arrays import FloatArray
from active_surface.views.prints.sheet import MM, Picture
from common import NOTHING, unit_for
from coupling.pictures import (
    Curves,
    Portrait,
    draw_events,
    draw_over_time,
    draw_path,
    draw_plate,
    draw_way,
    draw_window,
    margins_over_time,
    path_window,
    put_keys,
    strokes_of,
    velocities_of,
)
from particle import PATH_COLOUR, State, shade_keys, stretches

SHARE = 0.75  # of the width is a map's, about
PANEL, STRIP, REST = 27.0, 3.5, 16.0  # mm: the height of a panel, of the strip of events, of labels and keys
FAR = 3.0  # times its extent a path is from the origin: then displacements are shown


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
    names = ", ".join(curves.label for curves in courses(portrait))
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


def courses(portrait: Portrait) -> list[Curves]:
    """What is shown over time, from the top."""
    samples = portrait.samples
    way = samples.position - samples.position[0]
    moved = np.abs(samples.position).max() > FAR * max(float(np.ptp(samples.position, axis=0).max()), NOTHING)
    x, y = (way if moved else samples.position).T
    relative, times = "relative " if portrait.base else "", samples.time
    label = relative + ("displacement" if moved else "position")
    result = [Curves(label, "m", {"along x": x, "along y": y}, times), strokes_of(portrait)]
    v_x, v_y = samples.velocity.T
    result.append(Curves(f"{relative}velocity", "m/s", {"along x": v_x, "along y": v_y}, times))
    result += velocities_of(portrait)
    result.append(margins_over_time(portrait))
    result.append(Curves("normal load", "N", {"": samples.normal_force}, times))
    result.append(Curves("friction", "N", {"": samples.friction_force}, times))
    return [one for one in result if one is not None]


def _draw_course(figure: Figure, portrait: Portrait) -> None:
    all_curves, rows, times = courses(portrait), portrait.rows, portrait.samples.time
    figure.set_figheight((PANEL * len(all_curves) + STRIP + REST) * MM)
    unit = unit_for(times, "s")
    grid = figure.add_gridspec(len(all_curves) + 1, 1, height_ratios=[STRIP, *[PANEL] * len(all_curves)])
    strip = figure.add_subplot(grid[0])
    panels = [figure.add_subplot(grid[k + 1], sharex=strip) for k in range(len(all_curves))]
    bands: list[Artist] = []
    for panel, curves in zip(panels, all_curves, strict=True):
        bands += draw_over_time(panel, rows, curves, unit, cycles=portrait.cycles)
        panel.tick_params(labelbottom=panel is panels[-1])
    panels[-1].set_xlabel(f"time [{unit.name}]")
    figure.align_ylabels(panels)
    keys = bands + shade_keys(rows)
    if stretches(rows.state == State.SLIP):
        keys.append(Patch(facecolor="white", edgecolor="#808080", linewidth=0.5, label="slipping"))
    put_keys(figure, keys + draw_events(strip, portrait, unit.per_si, 72 * SHARE * figure.get_figwidth()))
