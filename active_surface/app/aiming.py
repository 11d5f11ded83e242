"""Aiming: the search for drives that bring the part to a clicked target, watched as it goes on."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Final

from active_surface.steering import Aimed, Settings, Task, aim_over, prepared
from coupling import report
from coupling.case import Case, length_text
from particle import Trajectory

NEARER: Final = 0.99  # of the distance at the start: drives that leave more are not taken
APART: Final = 0.2  # s, of looks at the search

CHOSEN: Final = ("groups", "frequency", "stroke")  # settings that the page has

Watch = Callable[[int, int, float, Trajectory | None], object]
"""Gets how many paths were followed, of how many, how long [s] the others take, and the path of the best drives."""


class Search:
    """A search that another thread can stop."""

    def __init__(self, case: Case, target: tuple[float, float], settings: Settings | None = None) -> None:
        self.case, self.target, self.settings = case, target, settings or Settings()
        self._stopped = False

    def run(self, watch: Watch) -> Aimed | None:
        """Search; None where it was stopped before there were any drives.

        Raises ValueError where the target cannot be reached, or the case cannot be run.
        """
        task = Task(self.case, self.target, self.settings)
        began, looked, counts = time.monotonic(), 0.0, (0, 0)

        def tell(done: int, of: int) -> None:
            nonlocal counts
            counts = done, of
            if self._stopped:
                raise KeyboardInterrupt  # the best so far counts

        def watched(look: Callable[[], Trajectory | None]) -> None:
            nonlocal looked
            if time.monotonic() - looked >= APART:
                (done, of), looked = counts, time.monotonic()
                watch(done, of, (of - done) * (looked - began) / max(done, 1), look())

        try:
            return aim_over(prepared(task.case, task.settings), task, tell=tell, watch=watched)
        except KeyboardInterrupt:
            return None

    def stop(self) -> None:
        """End the search with the best drives so far."""
        self._stopped = True

    def away(self, path: Trajectory) -> str:
        """How far from the target a path ends."""
        return report.with_micro_signs(length_text(math.dist(path.position[-1].tolist(), self.target)))

    def helps(self, result: Aimed) -> bool:
        """Whether the drives bring the part nearer to the target than it starts."""
        return result.distance < NEARER * math.dist(self.case.part.position, self.target)

    def text(self, result: Aimed) -> str:
        """How near the drives bring the part."""
        found = f"After {result.paths} paths the part ends {length_text(result.distance)} from the target"
        found = report.with_micro_signs(found)
        if result.reached:
            return f"{found}."
        if self.helps(result):
            return f"{found}: it is not reached. A longer run, other strokes or a nearer target may help."
        return f"{found}: no drives bring it nearer, and yours stay. Other strokes or a nearer target may help."
