"""Following a plan: after each leg a measured place replaces the planned one, and the next leg is aimed from there."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from active_surface.steering.aiming import aim_over
from active_surface.steering.objectives import prepared
from active_surface.steering.result import Aimed
from active_surface.steering.task import Place, Route, Task
from coupling import ProgressCallback, no_progress
from coupling.case import Case

ATTEMPTS = 3  # legs to one way-point, at most

Measure = Callable[[Case], Sequence[float]]
"""Drives the part as a case says and returns where it is then, (x, y) m."""


class Progress(NamedTuple):
    """Which way-point the next leg goes to, and from where."""

    place: Place  # m
    ends: tuple[Place, ...] = ()  # m, where the part was last on the way to each way-point that is done
    attempt: int = 0  # for the next one

    @property
    def way_point(self) -> int:
        """The number of the next way-point, which is that of all where none is left."""
        return len(self.ends)


@dataclass(frozen=True, eq=False, kw_only=True)
class Followed:
    """A plan that was followed leg by leg.

    Parameters
    ----------
    legs : tuple of Aimed
        Each leg's drives and its computed path, from the place measured before it.
    way_points : tuple of int
        The way-point of each leg.
    measured : tuple of points
        Where the part was after each leg, m.
    ends : tuple of points
        Where it was last on the way to each way-point that is done, m.
    failure : str
        Why the plan ended before its last way-point; empty if it did not.
    """

    route: Route
    legs: tuple[Aimed, ...]
    way_points: tuple[int, ...]
    measured: tuple[Place, ...]
    ends: tuple[Place, ...]
    failure: str = ""

    @property
    def distances(self) -> list[float]:
        """From where the part was measured last on the way to each way-point to that [m]; of those that are done."""
        return self.route.distances(self.ends)

    @property
    def complete(self) -> bool:
        """Whether the part was measured within the tolerance of every way-point."""
        done = len(self.ends) == len(self.route.through)
        return done and all(distance <= self.route.settings.tolerance for distance in self.distances)


def follow_plan(
    route: Route,
    measure: Measure,
    attempts: int = ATTEMPTS,
    threads: int | None = None,
    tell: ProgressCallback = no_progress,
) -> Followed:
    """Carry a part over way-points in a closed loop: aim a leg, drive it, measure, and aim the next from there.

    Parameters
    ----------
    route : Route
        The case and its way-points.
    measure : callable
        Called with the case of each leg, whose drives bring the part from the place measured last to a way-point;
        drives the device and returns where the part is then, (x, y) in m.
    attempts : int
        Number of legs to a way-point at most. Another follows where the part is measured beyond the tolerance.
    threads : int, optional
        Number of paths at a time, by default one on each processor; the result is the same for any.
    tell : callable
        Called with the number of paths so far, and the largest number of paths, of each leg.

    Returns
    -------
    followed : Followed
        All legs, and the places measured after them.

    Raises
    ------
    ValueError
        The case cannot be run, `attempts` is less than 1, or `measure` returns no place.
    """
    surface = prepared(route.case, route.settings)
    legs: list[Aimed] = []
    way_points: list[int] = []
    measured: list[Place] = []
    failure = ""
    while (progress := progress_of(route, measured, attempts)).way_point < len(route.through):
        try:
            result = aim_over(surface, route.leg(progress.way_point, progress.place, len(measured)), threads, tell)
        except ValueError as error:
            failure = f"leg {len(measured)}: {error}"
            break
        if result.interrupted:  # no device is driven after Ctrl-C
            failure = f"leg {len(measured)}: interrupted"
            break
        legs.append(result)
        way_points.append(progress.way_point)
        measured.append(_place(measure(result.case)))
    return Followed(
        route=route,
        legs=tuple(legs),
        way_points=tuple(way_points),
        measured=tuple(measured),
        ends=progress.ends,
        failure=failure,
    )


def progress_of(route: Route, measured: Sequence[Place], attempts: int = ATTEMPTS) -> Progress:
    """What comes after the places [m] measured so far, one after each leg.

    A way-point is done when the part is within the tolerance of it, or after so many attempts.
    """
    if attempts < 1:
        raise ValueError(f"attempts must be at least 1; got {attempts}")
    progress, tolerance = Progress(route.case.part.position), route.settings.tolerance
    for place in measured:
        if progress.way_point == len(route.through):
            raise ValueError(
                f"measured must end with the plan; got {len(measured)} places, of which the last has no leg"
            )
        arrived = math.dist(place, route.through[progress.way_point]) <= tolerance
        ends, attempt = progress.ends, progress.attempt + 1
        if arrived or attempt == attempts:
            ends, attempt = (*ends, place), 0
            # A way-point where the part is already needs no leg.
            while len(ends) < len(route.through) and math.dist(place, route.through[len(ends)]) <= tolerance:
                ends = (*ends, place)
        progress = Progress(place, ends, attempt)
    return progress


def next_leg(route: Route, measured: Sequence[Place], attempts: int = ATTEMPTS) -> Task | None:
    """The task of the leg after the places [m] measured so far; None where every way-point is done.

    Raises ValueError where there are too many places, or the way-point cannot be reached from the last.
    """
    progress = progress_of(route, measured, attempts)
    if progress.way_point == len(route.through):
        return None
    return route.leg(progress.way_point, progress.place, len(measured))


def _place(measured: Sequence[float]) -> Place:
    place = tuple(float(x) for x in measured)
    if len(place) != 2 or not all(map(math.isfinite, place)):
        raise ValueError(f"measure must return two finite lengths, x and y in m; got {measured}")
    return place[0], place[1]
