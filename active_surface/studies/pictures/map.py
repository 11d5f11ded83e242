"""The picture of a sweep: curves over one axis, maps over two, places of random points, basins over starts."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from active_surface.studies.pictures.basins import NEARNESS, Basins, is_over_starts
from active_surface.studies.pictures.curve import draw_curve, draw_shares, draw_threshold
from active_surface.studies.pictures.findings import Findings
from active_surface.studies.pictures.heat import OUTCOME, draw_outcome, draw_value
from active_surface.studies.pictures.scatter import draw_ends, draw_outcomes, draw_points
from active_surface.studies.pictures.selection import Selection
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
    if is_over_starts(selection) and selection.findings.scattered:
        chosen = [Panel("ends", "where the part ends", lambda figure, axes: draw_ends(axes, selection))]
        chosen += [value_panel(selection), outcome_panel(selection)]
    elif is_over_starts(selection):
        basins = Basins(selection)
        chosen = [
            Panel("basins", "where the part is carried", lambda figure, axes: basins.draw_carried(axes)),
            Panel("nearness", NEARNESS, basins.draw_nearness),
        ]
    else:
        chosen = [value_panel(selection), outcome_panel(selection)]
    holds, threshold = selection.holds, selection.findings.threshold
    if holds is not None and threshold and len(selection.axes) > 1:
        text = threshold.text
        chosen.append(
            Panel(
                "threshold",
                f"where {text} begins",
                lambda figure, axes: draw_threshold(axes, selection, holds, text),
            )
        )
    return chosen


def value_panel(selection: Selection) -> Panel:
    """The picture of the column that is shown."""

    def draw(figure: Figure, axes: Axes) -> None:
        if selection.findings.scattered:
            draw_points(figure, axes, selection)
        elif len(selection.axes) == 1:
            draw_curve(axes, selection)
        else:
            draw_value(figure, axes, selection)

    return Panel(selection.column, selection.meaning, draw)


def outcome_panel(selection: Selection) -> Panel:
    """The picture of what became of the part."""
    over_one = draw_outcomes if selection.findings.scattered else draw_shares
    over_two = draw_outcomes if selection.findings.scattered else draw_outcome
    draw = over_one if len(selection.axes) == 1 else over_two
    return Panel("outcome", OUTCOME, lambda figure, axes: draw(axes, selection))
