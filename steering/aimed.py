"""Aimed: what a search found."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from coupling.case import Case
from particle import Trajectory
from steering.paths import Disturbance, Paths
from steering.scatter import TOLD, Scatter, disturbances
from steering.task import Task


@dataclass(frozen=True, eq=False)
class Aimed:
    """The case with the drives that were found, its path, and how far it ends from the target; `files` were written.

    paths: how many were followed to find it.  interrupted: whether the search was stopped before its end.
    """

    task: Task
    case: Case
    trajectory: Trajectory = field(repr=False)
    scatter: Scatter = field(repr=False)
    paths: int
    interrupted: bool = False
    files: tuple[Path, ...] = ()

    @property
    def distance(self) -> float:
        """From the path's end to the target [m]."""
        return float(np.hypot(*(self.trajectory.position[-1] - self.task.target)))

    @property
    def reached(self) -> bool:
        """Whether the part ends within the tolerance of the target."""
        return self.distance <= self.task.settings.tolerance


def scattered(paths: Paths, case: Case, target: tuple[float, float], count: int, seed: int) -> Scatter:
    """The ends of so many disturbed runs of a case, and their distances from a target [m]."""
    ways = disturbances(count, len(case.actuators), seed, TOLD)
    found = paths.of([(case.actuators, way) for way in ways])
    ends = np.array([path.position[-1] for path in found])
    lost = sum(path.time[-1] < case.run.duration for path in found)
    return Scatter(ends, np.hypot(*(ends - target).T), int(lost))


def path_of(paths: Paths, case: Case) -> Trajectory:
    """The path of a case."""
    return paths.of([(case.actuators, Disturbance())])[0]
