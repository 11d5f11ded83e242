"""Error estimates of finite-element solutions, and refinement to a tolerance."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Self, TypeVar

import numpy as np

from fem_plate.elements import GAIN, PlateFunctions

MAX_UNKNOWNS = 100_000  # refinement to a tolerance stops here


class Estimated:
    """A solution on one mesh that can estimate its own error."""

    functions: PlateFunctions
    size: float  # m, the length that makes the functions dimensionless
    refine: Callable[[], Self]  # solves again on cells of half the size
    rounding: float = 0.0  # error of w that finer cells have as well, relative as the estimate

    @property
    def unknowns(self) -> int:
        """Number of unknowns of the mesh."""
        return self.functions.space.unknowns

    @cached_property
    def error_estimate(self) -> float:
        """Estimated largest error of w, relative to each function's largest deflection.

        It is the difference from the solution on cells of half the size, which is computed on first use, and rounding.
        """
        return self.refine().difference(self) + self.rounding

    def difference(self, coarser: Estimated) -> float:
        """The largest difference from a solution on another mesh, at this mesh's points, relative as the estimate."""
        x = self.functions.space.points
        w = self.functions.values(x)
        # New points on a curved rim may make the refined mesh's box, and so its size, a little larger.
        w_coarser = coarser.functions.values(x * (self.size / coarser.size))
        largest = np.abs(w).max(axis=0)
        return float(np.max(np.abs(w - w_coarser) / np.where(largest > 0, largest, 1.0)))


Solution = TypeVar("Solution", bound=Estimated)


def refined(solve: Callable[[int], Solution], tolerance: float | None, gain: float = GAIN) -> Solution:
    """The solution on cells halved as often as the tolerance requires; without one, on the cells as they are.

    solve: takes the number of halvings.  gain: what a halving divides the error of w by, at least.
    """

    def on_halved(times: int) -> Solution:
        found = solve(times)
        found.refine = lambda: on_halved(times + 1)
        return found

    solution = on_halved(0)
    if tolerance is None:
        return solution
    change, halvings = np.inf, 0
    least = tolerance + solution.rounding  # finer cells do not lessen rounding
    while 4 * solution.unknowns < MAX_UNKNOWNS and (not halvings or solution.error_estimate > least):
        halvings += 1
        coarse, solution = solution, on_halved(halvings)
        last_change, change = change, solution.difference(coarse)
        solution.error_estimate = change * max(change / last_change, 1 / gain) + solution.rounding
        if change > last_change / 2:
            # Halving gains no more: the rest is rounding, or the estimates were too optimistic.
            coarse.error_estimate, solution.error_estimate = (e + solution.rounding for e in (last_change, change))
            return coarse if last_change < change else solution
    return solution
