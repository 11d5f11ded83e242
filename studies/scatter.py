"""Random or listed points of a sweep: how far parts went over the first two axes, and what became of them."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure

from coupling.readable import readable
from studies.heat import COLOURS, OUTCOME, add_key, frame
from studies.record import OUTCOMES
from studies.shown import Shown

LARGEST, SMALLEST = 40.0, 3.0  # square points, of a marker


def draw_points(figure: Figure, axes: list[Axes], shown: Shown) -> None:
    """Draw the distance into the first axes and the outcome into the second, over two axes or one."""
    lengths, outcome = shown.mean_distance, shown.usual_outcome
    known = np.isfinite(lengths)
    unit = readable(lengths[known], "m") if known.any() else readable(np.zeros(1), "m")
    across = shown.axes[0]
    up = shown.axes[1] if len(shown.axes) > 1 else None
    size = float(np.clip(2e4 / len(lengths), SMALLEST, LARGEST))
    heights = up.drawn if up else lengths * unit.per_si
    for one in axes:
        frame(one, across, up)
        if not up:
            one.set_ylabel(f"distance from the start [{unit.name}]")
    common: dict[str, Any] = {"s": size, "linewidths": 0}
    marks = axes[0].scatter(
        across.drawn[known], heights[known], c=lengths[known] * unit.per_si, cmap="viridis", **common
    )
    figure.colorbar(marks, ax=axes[0], label=f"distance from the start [{unit.name}]")
    norm = BoundaryNorm(np.arange(len(OUTCOMES) + 1) - 0.5, len(OUTCOMES))
    axes[1].scatter(across.drawn, heights, c=outcome, cmap=ListedColormap(list(COLOURS)), norm=norm, **common)
    axes[1].set_title(OUTCOME, fontsize=10)
    add_key(axes[1], outcome, OUTCOMES, COLOURS)
