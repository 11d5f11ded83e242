"""Figures 17 and 19: one actuator that goes up and down without end draws the part to itself, or throws it out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from active_surface.arrays import FloatArray
from active_surface.paper.figure_result import MICRO, MILLI, FigureResult, finish
from active_surface.paper.figures.coming_off import end_said, off_numbers, off_said
from active_surface.paper.figures.pairs import ENDS, MARKS
from active_surface.paper.models import CLOSED, MODELS, Bench
from active_surface.paper.parameters import Effort
from active_surface.paper.path import Path
from active_surface.paper.share import Share, share_of
from active_surface.paper.verdict import Answer, Verdict

LOW, HIGH, ANY = 300.0, 600.0, 250.0  # Hz, figures 17a, 17b and 19
STROKES_TO_LEAVE: Final = 2  # in which the part of figure 17b is gone: taken as cycles
REACH, FASTEST = 150e-6, 0.02  # m and m/s: the states of figure 19, which the paper does not list
DRAWN: Final = 12  # paths
ACTUATOR: Final = ((0.0, 0.0),)  # m


def find(bench: Bench, effort: Effort) -> FigureResult:
    """All three pictures."""
    results: dict[str, dict[str, list[Path]]] = {"17a": {}, "17b": {}, "19": {}}
    for model in MODELS:
        count = bench.starts_of(model, effort)
        results["17a"][model], results["17b"][model] = (from_start(bench, model, f, count) for f in (LOW, HIGH))
        results["19"][model] = from_states(bench, model, count)
    verdicts = (_converges(bench, results["17a"]), _leaves(bench, results["17b"]), _all_converge(bench, results["19"]))
    data: dict[str, Any] = {
        f: {m: paths[0].drawn(800).tolist() for m, paths in rows.items()} for f, rows in results.items() if f != "19"
    }
    data["19_closed"] = [path.drawn().tolist() for path in results["19"][CLOSED][:DRAWN]]

    def draw(figure: Figure) -> None:
        axes = figure.subplots(3, len(MODELS), sharey="row")
        titles = {"17a": f"figure 17a, {LOW:g} Hz", "17b": f"figure 17b, {HIGH:g} Hz", "19": f"figure 19, {ANY:g} Hz"}
        for i, (name, by_model) in enumerate(results.items()):
            for k, (model, paths) in enumerate(by_model.items()):
                _draw_ways(axes[i, k], paths, bench.parameters.far)
                across = "time [ms]" if i == len(results) - 1 else ""
                up = "distance from\nthe actuator [µm]" if k == 0 else ""
                finish(axes[i, k], across, up, f"{titles[name]}: {MODELS[model]}", legend=False)
        figure.legend(handles=_handles(), loc="outside lower center", ncols=7, frameon=False, fontsize=9)

    return FigureResult("fig17-19", "Convergence to one actuator", verdicts, data, draw, (14.0, 9.0),
                 "Continuous cycles of 150 µm: how far from the actuator the part is. Black: the paper's "
                 "start (19: the "
                 "first of the states).")  # fmt: skip


def _draw_ways(axes: Axes, paths: Sequence[Path], far: float) -> None:
    """Distances over time, the first heavy, and how all of them end."""
    for k, path in reversed(list(enumerate(paths))):
        away = MICRO * path.away()
        if k < DRAWN:
            colour = "black" if k == 0 else "#9ab5d6"
            axes.plot(
                MILLI * path.time, away, color=colour, linewidth=0.9 if k == 0 else 0.5, zorder=3 if k == 0 else 2
            )
        mark, colour = MARKS[next(name for name, how in ENDS.items() if how(path))]
        axes.plot(MILLI * path.time[-1], away[-1], mark, color=colour, markerfacecolor="none", markersize=5, zorder=4)
    axes.axhline(MICRO * far, color="#b8862d", linewidth=0.9)


def _handles() -> list[Line2D]:
    ends = [
        Line2D([], [], marker=m, linestyle="", color=c, markerfacecolor="none", label=e) for e, (m, c) in MARKS.items()
    ]
    return [
        Line2D([], [], color="black", label="the stated start"),
        Line2D([], [], color="#9ab5d6", label="others"),
        *ends,
        Line2D([], [], color="#b8862d", label="beyond it, it has left"),
    ]


def from_start(bench: Bench, model: str, frequency: float, count: int) -> list[Path]:
    """Paths from the paper's start and others around it."""
    drive = bench.drive(frequency)
    return bench.paths(model, [drive], bench.starts(bench.parameters.start, count), bench.duration(drive))


def from_states(bench: Bench, model: str, count: int) -> list[Path]:
    """Paths of figure 19, from the same states in every model."""
    drive = bench.drive(ANY)
    places, velocities = states(bench.parameters.seed, count)
    return bench.paths(model, [drive], places, bench.duration(drive), velocities)


def states(seed: int, count: int) -> tuple[FloatArray, FloatArray]:
    """Places (count, 2) [m] around the actuator and velocities (count, 2) [m/s]."""
    random = np.random.default_rng(seed)
    numbers = random.random((count, 4))
    angle, turn = 2 * np.pi * numbers[:, 1], 2 * np.pi * numbers[:, 3]
    away, speed = REACH * np.sqrt(numbers[:, 0]), FASTEST * numbers[:, 2]
    return (
        np.stack([away * np.cos(angle), away * np.sin(angle)], axis=1),
        np.stack([speed * np.cos(turn), speed * np.sin(turn)], axis=1),
    )


def converge(bench: Bench, paths: list[Path], frequency: float) -> Share:
    """The share of parts that converge."""
    period = 1 / bench.drive(frequency).frequency
    return share_of(path.converged(period, bench.parameters.near) for path in paths)


def leave(bench: Bench, paths: list[Path], cycles: float = np.inf) -> Share:
    """The share of figure 17b's parts that leave, in so many cycles."""
    soon = cycles / bench.drive(HIGH).frequency
    times = [path.leaves_at(bench.parameters.far) for path in paths]
    return share_of(np.isfinite(time) and time <= soon for time in times)


def _convergence(bench: Bench, paths: list[Path], frequency: float, what: str) -> tuple[Answer, dict[str, Any]]:
    """The share of parts that converge, and what the others do."""
    share = converge(bench, paths, frequency)
    others = [path for path in paths if not converge(bench, [path], frequency).hits]
    lost = Share(sum(path.lost(bench.parameters.far) for path in others), len(paths))
    unknown = Share(sum(path.unknown for path in others), len(paths))
    to_and_fro = 1 - share.value - lost.value - unknown.value
    numbers = {
        "share": share.value, "lost": lost.value, "unknown": unknown.value, "to_and_fro": to_and_fro,
        "starts": len(paths),
    }  # fmt: skip
    more = f"of {len(paths)} {what} {100 * to_and_fro:.0f} % go to and fro over the actuator"
    more += f", {100 * lost.value:.0f} % are lost" if lost.hits else ""
    return Answer(str(share), share.met, more), numbers


def _converges(bench: Bench, results: dict[str, list[Path]]) -> Verdict:
    p = bench.parameters
    answers, numbers = {}, {}
    for model, paths in results.items():
        answer, numbers[model] = _convergence(bench, paths, LOW, "starts")
        stated = bool(converge(bench, paths[:1], LOW).hits)
        numbers[model]["stated_start_converges"] = stated
        answers[model] = answer._replace(more=f"{answer.more}; the stated start {'does' if stated else 'does not'}")
    return Verdict(
        "17a", "From rest at (100, 100) um the part converges to the actuator at 300 Hz.", answers,
        f"Converged: on the surface after {p.cycles} cycles, within {MICRO * p.near:g} um of the actuator for the "
        f"last five. Starts are displaced by up to {MICRO * p.jitter:g} um. Paths are chaotic next to the threshold.",
        numbers,
    )  # fmt: skip


def _leaves(bench: Bench, results: dict[str, list[Path]]) -> Verdict:
    p = bench.parameters
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for model, paths in results.items():
        leaves, soon = leave(bench, paths), leave(bench, paths, STROKES_TO_LEAVE)
        first = paths[0].leaves_at(p.far) * bench.drive(HIGH).frequency
        numbers[model] = {
            "share": leaves.value, "share_in_two": soon.value, "cycles_of_the_stated_start": first,
            "coming_off": off_numbers(paths, ACTUATOR), "starts": len(paths),
        }  # fmt: skip
        stated = f"leaves after {first:.2f} cycles" if np.isfinite(first) else "never leaves"
        more = (
            f"of {len(paths)} starts {off_said(paths, ACTUATOR)}; the stated start {stated} and "
            f"{end_said(paths[0], ACTUATOR)}"
        )
        answers[model] = Answer(f"{leaves} leave, {soon} in two", (leaves.met + soon.met) / 2, more)
    return Verdict(
        "17b", "From the same start at 600 Hz it leaves the actuator's region in two strokes.", answers,
        f"It has left once it is {MICRO * p.far:g} um away or over the rim; strokes are taken as cycles. A part that "
        "comes off the surface before is lost, too, but has not left. How many leave hangs on that distance: see the "
        "open points.", numbers,
    )  # fmt: skip


def _all_converge(bench: Bench, results: dict[str, list[Path]]) -> Verdict:
    answers, numbers = {}, {}
    for model, paths in results.items():
        answers[model], numbers[model] = _convergence(bench, paths, ANY, "states")
    return Verdict(
        "19", "At 250 Hz parts converge from various places and velocities.", answers,
        f"The states are not listed, so that there is no stated one; here places within {MICRO * REACH:g} um and "
        f"velocities up to {FASTEST} m/s.", numbers,
    )  # fmt: skip
