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

from active_surface.steering.knobs import Knobs
from active_surface.steering.objective import Objective

FloatArray = NDArray[np.float64]
Seed = tuple[int, ...]

POPULATION = 8  # to a knob
CONVERGED = 0.01  # of the mean cost: where all of a population are so close, another one begins
MOST_GENERATIONS = 10_000
AROUND = 0.1  # of a knob's range is how far a robust drive is looked for around what there is
NEAR = 0.1  # of the surface's size, from where on Newton's method is tried
PATIENCE = 5  # generations that leave more than PROGRESS of the cost: then another population begins
NEWTONS = 8  # of its steps, at most
DIFFERENCE = 1e-5  # of a knob's range
SHARES = (1.0, 0.7, 0.5, 0.35, 0.25, 0.12, 0.06, 0.03)  # of a step, all of which are tried
PROGRESS = 0.8  # of the cost before: where a step leaves more, it was the last


def search(knobs: Knobs, objective: Objective, near: float, seed: Seed) -> None:
    """Makes an objective small: until it is within the tolerance, or there have been as many paths as there may be.

    near: m, from the target, from where on Newton's method is tried. The same for the same seed.
    """
    populations = 0
    if not knobs.knobs:
        objective.of(np.zeros((1, 0)))
        return
    while not (objective.reached or objective.exhausted):
        _evolve(knobs, objective, near, (*seed, populations))
        populations += 1


def search_robust(knobs: Knobs, nominal: Objective, robust: Objective, near: float, seed: Seed) -> None:
    """Makes a robust objective small, from drives that reach the target if nothing disturbs them.

    As many of these are found as the nominal objective allows. Around the one that is most robust evolution goes on.
    """
    populations = 0
    if not knobs.knobs:
        robust.of(np.zeros((1, 0)))
        return
    while not nominal.exhausted:
        _evolve(knobs, nominal, near, (*seed, populations))
        robust.of(nominal.recent.values[None])
        populations += 1
    if robust.exhausted:
        return
    low, high = np.array(knobs.bounds).T
    middle, reach = robust.best.values, AROUND * (high - low)
    box = list(zip(np.maximum(low, middle - reach), np.minimum(high, middle + reach), strict=True))
    robust.forget()
    _minimise(box, robust, (*seed, populations), _Watch(knobs, robust, 0.0), middle)


def _evolve(knobs: Knobs, objective: Objective, near: float, seed: Seed) -> None:
    """Goes on with a new population until it does not get on any more."""
    objective.forget()
    _minimise(knobs.bounds, objective, seed, _Watch(knobs, objective, near))


def _minimise(
    bounds: list[tuple[float, float]],
    objective: Objective,
    seed: Seed,
    watch: _Watch,
    first: FloatArray | None = None,
) -> None:
    differential_evolution(
        lambda values: objective.of(values.T)[1],
        bounds,
        strategy="best1bin",
        popsize=POPULATION,
        maxiter=MOST_GENERATIONS,
        tol=CONVERGED,
        rng=np.random.default_rng(seed),
        polish=False,
        vectorized=True,
        updating="deferred",
        callback=watch,
        x0=first,
    )


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
        gets_on = objective.recent.cost < PROGRESS * self._before
        self._idle = 0 if gets_on else self._idle + 1
        self._before = objective.recent.cost if gets_on else self._before
        if objective.reached or objective.exhausted or self._idle >= PATIENCE:
            raise StopIteration


def _newton(knobs: Knobs, objective: Objective) -> None:
    """Newton's method from the best turn of a population: each step is the smallest that should meet the target."""
    low, high = np.array(knobs.bounds).T
    smooth, width = knobs.smooth, high - low
    if not len(smooth):
        return
    for _ in range(NEWTONS):
        start = objective.recent
        side = np.where(start.values + DIFFERENCE * width > high, -DIFFERENCE, DIFFERENCE)[smooth]
        moved = np.repeat(start.values[None], len(smooth), axis=0)
        moved[np.arange(len(smooth)), smooth] += side * width[smooth]
        off, _ = objective.of(moved)
        if objective.exhausted:
            return
        slopes = ((off - start.offset) / side[:, None]).T  # (2, smooth) m, over the ranges of the knobs
        step = -np.linalg.pinv(slopes) @ start.offset * width[smooth]
        steps = np.repeat(start.values[None], len(SHARES), axis=0)
        steps[:, smooth] = np.clip(steps[:, smooth] + np.outer(SHARES, step), low[smooth], high[smooth])
        objective.of(steps)
        if objective.reached or objective.exhausted or objective.recent.cost > PROGRESS * start.cost:
            return
