"""The curve of a sweep over one axis: how far parts went, and what became of them."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from coupling.readable import readable
from studies.heat import COLOURS, add_key, frame
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
            low, high = np.percentile(shown.distance[rows], PERCENTILES, axis=-1) * unit.per_si
            said = f"{PERCENTILES[0]} to {PERCENTILES[1]} % of the starts"
            axes[0].fill_between(where[rows], low, high, color="#c6d9e8", label=said)
        axes[0].plot(where, shown.mean_distance * unit.per_si, ".-", color="#40719c", linewidth=1.0, label="mean")
        axes[0].set_ylabel(f"distance from the start [{unit.name}]")
        axes[0].set_ylim(bottom=0)
        if shown.distance.shape[-1] > 1:
            axes[0].legend(frameon=False, fontsize=9)
    shares = np.stack([(shown.outcome == k).mean(axis=-1) for k in range(len(OUTCOMES))])
    axes[1].stackplot(where, 100 * shares, colors=list(COLOURS), step="mid", linewidth=0)
    axes[1].set_ylabel("share of the paths [%]")
    axes[1].set_ylim(0, 100)
    if len(where) > 1:
        axes[1].set_xlim(where.min(), where.max())
    add_key(axes[1], shown.outcome, OUTCOMES, COLOURS)
