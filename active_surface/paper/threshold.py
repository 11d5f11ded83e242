"""Figure 18: below which frequency parts converge to an actuator and above which they leave, over the stroke."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from active_surface.arrays import BoolArray, FloatArray
from active_surface.paper.bench import CLOSED, MODELS, PAPER, Bench
from active_surface.paper.picture import GOLD, GREEN, MICRO, RED, Curve, Found, Panel, dots, look
from active_surface.paper.statements import THRESHOLD, THRESHOLD_STROKE
from active_surface.paper.verdict import HARDLY_ANY, Share

LOWEST, HIGHEST = 160.0, 760.0  # Hz, of the thresholds
SHOWN: Final = 520.0  # Hz, up to which starts are followed at the stated stroke
FROM: Final = 0.7  # of the stated threshold, scaled by the stroke, where its search begins
NEAREST, FARTHEST = 40e-6, 160e-6  # m from the actuator: the starts
MOVED: Final = 1e-6  # m: a part that friction holds where it was placed shows nothing


class Ends(NamedTuple):
    """What becomes of parts at every frequency and start, (F, n) each. Some do neither: they go to and fro."""

    converges: BoolArray
    lost: BoolArray
    moves: BoolArray  # friction does not hold them where they were placed


def threshold(bench: Bench) -> Found:
    """Below which frequency parts converge and above which they leave, over the stroke.

    One actuator's surface is round, so that of a place at rest only its distance from the actuator counts.
    """
    p, step = bench.parameters, bench.effort.step
    strokes = np.linspace(p.strokes[0], p.strokes[-1], bench.effort.strokes)
    strokes = np.unique(np.round(np.append(strokes, THRESHOLD_STROKE), 9))
    frequencies, fine = np.arange(LOWEST, SHOWN + 1, step), np.linspace(strokes[0], strokes[-1], 100)
    numbers: dict[str, dict[str, Any]] = {"18": {}, "18 (above)": {}, "18 (curve)": {}}
    curves, maps = [], []
    for shift, model in enumerate(MODELS, start=-1):
        count = max(bench.count(model) // 4, 1)  # fewer than elsewhere, as each is followed at every frequency
        ends = ends_at(bench, model, THRESHOLD_STROKE, frequencies, count)
        levels = np.array([loss_from(bench, model, stroke, step, count) for stroke in strokes.tolist()])
        level = first_loss(frequencies, ends)
        quadratic, misfit = quadratic_of(strokes / THRESHOLD_STROKE, levels)
        below, above = shares_around(frequencies, ends, level)
        numbers["18"][model] = {"threshold": level, "below": below, "starts": count}
        numbers["18 (above)"][model] = {"above": above}
        numbers["18 (curve)"][model] = {
            "step": step, "strokes": strokes.tolist(), "thresholds": levels.tolist(), "quadratic": quadratic,
            "misfit": misfit,
        }  # fmt: skip
        bars = dots("osx"[shift + 1], look(model)["color"], capsize=2, elinewidth=0.8)
        curves.append(Curve(MICRO * strokes + 0.8 * shift, levels, bars, step / 2))
        along = np.polyval(quadratic, fine / THRESHOLD_STROKE)
        curves.append(Curve(MICRO * fine, along, look(model, f"{{}}; quadratic off by {misfit:.0f} Hz")))
        if model in (PAPER, CLOSED):
            maps.append(_map(frequencies, ends, f"{MICRO * THRESHOLD_STROKE:g} µm: {MODELS[model]}"))
    star = dots("*", GOLD, "the paper's 320 Hz", 14, zorder=5)
    curves.append(Curve([MICRO * THRESHOLD_STROKE], [THRESHOLD], star))
    return numbers, [[Panel("stroke [µm]", "threshold frequency [Hz]", curves, "figure 18"), *maps]]


def _map(frequencies: FloatArray, ends: Ends, title: str) -> Panel:
    away = np.broadcast_to(MICRO * np.linspace(NEAREST, FARTHEST, ends.lost.shape[1]), ends.lost.shape)
    up = np.broadcast_to(frequencies[:, None], ends.lost.shape)
    curves = [
        Curve(away[rows], up[rows], dots(marker, colour, name, 5))
        for name, marker, colour, rows in (
            ("converges", "o", GREEN, ends.converges & ends.moves),
            ("is lost", "x", RED, ends.lost),
            ("goes to and fro", ".", "#707070", ends.moves & ~ends.lost & ~ends.converges),
        )
    ]
    across = "start's distance from the actuator [µm]"
    return Panel(across, "frequency [Hz]", curves, title, [("y", THRESHOLD, THRESHOLD, GOLD)], legend=False)


def ends_at(bench: Bench, model: str, stroke: float, frequencies: ArrayLike, count: int) -> Ends:
    """What becomes of `count` parts at rest at even distances, at every frequency (F,) [Hz] of a stroke [m]."""
    p, rows = bench.parameters, []
    starts = np.column_stack([np.linspace(NEAREST, FARTHEST, count), np.zeros(count)])
    for frequency in np.asarray(frequencies).tolist():
        paths = bench.paths(model, [bench.drive(frequency, stroke)], starts)
        lost = np.array([path.lost(p.far) for path in paths])
        near = np.array([path.converged(1 / frequency, p.near) for path in paths])
        rows.append((near & ~lost, lost, [path.trajectory.path_length > MOVED for path in paths]))
    return Ends(*np.array(rows).transpose(1, 0, 2))


def first_loss(frequencies: FloatArray, ends: Ends) -> float:
    """The lowest of frequencies (F,) [Hz] at which more than HARDLY_ANY of the starts are lost, less half a step.

    nan: there is none.
    """
    lost = np.flatnonzero(ends.lost.mean(axis=1) > HARDLY_ANY)
    return float(frequencies[lost[0]] - (frequencies[1] - frequencies[0]) / 2) if len(lost) else float("nan")


def loss_from(bench: Bench, model: str, stroke: float, step: float, count: int) -> float:
    """The threshold [Hz] at a stroke [m], looked for upwards from well below the stated one; nan: none to HIGHEST."""
    lowest = FROM * THRESHOLD * THRESHOLD_STROKE / stroke
    for frequency in np.arange(step * np.ceil(lowest / step), HIGHEST + 1, step).tolist():
        level = first_loss(np.array([frequency, frequency + step]), ends_at(bench, model, stroke, [frequency], count))
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


def quadratic_of(strokes: FloatArray, frequencies: FloatArray) -> tuple[list[float], float]:
    """The quadratic [Hz], highest power first, through frequencies over strokes (n,), and its misfit [Hz].

    The misfit is the root of the summed squares over the numbers left free; nan: fewer than four frequencies known.
    """
    known = np.isfinite(frequencies)
    if known.sum() < 4:
        return [np.nan] * 3, np.nan
    x, f = strokes[known], frequencies[known]
    quadratic = np.polyfit(x, f, 2)
    off = np.polyval(quadratic, x) - f
    return quadratic.tolist(), float(np.sqrt((off**2).sum() / (len(f) - 3)))
