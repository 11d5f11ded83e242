"""The curve of a sweep over one axis: how far parts went, and what became of them."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from coupling.readable import readable
from studies.heat import COLOURS, OUTCOME, add_key, edges, frame
from studies.record import OUTCOMES
from studies.shown import Shown

PERCENTILES = (10, 90)


def draw_curve(axes: list[Axes], shown: Shown) -> None:
    """Draw the distance into the first axes, with the spread of repeats, and the shares of outcomes into the second."""
    (across,) = shown.axes
    where = across.drawn
    for one in axes:
        frame(one, across)
    known = shown.distance[np.isfinite(shown.distance)]
    if len(known):
        unit = readable(known, "m")
        if shown.distance.shape[-1] > 1:
            rows = np.isfinite(shown.distance).all(axis=-1)
            low, high = np.full((2, len(where)), np.nan)  # with gaps where starts were refused
            low[rows], high[rows] = np.percentile(shown.distance[rows], PERCENTILES, axis=-1) * unit.per_si
            said = f"{PERCENTILES[0]} to {PERCENTILES[1]} % of the starts"
            axes[0].fill_between(where, low, high, color="#c6d9e8", label=said)
        line = "." if across.axis.field.kind == "text" else ".-"
        axes[0].plot(where, shown.mean_distance * unit.per_si, line, color="#40719c", linewidth=1.0, label="mean")
        axes[0].set_ylabel(f"distance from the start [{unit.name}]")
        axes[0].set_ylim(bottom=0)
        if shown.distance.shape[-1] > 1:
            axes[0].legend(frameon=False, fontsize=9)
    shares = np.stack([(shown.outcome == k).mean(axis=-1) for k in range(len(OUTCOMES))])
    borders = edges(across)
    low = np.zeros(len(where))
    for share, colour in zip(100 * shares, COLOURS, strict=True):
        axes[1].stairs(low + share, borders, baseline=low, fill=True, color=colour, linewidth=0)
        low = low + share
    axes[1].set_ylabel("share of the paths [%]")
    axes[1].set_ylim(0, 100)
    for one in axes:
        one.set_xlim(borders[0], borders[-1])
    axes[1].set_title(OUTCOME, fontsize=10)
    add_key(axes[1], shown.outcome, OUTCOMES, COLOURS)
