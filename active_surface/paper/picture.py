"""Picture: the panels of a figure as data, the one way to draw them, and what a figure's computation returns."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from active_surface.arrays import FloatArray
from active_surface.paper.bench import CLOSED, MODELS, OFF, OVER, PAPER, PLATE, STAYS, UNKNOWN, Path
from active_surface.paper.statements import STATEMENTS
from active_surface.paper.verdict import Numbers, Verdict

Look = dict[str, Any]  # of matplotlib's `plot`, its label among them
LOOK: Final[dict[str, Look]] = {
    PAPER: {"color": "#c8371b", "linestyle": "--", "linewidth": 1.6},
    CLOSED: {"color": "black", "linestyle": "-", "linewidth": 1.1},
    PLATE: {"color": "#5b8fc7", "linestyle": ":", "linewidth": 2.0},
}
"""Lines of the models, which differ in grey as well."""
COLOURS: Final = ("#1b4f9c", "#c8371b", "#3d8a4e", "#8a6d3b", "#7a4b94", "#404040")
"""Lines of different strokes."""
GREY, GOLD, GREEN, RED = "#8a8a8a", "#b8862d", "#3d8a4e", "#c8371b"
MARKS: Final = {STAYS: ("o", GREEN), OFF: ("x", RED), OVER: ("s", "#7a4b94"), UNKNOWN: ("*", "#404040")}
"""How paths end."""
FIRST: Final[Look] = {
    "color": "black", "linewidth": 0.9, "zorder": 3, "marker": "D", "markevery": [0], "markerfacecolor": "none",
    "label": "the first start and its path",
}  # fmt: skip
MICRO, MILLI = 1e6, 1e3


class Curve(NamedTuple):
    """A line or marks; those without a label are not written as data."""

    x: ArrayLike  # (n,) in the units of its panel
    y: ArrayLike
    look: Look
    error: ArrayLike | None = None


@dataclass(frozen=True, eq=False)
class Panel:
    """A pair of axes."""

    across: str
    up: str
    curves: Sequence[Curve]
    title: str = ""
    bands: Sequence[tuple[str, float, float, str]] = ()  # "x" or "y", from, to, colour; a line where both are the same
    legend: bool = True  # its own; the labels of the other panels stand once, below all
    settings: dict[str, Any] = field(default_factory=dict)  # of matplotlib's `Axes.set`


Found = tuple[dict[str, dict[str, Any]], Sequence[Sequence[Panel]]]
"""Numbers by figure of the statements, then by model or otherwise; and panels by row."""


@dataclass(frozen=True, eq=False)
class FigureResult:
    """One figure, or a group of them that share a picture."""

    name: str
    numbers: dict[str, dict[str, Numbers]]  # by figure of the statements, then by model or otherwise
    panels: Sequence[Sequence[Panel]]  # by row

    @property
    def verdicts(self) -> list[Verdict]:
        """One for each statement, in the order of the table."""
        return [one.judged(self.numbers[one.figure]) for one in STATEMENTS if one.figure in self.numbers]

    @property
    def data(self) -> list[dict[str, Any]]:
        """What the panels show: for a JSON file."""
        return [
            {
                "title": panel.title, "across": panel.across, "up": panel.up,
                "curves": [
                    {"label": curve.look["label"], "x": np.asarray(curve.x).tolist(), "y": np.asarray(curve.y).tolist()}
                    for curve in panel.curves if "label" in curve.look and np.size(curve.x)
                ],
            }
            for row in self.panels for panel in row
        ]  # fmt: skip


def draw(found: FigureResult) -> Figure:
    """The picture; panels of a row share their vertical axis where it has one label, and then columns their other."""
    rows, columns = len(found.panels), len(found.panels[0])
    figure = Figure(figsize=(min(4.7 * columns, 15.0), 4.7 if rows == 1 else 10.0))
    FigureCanvasAgg(figure)
    figure.set_layout_engine("constrained", w_pad=0.1, h_pad=0.06)
    shared = columns > 1 and all(len({panel.up for panel in row}) == 1 for row in found.panels)
    grid = figure.subplots(
        rows, columns, squeeze=False, sharex="col" if shared else False, sharey="row" if shared else False
    )
    below: dict[str, Any] = {}
    for axes, panel in zip(grid.ravel(), [panel for row in found.panels for panel in row], strict=True):
        for x, y, look, error in panel.curves:
            axes.errorbar(x, y, error, **look) if error is not None else axes.plot(x, y, **look)
        for along, low, high, colour in panel.bands:
            line, span = (axes.axvline, axes.axvspan) if along == "x" else (axes.axhline, axes.axhspan)
            line(low, color=colour, linewidth=0.8) if low == high else span(low, high, color=colour, alpha=0.15)
        axes.set(xlabel=panel.across, ylabel=panel.up, **panel.settings)
        axes.set_title(panel.title, fontsize=10)
        axes.grid(alpha=0.3)
        if shared:
            axes.label_outer()
        if panel.legend:
            axes.legend(frameon=False, fontsize=8)
        else:
            handles, labels = axes.get_legend_handles_labels()
            below = dict(zip(labels, handles, strict=True)) | below
    if below:
        figure.legend(below.values(), below, loc="outside lower center", ncols=8, frameon=False, fontsize=8)
    return figure


def look(model: str, label: str = "{}", **more: Any) -> Look:
    """How a model's line looks, and what it is called, {} for the name of the model."""
    return LOOK[model] | {"label": label.format(MODELS[model])} | more


def dots(marker: str, colour: str, label: str = "", size: float = 4, **more: Any) -> Look:
    """Marks without a line."""
    plain: Look = {"linestyle": "", "marker": marker, "color": colour, "markersize": size}
    return plain | ({"label": label} if label else {}) | more


def ways(
    paths: Sequence[Path],
    x: Callable[[FloatArray], FloatArray],
    y: Callable[[FloatArray], FloatArray],
    shown: int = 8,
) -> list[Curve]:
    """Paths as lines, the first heavy, and how all of them end; x and y are made of times and places (n, 3) [s, m]."""
    curves = []
    for k, path in reversed(list(enumerate(paths[:shown]))):
        rows = path.drawn(600)
        curves.append(Curve(x(rows), y(rows), {"color": "#9ab5d6", "linewidth": 0.5} if k else FIRST))
    for name, (marker, colour) in MARKS.items():
        ends = np.array([path.drawn(2)[-1] for path in paths if path.end == name]).reshape(-1, 3)
        curves.append(Curve(x(ends), y(ends), dots(marker, colour, name, markerfacecolor="none", zorder=4)))
    return curves
