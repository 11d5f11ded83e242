"""Drawing: figures that notebooks show, axes in SI units with prefixes, and the rim of a plate."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable
from io import BytesIO
from typing import Any, cast

import numpy as np
from matplotlib import rcParams
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator
from matplotlib.transforms import ScaledTranslation
from numpy.typing import NDArray

from common.wording import unit_for

FloatArray = NDArray[np.float64]

SIZE = 4.2, 3.6  # inches, of one pair of axes
DPI = 80  # in a notebook
MAX_TICKS = 5
STEPS = (1, 2, 2.5, 5, 10)  # between ticks, times a power of ten
MINUS = "\N{MINUS SIGN}"
BELOW = 3.6  # times the font size: room for an axis and its label
RIM_WIDTH = 1.5  # points


class Drawing(Figure):
    """A figure that a notebook shows as a picture, whether or not it uses pyplot."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**{"figsize": SIZE, "layout": "constrained"} | options)
        FigureCanvasAgg(self)

    def _repr_html_(self) -> str:
        image = BytesIO()
        self.savefig(image, format="png", dpi=DPI)
        data = b64encode(image.getvalue()).decode()
        return f'<img style="max-width: 100%" src="data:image/png;base64,{data}"/>'


def axes_or_new(axes: Axes | None) -> Axes:
    """Axes that are given, or new ones in a figure of their own."""
    return Drawing().add_subplot() if axes is None else axes


def figure_of(axes: Axes) -> Figure:
    """The figure of axes."""
    return cast(Figure, axes.figure)


def label_places(axes: Axes) -> None:
    """Give axes in m equal scales, and label them in a unit with a prefix."""
    axes.set_aspect("equal")
    extent = max(_extent(axes.xaxis), _extent(axes.yaxis))
    for axis, name in ((axes.xaxis, "x"), (axes.yaxis, "y")):
        label_axis(axis, name, "m", extent)


def label_axis(axis: Axis, name: str, si: str, extent: float | None = None) -> None:
    """Label an axis of numbers in an SI unit as one in a unit with a prefix, which suits an extent or what it shows."""
    unit = unit_for(extent or _extent(axis), si)
    axis.set_major_locator(MaxNLocator(MAX_TICKS, steps=STEPS))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value * unit.per_si:.6g}".replace("-", MINUS)))
    axis.set_label_text(f"{name} [{unit.name}]")


def _extent(axis: Axis) -> float:
    return max(map(abs, axis.get_view_interval()))


def draw_rim(axes: Axes, curves: Iterable[FloatArray], per_metre: float | FloatArray = 1.0, **look: Any) -> None:
    """Draw the rim of a plate, curves (k, 2) [m], into axes of so many units per metre, of each axis or of both."""
    options: dict[str, Any] = {"colors": "black", "linewidths": RIM_WIDTH} | look
    axes.add_collection(LineCollection([curve * per_metre for curve in curves], **options))


def legend_below(axes: Axes, **options: Any) -> None:
    """Put a legend below axes and their label."""
    down = ScaledTranslation(0, -BELOW * rcParams["font.size"] / 72, axes.figure.dpi_scale_trans)
    place: dict[str, Any] = {"loc": "upper center", "bbox_to_anchor": (0.5, 0), "bbox_transform": axes.transAxes + down}
    for text in axes.legend(frameon=False, fontsize="small", **place, **options).get_texts():
        text.set_parse_math(False)
