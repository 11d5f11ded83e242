"""Planned: what a plan found."""

from __future__ import annotations

import math
from dataclasses import dataclass

from steering.found import Found
from steering.route import Route


@dataclass(frozen=True, eq=False, kw_only=True)
class Planned(Found):
    """The case with the schedule that was found, its path, and what became of each leg.

    arrivals: s, when the part rests for good at each way-point, or beside it.  failure: why there are less of them than
    way-points; "": there are not, or Ctrl-C came.
    """

    route: Route
    arrivals: tuple[float, ...]
    failure: str = ""

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
