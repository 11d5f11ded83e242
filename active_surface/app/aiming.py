"""Aiming: the search for drives that bring the part to a clicked target, watched as it goes on."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Final

from active_surface.steering import Aimed, Task, aim_over, prepared
from coupling.case import Case, length_text
from particle import Trajectory

APART: Final = 0.2  # s, of looks at the search

Watch = Callable[[int, int, Trajectory | None], object]
"""Gets how many paths were followed, and of how many, and the path of the best drives."""


class Search:
    """A search that another thread can stop."""

    def __init__(self, case: Case, target: tuple[float, float]) -> None:
        self.case, self.target = case, target
        self._stopped = False

    def run(self, watch: Watch) -> Aimed | None:
        """Search; None where it was stopped before there were any drives.

        Raises ValueError where the target cannot be reached, or the case cannot be run.
        """
        task = Task(self.case, self.target)
        looked, counts = 0.0, (0, 0)

        def tell(done: int, of: int) -> None:
            nonlocal counts
            counts = done, of
            if self._stopped:
                raise KeyboardInterrupt  # the best so far counts

        def watched(look: Callable[[], Trajectory | None]) -> None:
            nonlocal looked
            if time.monotonic() - looked >= APART:
                looked = time.monotonic()
                watch(*counts, look())

        try:
            return aim_over(prepared(task.case, task.settings), task, tell=tell, watch=watched)
        except KeyboardInterrupt:
            return None

    def stop(self) -> None:
        """End the search with the best drives so far."""
        self._stopped = True

    def text(self, result: Aimed) -> str:
        """How near the drives bring the part."""
        away = length_text(result.distance)
        return f"After {result.paths} paths the part ends {away} from the target."
