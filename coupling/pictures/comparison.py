"""The picture of two runs: both paths from above, and over time where they are, how far apart and how near to loss."""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec
from numpy.typing import NDArray

from common import NOTHING, draw, draw_rim, unit_for
from coupling.comparison import Comparison
from coupling.pictures.figure import plain_ticks, put_keys, put_title
from coupling.pictures.parts import END, PARTS_COLOURS, draw_paths_into, draw_paths_over
from coupling.pictures.portrait import Portrait, portrait_of
from coupling.pictures.run import outlines_of
from coupling.pictures.time import MANY
from coupling.report import with_micro_signs
from fem_plate import extent
from meshes import rim_curves

FloatArray = NDArray[np.float64]
Line = tuple[FloatArray, FloatArray]
"""Times [s] and values."""

ROW: Final = 1.25  # inches: the height of what is drawn over time
STEPS: Final = 150  # of the time of a run, in each of which the least margin is drawn
ROUNDING: Final = 1e-9
BESIDE: Final = PARTS_COLOURS[3]  # the colour of what both have together


@draw.register(Comparison)
def draw_comparison(comparison: Comparison, axes: Axes | None = None) -> Figure:
    """Draw both paths over the larger plate, and over time; with axes in m, only the paths, into these."""
    both = dict(zip(comparison.names, map(portrait_of, comparison.runs), strict=True))
    lines = {name: portrait.samples for name, portrait in both.items()}
    outlines = [outlines_of(one.case, one.samples, one.rows) for one in both.values()]
    under = max(both, key=lambda name: extent(both[name].box) if both[name].plate else 0.0)
    if axes is not None:
        return draw_paths_into(axes, both[under], lines, outlines)
    rows = _rows(comparison, list(both.values()))
    box = np.concatenate([portrait.box for portrait in both.values()])
    figure, place, keys = draw_paths_over(both[under], lines, outlines, box, ROW * len(rows))
    if plate := both[under].plate:
        figure.axes[0].set_title(f"The plate of {under} at {both[under].when}", fontsize=10, parse_math=False)
        for colour, other in zip(PARTS_COLOURS, both.values(), strict=False):
            if other.plate and not np.array_equal(other.box, both[under].box):
                curves = rim_curves(other.plate.outline, extent(other.box) / 200)
                draw_rim(
                    figure.axes[0], curves, unit_for(plate.outline.box, "m").per_si, colors=colour, linestyles="--"
                )
    end = max(float(line.time[-1]) for line in lines.values())
    _draw_rows(figure, place, rows, end if end > NOTHING else max(s.duration for s in comparison.summaries))
    ends = (f"{name} ({portrait.summary.outcome})" for name, portrait in both.items())
    put_title(figure, f"{' and '.join(ends)}\n{with_micro_signs(comparison.sentence)}")
    put_keys(figure, keys)
    return figure


def _rows(comparison: Comparison, both: list[Portrait]) -> list[tuple[str, str, list[Line]]]:
    """Label, unit and lines of what is drawn over time."""
    ways = [(one.samples.time, (one.samples.position - one.samples.position[0]).T) for one in both]
    rows = [(f"way along {axis}", "m", [(time, way[k]) for time, way in ways]) for k, axis in enumerate("xy")]
    rows.append(("apart", "m", [(comparison.time, comparison.distance)]))
    left = [_left(one) for one in both]
    return rows + [("force to\ncoming off", "N", left)] * all(len(time) for time, _ in left)


def _left(one: Portrait) -> Line:
    """The least force [N] that was left to coming off in each cycle, or in a STEPS-th of the run; empty: not known."""
    known, end = np.isfinite(one.margins.contact), float(one.samples.time[-1])
    times, forces = one.margins.time[known], one.summary.margins.scale * one.margins.contact[known]
    step = max([end / STEPS or 1.0, *(cycle for cycle in one.cycles if MANY * cycle < end)])
    last = max(int(end / step * (1 + ROUNDING)), 1) - 1  # it also has what is left over
    first = np.unique(np.minimum((times / step).astype(int), last), return_index=True)[1]
    return times[first], np.minimum.reduceat(forces, first) if len(first) else forces


def _draw_rows(figure: Figure, place: SubplotSpec, rows: list[tuple[str, str, list[Line]]], end: float) -> None:
    """Draw what happens up to an end [s], one row below the other."""
    clock = unit_for(end, "s")
    grid = place.subgridspec(len(rows), 1)
    for k, (label, si, lines) in enumerate(rows):
        axes = figure.add_subplot(grid[k], sharex=figure.axes[-1] if k else None)
        unit = unit_for(np.concatenate([values for _, values in lines]), si)
        for (time, values), colour in zip(lines, PARTS_COLOURS if len(lines) > 1 else (BESIDE,), strict=False):
            axes.plot(time * clock.per_si, values * unit.per_si, color=colour, linewidth=1.3)
            look = END | {"markersize": 5, "color": colour, "clip_on": False}
            axes.plot(time[-1:] * clock.per_si, values[-1:] * unit.per_si, **look)
        plain_ticks(axes)
        axes.set_xlim(0, end * clock.per_si)
        axes.grid(alpha=0.3)
        axes.tick_params(labelbottom=k == len(rows) - 1)
        axes.set_ylabel(f"{label}\n[{unit.name}]")
    axes.set_xlabel(f"time [{clock.name}]")
