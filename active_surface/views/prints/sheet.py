"""Sheet: a picture for print, as wide as is asked for and as high as what is drawn, saved with its text as text."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from textwrap import fill
from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text

from coupling import whole_file

FORMATS: Final = ("pdf", "svg", "png")
WIDTH: Final = 85.0  # mm, of a column of many journals
NARROWEST, WIDEST = 50.0, 500.0  # mm
MM = 1 / 25.4  # inches
DOTS = 600  # an inch, of pixels in any format
PAD = 1.0  # mm, around all
SHORT = 8  # letters of a label that stay on one line
PLACES = 6  # digits of the figure's height in inches, and of the places of axes over its size
ROUNDS, CLOSE = 6, 0.2  # mm: how well the height is fitted
TEXT = {"font.size": 8.0, "xtick.labelsize": 7.0, "ytick.labelsize": 7.0, "legend.fontsize": 7.0, "axes.titlesize": 8.0}
LINES = {
    "axes.linewidth": 0.6,
    "hatch.linewidth": 0.4,
    "lines.linewidth": 1.0,
    **{f"{axis}tick.major.{what}": size for axis in "xy" for what, size in (("width", 0.6), ("size", 2.5))},
}
FILES = {"pdf.fonttype": 42, "svg.fonttype": "none", "svg.hashsalt": "active-surface"}
UNDATED: dict[str, dict[str, Any]] = {"pdf": {"CreationDate": None}, "svg": {"Date": None}, "png": {}}


class Picture(NamedTuple):
    """A picture yet to be drawn; `name` tells it from others of the same result."""

    name: str
    caption: str
    draw: Callable[[Figure], None]  # into an empty figure of the wanted width


@contextmanager
def _styled() -> Iterator[None]:
    with rc_context(TEXT | LINES | FILES):
        yield


def drawn(picture: Picture, width: float = WIDTH) -> Figure:
    """The figure of a picture, so wide [mm], with its layout fixed: the same picture gives the same file.

    Raises ValueError for a width that no picture can have.
    """
    if not NARROWEST <= width <= WIDEST:
        raise ValueError(f"Input width must be from {NARROWEST:g} to {WIDEST:g} mm; got {width:g}")
    with _styled():
        figure = Figure(figsize=(width * MM, 1.6 * width * MM))
        FigureCanvasAgg(figure)
        figure.set_layout_engine("constrained", w_pad=PAD * MM, h_pad=PAD * MM, hspace=0.03, wspace=0.03)
        picture.draw(figure)
        figure.axes[0].set_anchor("SW")  # beside its labels; what is left over is above, where it is cut off
        for _ in range(ROUNDS):
            figure.draw_without_rendering()
            wrapped = [_wrap(label, axes) for axes in figure.axes for label in (axes.xaxis.label, axes.yaxis.label)]
            left_over = _left_over(figure.axes[0]) * figure.get_figheight()
            if not any(wrapped) and abs(left_over) < CLOSE * MM:
                break
            figure.set_figheight(round(figure.get_figheight() - left_over, PLACES))
        _fix_layout(figure)
        return figure


def _fix_layout(figure: Figure) -> None:
    """Round where axes are, and leave them there.

    The solver of the layout orders its unknowns by their addresses in memory, so its last digits are not always
    the same, and files would differ in these.
    """
    figure.set_layout_engine("none")
    for axes in figure.axes:
        axes.set_position(np.round(axes.get_position(original=True).bounds, PLACES).tolist())


def _wrap(label: Text, axes: Axes) -> bool:
    """Put a label that is longer than its axes on several lines; return whether it was."""
    if " " not in label.get_text():
        return False
    box, room = label.get_window_extent(), axes.get_window_extent()
    share = room.width / box.width if label.get_rotation() == 0 else room.height / box.height
    if share >= 1:
        return False
    longest = max(map(len, label.get_text().splitlines()))
    label.set_text(fill(" ".join(label.get_text().split()), max(int(longest * share), SHORT), break_long_words=False))
    return True


def _left_over(axes: Axes) -> float:
    """How much of the figure's height axes of a fixed aspect leave free above them."""
    return float(axes.get_position(original=True).y1 - axes.get_position().y1)


def save(figure: Figure, stem: Path, formats: Sequence[str] = FORMATS[:1]) -> list[Path]:
    """Saves a figure as STEM.pdf, STEM.svg or STEM.png, or as several of these; returns their paths."""
    files = []
    for kind in formats:
        path = stem.with_name(f"{stem.name}.{kind}")
        with _styled(), whole_file(path) as partial:
            figure.savefig(partial, format=kind, dpi=DOTS, metadata=UNDATED[kind])
        files.append(path)
    return files
