"""The figure of a picture: axes whose numbers are in a unit with a prefix, title and keys, and its PNG file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from textwrap import fill
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, ScalarFormatter

from common import STEPS, Unit
from coupling.files import whole_file

DPI = 110
COMPRESSION = 3  # of PNG: three times as fast as the usual 6 in files that are a tenth larger
MAX_TICKS = 6
PAD = 0.04  # inches, at least, at the left and right of title and keys


def plain_ticks(axes: Axes) -> None:
    """Set a few ticks, labelled with plain numbers: without an offset or a power of ten."""
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(MAX_TICKS, steps=STEPS))
        formatter = ScalarFormatter(useOffset=False)
        formatter.set_scientific(False)
        axis.set_major_formatter(formatter)


def map_axes(axes: Axes, unit: Unit, where: str = "") -> None:
    """Give axes of places equal scales and plain ticks, and label them with a unit; where: such as " on the plate"."""
    axes.set_aspect("equal")
    plain_ticks(axes)
    axes.set_xlabel(f"x{where} [{unit.name}]")
    axes.set_ylabel(f"y{where} [{unit.name}]")


def put_keys(figure: Figure, keys: Sequence[Artist]) -> None:
    """Put keys below all, each name once, on as few lines as the width takes."""
    chosen = list({key.get_label(): key for key in reversed(keys)}.values())[::-1]
    for lines in range(1, len(chosen) + 1):
        columns = -(-len(chosen) // lines)
        legend = figure.legend(handles=chosen, loc="outside lower center", ncols=columns, frameon=False, borderpad=0.1)
        if columns == 1 or legend.get_window_extent().width < figure.bbox.width - 2 * PAD * figure.dpi:
            return
        legend.remove()


def put_title(figure: Figure, text: str, **look: Any) -> None:
    """Put a title above all, on as many lines as the width needs."""
    columns = max(map(len, text.splitlines()))
    while True:
        lines = [fill(line, columns) for line in text.splitlines()]
        title = figure.suptitle("\n".join(lines), parse_math=False, **look)
        times = title.get_window_extent().width / (figure.bbox.width - 2 * PAD * figure.dpi)
        if times <= 1 or columns == 1:
            return
        columns = max(1, min(columns - 1, int(columns / times)))


def save_picture(figure: Figure, path: Path) -> Path:
    """Save a figure as a PNG file, as a whole or not at all; return its path."""
    figure.set_dpi(DPI)
    canvas = FigureCanvasAgg(figure)
    with whole_file(path) as partial:  # not by savefig, which draws everything twice to find the layout
        canvas.print_png(partial, pil_kwargs={"compress_level": COMPRESSION})
    return path
