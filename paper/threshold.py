"""Figure 18, and beyond it: the frequency from which on parts leave, over the stroke, with its scatter."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from paper.found import MICRO, Found, finish, look
from paper.models import MODELS, PAPER, Bench, FloatArray
from paper.parameters import Effort
from paper.verdict import Answer, Verdict, of_checks

NAMES = ("fig18",)
LOWEST, HIGHEST = 160.0, 760.0  # Hz
STATED, STATED_STROKE, WITHIN = 320.0, 150e-6, 20.0  # Hz, m, Hz: what counts as the same
NANOMETRES: Final = 9  # digits of strokes in m
FEWER_STARTS: Final = 3  # times fewer starts than elsewhere, as each is followed at every frequency
PERCENTILES: Final = (10, 50, 90)


def find(bench: Bench, effort: Effort) -> Found:
    """Thresholds of every start, at every stroke, in every model."""
    p = bench.parameters
    frequencies = np.arange(LOWEST, HIGHEST + 1, effort.step)
    strokes = np.linspace(p.strokes[0], p.strokes[-1], effort.strokes)
    strokes = np.unique(np.round(np.append(strokes, STATED_STROKE), NANOMETRES))
    thresholds = {model: _thresholds(bench, model, effort, strokes, frequencies) for model in MODELS}
    fits = {model: fits_of(strokes, np.median(rows, axis=1)) for model, rows in thresholds.items()}

    def draw(figure: Figure) -> None:
        axes = figure.add_subplot()
        for model, rows in thresholds.items():
            low, middle, high = np.percentile(rows, PERCENTILES, axis=1)
            style = look(model)
            axes.fill_between(MICRO * strokes, low, high, color=style["color"], alpha=0.13, linewidth=0)
            axes.plot(MICRO * strokes, middle, **style, marker="o", markersize=4)
        fine = np.linspace(strokes[0], strokes[-1], 100)
        exponent, level = fits[PAPER]["power_law"][:2]
        axes.plot(MICRO * fine, level * (fine / STATED_STROKE) ** exponent, color="#c8371b", linewidth=0.6)
        axes.plot(MICRO * STATED_STROKE, STATED, "*", color="#b8862d", markersize=13, label="the paper's 320 Hz")
        finish(axes, "stroke [µm]", "threshold frequency [Hz]", "figure 18: median, and 10 to 90 % of the starts")

    data: dict[str, Any] = {"strokes": strokes.tolist(), "frequencies": frequencies.tolist(), "fits": fits}
    data |= {f"thresholds_{model}": rows.tolist() for model, rows in thresholds.items()}
    verdict = _verdict(strokes, thresholds, fits, effort.step)
    return Found("fig18", "Threshold of convergence", (verdict,), data, draw, (8.0, 5.0),
                 "For each start the lowest frequency at which the part is lost; the thin line is the power law "
                 "through the paper's scheme.")  # fmt: skip


def _thresholds(bench: Bench, model: str, effort: Effort, strokes: FloatArray, frequencies: FloatArray) -> FloatArray:
    """The lowest frequency [Hz] at which the part is lost, (strokes, starts); one step beyond the last: none."""
    p = bench.parameters
    count = max(bench.starts_of(model, effort) // FEWER_STARTS, 1)
    starts = bench.starts(p.start, count)
    found = np.full((len(strokes), count), frequencies[-1] + effort.step)
    for i, stroke in enumerate(strokes.tolist()):
        for frequency in frequencies.tolist():
            open_ = np.flatnonzero(found[i] > frequencies[-1])
            if not len(open_):
                break
            drive = bench.drive(frequency, stroke)
            paths = bench.paths(model, [drive], starts[open_], p.cycles / frequency)
            lost = [path.lost(p.far) for path in paths]
            found[i, open_[lost]] = frequency
    return found


def fits_of(strokes: FloatArray, thresholds: FloatArray) -> dict[str, list[float]]:
    """A power law (exponent, Hz at 150 um, misfit) and a quadratic through the origin's axis (three "
    "coefficients, misfit).

    Misfits are the root of the mean squared distance, Hz.
    """
    x = strokes / STATED_STROKE
    exponent, level = np.polyfit(np.log(x), np.log(thresholds), 1)
    law = np.exp(level) * x**exponent
    quadratic = np.polyfit(x, thresholds, min(2, len(x) - 1))
    square = np.polyval(quadratic, x)
    return {
        "power_law": [float(exponent), float(np.exp(level)), _misfit(law, thresholds)],
        "quadratic": [*map(float, quadratic), _misfit(square, thresholds)],
    }


def _misfit(fitted: ArrayLike, values: FloatArray) -> float:
    return float(np.sqrt(((np.asarray(fitted) - values) ** 2).mean()))


def _verdict(strokes: FloatArray, thresholds: dict[str, FloatArray], fits: dict[str, Any], step: float) -> Verdict:
    row = int(np.argmin(np.abs(strokes - STATED_STROKE)))
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for model, rows in thresholds.items():
        low, middle, high = np.percentile(rows[row], PERCENTILES).tolist()
        falls = bool((np.diff(np.median(rows, axis=1)) <= 0).all())
        exponent, _, misfit = fits[model]["power_law"]
        quadratic = fits[model]["quadratic"][-1]
        numbers |= {f"threshold_{model}": [low, middle, high], f"fit_{model}": fits[model]}
        numbers[f"medians_{model}"] = np.median(rows, axis=1).tolist()
        text = (
            f"{middle:.0f} Hz ({low:.0f} to {high:.0f}) at 150 um; as stroke^{exponent:.2f}, off by {misfit:.0f} Hz, "
            f"quadratic by {quadratic:.0f} Hz"
        )
        answers[model] = of_checks(text, [abs(middle - STATED) <= WITHIN, falls, quadratic <= step])
    return Verdict(
        "18", "The threshold is 320 Hz at 150 um, and a quadratic function of the stroke from 100 to 200 um.", answers,
        "The lowest frequency at which a part leaves, as in figure 17b, or comes off. Median over starts, with 10 "
        f"and 90 %; frequencies are {step:g} Hz apart. A quadratic has one free number more than the power law. Near "
        "the threshold single starts converge at one frequency, not at the next, and again beyond it.",
        numbers,
    )  # fmt: skip
