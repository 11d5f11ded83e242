"""The search for the drives of one leg: from where a part starts or rests to a target."""

from __future__ import annotations

import numpy as np

from active_surface.steering.knobs import Knobs
from active_surface.steering.objective import Objective
from active_surface.steering.paths import Paths
from active_surface.steering.schedule import Leg
from active_surface.steering.search import NEAR, search, search_robust
from active_surface.steering.task import Task
from coupling import Tell
from particle import SurfaceMotion


class LegSearch:
    """Finds the drives that bring a part to a task's target within its case's duration, by so many paths at most."""

    def __init__(
        self, surface: SurfaceMotion, task: Task, threads: int | None, tell: Tell, most: int, number: int = 0
    ) -> None:
        """number: of the search, so that each has random numbers of its own."""
        self._near, self._movers, self._seed = NEAR * surface.size, task.movers, (task.settings.seed, number)
        self._paths, self._knobs = Paths(task.case, surface, threads), Knobs(task.case, task.settings, self._movers)
        self._robust: Objective | None = None
        if task.settings.quantile is not None:
            self._robust = Objective(task, self._knobs, self._paths, tell, most, disturbed=True)
            most = max(most // 2, 1)
        self._nominal = Objective(task, self._knobs, self._paths, tell, most)

    def run(self) -> None:
        """Search until the target is reached or there were enough paths; the best so far counts after Ctrl-C too."""
        if self._robust is None:
            search(self._knobs, self._nominal, self._near, self._seed)
        else:
            search_robust(self._knobs, self._nominal, self._robust, self._near, self._seed)

    @property
    def paths(self) -> int:
        """How many have been followed."""
        return self._paths.count

    @property
    def has_drives(self) -> bool:
        """Whether there are drives."""
        return bool(np.isfinite(self._objective.best.cost))

    def leg(self, start: float) -> Leg:
        """The best drives, from a time [s] on."""
        actuators = self._knobs.actuators(self._objective.best.values)
        return Leg(start, actuators, self._movers)

    @property
    def _objective(self) -> Objective:
        if self._robust is not None and np.isfinite(self._robust.best.cost):
            return self._robust
        return self._nominal
