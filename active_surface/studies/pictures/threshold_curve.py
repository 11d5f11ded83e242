"""The threshold curve of a sweep: the lowest values of one axis over another at which a condition holds."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from active_surface.arrays import BoolArray
from active_surface.studies.pictures.heat import edges, frame
from active_surface.studies.pictures.selection import Selection
from active_surface.studies.threshold import lowest
from common import legend_below

COLOUR, BAND = "#c8371b", "#f3c9bd"


def draw_threshold(axes: Axes, selection: Selection, holds: BoolArray, condition: str) -> None:
    """Draw the lowest value of the second axis at which a condition holds over the first axis."""
    across, up = selection.axes
    frame(axes, across, up)
    order = np.argsort(across.drawn)
    where = across.drawn[order]
    begins, before = (values[order] for values in lowest(up.drawn, holds))
    axes.fill_between(where, before, begins, color=BAND, linewidth=0, label=f"down to the next lower {up.axis.name}")
    axes.plot(where, begins, ".-", color=COLOUR, linewidth=1.0, label=f"lowest {up.axis.name} with {condition}")
    from_first = np.isfinite(begins) & np.isnan(before)
    if from_first.any():
        marks: dict[str, Any] = {"marker": "v", "markerfacecolor": "white", "markeredgecolor": COLOUR, "linestyle": ""}
        axes.add_line(Line2D(where[from_first], begins[from_first], label="there or below", **marks))
    limits = edges(across), edges(up)
    axes.set_xlim(limits[0].min(), limits[0].max())
    axes.set_ylim(limits[1].min(), limits[1].max())
    axes.grid(alpha=0.3)
    if np.isnan(begins).all():
        axes.text(0.5, 0.5, f"{condition} nowhere", transform=axes.transAxes, ha="center", parse_math=False)
    else:
        legend_below(axes)
