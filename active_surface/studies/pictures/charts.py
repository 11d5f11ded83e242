"""Charts of a sweep: curves over one axis, maps over two, and points; with the bar or the key of their colours."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import ScalarFormatter

from active_surface.arrays import BoolArray, FloatArray, IntArray
from active_surface.studies.columns import OUTCOMES, lowest
from active_surface.studies.pictures.selection import Scale, Selection, labelled
from common import Unit, figure_of, legend_below
from coupling.pictures import plain_ticks

COLOURS: Final = ("#40719c", "#e0c368", "#b8862d", "#7d1f0e", "#7a4b94", "#4f8a5b", "#a8a8a8", "#dedede")
"""Of the outcomes, by their number; they differ in grey, too."""
NARROW: Final = 5.0  # inches: a figure with one key a line
MAX_NAMES: Final = 12  # along an axis
PERCENTILES: Final = (10, 90)
BEGINS, BEFORE = "#c8371b", "#f3c9bd"
DOWNWARDS: Final[dict[str, Any]] = {"markerfacecolor": "white", "markeredgecolor": BEGINS, "label": "there or below"}
LARGEST, SMALLEST = 40.0, 3.0  # square points, of a marker
FEW_POINTS: Final = 20  # more have the colours of the nearest around them
CELLS: Final = 240  # along each side, that are coloured
MAX_VECTORS: Final = 2000  # markers that are not drawn as pixels in files of lines
FEW_DIGITS: Final = 1e-4, 1e7  # numbers between them are written out
OUTLINE: Final[dict[str, Any]] = {
    "colors": "white",
    "linewidths": 1.4,
    "path_effects": [withStroke(linewidth=3.0, foreground="black")],
}


def draw_values(axes: Axes, selection: Selection) -> None:
    """Draw a column of the results: a curve over one axis, a map over two, marks at points."""
    if selection.findings.scattered:
        shades = selection.mean_value * selection.unit.per_si
        known = shades[np.isfinite(shades)]
        span: dict[str, Any] = {"vmin": known.min(), "vmax": known.max()} if len(known) else {}
        add_bar(axes, _draw_points(axes, selection, shades, {"cmap": "viridis"} | span), selection.label)
    elif len(selection.axes) == 1:
        _draw_curve(axes, selection)
    else:
        across, up = selection.axes
        draw_field(axes, across, up, selection.mean_value, selection.meaning, selection.unit)
        draw_outline(axes, across, up, selection.holds)


def draw_outcomes(axes: Axes, selection: Selection) -> None:
    """Draw what became of the part: shares over one axis, a map over two, marks at points."""
    if selection.findings.scattered:
        _draw_points(axes, selection, selection.usual_outcome, look_of(COLOURS))
        add_key(axes, selection.usual_outcome)
    elif len(selection.axes) == 1:
        _draw_shares(axes, selection)
    else:
        across, up = selection.axes
        draw_classes(axes, across, up, selection.usual_outcome)
        draw_outline(axes, across, up, selection.holds)


def _draw_curve(axes: Axes, selection: Selection) -> None:
    """Draw the mean of a column, with the spread of repeats."""
    (across,) = selection.axes
    frame(axes, across)
    axes.set_ylabel(selection.label)
    axes.set_xlim(*edges(across)[[0, -1]])
    shown, repeated = selection.value * selection.unit.per_si, selection.value.shape[-1] > 1
    if not np.isfinite(shown).any():
        return
    if repeated:
        low, high = np.percentile(shown, PERCENTILES, axis=-1)  # nan, a gap, where starts were refused
        label = f"{PERCENTILES[0]} to {PERCENTILES[1]} % of the starts"
        axes.fill_between(across.drawn, low, high, color="#c6d9e8", label=label)
    line = "." if across.axis.field.kind == "text" else ".-"
    heights = selection.mean_value * selection.unit.per_si
    axes.plot(across.drawn, heights, line, color="#40719c", linewidth=1.0, label="mean")
    if np.nanmin(shown) >= 0:
        axes.set_ylim(bottom=0)
    if repeated:
        legend_below(axes, ncols=2)


def _draw_shares(axes: Axes, selection: Selection) -> None:
    """Draw the shares of outcomes."""
    (across,) = selection.axes
    frame(axes, across)
    borders, low = edges(across), np.zeros(len(across.drawn))
    for k, colour in enumerate(COLOURS):
        high = low + 100 * (selection.outcome == k).mean(axis=-1)
        axes.stairs(high, borders, baseline=low, fill=True, color=colour, linewidth=0)
        low = high
    axes.set(ylabel="share of the paths [%]", xlim=borders[[0, -1]], ylim=(0, 100))
    add_key(axes, selection.outcome)


def draw_threshold(axes: Axes, selection: Selection) -> None:
    """Draw the lowest value of the second axis at which the condition begins to hold, over the first axis."""
    (across, up), condition = selection.axes, selection.findings.threshold
    assert condition is not None and selection.holds is not None
    frame(axes, across, up)
    begins, before = lowest(up.drawn, selection.holds)
    next_lower, from_first = f"down to the next lower {up.axis.name}", np.isfinite(begins) & np.isnan(before)
    axes.fill_between(across.drawn, before, begins, color=BEFORE, linewidth=0, label=next_lower)
    label = f"lowest {up.axis.name} with {condition.text}"
    axes.plot(across.drawn, begins, ".-", color=BEGINS, linewidth=1.0, label=label)
    if from_first.any():
        axes.plot(across.drawn[from_first], begins[from_first], "v", **DOWNWARDS)
    axes.set(xlim=edges(across)[[0, -1]], ylim=edges(up)[[0, -1]])
    axes.grid(alpha=0.3)
    if np.isnan(begins).all():
        axes.text(0.5, 0.5, f"{condition.text} nowhere", transform=axes.transAxes, ha="center", parse_math=False)
    else:
        legend_below(axes)


def _draw_points(
    axes: Axes, selection: Selection, colours: FloatArray | IntArray, look: dict[str, Any]
) -> PathCollection:
    """Mark points in their colours (n,), those that have one, and colour what is around them."""
    across, *others = selection.axes
    frame(axes, across, *others)
    if not others:
        axes.set_ylabel(selection.label)
    heights = others[0].drawn if others else selection.mean_value * selection.unit.per_si
    known = np.isfinite(colours)
    places = np.stack([across.drawn, heights], axis=1)[known]
    if others and len(places) > FEW_POINTS:
        draw_nearest(axes, [across, others[0]], places, colours[known], look)
    x, y = places.T
    return axes.scatter(x, y, c=colours[known], **look, **marks(len(known), bool(others)))


def marks(count: int, over_colours: bool = False) -> dict[str, Any]:
    """How count points are marked; over_colours: small, with an edge, on colours that say the same."""
    size = float(np.clip(2e4 / count, SMALLEST, LARGEST))
    if over_colours and count > FEW_POINTS:
        return {"s": min(size, 10.0), "linewidths": 0.3, "edgecolors": "black", "rasterized": count > MAX_VECTORS}
    return {"s": size, "linewidths": 0, "rasterized": count > MAX_VECTORS}


def draw_nearest(
    axes: Axes, scales: Sequence[Scale], places: FloatArray, values: FloatArray | IntArray, look: dict[str, Any]
) -> None:
    """Colour the box around places (n, 2) by the value (n,) of the nearest, distances taken over the box's sides."""
    from scipy.interpolate import NearestNDInterpolator  # here, because few pictures need it

    logarithmic = [scale.logarithmic for scale in scales]
    flat = np.where(logarithmic, np.log(np.where(logarithmic, places, 1.0)), places)
    low, high = flat.min(axis=0), flat.max(axis=0)
    if (low == high).any():
        return
    borders = np.linspace(low, high, CELLS + 1)
    middles = (borders[1:] + borders[:-1]) / 2
    nearest = NearestNDInterpolator(flat, values, rescale=True)(*np.meshgrid(*middles.T))
    x, y = np.where(logarithmic, np.exp(np.where(logarithmic, borders, 0.0)), borders).T
    axes.pcolormesh(x, y, nearest, rasterized=True, zorder=0, linewidth=0, **look)


def draw_field(axes: Axes, across: Scale, up: Scale, values: FloatArray, label: str, unit: Unit) -> None:
    """Draw values (n, m) in SI units over two scales, with their bar."""
    frame(axes, across, up)
    if np.isfinite(values).any():
        shades = np.ma.masked_invalid(values).T * unit.per_si
        zeros: dict[str, Any] = {} if shades.any() else {"vmin": 0.0, "vmax": 1.0}
        mesh = axes.pcolormesh(edges(across), edges(up), shades, cmap="viridis", rasterized=True, **zeros)
        add_bar(axes, mesh, labelled(label, unit))


def add_bar(axes: Axes, shades: ScalarMappable, label: str) -> None:
    """Put the bar of the colours of values beside axes."""
    figure_of(axes).colorbar(shades, ax=axes).set_label(label, parse_math=False)


def draw_classes(
    axes: Axes,
    across: Scale,
    up: Scale,
    numbers: IntArray,
    names: tuple[str, ...] = OUTCOMES,
    colours: tuple[Any, ...] = COLOURS,
) -> None:
    """Draw classes (n, m), each in its colour, with a key of those that there are."""
    frame(axes, across, up)
    axes.pcolormesh(edges(across), edges(up), numbers.T, rasterized=True, **look_of(colours))
    add_key(axes, numbers, names, colours)


def look_of(colours: tuple[Any, ...]) -> dict[str, Any]:
    """How numbers of classes become their colours."""
    return {
        "cmap": ListedColormap(list(colours)),
        "norm": BoundaryNorm(np.arange(len(colours) + 1) - 0.5, len(colours)),
    }


def add_key(
    axes: Axes, numbers: IntArray, names: tuple[str, ...] = OUTCOMES, colours: tuple[Any, ...] = COLOURS
) -> None:
    """A key of the classes that there are, with the share of each, below the axes."""
    counts = np.bincount(numbers.ravel(), minlength=len(names))
    patches = [
        Patch(
            facecolor=colours[k],
            edgecolor="#606060",
            lw=0.5,
            label=f"{names[k]}, {counts[k] * 100 / numbers.size:.3g} %",
        )
        for k in np.flatnonzero(counts)
    ]
    wide = axes.figure.bbox.width > NARROW * axes.figure.dpi
    legend_below(axes, handles=patches, ncols=2 if len(patches) > 1 and wide else 1)


def draw_outline(axes: Axes, across: Scale, up: Scale, holds: BoolArray | None) -> None:
    """Draw a line between the fields (n, m) of a map where a condition holds and the others; None: there is none."""
    if holds is not None:
        axes.add_collection(LineCollection(outline(across, up, holds), **OUTLINE), autolim=False)


def outline(across: Scale, up: Scale, holds: BoolArray) -> list[list[tuple[float, float]]]:
    """The straight pieces between the fields (n, m) of a map where a condition holds and the others."""
    x, y = edges(across).tolist(), edges(up).tolist()
    lines = [[(x[i + 1], y[j]), (x[i + 1], y[j + 1])] for i, j in np.argwhere(holds[1:] != holds[:-1])]
    return lines + [[(x[i], y[j + 1]), (x[i + 1], y[j + 1])] for i, j in np.argwhere(holds[:, 1:] != holds[:, :-1])]


def frame(axes: Axes, across: Scale, up: Scale | None = None) -> None:
    """Label the axes and set their scales: name a few of the texts, write very large or small numbers with a power."""
    plain_ticks(axes)
    for letter, axis, scale in (("x", axes.xaxis, across), ("y", axes.yaxis, up)):
        if scale is None:
            continue
        axis.set_label_text(scale.label, parse_math=False)
        if scale.logarithmic:
            axes.set(**{f"{letter}scale": "log"})
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
        borders = values[0] + np.array([-0.5, 0.5]) * (abs(values[0]) or 1.0)
    else:
        middles = (values[1:] + values[:-1]) / 2
        borders = np.concatenate([[2 * values[0] - middles[0]], middles, [2 * values[-1] - middles[-1]]])
    return np.exp(borders) if scale.logarithmic else borders
