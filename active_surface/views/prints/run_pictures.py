"""Pictures of a run for print: its path over the plate, what is around a short one, and its course over time."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from active_surface.arrays import FloatArray
from active_surface.views.prints.sheet import MM, Picture, put_keys
from coupling.pictures import (
    Curves,
    Portrait,
    curves_of,
    draw_over_time,
    draw_path,
    draw_plate,
    draw_surface,
    draw_window,
    is_visible,
    map_axes,
    path_window,
)
from meshes import NOTHING, unit_for
from particle import EventKind, State, shade, shade_keys, stretches

SHARE = 0.75  # of the width is a map's, about
PANEL, STRIP, REST = 27.0, 3.5, 16.0  # mm: the height of a panel, of the strip of events, of labels and keys
APART = 3.5  # points: nearer to each other, marks of events merge
FAR = 3.0  # times its extent a path is from the origin: then displacements are shown
MARKS: dict[EventKind, tuple[str, str, str]] = {  # marker, its colour, what is said
    EventKind.SLIPS: (">", "black", "slips"),
    EventKind.STOPS: ("s", "black", "stops"),
    EventKind.REVERSES: ("D", "white", "turns back"),
    EventKind.DETACHES: ("^", "white", "comes off"),
    EventKind.LANDS: ("v", "white", "lands"),
    EventKind.LEAVES_PLATE: ("X", "white", "leaves the plate"),
    EventKind.OVERLOADS: ("P", "white", "overload"),
}
OFTEN = (EventKind.SLIPS, EventKind.STOPS)  # where shades begin and end in any case


def run_pictures(portrait: Portrait) -> list[Picture]:
    """The pictures that tell of a run; that around its path only where the path is short beside the plate."""
    line, relief = portrait.samples.position, portrait.relief
    window = path_window(line, portrait.box, relief.actuators) if relief else None
    surface = f"the plate at {portrait.when}, {portrait.most}" if relief else portrait.origin
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
    unit = unit_for(portrait.box, "m")
    axes = figure.add_subplot()
    map_axes(axes, unit, portrait.where)
    keys = draw_surface(figure, axes, portrait, unit, width=SHARE * 72 * figure.get_figwidth())
    if window is not None:
        draw_window(axes, unit, window)
    line = portrait.samples.position
    put_keys(figure, draw_path(axes, portrait.rows, line, unit, is_visible(line, portrait.box)) + keys)


def _draw_window(figure: Figure, portrait: Portrait, window: FloatArray) -> None:
    unit = unit_for(window, "m")
    axes = figure.add_subplot()
    map_axes(axes, unit, portrait.where)
    assert portrait.relief
    keys = draw_plate(figure, axes, portrait.relief, unit, window, width=SHARE * 72 * figure.get_figwidth())
    put_keys(figure, draw_path(axes, portrait.rows, portrait.samples.position, unit, True) + keys)


def courses(portrait: Portrait) -> list[Curves]:
    """What is shown over time, from the top."""
    samples = portrait.samples
    way = samples.position - samples.position[0]
    moved = np.abs(samples.position).max() > FAR * max(float(np.ptp(samples.position, axis=0).max()), NOTHING)
    x, y = (way if moved else samples.position).T
    relative = "relative " if portrait.base else ""
    result = [Curves(relative + ("displacement" if moved else "position"), "m", {"along x": x, "along y": y})]
    if samples.height.any():
        result.append(Curves("height", "m", {"": samples.height}))
    v_x, v_y = samples.velocity.T
    result.append(Curves(f"{relative}velocity", "m/s", {"along x": v_x, "along y": v_y}))
    result += [curves for curves in curves_of(portrait) if "platform" in curves.values]
    forces = {"normal load": samples.normal_force, "friction": samples.friction_force}
    return [*result, Curves("contact force", "N", forces)]


def _draw_course(figure: Figure, portrait: Portrait) -> None:
    all_curves, rows, times = courses(portrait), portrait.rows, portrait.samples.time
    figure.set_figheight((PANEL * len(all_curves) + STRIP + REST) * MM)
    unit = unit_for(times, "s")
    grid = figure.add_gridspec(len(all_curves) + 1, 1, height_ratios=[STRIP, *[PANEL] * len(all_curves)])
    strip = figure.add_subplot(grid[0])
    panels = [figure.add_subplot(grid[k + 1], sharex=strip) for k in range(len(all_curves))]
    for panel, curves in zip(panels, all_curves, strict=True):
        draw_over_time(panel, rows, times, curves, unit)
        panel.tick_params(labelbottom=panel is panels[-1])
    panels[-1].set_xlabel(f"time [{unit.name}]")
    figure.align_ylabels(panels)
    keys = shade_keys(rows)
    if stretches(rows.state == State.SLIP):
        keys.append(Patch(facecolor="white", edgecolor="#808080", linewidth=0.5, label="slipping"))
    put_keys(figure, keys + _draw_events(strip, portrait, unit.per_si))


def _draw_events(axes: Axes, portrait: Portrait, per_second: float) -> list[Artist]:
    """Draw a strip of states with a mark for each event, or for rare ones where all would merge; return keys."""
    shade(axes, portrait.rows, per_second)
    axes.set_yticks([])
    axes.set_ylim(0, 1)
    axes.tick_params(bottom=False, labelbottom=False)
    room = 72 * SHARE * axes.figure.bbox.width / axes.figure.dpi / APART
    keys: list[Artist] = []
    for kind, (marker, colour, text) in MARKS.items():
        times = [event.time for event in portrait.events if event.kind is kind]
        if not times or (kind in OFTEN and len(portrait.events) > room):
            continue
        look: dict[str, Any] = {"marker": marker, "color": colour, "markeredgecolor": "black", "linestyle": ""}
        look |= {"markersize": APART, "markeredgewidth": 0.6}
        axes.plot(np.array(times) * per_second, np.full(len(times), 0.5), **look, clip_on=False)
        keys.append(Line2D([], [], **look, label=text))
    return keys
