"""Figure result: what a figure's module returns: data, verdicts, and how its picture is drawn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from active_surface.paper.models import CLOSED, MODELS, PAPER, PLATE
from active_surface.paper.verdict import Verdict

LOOK: dict[str, dict[str, Any]] = {
    PAPER: {"color": "#c8371b", "linestyle": "--", "linewidth": 1.6},
    CLOSED: {"color": "black", "linestyle": "-", "linewidth": 1.1},
    PLATE: {"color": "#5b8fc7", "linestyle": ":", "linewidth": 2.0},
}
"""Lines of the models, which differ in grey as well."""
COLOURS = ("#1b4f9c", "#c8371b", "#3d8a4e", "#8a6d3b", "#7a4b94", "#404040")
"""Lines of different strokes."""
MICRO, MILLI = 1e6, 1e3


@dataclass(frozen=True, eq=False)
class FigureResult:
    """One figure, or a group of them that share a picture."""

    name: str
    title: str
    verdicts: tuple[Verdict, ...]
    data: dict[str, Any]  # numbers, texts, lists and dictionaries of these: written as JSON
    draw: Callable[[Figure], None] = field(repr=False)
    size: tuple[float, float] = (10.0, 4.4)  # inches
    caption: str = ""


def look(model: str, **more: Any) -> dict[str, Any]:
    """How a model's line looks, with its name."""
    return LOOK[model] | {"label": MODELS[model]} | more


def finish(axes: Axes, across: str, up: str, title: str = "", legend: bool = True) -> None:
    """Labels, grid and legend of a pair of axes."""
    axes.set_xlabel(across)
    axes.set_ylabel(up)
    axes.set_title(title, fontsize=10)
    axes.grid(alpha=0.3)
    if legend:
        axes.legend(frameon=False, fontsize=8)


def percent(share: float) -> str:
    """A share in words; nan: of nothing."""
    return "- %" if share != share else f"{100 * share:.0f} %"
