"""The picture of figure 18: thresholds over the stroke, and what becomes of parts over frequency."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from active_surface.arrays import BoolArray, FloatArray
from active_surface.paper.figure_result import LOOK, MICRO, look
from active_surface.paper.models import CLOSED, PAPER, PLATE
from active_surface.paper.split import Thresholds

GREY, SHIFT = "#707070", 1.2  # um, by which the models' marks stand apart


def draw_thresholds(axes: Axes, strokes: FloatArray, frequencies: FloatArray, results: dict[str, Thresholds]) -> None:
    """Thresholds over strokes (S,) [m] with their scatter, and where single starts do not heed them."""
    for k, (model, one) in enumerate(results.items()):
        across = MICRO * strokes + SHIFT * (k - 1)
        style = look(model)
        axes.plot(across, [split.frequency for split in one.split], **style, marker="o", markersize=4)
        axes.vlines(across, *np.array(one.scatter).T, color=style["color"], linewidth=0.9)
        if model == PAPER and one.fits:
            fine = np.linspace(strokes[0], strokes[-1], 100)
            law = one.fits.level * (fine / one.fits.unit) ** one.fits.exponent
            axes.plot(MICRO * fine, law, color=style["color"], linewidth=0.6, label="power law through it")
    one = results[CLOSED]
    for stroke, split, converges, lost in zip(strokes.tolist(), one.split, *one.ends, strict=True):
        for ends, wrong, hollow in (
            (converges, frequencies > split.frequency, False),
            (lost, frequencies < split.frequency, True),
        ):
            shares = ends.mean(axis=1)
            seen = wrong & (shares > 0)
            sizes = 4 + 60 * shares[seen]
            face = "none" if hollow else GREY
            axes.scatter(np.full(seen.sum(), MICRO * stroke), frequencies[seen], sizes, face, edgecolors=GREY)


def draw_ends(axes: Axes, frequencies: FloatArray, ends: dict[str, Sequence[BoolArray]]) -> None:
    """The shares of starts that converge and that are lost over frequencies (F,) [Hz], of each model."""
    for model, (converges, lost) in ends.items():
        for rows, mark, text in ((converges, "o", "converge"), (lost, "x", "are lost")):
            style: dict[str, Any] = LOOK[model] | {"marker": mark, "markersize": 4, "linewidth": 0.9}
            style |= {"marker": ""} if model == PLATE else {}
            axes.plot(frequencies, 100 * rows.mean(axis=1), **style, label=f"{model}: {text}")
