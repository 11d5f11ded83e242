"""Figures 11 and 12: one cycle of one actuator moves the part along a straight line through the actuator."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from active_surface.arrays import FloatArray
from active_surface.paper.figure_result import MICRO, MILLI, FigureResult, finish, look
from active_surface.paper.models import MODELS, Bench
from active_surface.paper.parameters import Effort, Place
from active_surface.paper.path import Path
from active_surface.paper.verdict import Verdict, of_checks
from particle import Drive

START: Final[Place] = (170.08e-6, 170.08e-6)  # m
OFF_DIAGONAL: Final[Place] = (200e-6, 100e-6)  # m, where x and y are not each other's mirror
FREQUENCY, DURATION = 1600.0, 3e-3  # Hz, s
WITHIN: Final = 1e-9
TOLERANCE: Final = 1e-12
SLOW: Final = 1e-3  # of the largest speed, below which no ratio is taken


def find(bench: Bench, effort: Effort) -> FigureResult:
    """Both figures, and the same from a start that is not on the diagonal."""
    drive = one_cycle(bench)
    paths: dict[str, Path] = {}
    numbers: dict[str, Any] = {}
    ratios, lines = {}, {}
    for model in MODELS:
        both = bench.paths(model, [drive], [START, OFF_DIAGONAL], DURATION, tolerance=TOLERANCE)
        paths[model] = both[0]
        ratio = max(_ratio(path, start) for path, start in zip(both, (START, OFF_DIAGONAL), strict=True))
        line = max(_bend(path, start) for path, start in zip(both, (START, OFF_DIAGONAL), strict=True))
        numbers |= {f"ratio_{model}": ratio, f"bend_{model}": line}
        ratios[model] = of_checks(f"constant to {ratio:.0e}", [ratio < WITHIN])
        lines[model] = of_checks(f"straight to {line:.0e} of its length", [line < WITHIN])
    drawn = {model: path.drawn() for model, path in paths.items()}
    speeds = {model: _velocities(paths[model], rows[:, 0]) for model, rows in drawn.items()}

    def draw(figure: Figure) -> None:
        axes = figure.subplots(1, 3)
        for k, name in enumerate("xy"):
            for model, rows in drawn.items():
                axes[k].plot(MILLI * rows[:, 0], speeds[model][:, k], **look(model))
            finish(axes[k], "time [ms]", f"{name} velocity [m/s]", "figure 11", legend=k == 0)
        for model, rows in drawn.items():
            axes[2].plot(MICRO * rows[:, 1], MICRO * rows[:, 2], **look(model))
        axes[2].plot(0, 0, "^", color="white", markeredgecolor="black", markersize=9, label="actuator")
        axes[2].set_aspect("equal", "datalim")
        finish(axes[2], "x [µm]", "y [µm]", "figure 12")

    data = {"numbers": numbers} | {
        model: {"time_x_y": rows.tolist(), "velocity": speeds[model].tolist()} for model, rows in drawn.items()
    }
    verdicts = (
        Verdict("11", "The velocities along x and y are constant multiples of each other.", ratios,
                f"One cycle, up and down in 1/f. The worst of two starts, {_said(START)} and "
                f"{_said(OFF_DIAGONAL)} um.", numbers),
        Verdict("12", "The path from (170.08, 170.08) um is a straight line through the actuator.", lines,
                "The distance from the line through start and actuator, over the way gone, from both starts.", numbers),
    )  # fmt: skip
    return FigureResult("fig11-12", "Transformation of the state", verdicts, data, draw, (13.0, 4.2),
                 "One cycle of 150 µm at 1.6 kHz: velocities and path.")  # fmt: skip


def one_cycle(bench: Bench) -> Drive:
    """Up and down once, by default in the 0.625 ms after which the paper's actuator rests; then the surface is flat."""
    return bench.drive(FREQUENCY, cycles=1)


def _velocities(path: Path, times: FloatArray) -> FloatArray:
    return path.trajectory.at(times).velocity


def _ratio(path: Path, start: Place) -> float:
    """By how much the ratio of the velocities differs from that of the start's coordinates, relative."""
    v = path.trajectory.velocity
    fast = np.hypot(*v.T) > SLOW * np.hypot(*v.T).max()
    return float(np.abs(v[fast, 1] / v[fast, 0] / (start[1] / start[0]) - 1).max())


def _bend(path: Path, start: Place) -> float:
    """The largest distance from the line through start and actuator, over the way gone."""
    x, y = path.place.T
    away = np.abs(x * start[1] - y * start[0]) / np.hypot(*start)
    return float(away.max() / path.trajectory.path_length)


def _said(place: Place) -> str:
    return f"({MICRO * place[0]:g}, {MICRO * place[1]:g})"
