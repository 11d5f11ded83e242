"""The picture of a run: the path from above, whole and in a window, and the motion over time.

The plate is drawn at one moment: the time step of the result files at which it is deflected most.
"""

from __future__ import annotations

from pathlib import Path
from typing import Literal, cast

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from coupling.case import Case
from coupling.display import DisplaySurface, display_surface
from coupling.drives import frame_times
from coupling.pictures.file import save_picture
from coupling.pictures.path import draw_path
from coupling.pictures.plate import AXES_WIDTH, draw_plate, draw_window, join
from coupling.pictures.portrait import Portrait, deflected_most, portrait_of
from coupling.pictures.ticks import map_axes
from coupling.pictures.time import curves_of, draw_over_time
from coupling.pictures.window import is_visible, path_window
from coupling.scene import Scene
from meshes import Drawing, Unit, label_places, unit_for
from particle import Trajectory, shade_keys

PANEL = 5.5  # inches, about; a picture has two or three panels side by side
MIN_WIDTH = 0.6  # of a panel: the width of a map


def draw_run(
    case: Case, scene: Scene, trajectory: Trajectory, surface: DisplaySurface, moment: float, path: Path
) -> None:
    """Draw the run into a PNG file; moment: the time [s] at which the surface is drawn."""
    figure = Drawing()
    compose(figure, portrait_of(case.name, scene, trajectory, surface, moment))
    save_picture(figure, path)


def plot_run(case: Case, scene: Scene, trajectory: Trajectory, axes: Axes | None = None) -> Figure:
    """The picture of a run; with axes in m, only the path over its surface, drawn into these."""
    surface = display_surface(scene, trajectory)
    times = frame_times(case.run.frames, [*scene.lifts, *scene.base], float(trajectory.time[-1]))
    moment = deflected_most(scene, surface, times)
    portrait = portrait_of(case.name, scene, trajectory, surface, moment)
    if axes is None:
        drawing = Drawing()
        compose(drawing, portrait)
        return drawing
    figure, unit = cast(Figure, axes.figure), Unit("m", 1.0)
    draw_surface(figure, axes, portrait, unit)
    line = portrait.samples.position
    draw_path(axes, trajectory, line, unit, is_visible(line, portrait.box))
    label_places(axes)
    return figure


def compose(figure: Figure, portrait: Portrait) -> None:
    """Draw the run into an empty figure."""
    box, rows, samples, relief = portrait.box, portrait.rows, portrait.samples, portrait.relief
    line, times = samples.position, samples.time
    window = path_window(line, box, relief.actuators) if relief else None
    curves = curves_of(portrait)
    width, height = np.ptp(box, axis=0)
    columns = [float(np.clip(width / height, MIN_WIDTH, 1.0)), *([] if window is None else [1.0]), 1.0]
    figure.set_size_inches(PANEL * sum(columns) + 1.0, max(PANEL, 2.2 * len(curves)) + 0.6)
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.06)
    grid = figure.add_gridspec(len(curves), len(columns), width_ratios=columns)
    axes = [figure.add_subplot(grid[:, k]) for k in range(len(columns) - 1)]
    units = [unit_for(points, "m") for points in (box, window) if points is not None]
    for one, unit in zip(axes, units, strict=True):
        map_axes(one, unit, portrait.where)
    if relief:
        axes[0].set_title(f"The plate at {portrait.when}, {portrait.most}", fontsize=10)
    keys = draw_surface(figure, axes[0], portrait, units[0], side="right" if window is None else "left")
    if relief and window is not None:
        axes[1].set_title(f"Around the path, also at {portrait.when}", fontsize=10)
        draw_window(axes[0], units[0], window)
        join(figure, axes, units[0], window)
        keys += draw_plate(figure, axes[1], relief, units[1], window)
    keys = draw_path(axes[-1], rows, line, units[-1], is_visible(line, box)) + keys
    time_unit = unit_for(times, "s")
    for k, some in enumerate(curves):
        panel = figure.add_subplot(grid[k, -1])
        draw_over_time(panel, rows, times, some, time_unit)
        panel.tick_params(labelbottom=k == len(curves) - 1)
    panel.set_xlabel(f"time [{time_unit.name}]")
    keys += shade_keys(rows)
    figure.suptitle(f"{portrait.name}: {portrait.sentence}", parse_math=False)
    keys = list({key.get_label(): key for key in reversed(keys)}.values())[::-1]
    figure.legend(handles=keys, loc="outside lower center", ncols=len(keys), frameon=False)


def draw_surface(
    figure: Figure,
    axes: Axes,
    portrait: Portrait,
    unit: Unit,
    side: Literal["left", "right"] = "right",
    width: float = AXES_WIDTH,
) -> list[Artist]:
    """Draw the whole plate, or the extent of a platform, into axes so wide [points]; return keys."""
    if portrait.relief:
        return draw_plate(figure, axes, portrait.relief, unit, portrait.relief.frame, side, width)
    (left, bottom), (right, top) = portrait.box * unit.per_si
    axes.set_xlim(left, right)
    axes.set_ylim(bottom, top)
    axes.grid(alpha=0.3)
    return []
