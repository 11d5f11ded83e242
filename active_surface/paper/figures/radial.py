"""Figures 11 and 12: one cycle of one actuator moves the part along a straight line through the actuator."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from active_surface.paper.figure_result import MICRO, MILLI, FigureResult, finish, look
from active_surface.paper.models import CLOSED, MODELS, Bench
from active_surface.paper.parameters import Effort, Place
from active_surface.paper.path import Path
from active_surface.paper.verdict import Verdict, of_checks
from particle import Drive

START: Final[Place] = (170.08e-6, 170.08e-6)  # m
OFF_DIAGONAL: Final[Place] = (200e-6, 100e-6)  # m, where x and y are not each other's mirror
FREQUENCY, DURATION = 1600.0, 3e-3  # Hz, s
RADIAL_STARTS: Final = (START, OFF_DIAGONAL)
WITHIN: Final = 1e-9
TOLERANCE: Final = 1e-12
SLOW: Final = 1e-3  # of the largest speed


def find(bench: Bench, effort: Effort) -> FigureResult:
    """Both figures, and the same from a start that is not on the diagonal."""
    drive = one_cycle(bench)
    paths: dict[str, list[Path]] = {}
    numbers: dict[str, Any] = {}
    ratios, lines = {}, {}
    for model in MODELS:
        paths[model] = bench.paths(model, [drive], list(RADIAL_STARTS), DURATION, tolerance=TOLERANCE)
        ratio, line = _errors(paths[model])
        numbers |= {f"ratio_{model}": ratio, f"bend_{model}": line}
        ratios[model] = of_checks(f"constant to {ratio:.0e}", [ratio < WITHIN])
        lines[model] = of_checks(f"straight to {line:.0e} of its length", [line < WITHIN])
    drawn = {model: [path.drawn() for path in both] for model, both in paths.items()}
    speeds = {
        model: [path.trajectory.at(rows[:, 0]).velocity for path, rows in zip(both, drawn[model], strict=True)]
        for model, both in paths.items()
    }

    def draw(figure: Figure) -> None:
        axes = figure.subplots(1, 3)
        for k, start in enumerate(RADIAL_STARTS):
            for model, rows in drawn.items():
                axes[k].plot(MILLI * rows[k][:, 0], speeds[model][k][:, 0], **look(model, label=f"x, {MODELS[model]}"))
            times, across = MILLI * drawn[CLOSED][k][::12, 0], speeds[CLOSED][k][::12, 1]
            axes[k].plot(
                times, across, "^", color="#3d8a4e", markersize=5, markerfacecolor="none", label="y, our equations"
            )
            ratio = start[0] / start[1]
            axes[k].plot(
                times, ratio * across, ".", color="#3d8a4e", markersize=6, label=f"y times {ratio:g}, our equations"
            )
            finish(axes[k], "time [ms]", "velocity [m/s]", f"figure 11, from {_said(start)} µm")
            for model, rows in drawn.items():
                axes[2].plot(MICRO * rows[k][:, 1], MICRO * rows[k][:, 2], **look(model) | _once(k))
            axes[2].axline((0, 0), (MICRO * start[0], MICRO * start[1]), color="#b0b0b0", linewidth=0.7, zorder=0)
            axes[2].plot(MICRO * start[0], MICRO * start[1], "o", color="none", markeredgecolor="black")
        axes[2].plot(0, 0, "^", color="white", markeredgecolor="black", markersize=9, label="actuator")
        axes[2].plot([], [], "o", color="none", markeredgecolor="black", label="starts")
        axes[2].set_xlim(-20, 260)
        axes[2].set_ylim(-20, 260)
        axes[2].set_aspect("equal")
        finish(axes[2], "x [µm]", "y [µm]", "figure 12; grey: the line through the actuator")

    data = {"numbers": numbers, "starts": [list(start) for start in RADIAL_STARTS]} | {
        model: {
            "time_x_y": [one.tolist() for one in rows],
            "velocity": [one.tolist() for one in speeds[model]],
        }
        for model, rows in drawn.items()
    }
    verdicts = (
        Verdict("11", "The velocities along x and y are constant multiples of each other.", ratios,
                f"One cycle, up and down in 1/f. The worst of two starts, {_said(START)} and "
                f"{_said(OFF_DIAGONAL)} um.", numbers),
        Verdict("12", "The path from (170.08, 170.08) um is a straight line through the actuator.", lines,
                "The distance from the line through start and actuator, over the way gone, from both starts.", numbers),
    )  # fmt: skip
    return FigureResult("fig11-12", "Transformation of the state", verdicts, data, draw, (14.5, 4.8),
                 "One cycle of 150 µm at 1.6 kHz: velocities from two starts, and both paths. Where the y "
                 "velocity, times "
                 "the ratio of the start's coordinates, lies on the x velocity, the statement holds.")  # fmt: skip


def radial_errors(bench: Bench, model: str, slow: float = SLOW) -> tuple[float, float]:
    """By how much velocities depart from a constant ratio and paths from a straight line, relative; the worst start.

    slow: share of the largest speed below which no ratio is taken.
    """
    return _errors(bench.paths(model, [one_cycle(bench)], list(RADIAL_STARTS), DURATION), slow)


def _errors(paths: Sequence[Path], slow: float = SLOW) -> tuple[float, float]:
    both = list(zip(paths, RADIAL_STARTS, strict=True))
    return max(_ratio(*one, slow) for one in both), max(_bend(*one) for one in both)


def _once(k: int) -> dict[str, Any]:
    """A label on the first of several lines only."""
    return {} if k == 0 else {"label": None}


def one_cycle(bench: Bench) -> Drive:
    """Up and down once, by default in the 0.625 ms after which the paper's actuator rests; then the surface is flat."""
    return bench.drive(FREQUENCY, cycles=1)


def _ratio(path: Path, start: Place, slow: float) -> float:
    """By how much the ratio of the velocities differs from that of the start's coordinates, relative."""
    v = path.trajectory.velocity
    if not path.trajectory.path_length:
        return np.inf  # it does not move
    fast = np.hypot(*v.T) > slow * np.hypot(*v.T).max()
    return float(np.abs(v[fast, 1] / v[fast, 0] / (start[1] / start[0]) - 1).max())


def _bend(path: Path, start: Place) -> float:
    """The largest distance from the line through start and actuator, over the way gone."""
    x, y = path.place.T
    if not path.trajectory.path_length:
        return np.inf
    away = np.abs(x * start[1] - y * start[0]) / np.hypot(*start)
    return float(away.max() / path.trajectory.path_length)


def _said(place: Place) -> str:
    return f"({MICRO * place[0]:g}, {MICRO * place[1]:g})"
