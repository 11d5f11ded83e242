"""Figure 15: how far one cycle of one actuator carries the part, over frequency, for several strokes."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from active_surface.arrays import FloatArray
from active_surface.paper.figure_result import COLOURS, MICRO, FigureResult, finish
from active_surface.paper.models import CLOSED, MODELS, PAPER, PLATE, Bench
from active_surface.paper.parameters import Effort, Place
from active_surface.paper.verdict import Answer, Verdict, of_checks

LOWEST, HIGHEST = 100.0, 1600.0  # Hz
MOVED: Final = 0.1e-6  # m
DURATION: Final = 20e-3  # s, after which every part has come to rest
STRAIGHT: Final = 0.9  # of the neighbouring frequencies between which the distance grows: "with the frequency"
STYLES: Final = {PAPER: "--", CLOSED: "-", PLATE: ":"}


class Ends(NamedTuple):
    """Where one cycle leaves the part, by stroke and frequency."""

    distance: FloatArray  # (S, F) m from the start; nan: it came off or left
    outcome: NDArray[Any]  # (S, F) texts


def find(bench: Bench, effort: Effort) -> FigureResult:
    """Distances in every model."""
    p = bench.parameters
    frequencies = np.geomspace(LOWEST, HIGHEST, effort.frequencies)
    strokes = np.linspace(p.strokes[0], p.strokes[-1], effort.strokes)
    results = {model: _ends(bench, model, strokes, frequencies) for model in MODELS}

    def draw(figure: Figure) -> None:
        axes = figure.add_subplot()
        for i, stroke in enumerate(strokes.tolist()):
            for model, ends in results.items():
                text = f"{MICRO * stroke:.4g} µm" if model == CLOSED else None
                colour = COLOURS[i % len(COLOURS)]
                axes.plot(frequencies, MICRO * moving(ends.distance)[i], STYLES[model], color=colour, label=text)
        for model in MODELS:
            axes.plot([], [], STYLES[model], color="black", label=MODELS[model])
        finish(axes, "frequency [Hz]", "distance [µm]", "figure 15")

    data: dict[str, Any] = {"frequencies": frequencies.tolist(), "strokes": strokes.tolist()}
    data |= {model: np.where(np.isnan(ends.distance), -1.0, ends.distance).tolist() for model, ends in results.items()}
    verdict = _verdict(frequencies, results, p.start)
    return FigureResult("fig15", "Distance over frequency and stroke", (verdict,), data, draw, (8.5, 4.8),
                 "Distance from the start after one cycle, from the frequency at which the part "
                 "first moves to that at which it is lost; -1 in the data: it came off or left.")  # fmt: skip


def _ends(bench: Bench, model: str, strokes: FloatArray, frequencies: FloatArray) -> Ends:
    distance = np.full((len(strokes), len(frequencies)), np.nan)
    outcome = np.full(distance.shape, "", dtype=object)
    for i, stroke in enumerate(strokes.tolist()):
        for k, frequency in enumerate(frequencies.tolist()):
            drive = bench.drive(frequency, stroke, cycles=1)
            (path,) = bench.paths(model, [drive], [bench.parameters.start], max(DURATION, 1 / drive.frequency))
            outcome[i, k] = path.outcome
            if path.attached:
                distance[i, k] = path.trajectory.distance
    return Ends(distance, outcome)


def moving(distance: FloatArray) -> FloatArray:
    """The same (S, F) with nan where the part does not move."""
    return np.where(distance > MOVED, distance, np.nan)


def grows(distance: FloatArray) -> float:
    """The share of neighbouring frequencies with motion between which the distance grows; nan: there are none."""
    return _positive(np.diff(moving(distance), axis=1))


def farther(distance: FloatArray) -> float:
    """The share of neighbouring strokes with motion of which the larger one goes farther; nan: there are none."""
    return _positive(np.diff(moving(distance), axis=0))


def _positive(steps: FloatArray) -> float:
    known = steps[np.isfinite(steps)]
    return float((known > 0).mean()) if len(known) else float("nan")


def ends_of(frequencies: FloatArray, distance: FloatArray) -> tuple[float, float]:
    """The first and the last of frequencies (F,) [Hz] at which a part moves and stays; nan: there is none."""
    holds = np.flatnonzero(distance > MOVED)
    return (float(frequencies[holds[0]]), float(frequencies[holds[-1]])) if len(holds) else (np.nan, np.nan)


def beyond(distance: FloatArray, outcome: NDArray[Any]) -> str:
    """What becomes of the part at the frequency above the last one at which it moves and stays."""
    holds = np.flatnonzero(distance > MOVED)
    if not len(holds) or holds[-1] + 1 == len(distance):
        return "not reached"
    return str(outcome[holds[-1] + 1])


def _verdict(frequencies: FloatArray, results: dict[str, Ends], start: Place) -> Verdict:
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for model, (distance, outcome) in results.items():
        first, last = zip(*[ends_of(frequencies, row) for row in distance], strict=True)
        share, wide = grows(distance), farther(distance)
        after = [beyond(*rows) for rows in zip(distance, outcome, strict=True)]
        numbers[model] = {
            "first": list(first), "last": list(last), "grows": share, "farther": wide, "beyond_the_last": after,
        }  # fmt: skip
        ends = ", ".join(f"{how} with {after.count(how)}" for how in dict.fromkeys(after))
        text = (
            f"moves from {first[0]:.0f} (least stroke) and {first[-1]:.0f} Hz (largest) to {last[0]:.0f} and "
            f"{last[-1]:.0f} Hz; beyond: {ends} of {len(after)} strokes; grows between {100 * share:.0f} % of "
            f"neighbouring frequencies; the larger of two strokes goes farther in {100 * wide:.0f} %"
        )
        off = all(how == "detached" for how in after)
        answers[model] = of_checks(text, [bool(np.isfinite(first).all()), off, share >= STRAIGHT])
    ratio = frequencies[1] / frequencies[0]
    return Verdict(
        "15", "For each stroke the part moves between a lowest frequency, where friction holds it, and a "
        "highest, where it comes off; the distance grows in between.", answers,
        f"Start ({MICRO * start[0]:g}, {MICRO * start[1]:g}) um and one cycle: neither is stated. The picture's shape "
        f"is all that can be compared. Frequencies are {100 * (ratio - 1):.0f} % apart.", numbers,
    )  # fmt: skip
