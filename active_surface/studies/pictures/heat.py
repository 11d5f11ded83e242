"""Maps over two axes of a sweep: how far parts went, and what became of them."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.collections import LineCollection
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import ScalarFormatter

from active_surface.arrays import BoolArray, FloatArray, IntArray
from active_surface.studies.pictures.selection import Scale, Selection, labelled
from active_surface.studies.record import OUTCOMES
from common import Unit, legend_below
from coupling.pictures import plain_ticks

COLOURS = ("#40719c", "#e0c368", "#b8862d", "#7d1f0e", "#7a4b94", "#a8a8a8", "#dedede")
"""Of the outcomes, by their number; they differ in grey, too."""
OUTCOME = "what became of the part"
NARROW = 5.0  # inches: a figure with one key a line
MAX_NAMES = 12  # along an axis
FEW_DIGITS = 1e-4, 1e7  # numbers between them are written out


def draw_value(figure: Figure, axes: Axes, selection: Selection) -> None:
    """Draw a map of a column of the results."""
    across, up = selection.axes
    draw_field(figure, axes, across, up, selection.mean_value, selection.meaning, selection.unit)
    draw_outline(axes, across, up, selection.holds)


def draw_outcome(axes: Axes, selection: Selection) -> None:
    """Draw a map of what became of the part."""
    across, up = selection.axes
    draw_classes(axes, across, up, selection.usual_outcome, OUTCOMES, COLOURS)
    draw_outline(axes, across, up, selection.holds)


def draw_field(
    figure: Figure, axes: Axes, across: Scale, up: Scale, values: FloatArray, label: str, unit: Unit
) -> None:
    """Draw values (n, m) in SI units over two scales, with their bar."""
    frame(axes, across, up)
    if np.isfinite(values).any():
        shades = np.ma.masked_invalid(values).T * unit.per_si
        zeros: dict[str, Any] = {} if shades.any() else {"vmin": 0.0, "vmax": 1.0}
        mesh = axes.pcolormesh(edges(across), edges(up), shades, cmap="viridis", rasterized=True, **zeros)
        figure.colorbar(mesh, ax=axes).set_label(labelled(label, unit), parse_math=False)


def draw_classes(
    axes: Axes, across: Scale, up: Scale, numbers: IntArray, names: tuple[str, ...], colours: tuple[Any, ...]
) -> None:
    """Draw classes (n, m), each in its colour, with a key of those that there are."""
    frame(axes, across, up)
    norm = BoundaryNorm(np.arange(len(names) + 1) - 0.5, len(names))
    axes.pcolormesh(edges(across), edges(up), numbers.T, cmap=ListedColormap(list(colours)), norm=norm, rasterized=True)
    add_key(axes, numbers, names, colours)


def outline(across: Scale, up: Scale, holds: BoolArray) -> list[list[tuple[float, float]]]:
    """The straight pieces between the fields (n, m) of a map where a condition holds and the others."""
    x, y = edges(across).tolist(), edges(up).tolist()
    lines = [[(x[i + 1], y[j]), (x[i + 1], y[j + 1])] for i, j in np.argwhere(holds[1:] != holds[:-1])]
    return lines + [[(x[i], y[j + 1]), (x[i + 1], y[j + 1])] for i, j in np.argwhere(holds[:, 1:] != holds[:, :-1])]


def draw_outline(axes: Axes, across: Scale, up: Scale, holds: BoolArray | None) -> None:
    """Draw a line between the fields (n, m) of a map where a condition holds and the others; None: there is none."""
    if holds is None:
        return
    lines = outline(across, up, holds)
    black = [withStroke(linewidth=3.0, foreground="black")]
    axes.add_collection(LineCollection(lines, colors="white", linewidths=1.4, path_effects=black), autolim=False)


def add_key(axes: Axes, numbers: IntArray, names: tuple[str, ...], colours: tuple[Any, ...]) -> None:
    """A key of the classes that there are, with the share of each, below the axes."""
    counts = np.bincount(numbers.ravel(), minlength=len(names))
    share = 100 / max(numbers.size, 1)
    patches = [
        Patch(facecolor=colours[k], edgecolor="#606060", linewidth=0.5, label=f"{names[k]}, {counts[k] * share:.3g} %")
        for k in np.flatnonzero(counts)
    ]
    legend_below(
        axes, handles=patches, ncols=2 if len(patches) > 1 and axes.figure.bbox.width > NARROW * axes.figure.dpi else 1
    )


def frame(axes: Axes, across: Scale, up: Scale | None = None) -> None:
    """Label the axes and set their scales."""
    plain_ticks(axes)
    axes.set_xlabel(across.label, parse_math=False)
    if across.logarithmic:
        axes.set_xscale("log")
    _name_ticks(axes.xaxis, across)
    if up:
        axes.set_ylabel(up.label, parse_math=False)
        if up.logarithmic:
            axes.set_yscale("log")
        _name_ticks(axes.yaxis, up)


def _name_ticks(axis: Axis, scale: Scale) -> None:
    """Name a few of a scale's texts, and write numbers with a power of ten where they would have many digits."""
    formatter = axis.get_major_formatter()
    if scale.texts:
        places = range(0, len(scale.texts), -(-len(scale.texts) // MAX_NAMES))
        axis.set_ticks(list(places), list(scale.texts[:: places.step]), parse_math=False)
    elif isinstance(formatter, ScalarFormatter) and not FEW_DIGITS[0] <= np.abs(scale.drawn).max() < FEW_DIGITS[1]:
        formatter.set_scientific(True)


def edges(scale: Scale) -> FloatArray:
    """The edges (n + 1,) of the fields around its values (n,), half-way to the next ones."""
    values = np.log(scale.drawn) if scale.logarithmic else scale.drawn
    if len(values) == 1:
        values = values[0] + np.array([-0.5, 0.5]) * (abs(values[0]) or 1.0)
        return np.exp(values) if scale.logarithmic else values
    middles = (values[1:] + values[:-1]) / 2
    borders = np.concatenate([[2 * values[0] - middles[0]], middles, [2 * values[-1] - middles[-1]]])
    return np.exp(borders) if scale.logarithmic else borders
