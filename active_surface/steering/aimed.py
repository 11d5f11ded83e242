"""Aimed: what an aim found."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from active_surface.steering.paths import settled
from active_surface.steering.result import SteeringResult
from active_surface.steering.schedule import Leg
from active_surface.steering.task import Task


@dataclass(frozen=True, eq=False, kw_only=True)
class Aimed(SteeringResult):
    """The case with the drives of an aim, its path, and how far it ends from the target.

    Parameters
    ----------
    legs : tuple
        The legs of the way, one after the other. The drives of a single leg are cycles, those of several are
        segments.
    """

    task: Task
    legs: tuple[Leg, ...]

    @property
    def distance(self) -> float:
        """From the path's end to the target [m]."""
        return float(np.hypot(*(self.trajectory.position[-1] - self.task.target)))

    @property
    def reached(self) -> bool:
        """Whether the part comes to rest for good within the tolerance of the target."""
        return self.distance <= self.task.settings.tolerance and settled(self.trajectory)
