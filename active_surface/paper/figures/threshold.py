"""Figure 18, and beyond it: below which frequency parts converge and above which they leave, over the stroke."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from active_surface.arrays import BoolArray, FloatArray
from active_surface.paper.figure_result import LOOK, MICRO, FigureResult, finish, look, percent
from active_surface.paper.models import CLOSED, MODELS, PAPER, PLATE, Bench
from active_surface.paper.parameters import Effort
from active_surface.paper.share import NEARLY_ALL
from active_surface.paper.split import Ends, Fits, Split, Thresholds, best_split, first_loss, fits_of
from active_surface.paper.verdict import Answer, Verdict, of_checks

LOWEST, HIGHEST = 160.0, 760.0  # Hz
STATED, STATED_STROKE, WITHIN = 320.0, 150e-6, 20.0  # Hz, m, Hz: what counts as the same
FIT_WITHIN: Final = 10.0  # Hz, by which a curve may be off
NANOMETRES: Final = 9  # digits of strokes in m
FEWER_STARTS: Final = 3  # times fewer starts than elsewhere, as each is followed at every frequency
PERCENTILES: Final = (10, 90)
GREY, SHIFT = "#707070", 1.2  # um, by which the models' marks stand apart


def find(bench: Bench, effort: Effort) -> FigureResult:
    """Ends of every start at every frequency and stroke, and the thresholds that follow."""
    p = bench.parameters
    frequencies = np.arange(LOWEST, HIGHEST + 1, effort.step)
    strokes = np.linspace(p.strokes[0], p.strokes[-1], effort.strokes)
    strokes = np.unique(np.round(np.append(strokes, STATED_STROKE), NANOMETRES))
    row = int(np.argmin(np.abs(strokes - STATED_STROKE)))
    results = {}
    for model in MODELS:
        count = max(bench.starts_of(model, effort) // FEWER_STARTS, 1)
        results[model] = thresholds(strokes, frequencies, ends_of(bench, model, strokes, frequencies, count))

    def draw(figure: Figure) -> None:
        left, right = figure.subplots(1, 2, width_ratios=(1.1, 1))
        draw_thresholds(left, strokes, frequencies, results)
        draw_ends(right, frequencies, {model: [ends[row] for ends in one.ends] for model, one in results.items()})
        left.plot(MICRO * STATED_STROKE, STATED, "*", color="#b8862d", markersize=13, label="the paper's 320 Hz")
        finish(left, "stroke [µm]", "threshold frequency [Hz]", "figure 18")
        right.axvline(STATED, color="#b8862d", linewidth=0.9)
        finish(right, "frequency [Hz]", "share of the starts [%]", f"stroke {MICRO * STATED_STROKE:g} µm")

    data: dict[str, Any] = {"strokes": strokes.tolist(), "frequencies": frequencies.tolist()}
    for model, one in results.items():
        data[f"converge_{model}"], data[f"lost_{model}"] = (ends.mean(axis=2).tolist() for ends in one.ends)
    verdicts = _verdicts(strokes, frequencies, results, row)
    return FigureResult("fig18", "Threshold of convergence", verdicts, data, draw, (13.0, 5.2),
                 "Left: the frequency that tells best between converging below and being lost above, with 10 and 90 % "
                 "of what single starts give; dots: our equations on the closed form, frequencies above it at which "
                 "some starts converge all the same, circles: below it, and some are lost, the larger the more. "
                 "Right: what becomes of the starts.")  # fmt: skip


def ends_of(bench: Bench, model: str, strokes: FloatArray, frequencies: FloatArray, count: int) -> Ends:
    """Follows `count` starts at every frequency (F,) [Hz] and stroke (S,) [m]."""
    p = bench.parameters
    starts = bench.starts(p.start, count)
    ends = Ends(*np.zeros((2, len(strokes), len(frequencies), count), dtype=np.bool_))
    for i, stroke in enumerate(strokes.tolist()):
        for k, frequency in enumerate(frequencies.tolist()):
            drive = bench.drive(frequency, stroke)
            paths = bench.paths(model, [drive], starts, bench.duration(drive))
            ends.converges[i, k] = [path.converged(1 / drive.frequency, p.near) for path in paths]
            ends.lost[i, k] = [path.lost(p.far) for path in paths]
    return Ends(ends.converges & ~ends.lost, ends.lost)


def thresholds(strokes: FloatArray, frequencies: FloatArray, ends: Ends) -> Thresholds:
    """Thresholds at every stroke, their scatter over the starts, and curves through them."""
    split, scatter = [], []
    others: dict[str, list[float]] = {"losses alone": [], "convergence alone": [], "the median first loss": []}
    for converges, lost in zip(*ends, strict=True):
        split.append(best_split(frequencies, converges, lost))
        starts = converges.shape[1]
        alone = [best_split(frequencies, converges[:, [n]], lost[:, [n]]).frequency for n in range(starts)]
        known = np.array(alone)[np.isfinite(alone)]
        low, high = np.percentile(known, PERCENTILES) if len(known) else (np.nan, np.nan)
        scatter.append((float(low), float(high)))
        both = best_split(frequencies, ~lost, lost).frequency, best_split(frequencies, converges, ~converges).frequency
        for row, frequency in zip(others.values(), (*both, first_loss(frequencies, lost)), strict=True):
            row.append(frequency)
    levels = np.array([one.frequency for one in split])
    results = {name: np.array(row) for name, row in others.items()}
    return Thresholds(ends, split, scatter, fits_of(strokes, levels, STATED_STROKE), results)


def mixed(frequencies: FloatArray, converges: BoolArray, lost: BoolArray) -> tuple[float, float] | None:
    """From the lowest frequency [Hz] at which a start is lost to the highest at which one converges; None: no such."""
    first, last = (np.flatnonzero(ends.any(axis=1)) for ends in (lost, converges))
    if not (len(first) and len(last)) or last[-1] < first[0]:
        return None
    return float(frequencies[first[0]]), float(frequencies[last[-1]])


def exceptions(frequencies: FloatArray, ends: Ends, split: Split) -> tuple[list[float], list[float]]:
    """Frequencies [Hz] below a threshold at which most of the starts are lost, and above it at which most converge."""
    early = (frequencies < split.frequency) & (ends.lost.mean(axis=1) > 0.5)
    again = (frequencies > split.frequency) & (ends.converges.mean(axis=1) > 0.5)
    return frequencies[early].tolist(), frequencies[again].tolist()


def _verdicts(
    strokes: FloatArray, frequencies: FloatArray, results: dict[str, Thresholds], row: int
) -> tuple[Verdict, Verdict]:
    at_stated: dict[str, Answer] = {}
    curves: dict[str, Answer] = {}
    numbers: dict[str, Any] = {"strokes": strokes.tolist()}
    for model, one in results.items():
        ends = Ends(*(every[row] for every in one.ends))
        split, both = one.split[row], mixed(frequencies, *ends)
        early, again = exceptions(frequencies, ends, split)
        fits = {name: fits_of(strokes, levels, STATED_STROKE) for name, levels in one.others.items()}
        numbers |= {
            f"threshold_{model}": split._asdict(), f"scatter_{model}": list(one.scatter[row]), f"mixed_{model}": both,
            f"lost_below_{model}": early, f"converge_above_{model}": again, f"starts_{model}": ends.lost.shape[1],
            f"thresholds_{model}": [other.frequency for other in one.split],
            f"told_{model}": [other.predicted for other in one.split],
            f"others_{model}": {name: levels.tolist() for name, levels in one.others.items()},
            f"fits_{model}": {name: fit and fit._asdict() for name, fit in ({"": one.fits} | fits).items()},
        }  # fmt: skip
        by = {name: float(levels[row]) for name, levels in one.others.items()}
        at_stated[model] = _at_stated(split, one.scatter[row], ends.lost.shape[1], both, (early, again), by)
        curves[model] = _curve(one.fits, fits)
    step = frequencies[1] - frequencies[0]
    return (
        Verdict(
            "18", "At 150 um parts converge below 320 Hz, and leave above.", at_stated,
            f"The threshold is the frequency that tells best: the share of (frequency, start) pairs from {LOWEST:g} to "
            f"{HIGHEST:g} Hz, {step:g} Hz apart, that converge below it or are lost above. Lost: gone as in figure "
            "17b, or off the surface. Some are neither: they do not move, or go to and fro. By losses alone: "
            "lost or not; by convergence alone: converged or not; the median first loss: the lowest frequency at which "
            "a start is lost, whatever it does above. Met: within "
            f"{WITHIN:g} Hz, {percent(NEARLY_ALL)} converge below, {percent(NEARLY_ALL)} are lost above.", numbers,
        ),
        Verdict(
            "18 (curve)", "The threshold is a quadratic function of the stroke from 100 to 200 um.", curves,
            f"Met: a quadratic is off by no more than {FIT_WITHIN:g} Hz, and by less than a power law. The misfit is "
            "the root of the summed squares over the numbers left free; thresholds lie half-way between frequencies "
            f"{step:g} Hz apart.", numbers,
        ),
    )  # fmt: skip


def _at_stated(
    split: Split,
    scatter: tuple[float, float],
    starts: int,
    both: tuple[float, float] | None,
    wrong: tuple[list[float], list[float]],
    others: dict[str, float],
) -> Answer:
    if not np.isfinite(split.frequency):
        return Answer(f"none of {starts} starts converges or is lost at any frequency", 0.0)
    text = (
        f"{split.frequency:.0f} Hz ({scatter[0]:.0f} to {scatter[1]:.0f} by single ones of {starts} starts): it tells "
        f"{percent(split.predicted)}; below {percent(split.below)} converge, above {percent(split.above)} are lost"
    )
    text += f"; both happen from {both[0]:.0f} to {both[1]:.0f} Hz" if both else "; nowhere do both happen"
    for frequencies, what in zip(wrong, ("are lost already", "converge again"), strict=True):
        text += f"; most {what} at {', '.join(f'{f:.0f}' for f in frequencies)} Hz" if frequencies else ""
    text += "; by " + ", by ".join(f"{name} {frequency:.0f} Hz" for name, frequency in others.items())
    return of_checks(
        text, [abs(split.frequency - STATED) <= WITHIN, split.below >= NEARLY_ALL, split.above >= NEARLY_ALL]
    )


def _curve(fits: Fits | None, others: dict[str, Fits | None]) -> Answer:
    if fits is None:
        return Answer("too few thresholds for a curve", 0.0)
    text = "; ".join([str(fits), *(f"by {name} {fit}" for name, fit in others.items() if fit)])
    return of_checks(text, [fits.quadratic_misfit <= FIT_WITHIN, fits.quadratic_misfit < fits.law_misfit])


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
