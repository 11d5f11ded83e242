"""Rerun: a saved run repeated, and whether that comes to the same end."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

from coupling.environment import versions
from coupling.progress import Progress, silent
from coupling.result import Result
from coupling.results import SavedRun
from coupling.run import run_case


@dataclass(frozen=True, eq=False)
class Rerun:
    """A run and its repetition."""

    saved: SavedRun
    result: Result
    changed: dict[str, tuple[str, str]] = field(default_factory=dict)  # versions then and now, where they differ

    @property
    def same_end(self) -> bool:
        """Whether both end at the same time and place, bit for bit."""
        return self._end == (self.result.summary.end_time, *self.result.summary.end_position)

    @property
    def moved(self) -> float:
        """How far [m] the ends are from each other."""
        return math.dist(self._end[1:], self.result.summary.end_position)

    @property
    def _end(self) -> tuple[float, float, float]:
        return (self.saved.summary["end_time"], *self.saved.summary["end_position"])


def rerun(saved: SavedRun, output: str | Path | None = None, progress: Progress = silent) -> Rerun:
    """Run the case of a saved run again; output: as of `run_case`.

    Raises ValueError when the output is the folder of the saved run, whose files would be replaced.
    """
    if output is not None and Path(output).resolve() == saved.part_path.parent.resolve():
        raise ValueError(f"Input output of rerun must be another folder than that of the result; got {output}")
    now = versions()
    changed = {key: (old, now.get(key, "none")) for key, old in saved.versions.items() if now.get(key) != old}
    return Rerun(saved, run_case(saved.case, output, progress), changed)
