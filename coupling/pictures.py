"""The picture of a run: the path from above, whole and in a window, and the motion over time.

The plate is shown at one moment, the time step of the result files at which it is deflected the most.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from coupling.case import Case
from coupling.path_picture import draw_path
from coupling.readable import plain_ticks, readable
from coupling.scene import Ground, Scene
from coupling.time_picture import curves_of, draw_over_time, shade_keys
from coupling.window import is_visible, path_window
from particle import Trajectory

FloatArray = NDArray[np.float64]

SAMPLES = 4000
AS_MUCH = 0.999  # of the largest deflection: the first moment with so much is shown
PANEL = 5.5  # inches, about, of which a picture has two or three side by side
SLIMMEST = 0.6  # of a panel is the least width of a map


def moment_of_most(spread: FloatArray) -> int:
    """The first of k moments at which the plate is deflected the most; spread: (k,), its mean square deflections."""
    return int(np.argmax(spread >= AS_MUCH**2 * spread.max()))


def draw_run(case: Case, scene: Scene, trajectory: Trajectory, ground: Ground, moment: float, path: Path) -> None:
    """Draws the run into a PNG file; moment: the time [s] at which the surface is shown."""
    figure = Figure()
    FigureCanvasAgg(figure)
    compose(figure, case, scene, trajectory, ground, moment)
    partial = path.with_suffix(".partial.png")
    figure.savefig(partial, dpi=110)
    partial.replace(path)


def compose(figure: Figure, case: Case, scene: Scene, trajectory: Trajectory, ground: Ground, moment: float) -> None:
    """Draws the run into an empty figure."""
    times = np.linspace(0, trajectory.time[-1], SAMPLES)
    samples = trajectory.at(times)
    line, box = samples.position, np.stack([ground.points.min(axis=0), ground.points.max(axis=0)])
    window = path_window(line, box, scene.shapes.points) if scene.shapes else None
    curves = curves_of(scene, samples)
    width, height = np.ptp(box, axis=0)
    columns = [float(np.clip(width / height, SLIMMEST, 1.0)), *([] if window is None else [1.0]), 1.0]
    figure.set_size_inches(PANEL * sum(columns) + 1.0, max(PANEL, 2.2 * len(curves)) + 0.6)
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.06)
    grid = figure.add_gridspec(len(curves), len(columns), width_ratios=columns)
    axes = [figure.add_subplot(grid[:, k]) for k in range(len(columns) - 1)]
    units = [readable(points, "m") for points in (box, window) if points is not None]
    on = f" on {scene.origin}" if scene.base else ""
    for one, unit in zip(axes, units, strict=True):
        one.set_aspect("equal")
        plain_ticks(one)
        one.set_xlabel(f"x{on} [{unit.name}]")
        one.set_ylabel(f"y{on} [{unit.name}]")
    time_unit = readable(times, "s")
    if scene.shapes:
        when = f"{moment * time_unit.per_si:.4g} {time_unit.name}"
        titles = (f"The plate at {when}, when it is deflected most", f"Around the path, also at {when}")
        for one, title in zip(axes, titles, strict=False):
            one.set_title(title, fontsize=10)
    keys = scene.draw(figure, axes, ground, moment, units, window)
    visible = is_visible(line, box)
    keys = draw_path(axes[-1], trajectory, line, units[-1], visible) + keys
    for k, shown in enumerate(curves):
        panel = figure.add_subplot(grid[k, -1])
        draw_over_time(panel, trajectory, times, shown, time_unit)
        panel.tick_params(labelbottom=k == len(curves) - 1)
    panel.set_xlabel(f"time [{time_unit.name}]")
    keys += shade_keys(trajectory)
    figure.suptitle(f"{case.name}: {trajectory.sentence}")
    figure.legend(handles=keys, loc="outside lower center", ncols=len(keys), frameon=False)
