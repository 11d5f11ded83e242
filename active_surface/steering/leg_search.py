"""The search for the drives of one leg: from where a part starts or rests to a target."""

from __future__ import annotations

import numpy as np

from active_surface.steering.knobs import Knobs
from active_surface.steering.objective import Objective
from active_surface.steering.paths import Paths
from active_surface.steering.schedule import Leg
from active_surface.steering.search import NEWTON_RANGE, search, search_robust
from active_surface.steering.task import Task
from coupling import ProgressCallback
from particle import SurfaceMotion


class LegSearch:
    """Finds the drives that bring a part to a task's target within its case's duration, on few enough paths."""

    def __init__(
        self,
        surface: SurfaceMotion,
        task: Task,
        threads: int | None,
        tell: ProgressCallback,
        max_paths: int,
        number: int = 0,
    ) -> None:
        """number: of the search; each number has its own stream of random numbers."""
        self._newton_range, self._movers = NEWTON_RANGE * surface.size, task.movers
        self._seed = task.settings.seed, number
        self._paths, self._knobs = Paths(task.case, surface, threads), Knobs(task.case, task.settings, self._movers)
        self._robust: Objective | None = None
        if task.settings.quantile is not None:
            self._robust = Objective(task, self._knobs, self._paths, tell, max_paths, disturbed=True)
            max_paths = max(max_paths // 2, 1)
        self._nominal = Objective(task, self._knobs, self._paths, tell, max_paths)

    def run(self) -> None:
        """Search until the target is reached or the paths are used up; after Ctrl-C the best so far counts."""
        if self._robust is None:
            search(self._knobs, self._nominal, self._newton_range, self._seed)
        else:
            search_robust(self._knobs, self._nominal, self._robust, self._newton_range, self._seed)

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
