"""Panels: the pictures that tell of a sweep, each drawn into axes of its own."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from active_surface.studies.pictures.basins import NEARNESS, Basins, is_over_starts
from active_surface.studies.pictures.curve import draw_curve, draw_shares
from active_surface.studies.pictures.heat import OUTCOME, draw_outcome, draw_value
from active_surface.studies.pictures.scatter import draw_outcomes, draw_points
from active_surface.studies.pictures.selection import Selection
from active_surface.studies.pictures.threshold_curve import draw_threshold


class Panel(NamedTuple):
    """One of the pictures; `name` tells it from the others."""

    name: str
    title: str
    draw: Callable[[Figure, Axes], None]


def panels(selection: Selection) -> list[Panel]:
    """What tells of a sweep: curves over one axis, maps over two, marks at points, basins over starts."""
    if is_over_starts(selection) and not selection.findings.scattered:
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
