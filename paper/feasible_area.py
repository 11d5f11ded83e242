"""Figures 5 and 6: the feasible area over frequency, its peak and its time integral."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from paper.found import Found, finish
from paper.models import CLOSED, MODELS, PAPER, PLATE, Bench
from paper.parameters import Effort
from paper.verdict import Answer, Verdict, of_checks
from particle import Micropart
from studies.feasible import Feasible, find_feasible

NAMES = ("fig5", "fig6")
LOWEST, HIGHEST = 100.0, 2500.0  # Hz
THRESHOLD: Final = 150.0, 250.0  # Hz, "about 200"
LARGEST: Final = 300.0, 400.0  # Hz, where the integral is to be largest
GREYS = ("#1b4f9c", "#c8371b", "#3d8a4e", "#8a6d3b")


def find(bench: Bench, effort: Effort) -> Found:
    """Both figures: at rest the paper's conditions and ours are the same, so two surfaces are all there is to "
    "compare."""
    p = bench.parameters
    found: dict[str, dict[float, Feasible]] = {}
    for model in (CLOSED, PLATE):
        ground = bench.ground(model)
        found[model] = {}
        for stroke in p.strokes:
            drive = bench.drive(LOWEST, stroke)
            factors = np.geomspace(1.0, HIGHEST / LOWEST, effort.frequencies)
            part = Micropart(p.mass, (0.0, 0.0))
            window = 1 / drive.frequency
            surface = ground.surface.driven_by([drive])
            found[model][stroke] = find_feasible(
                surface, ground.outline, part, p.friction, window, factors, p.gravity, effort.across
            )
    data: dict[str, Any] = {"strokes": list(p.strokes)}
    for model, rows in found.items():
        data[model] = [
            {
                "stroke": stroke,
                "frequency": (LOWEST * row.factors).tolist(),
                "peak_area": row.feasible.peak.tolist(),
                "time_integral": row.feasible.integral.tolist(),
                "peak_area_slipping": row.slipping.peak.tolist(),
                "time_integral_slipping": row.slipping.integral.tolist(),
            }
            for stroke, row in rows.items()
        ]

    def draw(figure: Figure) -> None:
        axes = figure.subplots(1, 2)
        for (stroke, row), colour in zip(found[CLOSED].items(), GREYS, strict=False):
            said = f"{1e6 * stroke:g} µm"
            frequency = LOWEST * row.factors
            axes[0].plot(frequency, 1e12 * row.feasible.peak, color=colour, label=said)
            axes[1].plot(frequency, 1e15 * row.feasible.integral, color=colour, label=said)
            axes[0].plot(frequency, 1e12 * row.slipping.peak, "--", color=colour, linewidth=0.8)
            axes[1].plot(frequency, 1e15 * row.slipping.integral, "--", color=colour, linewidth=0.8)
        for (_, row), colour in zip(found[PLATE].items(), GREYS, strict=False):
            marks: dict[str, Any] = {"linestyle": "", "marker": "x", "markersize": 4, "color": colour}
            axes[0].plot(LOWEST * row.factors, 1e12 * row.feasible.peak, **marks)
            axes[1].plot(LOWEST * row.factors, 1e15 * row.feasible.integral, **marks)
        axes[0].plot([], [], "k--", linewidth=0.8, label="counting places where it comes off later")
        axes[0].plot([], [], "kx", markersize=4, label="finite elements")
        finish(axes[0], "frequency [Hz]", "largest feasible area [µm²]", "figure 5")
        finish(axes[1], "frequency [Hz]", "time integral [µm² ms]", "figure 6", legend=False)
        axes[0].set_ylim(0, 1.35 * axes[0].get_ylim()[1])

    return Found("fig5-6", "Feasible area", _verdicts(found), data, draw, (11.5, 4.6),
                 "Largest feasible area over a cycle, and its time integral. Places where the part comes off at some "
                 "moment of the cycle do not count; dashed: they do, at moments when it is attached.")  # fmt: skip


def _verdicts(found: dict[str, dict[float, Feasible]]) -> tuple[Verdict, Verdict]:
    five: dict[str, Answer] = {}
    six: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for model, rows in found.items():
        first = [_first(row) for row in rows.values()]
        top = [float(LOWEST * row.factors[row.feasible.peak.argmax()]) for row in rows.values()]
        most = [float(LOWEST * row.factors[row.feasible.integral.argmax()]) for row in rows.values()]
        numbers |= {f"threshold_{model}": first, f"peak_{model}": top, f"integral_{model}": most}
        falls = [top_k < HIGHEST for top_k in top]
        checks = [*(THRESHOLD[0] <= f <= THRESHOLD[1] for f in first), *falls]
        five[model] = of_checks(f"from {_list(first)} Hz; largest at {_list(top)} Hz, then falls", checks)
        six[model] = of_checks(f"largest at {_list(most)} Hz", [LARGEST[0] <= f <= LARGEST[1] for f in most])
    for answers in (five, six):
        answers[PAPER] = answers[CLOSED]
    strokes = _list([1e6 * stroke for stroke in found[CLOSED]])
    return (
        Verdict(
            "5", "Below about 200 Hz nothing moves, for three strokes alike; the area grows with frequency, "
            "peaks, and falls because the part comes off.", _ordered(five),
            f"Strokes are not stated; here {strokes} um. Slip begins where slope times acceleration is enough; one "
            "goes with the stroke, the other with that times frequency squared: one threshold for all strokes cannot "
            "be. The area falls only if places where the part comes off at another moment of the cycle do not count.",
            numbers,
        ),
        Verdict(
            "6", "The time integral is largest at 300 to 400 Hz, for all strokes.", _ordered(six),
            "Its place moves with the stroke, as the threshold does.", numbers,
        ),
    )  # fmt: skip


def _ordered(answers: dict[str, Answer]) -> dict[str, Answer]:
    return {model: answers[model] for model in MODELS}


def _first(row: Feasible) -> float:
    """The lowest frequency [Hz] at which the part slips anywhere, nan if none, between those looked at."""
    moves = np.flatnonzero(row.slipping.peak > 0)
    return float(LOWEST * row.factors[moves[0]]) if len(moves) else float("nan")


def _list(values: list[float]) -> str:
    return ", ".join(f"{value:.0f}" for value in values)
