"""Planned: what a plan found."""

from __future__ import annotations

import math
from dataclasses import dataclass

from active_surface.steering.result import SteeringResult
from active_surface.steering.route import Place, Route


@dataclass(frozen=True, eq=False, kw_only=True)
class Planned(SteeringResult):
    """The case with the schedule of a plan, its path, and how each leg ended.

    Parameters
    ----------
    arrivals : tuple of float
        When the part comes to rest for good at each way-point, or beside it, s.
    tried : int
        Number of way-points with drives, including one on whose way the path failed.
    failure : str
        Why there are fewer arrivals than way-points; empty if there are not, or if Ctrl-C came.
    """

    route: Route
    arrivals: tuple[float, ...]
    tried: int
    failure: str = ""

    @property
    def targets(self) -> tuple[Place, ...]:
        """The way-points [m] for which there are drives: the last of them is where these are to end."""
        return self.route.through[: self.tried]

    @property
    def distances(self) -> list[float]:
        """From the part to each way-point [m] when it has arrived there."""
        there = self.trajectory.at(self.arrivals).position
        ways = zip(there.tolist(), self.route.through, strict=False)  # to those where it has arrived
        return [math.dist(place, target) for place, target in ways]

    @property
    def reached(self) -> list[bool]:
        """Whether it arrived at each way-point within the tolerance."""
        return [distance <= self.route.settings.tolerance for distance in self.distances]

    @property
    def complete(self) -> bool:
        """Whether every way-point was reached, within the tolerance."""
        return len(self.arrivals) == len(self.route.through) and all(self.reached)
