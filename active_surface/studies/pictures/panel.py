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
from active_surface.studies.pictures.shown import Shown
from active_surface.studies.pictures.threshold_curve import draw_threshold


class Panel(NamedTuple):
    """One of the pictures; `name` tells it from the others."""

    name: str
    title: str
    draw: Callable[[Figure, Axes], None]


def panels(shown: Shown) -> list[Panel]:
    """What tells of a sweep: curves over one axis, maps over two, marks at points, basins over starts."""
    if is_over_starts(shown) and not shown.findings.scattered:
        basins = Basins(shown)
        chosen = [
            Panel("basins", "where the part is carried", lambda figure, axes: basins.draw_carried(axes)),
            Panel("nearness", NEARNESS, basins.draw_nearness),
        ]
    else:
        chosen = [value_panel(shown), outcome_panel(shown)]
    holds, threshold = shown.holds, shown.findings.threshold
    if holds is not None and threshold and len(shown.axes) > 1:
        text = threshold.text
        chosen.append(
            Panel("threshold", f"where {text} begins", lambda figure, axes: draw_threshold(axes, shown, holds, text))
        )
    return chosen


def value_panel(shown: Shown) -> Panel:
    """The picture of the column that is shown."""

    def draw(figure: Figure, axes: Axes) -> None:
        if shown.findings.scattered:
            draw_points(figure, axes, shown)
        elif len(shown.axes) == 1:
            draw_curve(axes, shown)
        else:
            draw_value(figure, axes, shown)

    return Panel(shown.column, shown.meaning, draw)


def outcome_panel(shown: Shown) -> Panel:
    """The picture of what became of the part."""
    over_one = draw_outcomes if shown.findings.scattered else draw_shares
    over_two = draw_outcomes if shown.findings.scattered else draw_outcome
    draw = over_one if len(shown.axes) == 1 else over_two
    return Panel("outcome", OUTCOME, lambda figure, axes: draw(axes, shown))
