"""Two actuators: the paths over superposed profiles, over the nearest one's alone, and over a plate."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from active_surface.paper.figure_result import MICRO
from active_surface.paper.models import CLOSED, MODELS, PAPER, PLATE, Bench
from active_surface.paper.parameters import Effort, Place
from active_surface.paper.path import Path
from active_surface.paper.profiles import NEAREST, SUPERPOSED
from active_surface.paper.verdict import Answer
from particle import Drive

SURFACES: Final[dict[str, tuple[str, str]]] = {
    "paper, nearest": (PAPER, NEAREST),
    "paper, superposed": (PAPER, SUPERPOSED),
    "closed, nearest": (CLOSED, NEAREST),
    "closed, superposed": (CLOSED, SUPERPOSED),
    "plate": (PLATE, SUPERPOSED),
}
"""Models and how the closed forms are put together; the nearest one's alone jumps half-way between the actuators."""
JUMPS = (
    "Of the two ways to put closed forms together the better one counts. Over nearest-actuator profiles the surface "
    "jumps half-way between the actuators; superposed ones and the plate are smooth. The rim of the plate is not that "
    "of the closed forms: see above. "
)
Paths = dict[str, list[Path]]  # by name of SURFACES
ENDS: Final[dict[str, Callable[[Path], bool]]] = {
    "ends on the surface": lambda path: path.attached,
    "comes off": lambda path: path.came_off,
    "goes over the rim": lambda path: path.over_rim,
    "not followed": lambda _: True,
}
"""Why a path ends."""
MARKS: Final = dict(zip(ENDS, (("o", "#3d8a4e"), ("x", "#c8371b"), ("s", "#7a4b94"), ("*", "#404040")), strict=True))


def paths_of(bench: Bench, effort: Effort, drives: Sequence[Drive], start: Place, duration: float) -> Paths:
    """Paths from jittered starts by model and surface; drives of the actuators at (0, 0) and (pitch, 0)."""
    return {
        name: bench.paths(
            model, drives, bench.starts(start, bench.starts_of(model, effort)), duration, actuators=surface
        )
        for name, (model, surface) in SURFACES.items()
    }


def reaches(path: Path, actuator: Place, pitch: float) -> float:
    """When [s] a part is first nearer than half a pitch [m] to an actuator; inf: never."""
    close = np.flatnonzero(path.away(actuator) < pitch / 2)
    return float(path.time[close[0]]) if len(close) else np.inf


def joined(results: dict[str, Answer]) -> dict[str, Answer]:
    """The answers of all surfaces as answers of the three models: the better of two ways to put closed forms together.

    The paper does not say which of them is its own.
    """
    answers = {}
    for model in MODELS:
        own = {SURFACES[name][1]: answer for name, answer in results.items() if SURFACES[name][0] == model}
        best = max(own.values(), key=lambda answer: answer.met)
        if model == PLATE:
            answers[model] = best
            continue
        text = ", ".join(f"{surface}: {answer.text}" for surface, answer in own.items())
        more = "; ".join(f"{surface}: {answer.more}" for surface, answer in own.items() if answer.more)
        answers[model] = Answer(text, best.met, more)
    return answers


def draw_plane(axes: Axes, paths: Sequence[Path], pitch: float, frequencies: Sequence[float], drawn: int = 8) -> None:
    """Paths in the plane, the first one heavy, how they all end, and the actuators with their frequencies [Hz]."""
    for k, path in reversed(list(enumerate(paths))):
        x, y = MICRO * path.place[-1]
        if k < drawn:
            rows = MICRO * path.drawn(600)[:, 1:]
            axes.plot(
                *rows.T, color="black" if k == 0 else "#9ab5d6", linewidth=0.9 if k == 0 else 0.5, zorder=2 - (k > 0)
            )
        name = next(name for name, how in ENDS.items() if how(path))
        mark, colour = MARKS[name]
        face = "none" if mark == "s" else colour
        axes.plot(x, y, mark, color=colour, markerfacecolor=face, markersize=6 if k == 0 else 4, zorder=4)
    x, y = MICRO * paths[0].place[0]
    axes.plot(x, y, "D", color="none", markeredgecolor="black", markersize=6, zorder=5)
    for place, frequency in zip((0.0, MICRO * pitch), frequencies, strict=True):
        slow = frequency == min(frequencies)
        face = "#b8862d" if slow and len(set(frequencies)) > 1 else "white"
        axes.plot(place, 0, "^", color=face, markeredgecolor="black", markersize=9, zorder=3)
        if len(set(frequencies)) > 1:
            axes.annotate(
                f"{frequency:g} Hz", (place, 0), (0, -14), textcoords="offset points", ha="center", fontsize=7
            )
    axes.axvline(MICRO * pitch / 2, color="#b0b0b0", linewidth=0.7)
    axes.set_aspect("equal")


def draw_x(axes: Axes, paths: Sequence[Path], pitch: float, frequency: float, drawn: int = 8) -> None:
    """Places along x over time in cycles, the first heavy, and how all end; lines: the actuators and half-way."""
    for k, path in reversed(list(enumerate(paths))):
        colour = "black" if k == 0 else "#9ab5d6"
        if k < drawn:
            axes.plot(frequency * path.time, MICRO * path.place[:, 0], color=colour, linewidth=1.0, zorder=2 - (k > 0))
        mark, colour = MARKS[next(name for name, how in ENDS.items() if how(path))]
        axes.plot(frequency * path.time[-1], MICRO * path.place[-1, 0], mark, color=colour, markersize=5, zorder=4)
    axes.plot(0, MICRO * paths[0].place[0, 0], "D", color="none", markeredgecolor="black", markersize=6, zorder=5)
    for place, style in ((0.0, "-"), (pitch / 2, ":"), (pitch, "-")):
        axes.axhline(MICRO * place, color="#8a8a8a", linewidth=0.8, linestyle=style)


def legend(figure: Figure, slow: bool) -> None:
    """What the marks of all planes mean, below them."""
    styles: list[tuple[str, dict[str, Any]]] = [
        ("the stated start and its path", {"marker": "D", "markerfacecolor": "none", "color": "black"}),
        ("paths of others", {"color": "#9ab5d6"}),
        *((name, {"marker": mark, "linestyle": "", "color": colour}) for name, (mark, colour) in MARKS.items()),
    ]
    if slow:
        triangle = {"marker": "^", "linestyle": "", "color": "black"}
        styles += [
            ("actuators", triangle | {"markerfacecolor": "white"}),
            ("the slow one", triangle | {"markerfacecolor": "#b8862d"}),
        ]
    handles = [Line2D([], [], label=name, **style) for name, style in styles]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), frameon=False, fontsize=8)
