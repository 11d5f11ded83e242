"""Figure 15: how far one cycle of one actuator carries the part, over frequency, for several strokes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from active_surface.arrays import FloatArray
from active_surface.paper.figure_result import COLOURS, MICRO, FigureResult, finish
from active_surface.paper.models import MODELS, Bench
from active_surface.paper.parameters import Effort, Place
from active_surface.paper.path import Path
from active_surface.paper.profiles import SUPERPOSED
from active_surface.paper.verdict import Answer, Verdict, of_checks
from particle import Drive

LOWEST, HIGHEST = 100.0, 1600.0  # Hz
MOVED: Final = 0.1e-6  # m
DURATION: Final = 20e-3  # s, after which every part has come to rest
STRAIGHT: Final = 0.9  # of the neighbouring frequencies between which the distance grows: "with the frequency"
OFF: Final = "detached"
MARKS: Final = {"o": "below it friction holds", "x": "beyond it comes off", "s": "beyond it leaves, or not reached"}


class Ends(NamedTuple):
    """Where one cycle leaves the part, by stroke and frequency."""

    distance: FloatArray  # (S, F) m from the start; nan: it came off or left
    outcome: NDArray[Any]  # (S, F) texts


def find(bench: Bench, effort: Effort) -> FigureResult:
    """Distances in every model."""
    p = bench.parameters
    frequencies = np.geomspace(LOWEST, HIGHEST, effort.frequencies)
    strokes = np.array(p.carrying)
    results = {model: one_cycle_ends(bench, model, strokes, frequencies, [p.start])[0] for model in MODELS}

    def draw(figure: Figure) -> None:
        panels = figure.subplots(1, len(MODELS), sharey=True)
        for axes, (model, ends) in zip(panels, results.items(), strict=True):
            for k, (stroke, distance, outcome) in enumerate(zip(strokes.tolist(), *ends, strict=True)):
                colour, going = COLOURS[k % len(COLOURS)], np.flatnonzero(distance > MOVED)
                axes.plot(frequencies, MICRO * moving(distance), color=colour, label=f"{MICRO * stroke:.4g} µm")
                if len(going):
                    axes.plot(frequencies[going[0]], MICRO * distance[going[0]], "o", color=colour, markersize=5)
                    mark = "x" if beyond(distance, outcome) == OFF else "s"
                    axes.plot(frequencies[going[-1]], MICRO * distance[going[-1]], mark, color=colour, markersize=7)
            finish(axes, "frequency [Hz]", "distance [µm]" if axes is panels[0] else "", MODELS[model], legend=False)
        for mark, text in MARKS.items():
            panels[0].plot([], [], mark, color="black", label=text)
        handles, names = panels[0].get_legend_handles_labels()
        figure.legend(handles, names, loc="outside lower center", ncols=len(names), frameon=False, fontsize=8)

    data: dict[str, Any] = {"frequencies": frequencies.tolist(), "strokes": strokes.tolist()}
    data |= {model: np.where(np.isnan(ends.distance), -1.0, ends.distance).tolist() for model, ends in results.items()}
    verdict = _verdict(frequencies, results, p.start, strokes)
    return FigureResult("fig15", "Distance over frequency and stroke", (verdict,), data, draw, (13.0, 4.8),
                 "Distance from the start after one cycle, over the frequencies at which the part moves and "
                 "stays; -1 in "
                 "the data: it came off or left.")  # fmt: skip


def one_cycle_ends(
    bench: Bench, model: str, strokes: FloatArray, frequencies: FloatArray, starts: Sequence[Place], flat: bool = False
) -> list[Ends]:
    """From each start, after one cycle of strokes (S,) [m] at frequencies (F,) [Hz].

    flat: on the bench's surface of two actuators, which may go on flat beyond its rim; the other one rests.
    """
    others, actuators = ([Drive(0.0, 1.0)], SUPERPOSED) if flat else ([], "one")
    shape = (len(starts), len(strokes), len(frequencies))
    distance, outcome = np.full(shape, np.nan), np.full(shape, "", dtype=object)
    for i, stroke in enumerate(strokes.tolist()):
        for k, frequency in enumerate(frequencies.tolist()):
            drive = bench.drive(frequency, stroke, cycles=1)
            for n, path in enumerate(_cycle(bench, model, [drive, *others], starts, actuators)):
                outcome[n, i, k] = path.outcome
                if path.attached:
                    distance[n, i, k] = path.trajectory.distance
    return [Ends(*rows) for rows in zip(distance, outcome, strict=True)]


def _cycle(bench: Bench, model: str, drives: Sequence[Drive], starts: Sequence[Place], actuators: str) -> list[Path]:
    return bench.paths(model, drives, starts, max(DURATION, 1 / drives[0].frequency), actuators=actuators)


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


def checks_of(frequencies: FloatArray, ends: Ends) -> list[bool]:
    """Whether at every stroke the part moves from some frequency on, and until it comes off; and the distance grows."""
    first = [ends_of(frequencies, row)[0] for row in ends.distance]
    after = [beyond(*rows) for rows in zip(*ends, strict=True)]
    return [bool(np.isfinite(first).all()), all(how == OFF for how in after), grows(ends.distance) >= STRAIGHT]


def _verdict(frequencies: FloatArray, results: dict[str, Ends], start: Place, strokes: FloatArray) -> Verdict:
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {"strokes": strokes.tolist()}
    for model, (distance, outcome) in results.items():
        first, last = zip(*[ends_of(frequencies, row) for row in distance], strict=True)
        share, wide = grows(distance), farther(distance)
        after = [beyond(*rows) for rows in zip(distance, outcome, strict=True)]
        numbers[model] = {
            "first": list(first), "last": list(last), "grows": share, "farther": wide, "beyond_the_last": after,
        }  # fmt: skip
        ends = ", ".join(f"{how} with {after.count(how)}" for how in dict.fromkeys(after))
        more = (
            f"beyond: {ends} of {len(after)} strokes; grows between {100 * share:.0f} % of neighbouring frequencies; "
            f"the larger of two strokes goes farther in {100 * wide:.0f} %"
        )
        text = f"{first[0]:.0f} to {last[0]:.0f} Hz (least), {first[-1]:.0f} to {last[-1]:.0f} Hz (largest stroke)"
        answers[model] = of_checks(text, checks_of(frequencies, Ends(distance, outcome)), more)
    ratio = frequencies[1] / frequencies[0]
    return Verdict(
        "15", "For each stroke the part moves between a lowest frequency, where friction holds it, and a "
        "highest, where it comes off; the distance grows in between.", answers,
        f"Strokes of {MICRO * strokes[0]:g} to {MICRO * strokes[-1]:g} um, the start "
        f"({MICRO * start[0]:g}, {MICRO * start[1]:g}) um and one cycle: none of them is stated. Larger strokes, up to "
        "200 um, carry the part over the rim before it comes off. The distance grows: between "
        f"{100 * STRAIGHT:.0f} % of neighbouring frequencies. They are {100 * (ratio - 1):.0f} % apart.", numbers,
    )  # fmt: skip
