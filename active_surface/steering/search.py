"""The search for a drive: differential evolution, then Newton's method near the target.

Over a few cycles the end point is a smooth function of strokes, frequencies and delays, except for jumps where the
part rests once more or once less. Evolution finds the smooth piece; Newton's method, with one difference for each
smooth knob, finds the point on it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.optimize import differential_evolution

from active_surface.arrays import FloatArray
from active_surface.steering.knobs import Knobs
from active_surface.steering.objective import Objective

Seed = tuple[int, ...]

POPULATION = 8  # times the number of knobs
CONVERGED = 0.01  # spread of a population, of its mean cost, at which another one begins
MAX_GENERATIONS = 10_000
AROUND = 0.1  # of a knob's range: the search for a robust drive around a nominal one
NEWTON_RANGE = 0.1  # of the surface's size: cost below which Newton's method is tried
PATIENCE = 5  # generations without PROGRESS before another population begins
MAX_STEPS = 8  # of Newton's method
DIFFERENCE = 1e-5  # of a knob's range: step of the differences
SHARES = (1.0, 0.7, 0.5, 0.35, 0.25, 0.12, 0.06, 0.03)  # of a Newton step; all are tried
PROGRESS = 0.8  # of the previous cost; a step that leaves more ends the method


def search(knobs: Knobs, objective: Objective, newton_range: float, seed: Seed) -> None:
    """Minimise an objective until it is within the tolerance or its paths are used up; equal seeds give equal results.

    newton_range: m, the cost below which Newton's method is tried.
    """
    populations = 0
    if not knobs.knobs:
        objective.of(np.zeros((1, 0)))
        return
    while not (objective.reached or objective.exhausted):
        _evolve(knobs, objective, newton_range, (*seed, populations))
        populations += 1


def search_robust(knobs: Knobs, nominal: Objective, robust: Objective, newton_range: float, seed: Seed) -> None:
    """Minimise a robust objective, starting from drives that reach the target undisturbed.

    The nominal objective limits their number. Evolution continues around the most robust one.
    """
    populations = 0
    if not knobs.knobs:
        robust.of(np.zeros((1, 0)))
        return
    while not nominal.exhausted:
        _evolve(knobs, nominal, newton_range, (*seed, populations))
        robust.of(nominal.recent.values[None])
        populations += 1
    if robust.exhausted:
        return
    low, high = np.array(knobs.bounds).T
    middle, reach = robust.best.values, AROUND * (high - low)
    box = list(zip(np.maximum(low, middle - reach), np.minimum(high, middle + reach), strict=True))
    robust.forget()
    _minimise(box, robust, (*seed, populations), _Watch(knobs, robust, 0.0), middle)


def _evolve(knobs: Knobs, objective: Objective, newton_range: float, seed: Seed) -> None:
    """Evolve a new population until it makes no more progress."""
    objective.forget()
    _minimise(knobs.bounds, objective, seed, _Watch(knobs, objective, newton_range))


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
        maxiter=MAX_GENERATIONS,
        tol=CONVERGED,
        rng=np.random.default_rng(seed),
        polish=False,
        vectorized=True,
        updating="deferred",
        callback=watch,
        x0=first,
    )


class _Watch:
    """After each generation: improves its best by Newton's method, and ends a population without progress."""

    def __init__(self, knobs: Knobs, objective: Objective, newton_range: float) -> None:
        self._knobs, self._objective, self._newton_range = knobs, objective, newton_range
        self._tried, self._before, self._idle = np.inf, np.inf, 0

    def __call__(self, intermediate_result: Any) -> None:
        objective = self._objective
        if not objective.reached and objective.recent.cost <= min(self._newton_range, self._tried * (1 - 1e-9)):
            _newton(self._knobs, objective)
            self._tried = objective.recent.cost
        improved = objective.recent.cost < PROGRESS * self._before
        self._idle = 0 if improved else self._idle + 1
        self._before = objective.recent.cost if improved else self._before
        if objective.reached or objective.exhausted or self._idle >= PATIENCE:
            raise StopIteration


def _newton(knobs: Knobs, objective: Objective) -> None:
    """Newton's method from the best setting of a population, by the smallest step that should meet the target."""
    low, high = np.array(knobs.bounds).T
    smooth, width = knobs.smooth, high - low
    if not len(smooth):
        return
    for _ in range(MAX_STEPS):
        start = objective.recent
        side = np.where(start.values + DIFFERENCE * width > high, -DIFFERENCE, DIFFERENCE)[smooth]
        moved = np.repeat(start.values[None], len(smooth), axis=0)
        moved[np.arange(len(smooth)), smooth] += side * width[smooth]
        offsets, _ = objective.of(moved)
        if objective.exhausted:
            return
        slopes = ((offsets - start.offset) / side[:, None]).T  # (2, smooth) m, over the ranges of the knobs
        step = -np.linalg.pinv(slopes) @ start.offset * width[smooth]
        steps = np.repeat(start.values[None], len(SHARES), axis=0)
        steps[:, smooth] = np.clip(steps[:, smooth] + np.outer(SHARES, step), low[smooth], high[smooth])
        objective.of(steps)
        if objective.reached or objective.exhausted or objective.recent.cost > PROGRESS * start.cost:
            return
