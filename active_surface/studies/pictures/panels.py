"""The picture of a sweep: curves over one axis, maps over two, places of random points, basins over starts."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from active_surface.studies.pictures.charts import draw_outcomes, draw_threshold, draw_values
from active_surface.studies.pictures.selection import Findings, Selection
from active_surface.studies.pictures.starts import NEARNESS, draw_basins, draw_ends, draw_nearness, is_over_starts
from active_surface.studies.study import Study
from common import Drawing
from coupling.pictures import put_title, save_picture

if TYPE_CHECKING:
    import xarray

WIDTH, HEIGHT = 6.2, 5.2  # inches, of a panel


def draw_sweep(study: Study, dataset: xarray.Dataset, path: Path) -> Path:
    """Draw the results of a study into a PNG file; return its path.

    Of a grid the two axes with the most values are drawn, the others at their middle value; of repeats the mean.
    """
    figure = Drawing()
    compose(figure, Findings.of(study.name, dataset, study.threshold))
    return save_picture(figure, path)


def compose(figure: Figure, findings: Findings) -> None:
    """Draw the results of a sweep into an empty figure."""
    selection = Selection.of(findings)
    drawn = panels(selection)
    figure.set_size_inches(WIDTH * len(drawn), HEIGHT)
    figure.set_layout_engine("constrained", w_pad=0.1, h_pad=0.06)
    places = [figure.add_subplot(1, len(drawn), k + 1) for k in range(len(drawn))]
    for axes, panel in zip(places, drawn, strict=True):
        panel.draw(figure, axes)
        axes.set_title(panel.title, fontsize=10, parse_math=False)
    put_title(figure, f"{findings.name}: {about(selection)}")


def about(selection: Selection) -> str:
    """What is shown, in words."""
    of, drawn, repeats = selection.findings.dataset["outcome"].size, selection.outcome.size, selection.findings.repeats
    parts = [f"{of} paths" if drawn == of else f"{drawn} of {of} paths"]
    if repeats > 1:
        parts.append(f"mean of {repeats} starts")
    return ", ".join(parts + [f"{name} = {text}" for name, text in selection.fixed.items()])


class Panel(NamedTuple):
    """One of the pictures; `name` tells it from the others."""

    name: str
    title: str
    draw: Callable[[Figure, Axes], None]


def panels(selection: Selection) -> list[Panel]:
    """What tells of a sweep: curves over one axis, maps over two, marks at points, basins over starts."""
    chosen = [value_panel(selection), outcome_panel(selection)]
    if is_over_starts(selection) and selection.findings.scattered:
        chosen.insert(0, _panel("ends", "where the part ends", draw_ends, selection))
    elif is_over_starts(selection):
        chosen = [
            _panel("basins", "where the part is carried", draw_basins, selection),
            _panel("nearness", NEARNESS, draw_nearness, selection),
        ]
    if selection.holds is not None and selection.findings.threshold and len(selection.axes) > 1:
        title = f"where {selection.findings.threshold.text} begins"
        chosen.append(_panel("threshold", title, draw_threshold, selection))
    return chosen


def value_panel(selection: Selection) -> Panel:
    """The picture of the column that is shown."""
    return _panel(selection.column, selection.meaning, draw_values, selection)


def outcome_panel(selection: Selection) -> Panel:
    """The picture of what became of the part."""
    return _panel("outcome", "what became of the part", draw_outcomes, selection)


def _panel(name: str, title: str, draw: Callable[[Axes, Selection], None], selection: Selection) -> Panel:
    return Panel(name, title, lambda _, axes: draw(axes, selection))
