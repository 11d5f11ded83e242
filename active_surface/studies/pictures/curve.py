"""Curves of a sweep over one axis: how far parts went, what became of them, or where a condition begins to hold."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from active_surface.arrays import BoolArray
from active_surface.studies.pictures.heat import COLOURS, add_key, edges, frame
from active_surface.studies.pictures.selection import Selection
from active_surface.studies.record import OUTCOMES
from active_surface.studies.threshold import lowest
from common import legend_below

PERCENTILES = (10, 90)
BEGINS, BEFORE = "#c8371b", "#f3c9bd"


def draw_curve(axes: Axes, selection: Selection) -> None:
    """Draw a column of the results, with the spread of repeats."""
    (across,) = selection.axes
    where, unit = across.drawn, selection.unit
    frame(axes, across)
    axes.set_ylabel(selection.label)
    borders = edges(across)
    axes.set_xlim(borders[0], borders[-1])
    if not np.isfinite(selection.value).any():
        return
    if selection.value.shape[-1] > 1:
        rows = np.isfinite(selection.value).all(axis=-1)
        low, high = np.full((2, len(where)), np.nan)  # with gaps where starts were refused
        low[rows], high[rows] = np.percentile(selection.value[rows], PERCENTILES, axis=-1) * unit.per_si
        label = f"{PERCENTILES[0]} to {PERCENTILES[1]} % of the starts"
        axes.fill_between(where, low, high, color="#c6d9e8", label=label)
    line = "." if across.axis.field.kind == "text" else ".-"
    axes.plot(where, selection.mean_value * unit.per_si, line, color="#40719c", linewidth=1.0, label="mean")
    if np.nanmin(selection.value) >= 0:
        axes.set_ylim(bottom=0)
    if selection.value.shape[-1] > 1:
        legend_below(axes, ncols=2)


def draw_shares(axes: Axes, selection: Selection) -> None:
    """Draw the shares of outcomes."""
    (across,) = selection.axes
    frame(axes, across)
    shares = np.stack([(selection.outcome == k).mean(axis=-1) for k in range(len(OUTCOMES))])
    borders = edges(across)
    low = np.zeros(len(across.drawn))
    for share, colour in zip(100 * shares, COLOURS, strict=True):
        axes.stairs(low + share, borders, baseline=low, fill=True, color=colour, linewidth=0)
        low = low + share
    axes.set_ylabel("share of the paths [%]")
    axes.set_ylim(0, 100)
    axes.set_xlim(borders[0], borders[-1])
    add_key(axes, selection.outcome, OUTCOMES, COLOURS)


def draw_threshold(axes: Axes, selection: Selection, holds: BoolArray, condition: str) -> None:
    """Draw the lowest value of the second axis at which a condition holds over the first axis."""
    across, up = selection.axes
    frame(axes, across, up)
    order = np.argsort(across.drawn)
    where = across.drawn[order]
    begins, before = (values[order] for values in lowest(up.drawn, holds))
    axes.fill_between(where, before, begins, color=BEFORE, linewidth=0, label=f"down to the next lower {up.axis.name}")
    axes.plot(where, begins, ".-", color=BEGINS, linewidth=1.0, label=f"lowest {up.axis.name} with {condition}")
    from_first = np.isfinite(begins) & np.isnan(before)
    if from_first.any():
        marks: dict[str, Any] = {"marker": "v", "markerfacecolor": "white", "markeredgecolor": BEGINS, "linestyle": ""}
        axes.add_line(Line2D(where[from_first], begins[from_first], label="there or below", **marks))
    limits = edges(across), edges(up)
    axes.set_xlim(limits[0].min(), limits[0].max())
    axes.set_ylim(limits[1].min(), limits[1].max())
    axes.grid(alpha=0.3)
    if np.isnan(begins).all():
        axes.text(0.5, 0.5, f"{condition} nowhere", transform=axes.transAxes, ha="center", parse_math=False)
    else:
        legend_below(axes)
