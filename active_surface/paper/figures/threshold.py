"""Figure 18: below which frequency parts converge and above which they leave, over the stroke.

One actuator's surface is round, so that of a place at rest only its distance from the actuator counts.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from active_surface.arrays import FloatArray
from active_surface.paper.figure_result import MICRO, FigureResult, finish, look
from active_surface.paper.loss import TOLERATED, Ends, Fits, first_loss, fits_of
from active_surface.paper.models import CLOSED, MODELS, PAPER, Bench
from active_surface.paper.parameters import Effort
from active_surface.paper.share import Share
from active_surface.paper.verdict import Answer, Verdict, of_checks

LOWEST, HIGHEST = 160.0, 760.0  # Hz
SHOWN: Final = 520.0  # Hz, up to which starts are followed at the stated stroke
STATED_THRESHOLD, STATED_STROKE, THRESHOLD_WITHIN = 320.0, 150e-6, 20.0  # Hz, m, Hz: what counts as the same
FROM: Final = 0.7  # of the stated threshold, scaled by the stroke, where its search begins
NEAREST, FARTHEST = 40e-6, 160e-6  # m from the actuator: the starts
MOVED: Final = 1e-6  # m: a part that friction holds where it was placed shows nothing
NANOMETRES: Final = 9  # digits of strokes in m
FEWER_STARTS: Final = 4  # times fewer starts than elsewhere, as each is followed at every frequency
GOLD: Final = "#b8862d"
MARKS: Final = {"converges": ("o", "#3d8a4e"), "is lost": ("x", "#c8371b"), "goes to and fro": (".", "#707070")}


def find(bench: Bench, effort: Effort) -> FigureResult:
    """Ends of every start at the stated stroke, and the thresholds at every stroke."""
    p = bench.parameters
    strokes = np.linspace(p.strokes[0], p.strokes[-1], effort.strokes)
    strokes = np.unique(np.round(np.append(strokes, STATED_STROKE), NANOMETRES))
    frequencies = np.arange(LOWEST, SHOWN + 1, effort.step)
    ends, levels = {}, {}
    for model in MODELS:
        count = max(bench.starts_of(model, effort) // FEWER_STARTS, 1)
        ends[model] = ends_of(bench, model, STATED_STROKE, frequencies, count)
        levels[model] = np.array([loss_from(bench, model, stroke, effort.step, count) for stroke in strokes.tolist()])
    fits = {model: fits_of(strokes, row, STATED_STROKE) for model, row in levels.items()}

    def draw(figure: Figure) -> None:
        left, *maps = figure.subplots(1, 3, width_ratios=(1.2, 1, 1))
        draw_thresholds(left, strokes, levels, fits, effort.step)
        for axes, model in zip(maps, (PAPER, CLOSED), strict=True):
            _draw_map(axes, frequencies, ends[model])
            across = "start's distance from the actuator [µm]"
            finish(axes, across, "frequency [Hz]", f"{MICRO * STATED_STROKE:g} µm: {MODELS[model]}", legend=False)
        handles, names = maps[0].get_legend_handles_labels()
        figure.legend(handles, names, loc="outside lower right", ncols=len(names), frameon=False, fontsize=9)

    data: dict[str, Any] = {"strokes": strokes.tolist(), "frequencies": frequencies.tolist()}
    data |= {f"thresholds_{model}": row.tolist() for model, row in levels.items()}
    data |= {f"{what}_{m}": rows.tolist() for m, one in ends.items() for what, rows in one._asdict().items()}
    verdicts = (*_at_stated(frequencies, ends), _curve(strokes, levels, fits, effort.step))
    return FigureResult("fig18", "Threshold of convergence", verdicts, data, draw, (15.0, 5.2),
                 "Left: the threshold, with the step between frequencies, and the quadratic through it. "
                 "Right: what becomes "
                 "of parts placed at rest; golden: the paper's 320 Hz.")  # fmt: skip


def ends_of(bench: Bench, model: str, stroke: float, frequencies: Sequence[float] | FloatArray, count: int) -> Ends:
    """What becomes of `count` parts at rest at even distances, at every frequency (F,) [Hz] of a stroke [m]."""
    p = bench.parameters
    starts = np.column_stack([np.linspace(NEAREST, FARTHEST, count), np.zeros(count)])
    ends = Ends(*np.zeros((3, len(frequencies), count), dtype=np.bool_))
    for k, frequency in enumerate(frequencies):
        drive = bench.drive(float(frequency), stroke)
        paths = bench.paths(model, [drive], starts, bench.duration(drive))
        ends.lost[k] = [path.lost(p.far) for path in paths]
        ends.converges[k] = [path.converged(1 / drive.frequency, p.near) and not path.lost(p.far) for path in paths]
        ends.moves[k] = [path.trajectory.path_length > MOVED for path in paths]
    return ends


def loss_from(bench: Bench, model: str, stroke: float, step: float, count: int) -> float:
    """The threshold [Hz] at a stroke [m], looked for upwards from well below the stated one; nan: none to HIGHEST."""
    lowest = FROM * STATED_THRESHOLD * STATED_STROKE / stroke
    for frequency in np.arange(step * np.ceil(lowest / step), HIGHEST + 1, step).tolist():
        level = first_loss(np.array([frequency, frequency + step]), ends_of(bench, model, stroke, [frequency], count))
        if np.isfinite(level):
            return level
    return float("nan")


def shares_around(frequencies: FloatArray, ends: Ends, level: float) -> tuple[Share, Share]:
    """Of parts that move: the share that converges below a threshold [Hz], and the share that is lost above it."""
    below = frequencies < level
    return tuple(  # type: ignore[return-value]
        Share(int((rows & ends.moves)[side].sum()), max(int(ends.moves[side].sum()), 1))
        for rows, side in ((ends.converges, below), (ends.lost, ~below))
    )


def _at_stated(frequencies: FloatArray, every: dict[str, Ends]) -> tuple[Verdict, Verdict]:
    step = float(frequencies[1] - frequencies[0])
    converge: dict[str, Answer] = {}
    leave: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for model, ends in every.items():
        level = first_loss(frequencies, ends)
        below, above = shares_around(frequencies, ends, level)
        count = ends.lost.shape[1]
        numbers[model] = {"threshold": level, "below": below.value, "above": above.value, "starts": count}
        more = f"{below.of} parts, {count} at each frequency"
        close = abs(level - STATED_THRESHOLD) <= THRESHOLD_WITHIN
        converge[model] = of_checks(f"{level:.0f} Hz, below {below} converge", [close, below.met == 1], more)
        leave[model] = Answer(f"{above}", above.met, f"{above.of} parts, up to {SHOWN:g} Hz")
    starts = f"at rest {MICRO * NEAREST:g} to {MICRO * FARTHEST:g} um from the actuator"
    return (
        Verdict(
            "18", "At 150 um the threshold is 320 Hz: below it parts converge to the actuator.", converge,
            "The threshold is the lowest frequency, less half a step, at which more than "
            f"{100 * TOLERATED:.0f} % of parts "
            f"{starts} are lost: gone as in figure 17b, or off the surface. Met: within {THRESHOLD_WITHIN:g} "
            "Hz; frequencies are "
            f"{step:g} Hz apart. Parts that friction holds where they were placed do not count.", numbers,
        ),
        Verdict(
            "18 (above)", "Above the threshold parts leave the actuator's region.", leave,
            "Of the same parts at all frequencies above the threshold. Those that do not leave converge all "
            "the same, or "
            "go to and fro: no frequency parts the two.", numbers,
        ),
    )  # fmt: skip


def _curve(strokes: FloatArray, levels: dict[str, FloatArray], fits: dict[str, Fits | None], step: float) -> Verdict:
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {"strokes": strokes.tolist()}
    for model, fit in fits.items():
        numbers[model] = {"thresholds": levels[model].tolist(), "fits": fit and fit._asdict()}
        answers[model] = curve_answer(fit, step, levels[model])
    return Verdict(
        "18 (curve)", "The threshold is a quadratic function of the stroke from 100 to 200 um.", answers,
        f"Met: a quadratic is off by no more than {step / 2:g} Hz, half the step between frequencies. Its "
        "misfit is the "
        "root of the summed squares over the numbers left free, as is that of a power law, which is no worse "
        "where it is "
        "as small.", numbers,
    )  # fmt: skip


def curve_answer(fit: Fits | None, step: float, levels: FloatArray) -> Answer:
    """Whether a quadratic is as near as thresholds are known."""
    if fit is None:
        return Answer("too few thresholds", 0.0)
    more = f"thresholds {', '.join(f'{level:.0f}' for level in levels)} Hz; power law stroke^{fit.exponent:.2f} off by "
    more += f"{fit.law_misfit:.0f} Hz"
    return of_checks(f"off by {fit.quadratic_misfit:.0f} Hz", [fit.quadratic_misfit <= step / 2], more)


def draw_thresholds(
    axes: Axes, strokes: FloatArray, levels: dict[str, FloatArray], fits: dict[str, Fits | None], step: float
) -> None:
    """Thresholds (S,) [Hz] of each model over strokes (S,) [m], with quadratics."""
    fine = np.linspace(strokes[0], strokes[-1], 100)
    for k, (model, row) in enumerate(levels.items()):
        style, fit = look(model), fits[model]
        across = MICRO * strokes + 0.8 * (k - 1)
        bars = {"fmt": "osx"[k], "color": style["color"], "markersize": 4, "capsize": 2, "linewidth": 0.8}
        axes.errorbar(across, row, step / 2, **bars)
        if fit:
            style["label"] += f"; quadratic off by {fit.quadratic_misfit:.0f} Hz"
            axes.plot(MICRO * fine, np.polyval(fit.coefficients, fine / fit.unit), **style)
    axes.plot(
        MICRO * STATED_STROKE, STATED_THRESHOLD, "*", color=GOLD, markersize=14, label="the paper's 320 Hz", zorder=5
    )
    finish(axes, "stroke [µm]", "threshold frequency [Hz]", "figure 18")


def _draw_map(axes: Axes, frequencies: FloatArray, ends: Ends) -> None:
    away = np.broadcast_to(MICRO * np.linspace(NEAREST, FARTHEST, ends.lost.shape[1]), ends.lost.shape)
    up = np.broadcast_to(frequencies[:, None], ends.lost.shape)
    else_moves = ends.moves & ~ends.lost & ~ends.converges
    for (text, (mark, colour)), rows in zip(
        MARKS.items(), (ends.converges & ends.moves, ends.lost, else_moves), strict=True
    ):
        axes.plot(away[rows], up[rows], mark, color=colour, markersize=5, label=text)
    axes.axhline(STATED_THRESHOLD, color=GOLD, linewidth=1.2)
