"""The search of aims by scipy's differential evolution in place of CMA-ES, to compare with: docs/decisions/0026."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.optimize import differential_evolution

from active_surface.arrays import FloatArray
from active_surface.steering.knobs import Knobs
from active_surface.steering.objectives import Trials
from active_surface.steering.search import PROGRESS, Seed, _newton

POPULATION = 8  # times the number of knobs
CONVERGED = 0.01  # spread of a population, of its mean cost, at which another one begins
PATIENCE = 5  # generations without PROGRESS before another population begins


def search(knobs: Knobs, trials: Trials, newton_range: float, seed: Seed, start: FloatArray | None = None) -> None:
    """Minimise the cost of trials, with the arguments of the program's own search; `start` is tried and left."""
    if not knobs.knobs or start is not None:
        trials.of((np.zeros(0) if start is None else start)[None])
    populations = 0
    while knobs.knobs and not (trials.reached or trials.exhausted):
        trials.forget()
        differential_evolution(
            lambda values: trials.of(values.T)[1],
            knobs.bounds,
            strategy="best1bin",
            popsize=POPULATION,
            maxiter=10_000,
            tol=CONVERGED,
            rng=np.random.default_rng((*seed, populations)),
            polish=False,
            vectorized=True,
            updating="deferred",
            callback=_Watch(knobs, trials, newton_range),
        )
        populations += 1


class _Watch:
    """After each generation: improves its best by Newton's method, and ends a population without progress."""

    def __init__(self, knobs: Knobs, trials: Trials, newton_range: float) -> None:
        self._knobs, self._trials, self._newton_range = knobs, trials, newton_range
        self._tried, self._before, self._idle = np.inf, np.inf, 0

    def __call__(self, intermediate_result: Any) -> None:
        trials = self._trials
        if not trials.reached and trials.recent.cost <= min(self._newton_range, self._tried * (1 - 1e-9)):
            _newton(self._knobs, trials)
            self._tried = trials.recent.cost
        improved = trials.recent.cost < PROGRESS * self._before
        self._idle = 0 if improved else self._idle + 1
        self._before = trials.recent.cost if improved else self._before
        if trials.reached or trials.exhausted or self._idle >= PATIENCE:
            raise StopIteration
