"""The figure of a picture: axes whose numbers are in a unit with a prefix, labels, title, keys, and its PNG file.

A label of a point is moved around it until it is clear of lines, marks and other labels.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from pathlib import Path
from textwrap import fill
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.path import Path as Curve
from matplotlib.text import Annotation
from matplotlib.ticker import MaxNLocator, ScalarFormatter
from matplotlib.transforms import Bbox
from numpy.typing import ArrayLike, NDArray

from common import STEPS, Unit
from coupling.files import whole_file

FloatArray = NDArray[np.float64]

DPI = 110
COMPRESSION = 3  # of PNG: three times as fast as the usual 6 in files that are a tenth larger
MAX_TICKS = 6
PAD = 0.04  # inches, at least, at the left and right of title and keys
SIDES = np.array([side for side in itertools.product((-1, 0, 1), repeat=2) if any(side)])
TIMES = (1.0, 1.6, 2.4)  # the distance at which a label is put first
DIAGONAL = 0.7  # of the distance, along each axis
CLEAR = 1.0  # pixels around a label
ACROSS, UP = {-1: "right", 0: "center", 1: "left"}, {-1: "top", 0: "center", 1: "bottom"}


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


def put_label(axes: Axes, text: str, point: ArrayLike, offset: tuple[float, float], **look: Any) -> None:
    """Write a text beside a point, at an offset [points] until `clear_labels` moves it."""
    x, y = np.asarray(point, dtype=float).tolist()
    axes.annotate(text, (x, y), offset, textcoords="offset points", **look).set_in_layout(False)


def clear_labels(figure: Figure) -> None:
    """Move the labels in a figure, in which all else is drawn, to where they cover least."""
    figure.draw_without_rendering()  # which finds the layout
    for axes in figure.axes:
        notes = [one for one in axes.texts if isinstance(one, Annotation)]
        arrows = [_path_of(one.arrow_patch) for one in notes if one.arrow_patch]
        lines, marks = _drawn(axes)
        placed: list[Bbox] = []
        for label in (one for one in notes if one.get_text()):
            placed.append(_move(label, [*arrows, *lines], marks, placed))


def _move(label: Annotation, lines: list[Curve], marks: FloatArray, placed: list[Bbox]) -> Bbox:
    """Move a label to the first place where it covers nothing, or to that where it covers least; return its box."""
    offset = np.array(label.xyann)
    likely = SIDES[np.argsort(-(SIDES @ offset) / np.hypot(*SIDES.T), kind="stable")]
    places = [(side, times * np.abs(offset).max()) for times in TIMES for side in likely]
    covered = []
    for place in places:
        box = _put(label, *place)
        middle, half = box.get_points().mean(axis=0), np.array(box.size) / 2
        over_marks = (np.abs(marks[:, :2] - middle) < marks[:, 2:] + half).all(axis=1).sum()
        over_lines = sum(line.intersects_bbox(box, filled=False) for line in lines)
        beyond = label.axes is not None and label.axes.bbox.count_contains(box.corners()) < 4
        covered.append(int(over_marks) + over_lines + box.count_overlaps(placed) + beyond)
        if not covered[-1]:
            break
    return _put(label, *places[int(np.argmin(covered))])


def _put(label: Annotation, side: NDArray[np.int64], distance: float) -> Bbox:
    """Put a label at a side of its point, at a distance [points]; return its box [pixels]."""
    x, y = side.tolist()
    along = distance * (DIAGONAL if x and y else 1.0)
    label.set(position=(x * along, y * along), ha=ACROSS[x], va=UP[y])
    return label.get_window_extent().padded(CLEAR)


def _drawn(axes: Axes) -> tuple[list[Curve], FloatArray]:
    """The lines in axes, and their marks, with the middle and half the size (n, 4) of each, in pixels."""
    lines = [_path_of(one) for one in axes.patches]
    for some in (one for one in axes.collections if isinstance(one, LineCollection)):
        lines += [some.get_transform().transform_path(path) for path in some.get_paths()]
    marks = [np.empty((0, 4))]
    for line in axes.lines:
        path = line.get_transform().transform_path(line.get_path())
        if line.get_linestyle() != "None":
            lines.append(path)
        if line.get_marker() != "None":
            places = np.asarray(path.vertices)
            marks.append(np.hstack([places, np.full(places.shape, line.get_markersize() * axes.figure.dpi / 144)]))
    return lines, np.concatenate(marks)


def _path_of(patch: Patch) -> Curve:
    return patch.get_transform().transform_path(patch.get_path())
