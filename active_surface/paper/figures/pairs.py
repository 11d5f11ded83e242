"""Two actuators: the paths over superposed profiles, over the nearest one's alone, and over a plate."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes

from active_surface.arrays import FloatArray
from active_surface.paper.figure_result import LOOK, MICRO
from active_surface.paper.models import CLOSED, MODELS, PAPER, PLATE, Bench
from active_surface.paper.parameters import Effort, Place
from active_surface.paper.path import Path
from active_surface.paper.profiles import NEAREST, SUPERPOSED
from active_surface.paper.verdict import Answer

SURFACES: Final[dict[str, tuple[str, str]]] = {
    "paper, nearest": (PAPER, NEAREST),
    "paper, superposed": (PAPER, SUPERPOSED),
    "closed, nearest": (CLOSED, NEAREST),
    "closed, superposed": (CLOSED, SUPERPOSED),
    "plate": (PLATE, SUPERPOSED),
}
"""Models and how the closed forms are put together; the nearest one's alone jumps half-way between the actuators."""
JUMPS = (
    "Over nearest-actuator profiles the surface jumps half-way between the actuators; superposed ones and the plate "
    "are smooth. The rim of the plate is not that of the closed forms: see above. "
)
Paths = dict[str, list[Path]]  # by name of SURFACES
WIDTHS: Final = {NEAREST: 1.6, SUPERPOSED: 0.9}


def paths_of(bench: Bench, effort: Effort, frequencies: Sequence[float], start: Place, cycles: int) -> Paths:
    """Paths from jittered starts, so many cycles of the slower one long, by model and surface.

    frequencies: Hz, of the actuators at (0, 0) and (pitch, 0).
    """
    drives = [bench.drive(frequency) for frequency in frequencies]
    duration = cycles / min(drive.frequency for drive in drives)
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
    """The answers of all surfaces as answers of the three models."""
    answers = {}
    for model in MODELS:
        own = {name: answer for name, answer in results.items() if SURFACES[name][0] == model}
        texts = [
            answer.text if model == PLATE else f"{SURFACES[name][1]}: {answer.text}" for name, answer in own.items()
        ]
        answers[model] = Answer("; ".join(texts), float(np.mean([answer.met for answer in own.values()])))
    return answers


def draw_plane(axes: Axes, drawn: dict[str, FloatArray], pitch: float) -> None:
    """Paths (n, 3) in the plane, with the actuators."""
    for name, rows in drawn.items():
        model, surface = SURFACES[name]
        style: dict[str, Any] = LOOK[model] | {"linewidth": WIDTHS[surface]}
        axes.plot(MICRO * rows[:, 1], MICRO * rows[:, 2], **style, label=name)
        axes.plot(MICRO * rows[-1, 1], MICRO * rows[-1, 2], "x", color=style["color"], markersize=6)
    first = next(iter(drawn.values()))
    axes.plot(MICRO * first[0, 1], MICRO * first[0, 2], "o", color="none", markeredgecolor="black", markersize=7)
    mark_actuators(axes, pitch)


def mark_actuators(axes: Axes, pitch: float) -> None:
    """The two actuators, and the line half-way between them."""
    axes.plot([0, MICRO * pitch], [0, 0], "^", color="white", markeredgecolor="black", markersize=8, zorder=5)
    axes.axvline(MICRO * pitch / 2, color="#b0b0b0", linewidth=0.7)
    axes.set_aspect("equal")
    axes.set_xlim(-310, MICRO * pitch + 310)
    axes.set_ylim(-310, 310)
