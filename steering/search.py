"""The search for a drive: differential evolution, and Newton's method from whatever it finds near the target.

Few cycles move a part by a smooth function of strokes, frequencies and delays, but for jumps where it rests once more
or once less. Evolution finds the piece to be on, and Newton's method, with as many differences as there are smooth
knobs, the place in it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import differential_evolution

from steering.knobs import Knobs
from steering.objective import Best, Objective
from steering.task import Task

FloatArray = NDArray[np.float64]

POPULATION = 8  # to a knob
CONVERGED = 0.01  # of the mean cost: where all of a population are so close, another one begins
NEAR = 0.1  # of the surface's size, from where on Newton's method is tried
PATIENCE = 5  # generations that leave more than PROGRESS of the cost: then another population begins
NEWTONS = 8  # of its steps, at most
DIFFERENCE = 1e-5  # of a knob's range
SHARES = (1.0, 0.7, 0.5, 0.35, 0.25, 0.12, 0.06, 0.03)  # of a step, all of which are tried
PROGRESS = 0.8  # of the cost before: where a step leaves more, it was the last


def search(task: Task, knobs: Knobs, objective: Objective, near: float) -> Best:
    """The best turn of the knobs: the first within the tolerance, or what there is after all trials.

    near: m, from the target, from where on Newton's method is tried. The same for the same seed.
    """
    populations = 0
    while not (objective.reached or objective.exhausted):
        objective.forget()
        differential_evolution(
            lambda values: objective.of(values.T)[1],
            knobs.bounds,
            strategy="best1bin",
            popsize=POPULATION,
            maxiter=task.settings.trials,
            tol=CONVERGED,
            rng=np.random.default_rng((task.settings.seed, populations)),
            polish=False,
            vectorized=True,
            updating="deferred",
            callback=_Watch(knobs, objective, near),
        )
        populations += 1
    return objective.best


class _Watch:
    """Looks at a population after each generation: at its best by Newton's method, and whether it gets on."""

    def __init__(self, knobs: Knobs, objective: Objective, near: float) -> None:
        self._knobs, self._objective, self._near = knobs, objective, near
        self._tried, self._before, self._idle = np.inf, np.inf, 0

    def __call__(self, intermediate_result: Any) -> None:
        objective = self._objective
        if not objective.reached and objective.recent.cost <= min(self._near, self._tried * (1 - 1e-9)):
            _newton(self._knobs, objective)
            self._tried = objective.recent.cost
        gets_on = objective.recent.cost <= PROGRESS * self._before
        self._idle = 0 if gets_on else self._idle + 1
        self._before = objective.recent.cost if gets_on else self._before
        if objective.reached or objective.exhausted or self._idle >= PATIENCE:
            raise StopIteration


def _newton(knobs: Knobs, objective: Objective) -> None:
    """Newton's method from the best turn of the knobs of a population: each step is the smallest that should meet the target."""
    low, high = np.array(knobs.bounds).T
    smooth, width = knobs.smooth, high - low
    for _ in range(NEWTONS):
        start = objective.recent
        side = np.where(start.values + DIFFERENCE * width > high, -DIFFERENCE, DIFFERENCE)[smooth]
        moved = np.repeat(start.values[None], len(smooth), axis=0)
        moved[np.arange(len(smooth)), smooth] += side * width[smooth]
        off, _ = objective.of(moved)
        slopes = ((off - start.off) / side[:, None]).T  # (2, smooth) m, over the ranges of the knobs
        step = -np.linalg.pinv(slopes) @ start.off * width[smooth]
        steps = np.repeat(start.values[None], len(SHARES), axis=0)
        steps[:, smooth] = np.clip(steps[:, smooth] + np.outer(SHARES, step), low[smooth], high[smooth])
        objective.of(steps)
        if objective.reached or objective.recent.cost > PROGRESS * start.cost:
            return
