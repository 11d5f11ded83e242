"""Drawing: a figure that a notebook shows, with axes of numbers in SI units that are labelled with prefixes."""

from __future__ import annotations

import math
from base64 import b64encode
from collections.abc import Callable
from html import escape
from io import BytesIO
from typing import Any, cast

from matplotlib import rcParams
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter, FuncFormatter, MaxNLocator
from matplotlib.transforms import ScaledTranslation

SIZE = 4.2, 3.6  # inches, of one pair of axes
DOTS = 80  # an inch, in a notebook
TICKS = 5
LEAST = -12  # the power of ten of the smallest prefix
ROUNDING = 1e-9
MINUS = "\N{MINUS SIGN}"
BELOW = 3.6  # times the size of the letters: room for an axis and its label


class Drawing(Figure):
    """A figure that a notebook shows as a picture, whether or not it uses pyplot."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**{"figsize": SIZE, "layout": "constrained"} | options)
        FigureCanvasAgg(self)

    def _repr_html_(self) -> str:
        image = BytesIO()
        self.savefig(image, format="png", dpi=DOTS)
        said = b64encode(image.getvalue()).decode()
        return f'<img style="max-width: 100%" src="data:image/png;base64,{said}"/>'


def plotted(draw: Callable[[Axes], object], axes: Axes | None) -> Figure:
    """The figure of axes into which something was drawn, or of new ones."""
    if axes is None:
        axes = Drawing().add_subplot()
    draw(axes)
    return cast(Figure, axes.figure)


def html(thing: Any) -> str:
    """What a notebook shows of something that can be plotted: its repr above its picture."""
    return f"<div><div>{escape(repr(thing))}</div>{thing.plot()._repr_html_()}</div>"


def plan(axes: Axes) -> None:
    """Make axes that show places in m ready."""
    axes.set_aspect("equal")
    extent = max(_extent(axes.xaxis), _extent(axes.yaxis))
    for axis, name in ((axes.xaxis, "x"), (axes.yaxis, "y")):
        in_unit(axis, name, "m", extent)


def in_unit(axis: Axis, name: str, unit: str, extent: float | None = None) -> None:
    """Label an axis of numbers in an SI unit as in one with a prefix, such as µm, by what it shows or an extent."""
    largest = extent or _extent(axis)
    power = min(max(3 * math.floor(math.log10(largest) / 3 + ROUNDING), LEAST), 0) if largest else 0
    axis.set_major_locator(MaxNLocator(TICKS))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / 10.0**power:.6g}".replace("-", MINUS)))
    axis.set_label_text(f"{name} [{EngFormatter.ENG_PREFIXES[power]}{unit}]")


def _extent(axis: Axis) -> float:
    return max(map(abs, axis.get_view_interval()))


def put_below(axes: Axes, **legend: Any) -> None:
    """Put a legend below axes and their label."""
    down = ScaledTranslation(0, -BELOW * rcParams["font.size"] / 72, axes.figure.dpi_scale_trans)
    place: dict[str, Any] = {"loc": "upper center", "bbox_to_anchor": (0.5, 0), "bbox_transform": axes.transAxes + down}
    for text in axes.legend(frameon=False, fontsize="small", **place, **legend).get_texts():
        text.set_parse_math(False)
