"""Picture: which strokes and frequencies bring parts to one actuator of a device, hold them, or lose them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from active_surface.paper.readings.windows import Window
from coupling import whole_file

LARGEST: Final = 260.0  # square points, of a disc where all parts do it
KINDS: Final = {
    "converge": ("#3d8a4e", "converge to the actuator"),
    "lost": ("#c8371b", "come off, leave or are not followed"),
    "rest": ("#9ab5d6", "are held, or go to and fro"),
}
NAME: Final = "windows.png"


def draw_windows(placing: Sequence[Window], path: Path) -> None:
    """Write the picture: a pie for each stroke and frequency, a panel for each plate and part."""
    radii, parts = list(dict.fromkeys(one.radius for one in placing)), list(dict.fromkeys(one.part for one in placing))
    figure = Figure(figsize=(6.4 * len(parts), 3.3 * len(radii)))
    FigureCanvasAgg(figure)
    figure.set_layout_engine("constrained", w_pad=0.1, h_pad=0.06)
    panels = figure.subplots(len(radii), len(parts), sharex=True, sharey=True, squeeze=False)
    for i, radius in enumerate(radii):
        for k, part in enumerate(parts):
            axes = panels[i, k]
            for one in placing:
                if (one.radius, one.part) == (radius, part):
                    shares = one.converge, one.lost, max(1 - one.converge - one.lost, 0.0)
                    _pie(axes, one.frequency, 1e6 * one.stroke, shares)
            axes.set_xscale("log")
            axes.set_yscale("log")
            strokes = sorted({1e6 * one.stroke for one in placing})
            axes.set_yticks(strokes, [f"{stroke:g}" for stroke in strokes])
            axes.set_ylim(strokes[0] / 1.6, strokes[-1] * 1.6)
            axes.minorticks_off()
            axes.set_xticks([500, 1000, 2000, 4000, 8000], ["0.5", "1", "2", "4", "8"])
            axes.set_title(f"{part}, a = {1e6 * radius:g} µm", fontsize=10)
            if k == 0:
                axes.set_ylabel("stroke [µm]")
            if i == len(radii) - 1:
                axes.set_xlabel("frequency [kHz]")
            axes.grid(color="#e4e4e4", linewidth=0.6)
            axes.set_axisbelow(True)
    marks = [Line2D([], [], marker="o", linestyle="", markersize=9, color=c, label=said) for c, said in KINDS.values()]
    figure.legend(handles=marks, loc="outside lower center", ncols=len(marks), frameon=False, fontsize=9)
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole_file(path) as partial:
        figure.savefig(partial, dpi=90)


def _pie(axes: Axes, x: float, y: float, shares: Sequence[float]) -> None:
    """One pie of sectors, clockwise from the top; markers keep their size on logarithmic axes."""
    begin = 0.0
    for share, (colour, _) in zip(shares, KINDS.values(), strict=True):
        if share > 0:
            angle = 2 * np.pi * np.linspace(begin, begin + share, 2 + int(40 * share))
            rim = np.column_stack([np.sin(angle), np.cos(angle)])
            sector = rim if share > 1 - 1e-9 else np.concatenate([[(0.0, 0.0)], rim])
            size = LARGEST * np.abs(sector).max() ** 2  # a marker is scaled by its farthest point
            axes.scatter([x], [y], marker=sector, s=size, color=colour, linewidth=0)
        begin += share
