"""Figure 15: how far one cycle of one actuator carries the part, over frequency, for several strokes."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from paper.feasible_area import GREYS
from paper.found import MICRO, Found, finish
from paper.models import CLOSED, MODELS, PAPER, PLATE, Bench
from paper.parameters import Effort
from paper.verdict import Answer, Verdict, of_checks
from particle import Drive

NAMES = ("fig15",)
LOWEST, HIGHEST = 100.0, 1600.0  # Hz
MOVED: Final = 0.1e-6  # m
DURATION: Final = 20e-3  # s, after which every part has come to rest
STRAIGHT: Final = 0.9  # of the neighbouring frequencies between which the distance grows: "with the frequency"
STYLES: Final = {PAPER: "--", CLOSED: "-", PLATE: ":"}


def find(bench: Bench, effort: Effort) -> Found:
    """Distances in every model."""
    p = bench.parameters
    frequencies = np.geomspace(LOWEST, HIGHEST, effort.frequencies)
    strokes = np.linspace(p.strokes[0], p.strokes[-1], effort.strokes)
    distance = {model: np.full((len(strokes), len(frequencies)), np.nan) for model in MODELS}
    outcome = {model: np.full((len(strokes), len(frequencies)), "", dtype=object) for model in MODELS}
    for model in MODELS:
        for i, stroke in enumerate(strokes.tolist()):
            for k, frequency in enumerate(frequencies.tolist()):
                drive = Drive(stroke, frequency, cycles=1)
                (path,) = bench.paths(model, [drive], [p.start], max(DURATION, 1 / frequency))
                outcome[model][i, k] = path.outcome
                if path.attached:
                    distance[model][i, k] = path.trajectory.distance

    def draw(figure: Figure) -> None:
        axes = figure.add_subplot()
        for i, stroke in enumerate(strokes.tolist()):
            for model in MODELS:
                moved = np.where(distance[model][i] > MOVED, distance[model][i], np.nan)
                said = f"{MICRO * stroke:.4g} µm" if model == CLOSED else None
                axes.plot(frequencies, MICRO * moved, STYLES[model], color=COLOURS[i % len(COLOURS)], label=said)
        for model in (PAPER, PLATE):
            axes.plot([], [], STYLES[model], color="black", label=MODELS[model])
        finish(axes, "frequency [Hz]", "distance [µm]", "figure 15")

    data: dict[str, Any] = {"frequencies": frequencies.tolist(), "strokes": strokes.tolist()}
    data |= {model: np.where(np.isnan(rows), -1.0, rows).tolist() for model, rows in distance.items()}
    verdict = _verdict(frequencies, distance, outcome, p.start)
    return Found("fig15", "Distance over frequency and stroke", (verdict,), data, draw, (8.5, 4.8),
                 "Distance from the start after one cycle, from the frequency at which the part "
                 "first moves to that at which it comes off; -1 in the data: it came off or left.")  # fmt: skip


COLOURS = (*GREYS, "#7a4b94", "#404040")


def _verdict(
    frequencies: Any, distance: dict[str, Any], outcome: dict[str, Any], start: tuple[float, float]
) -> Verdict:
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for model, rows in distance.items():
        first = [_first(frequencies, row > MOVED) for row in rows]
        last = [_last(frequencies, row > MOVED) for row in rows]
        moving = [np.where(row > MOVED, row, np.nan) for row in rows]
        steps = np.concatenate([np.diff(row) for row in moving])
        steps = steps[np.isfinite(steps)]
        grows = float((steps > 0).mean()) if len(steps) else 0.0
        farther = float(np.nanmean(np.diff(np.array(moving), axis=0) > 0)) if len(rows) > 1 else 0.0
        numbers |= {
            f"first_{model}": first,
            f"last_{model}": last,
            f"grows_{model}": grows,
            f"farther_{model}": farther,
        }
        beyond = [_beyond(row > MOVED, how) for row, how in zip(rows, outcome[model], strict=True)]
        off = sum(how == "detached" for how in beyond)
        numbers[f"beyond_the_last_{model}"] = beyond
        text = (
            f"moves from {first[0]:.0f} (least stroke) and {first[-1]:.0f} Hz (largest) to {last[0]:.0f} and "
            f"{last[-1]:.0f} Hz, beyond which it comes off with {off} of {len(rows)} strokes, else goes over the rim; "
            f"grows between {100 * grows:.0f} % of neighbouring frequencies"
        )
        answers[model] = of_checks(text, [all(np.isfinite(first)), off == len(rows), grows >= STRAIGHT])
    return Verdict(
        "15", "For each stroke the part moves between a lowest frequency, where friction holds it, and a "
        "highest, where it comes off; the distance grows in between.", answers,
        f"Start ({MICRO * start[0]:g}, {MICRO * start[1]:g}) um and one cycle: neither is stated. The picture's shape "
        "is all that can be compared.", numbers,
    )  # fmt: skip


def _beyond(holds: Any, outcome: Any) -> str:
    """What becomes of the part at the frequency above the last one at which it moves and stays."""
    last = len(holds) - 1 - int(np.argmax(holds[::-1]))
    return str(outcome[last + 1]) if holds.any() and last + 1 < len(holds) else "not reached"


def _first(frequencies: Any, holds: Any) -> float:
    return float(frequencies[np.argmax(holds)]) if holds.any() else float("nan")


def _last(frequencies: Any, holds: Any) -> float:
    return float(frequencies[len(holds) - 1 - np.argmax(holds[::-1])]) if holds.any() else float("nan")
