"""The picture of a sweep: curves over one axis, maps over two, places of random points, basins over starts."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from studies.basins import draw_basins, is_over_starts
from studies.curve import draw_curve
from studies.heat import draw_maps
from studies.scatter import draw_points
from studies.shown import Shown
from studies.study import Study
from studies.threshold_curve import draw_threshold

if TYPE_CHECKING:
    import xarray

WIDTH, HEIGHT = 6.2, 5.2  # inches, of a panel


def draw_sweep(study: Study, dataset: xarray.Dataset, path: Path) -> Path:
    """Draws the results of a study into a PNG file; returns that.

    Of a grid the two axes with the most values are drawn, the others at their middle value; of repeats the mean.
    """
    figure = Figure()
    FigureCanvasAgg(figure)
    compose(figure, study, dataset)
    partial = path.with_suffix(f".{os.getpid()}.partial.png")
    try:
        figure.savefig(partial, dpi=110)
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)
    return path


def compose(figure: Figure, study: Study, dataset: xarray.Dataset) -> None:
    """Draws the results of a study into an empty figure."""
    shown = Shown.of(study, dataset)
    panels = 2 if shown.holds is None else 3
    figure.set_size_inches(WIDTH * panels, HEIGHT)
    figure.set_layout_engine("constrained", w_pad=0.1, h_pad=0.06)
    axes = [figure.add_subplot(1, panels, k + 1) for k in range(panels)]
    if shown.scattered:
        draw_points(figure, axes, shown)
    elif len(shown.axes) == 1:
        draw_curve(axes, shown)
    elif is_over_starts(shown):
        draw_basins(figure, axes, shown)
    else:
        draw_maps(figure, axes, shown)
    if shown.holds is not None and study.threshold:
        draw_threshold(axes[2], shown, shown.holds, study.threshold.said)
    said = ", ".join(f"{name} = {text}" for name, text in shown.fixed.items())
    repeats = f", mean of {study.points.repeats} starts" if study.points.repeats > 1 else ""
    drawn, of = shown.outcome.size, len(study.points)
    paths = f"{of} paths" if drawn == of else f"{drawn} of {of} paths"
    figure.suptitle(f"{study.name}: {paths}{repeats}" + (f", {said}" if said else ""))
