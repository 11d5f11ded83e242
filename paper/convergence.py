"""Figures 17 and 19: one actuator that goes up and down without end draws the part to itself, or throws it out."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from paper.found import MICRO, MILLI, Found, finish, look, percent
from paper.models import CLOSED, MODELS, Bench, FloatArray, Path
from paper.parameters import Effort
from paper.verdict import Answer, Verdict, of_share

NAMES = ("fig17", "fig19")
LOW, HIGH, ANY = 300.0, 600.0, 250.0  # Hz, figures 17a, 17b and 19
STROKES_TO_LEAVE: Final = 2  # in which the part of figure 17b is gone: taken as cycles
REACH, FASTEST = 150e-6, 0.02  # m and m/s: the states of figure 19, which the paper does not list
DRAWN: Final = 8  # paths of figure 19


def find(bench: Bench, effort: Effort) -> Found:
    """All three pictures."""
    p = bench.parameters
    found: dict[str, dict[str, list[Path]]] = {"17a": {}, "17b": {}, "19": {}}
    for model in MODELS:
        count = bench.starts_of(model, effort)
        starts = bench.starts(p.start, count)
        for figure, frequency in (("17a", LOW), ("17b", HIGH)):
            found[figure][model] = bench.paths(model, [bench.drive(frequency)], starts, p.cycles / frequency)
        places, velocities = states(p.seed, count)
        found["19"][model] = bench.paths(model, [bench.drive(ANY)], places, p.cycles / ANY, velocities)
    verdicts = (_converges(bench, found["17a"]), _leaves(bench, found["17b"]), _all_converge(bench, found["19"]))
    drawn = {f: {m: paths[0].drawn(800) for m, paths in rows.items()} for f, rows in found.items() if f != "19"}
    several = [path.drawn() for path in found["19"][CLOSED][:DRAWN]]

    def draw(figure: Figure) -> None:
        axes = figure.subplots(2, 3)
        for k, (name, frequency) in enumerate((("17a", LOW), ("17b", HIGH))):
            for model, rows in drawn[name].items():
                axes[0, k].plot(MILLI * rows[:, 0], MICRO * np.hypot(rows[:, 1], rows[:, 2]), **look(model))
                axes[1, k].plot(MICRO * rows[:, 1], MICRO * rows[:, 2], **look(model))
            finish(
                axes[0, k], "time [ms]", "distance from the actuator [µm]", f"figure {name}: {frequency:g} Hz", False
            )
        for rows in several:
            axes[0, 2].plot(MILLI * rows[:, 0], MICRO * np.hypot(rows[:, 1], rows[:, 2]), linewidth=0.8)
            axes[1, 2].plot(MICRO * rows[:, 1], MICRO * rows[:, 2], linewidth=0.8)
            axes[1, 2].plot(*(MICRO * rows[0, 1:]), "k.", markersize=5)
        title = f"figure 19: {ANY:g} Hz, {len(several)} states"
        finish(axes[0, 2], "time [ms]", "distance from the actuator [µm]", title, legend=False)
        for one in axes[1]:
            one.plot(0, 0, "^", color="white", markeredgecolor="black", markersize=8)
            one.set_aspect("equal", "datalim")
            finish(one, "x [µm]", "y [µm]", legend=False)
        handles, names = axes[0, 0].get_legend_handles_labels()
        figure.legend(handles, names, loc="outside lower center", ncols=len(names), frameon=False, fontsize=9)

    data: dict[str, Any] = {f"{f}_{m}": rows.tolist() for f, both in drawn.items() for m, rows in both.items()}
    data |= {"19_closed": [rows.tolist() for rows in several]}
    return Found("fig17-19", "Convergence to one actuator", verdicts, data, draw, (13.0, 7.4),
                 "Continuous cycles of 150 µm: the paper's start (paths of all three models), and other "
                 "states.")  # fmt: skip


def states(seed: int, count: int) -> tuple[FloatArray, FloatArray]:
    """Places (count, 2) [m] around the actuator and velocities (count, 2) [m/s], the same ones for every model."""
    random = np.random.default_rng(seed)
    numbers = random.random((count, 4))
    angle, turn = 2 * np.pi * numbers[:, 1], 2 * np.pi * numbers[:, 3]
    away, speed = REACH * np.sqrt(numbers[:, 0]), FASTEST * numbers[:, 2]
    return (
        np.stack([away * np.cos(angle), away * np.sin(angle)], axis=1),
        np.stack([speed * np.cos(turn), speed * np.sin(turn)], axis=1),
    )


def _share(paths: list[Path], period: float, near: float) -> float:
    return float(np.mean([path.converged(period, near) for path in paths]))


def _to_and_fro(paths: list[Path], share: float, far: float) -> float:
    """The share of parts that neither converge nor are lost."""
    return float(np.mean([not path.lost(far) for path in paths])) - share


def _converges(bench: Bench, found: dict[str, list[Path]]) -> Verdict:
    p = bench.parameters
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for model, paths in found.items():
        share = _share(paths, 1 / LOW, p.near)
        to_and_fro = _to_and_fro(paths, share, p.far)
        numbers |= {f"share_{model}": share, f"to_and_fro_{model}": to_and_fro, f"starts_{model}": len(paths)}
        text = (
            f"{percent(share)} of {len(paths)} starts converge, {percent(to_and_fro)} go to and fro over the actuator"
        )
        answers[model] = of_share(text, share)
    return Verdict(
        "17a", "From rest at (100, 100) um the part converges to the actuator at 300 Hz.", answers,
        f"Converged: on the surface after {p.cycles} cycles, within {MICRO * p.near:g} um of the actuator for the "
        "last five. Starts are displaced by up to 1 um. Paths are chaotic next to the threshold.", numbers,
    )  # fmt: skip


def _leaves(bench: Bench, found: dict[str, list[Path]]) -> Verdict:
    p = bench.parameters
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for model, paths in found.items():
        cycles = np.array([path.leaves_at(p.far) for path in paths]) * HIGH
        leaves, soon = float(np.isfinite(cycles).mean()), float((cycles <= STROKES_TO_LEAVE).mean())
        off = float(np.mean([path.outcome == "detached" for path in paths]))
        first = cycles[0]
        numbers |= {
            f"share_{model}": leaves, f"share_in_two_{model}": soon, f"detached_{model}": off,
            f"cycles_of_the_stated_start_{model}": float(first) if np.isfinite(first) else None,
            f"starts_{model}": len(paths),
        }  # fmt: skip
        text = (
            f"{percent(leaves)} of {len(paths)} starts leave, {percent(soon)} in {STROKES_TO_LEAVE} cycles; "
            f"{percent(off)} come off in the end"
        )
        whole, part = of_share("", leaves).met, of_share("", soon).met
        answers[model] = Answer(text, (whole + part) / 2)
    return Verdict(
        "17b", "From the same start at 600 Hz it leaves the actuator's region in two strokes.", answers,
        f"It has left once it is {MICRO * p.far:g} um away or over the rim; strokes are taken as cycles. A part that "
        "comes off the surface before is lost, too, but has not left.", numbers,
    )  # fmt: skip


def _all_converge(bench: Bench, found: dict[str, list[Path]]) -> Verdict:
    p = bench.parameters
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for model, paths in found.items():
        share = _share(paths, 1 / ANY, p.near)
        to_and_fro = _to_and_fro(paths, share, p.far)
        numbers |= {f"share_{model}": share, f"to_and_fro_{model}": to_and_fro, f"starts_{model}": len(paths)}
        text = (
            f"{percent(share)} of {len(paths)} states converge, {percent(to_and_fro)} go to and fro over the actuator"
        )
        answers[model] = of_share(text, share)
    return Verdict(
        "19", "At 250 Hz parts converge from various places and velocities.", answers,
        f"The states are not listed; here places within {MICRO * REACH:g} um and velocities up to "
        f"{FASTEST} m/s.", numbers,
    )  # fmt: skip
