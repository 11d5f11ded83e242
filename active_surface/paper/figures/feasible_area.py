"""Figures 5 and 6: the feasible area over frequency, its peak and its time integral.

At rest the paper's conditions and ours are the same, so that there are two surfaces to compare and no schemes.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from active_surface.arrays import FloatArray
from active_surface.paper.figure_result import COLOURS, MICRO, FigureResult, finish
from active_surface.paper.models import CLOSED, PAPER, PLATE, Bench
from active_surface.paper.parameters import Effort
from active_surface.paper.verdict import Answer, Verdict, of_checks
from active_surface.studies.feasibility import Feasible, find_feasible
from particle import Micropart

LOWEST_AREA, HIGHEST = 50.0, 2500.0  # Hz
THRESHOLD: Final = 150.0, 250.0  # Hz, "about 200"
LARGEST: Final = 300.0, 400.0  # Hz, where the integral is to be largest
RANGE, NEAR = (300.0, 1000.0), 1.25  # Hz, the paper's feasible range, and the ratio up to which ends are the same
FINER: Final = 40  # frequencies between two, in the search for the onset
STEADY: Final = 0.95  # of the largest value so far: a curve that grows falls back no farther, as places are a grid
SAME: Final = "as our equations: no scheme in it"


class Curve(NamedTuple):
    """The largest area at any moment over frequency."""

    top: float  # Hz, where it is largest
    grows: bool  # up to there
    falls: bool  # from there on
    half: tuple[float, float]  # Hz, between which it is at least half as large


def find(bench: Bench, effort: Effort) -> FigureResult:
    """Both figures, with both meanings of the feasible area."""
    p = bench.parameters
    factors = np.geomspace(1.0, HIGHEST / LOWEST_AREA, effort.frequencies)
    results: dict[str, dict[float, Feasible]] = {}
    onsets: dict[str, list[float]] = {}
    for model in (CLOSED, PLATE):
        results[model] = {stroke: areas(bench, model, stroke, factors, effort.across) for stroke in p.slipping}
        onsets[model] = [onset(bench, model, stroke, effort.across) for stroke in p.slipping]
    data: dict[str, Any] = {"strokes": list(p.slipping), "frequency": (LOWEST_AREA * factors).tolist()}
    for model, rows in results.items():
        data[model] = [
            {
                "stroke": stroke,
                "peak_area": row.feasible.peak.tolist(),
                "time_integral": row.feasible.integral.tolist(),
                "peak_area_slipping": row.slipping.peak.tolist(),
                "time_integral_slipping": row.slipping.integral.tolist(),
                "lost_area": row.lost_area.tolist(),
            }
            for stroke, row in rows.items()
        ]

    def draw(figure: Figure) -> None:
        peak, integral = figure.subplots(1, 2)
        _draw(peak, integral, results)
        peak.axvspan(*THRESHOLD, color="#b8862d", alpha=0.2, label="the paper: no motion below about 200 Hz")
        integral.axvspan(*LARGEST, color="#3d8a4e", alpha=0.2, label="the paper: largest at 300 to 400 Hz")
        for frequency in RANGE:
            integral.axvline(frequency, color="#8a8a8a", linewidth=0.8)
        finish(peak, "frequency [Hz]", "largest feasible area [µm²]", "figure 5")
        finish(integral, "frequency [Hz]", "time integral [µm² ms]", "figure 6; grey: the paper's range")
        peak.set_ylim(0, 1.35 * peak.get_ylim()[1])

    verdicts = (_five(results, onsets), _six(results), _range(results))
    return FigureResult("fig5-6", "Feasible area", verdicts, data, draw, (11.5, 4.6),
                 "Largest feasible area over a cycle, and its time integral. Places where the part comes off at some "
                 "moment of the cycle do not count; dashed: they do, at moments when it is attached.")  # fmt: skip


def areas(bench: Bench, model: str, stroke: float, factors: FloatArray, across: int) -> Feasible:
    """The feasible areas of one actuator with a stroke [m], at factors (F,) of LOWEST_AREA."""
    p, ground, drive = bench.parameters, bench.ground(model), bench.drive(LOWEST_AREA, stroke)
    part, window = Micropart(p.mass, (0.0, 0.0), centre_height=p.centre_height), 1 / drive.frequency
    surface = bench.surface(model, [drive], window)
    return find_feasible(surface, ground.outline, part, p.friction, window, factors, p.gravity, across)


def onset(bench: Bench, model: str, stroke: float, across: int) -> float:
    """The lowest frequency [Hz] at which a part at rest slips anywhere, to some 0.3 %; nan: there is none."""
    factors = np.geomspace(1.0, HIGHEST / LOWEST_AREA, FINER)
    for _ in range(2):
        moves = np.flatnonzero(areas(bench, model, stroke, factors, across).slipping.peak > 0)
        if not len(moves):
            return float("nan")
        before, first = float(factors[max(moves[0] - 1, 0)]), float(factors[moves[0]])
        factors = np.geomspace(before, first, FINER)
    return float(LOWEST_AREA * factors[-1])


def curve_of(frequencies: FloatArray, area: FloatArray) -> Curve:
    """What a curve over frequencies (F,) [Hz] does."""
    k = int(area.argmax())
    up, down = area[: k + 1], area[k:]
    wide = frequencies[np.flatnonzero(area >= area[k] / 2)[[0, -1]]]
    grows = bool((up >= STEADY * np.maximum.accumulate(up)).all())
    falls = k + 1 < len(area) and bool((down <= np.minimum.accumulate(down) / STEADY).all())
    return Curve(float(frequencies[k]), grows, falls, (float(wide[0]), float(wide[1])))


def begins(onsets: Sequence[float]) -> list[bool]:
    """Whether parts begin to move at about the paper's frequency, by onsets [Hz] of single strokes."""
    return [THRESHOLD[0] <= f <= THRESHOLD[1] for f in onsets]


def hills(frequencies: FloatArray, areas: Sequence[FloatArray], lost: Sequence[FloatArray]) -> list[bool]:
    """Whether areas over frequencies (F,) [Hz] all grow, and all fall from their peak on as the part comes off."""
    curves = [curve_of(frequencies, area) for area in areas]
    off = [row[np.argmax(area) :].max() > 0 for row, area in zip(lost, areas, strict=True)]
    return [all(one.grows for one in curves), all(one.falls and own for one, own in zip(curves, off, strict=True))]


def peaks_of_integrals(rows: Sequence[Feasible]) -> list[float]:
    """Where [Hz] the time integrals are largest."""
    return [float(LOWEST_AREA * row.factors[row.feasible.integral.argmax()]) for row in rows]


def in_range(rows: Sequence[Feasible]) -> tuple[list[tuple[float, float]], list[bool]]:
    """Between which frequencies [Hz] integrals are at least half of their peak; whether that is the paper's range."""
    halves = [curve_of(LOWEST_AREA * row.factors, row.feasible.integral).half for row in rows]
    ends = list(zip(*halves, strict=True))
    checks = [all(1 / NEAR <= f / stated <= NEAR for f in end) for end, stated in zip(ends, RANGE, strict=True)]
    return halves, [*checks, all(max(end) / min(end) <= NEAR for end in ends)]


def _five(results: dict[str, dict[float, Feasible]], onsets: dict[str, list[float]]) -> Verdict:
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for model, rows in results.items():
        frequencies = LOWEST_AREA * next(iter(rows.values())).factors
        lost = [row.lost_area for row in rows.values()]
        meanings = {
            "never coming off": [row.feasible.peak for row in rows.values()],
            "attached at that moment": [row.slipping.peak for row in rows.values()],
        }
        checks = {meaning: hills(frequencies, every, lost) for meaning, every in meanings.items()}
        tops = {meaning: [curve_of(frequencies, area).top for area in every] for meaning, every in meanings.items()}
        numbers |= {f"onset_{model}": onsets[model], f"peaks_{model}": tops}
        never, attached = meanings
        more = f"{attached}: peaks at {_list(tops[attached])} Hz"
        more += "" if checks[attached][1] else f", and does not fall up to {HIGHEST:g} Hz"
        text = f"from {_list(onsets[model])} Hz, peaks at {_list(tops[never])} Hz"
        answers[model] = of_checks(text, [*begins(onsets[model]), *checks[never]], more)
    return Verdict(
        "5", "Below about 200 Hz nothing moves, for three strokes alike; the area grows with frequency, peaks, and "
        "falls because the part comes off.", _with_paper(answers),
        f"Strokes are not stated; here {_strokes(results)} um, for which {THRESHOLD[0]:g} to {THRESHOLD[1]:g} Hz count "
        "as about 200. Slope times acceleration must be enough to slip; one goes with the stroke, the other with that "
        "times frequency squared. So one threshold for all strokes cannot be, and larger strokes begin lower. The area "
        "leaves out the places where the part comes off at some moment of the cycle. Taken at each moment by itself "
        f"(dashed) it hardly falls. Growing and falling: but for {100 * (1 - STEADY):.0f} %.", numbers,
    )  # fmt: skip


def _six(results: dict[str, dict[float, Feasible]]) -> Verdict:
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for model, rows in results.items():
        largest = numbers[model] = peaks_of_integrals(list(rows.values()))
        answers[model] = of_checks(f"at {_list(largest)} Hz", [LARGEST[0] <= f <= LARGEST[1] for f in largest])
    return Verdict(
        "6", "The time integral is largest at 300 to 400 Hz, for all strokes.", _with_paper(answers),
        "Its place moves with the stroke, as the threshold does: strokes that meet this are about twice as large as "
        "those that meet figure 5.", numbers,
    )  # fmt: skip


def _range(results: dict[str, dict[float, Feasible]]) -> Verdict:
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for model, rows in results.items():
        halves, checks = in_range(list(rows.values()))
        numbers[model] = halves
        answers[model] = of_checks(", ".join(f"{low:.0f} to {high:.0f}" for low, high in halves) + " Hz", checks)
    return Verdict(
        "5, 6 (range)", "Frequencies from 300 to 1000 Hz are feasible, almost whatever the stroke.",
        _with_paper(answers),
        "How the range follows from the two figures is not said; here the frequencies at which the time integral is at "
        f"least half of its peak, by stroke. Ends within a factor of {NEAR:g} count as the same: the lower one, the "
        "upper one, and each over all strokes.", numbers,
    )  # fmt: skip


def _strokes(results: dict[str, dict[float, Feasible]]) -> str:
    return _list([MICRO * stroke for stroke in results[CLOSED]])


def _with_paper(answers: dict[str, Answer]) -> dict[str, Answer]:
    return {PAPER: Answer(SAME, answers[CLOSED].met)} | answers


def _list(values: list[float]) -> str:
    return ", ".join(f"{value:.0f}" for value in values)


def _draw(peak: Axes, integral: Axes, results: dict[str, dict[float, Feasible]]) -> None:
    for (stroke, row), colour in zip(results[CLOSED].items(), COLOURS, strict=False):
        frequency, text = LOWEST_AREA * row.factors, f"{MICRO * stroke:g} µm"
        peak.plot(frequency, 1e12 * row.feasible.peak, color=colour, label=text)
        integral.plot(frequency, 1e15 * row.feasible.integral, color=colour, label=text)
        peak.plot(frequency, 1e12 * row.slipping.peak, "--", color=colour, linewidth=0.8)
        integral.plot(frequency, 1e15 * row.slipping.integral, "--", color=colour, linewidth=0.8)
    for row, colour in zip(results[PLATE].values(), COLOURS, strict=False):
        marks: dict[str, Any] = {"linestyle": "", "marker": "x", "markersize": 4, "color": colour}
        peak.plot(LOWEST_AREA * row.factors, 1e12 * row.feasible.peak, **marks)
        integral.plot(LOWEST_AREA * row.factors, 1e15 * row.feasible.integral, **marks)
    peak.plot([], [], "k--", linewidth=0.8, label="counting places where it comes off later")
    peak.plot([], [], "kx", markersize=4, label="finite elements")
