"""Frames: what a film shows at each of its times, interpolated linearly between the run's stored steps.

Where the part is, and its state, is known at more times, those of the integrator's rows.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.views.film.stage import Stage
from particle import State


class Frame(NamedTuple):
    """One picture of a film: heights in m of everything that lies on the surface."""

    time: float  # s
    heights: dict[str, FloatArray]  # of the stage's surface, rim, cut, net, actuators, trail
    trail: FloatArray  # (r, 2) m; where the part has not yet been, it is where the part is
    part: FloatArray  # (3,) m
    under: float  # m, the surface's height under the part
    state: State
    shift: FloatArray  # (2,) m, how far a platform has come

    @property
    def flight(self) -> float:
        """How far above the surface the part is [m]."""
        return float(self.part[2]) - self.under if self.state is State.FLIGHT else 0.0


def frames_of(stage: Stage, times: FloatArray) -> Iterator[Frame]:
    """The frames at times (F,) [s] that do not decrease."""
    run = stage.run
    step = np.clip(np.searchsorted(run.time, times, side="right") - 1, 0, max(len(run.time) - 2, 0))
    before: FloatArray | None = None
    for first, heights in stage.stored_heights():
        known = heights if before is None else np.concatenate([before, heights])
        start = first - (before is not None)
        before = heights[-1:]
        last = start + len(known) - 1
        for time, k in zip(times, step, strict=True):
            if start <= k < last or (k == last == len(run.time) - 1):
                yield _frame(stage, float(time), int(k), known[k - start : k - start + 2])


def _frame(stage: Stage, time: float, step: int, known: FloatArray) -> Frame:
    run = stage.run
    later = min(step + 1, len(run.time) - 1)
    whole = run.time[later] - run.time[step]
    share = float(np.clip((time - run.time[step]) / whole, 0, 1)) if whole else 0.0
    deflection = (1 - share) * known[0] + share * known[-1]
    height = (1 - share) * run.position[step, 2] + share * run.position[later, 2]
    path, then = stage.path
    part = np.array([*(np.interp(time, then, column) for column in path.T), height])
    state = State(int(run.rows.state[np.searchsorted(run.rows.time, time, side="right") - 1]))
    under = float((stage.smooth.at(part[None, :2]) @ deflection)[0])
    heights = {name: matrix @ deflection for name, matrix in stage.matrices.items()}
    passed = stage.trail_time <= time
    heights["trail"] = np.where(passed, heights["trail"], under)
    trail = np.where(passed[:, None], stage.trail, part[:2])
    return Frame(time, heights, trail, part, under, state, stage.shifts(np.array([time]))[0])
