"""Curves of a sweep over one axis: how far parts went, and what became of them."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from active_surface.studies.pictures.heat import COLOURS, add_key, edges, frame
from active_surface.studies.pictures.selection import Selection
from active_surface.studies.record import OUTCOMES
from common import legend_below

PERCENTILES = (10, 90)


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
