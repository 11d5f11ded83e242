"""One plan, from route to schedule: this file reads as the pipeline.

route -> surface -> leg by leg: task -> aim -> schedule so far -> place reached -> case file and picture
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np

from coupling.case import Case
from coupling.case_text import write_case
from coupling.progress import Tell, interruptible, untold
from coupling.run import build_scene
from coupling.units import shown_length
from particle import SurfaceMotion, Trajectory
from steering.aimed import path_of, scattered
from steering.aiming import aim_over
from steering.paths import Paths
from steering.picture import draw_path_and_ends
from steering.route import Route
from steering.scatter import Scatter
from steering.schedule import Leg, lasting, scheduled

PAUSE = 5e-4  # s, at rest between legs
STEP = 1e-6  # s, of which times of legs are multiples


@dataclass(frozen=True, eq=False)
class Planned:
    """The case with the schedule that was found, its path, and what became of each leg; `files` were written.

    arrivals: s, when the part rests at each way-point.  paths: how many were followed to find the schedule.
    interrupted: whether the search was stopped before its end. A plan that was stopped, or whose part was lost, has
    less arrivals than way-points.
    """

    route: Route
    case: Case
    trajectory: Trajectory = field(repr=False)
    arrivals: tuple[float, ...]
    scatter: Scatter = field(repr=False)
    paths: int
    interrupted: bool = False
    files: tuple[Path, ...] = ()

    @property
    def distances(self) -> list[float]:
        """From the part to each way-point [m] when it has arrived there."""
        there = self.trajectory.at(self.arrivals).position
        return [float(np.hypot(*off)) for off in there - self.route.through[: len(self.arrivals)]]

    @property
    def complete(self) -> bool:
        """Whether there is a leg to every way-point."""
        return len(self.arrivals) == len(self.route.through)


def plan(route: Route, output: str | Path | None = None, threads: int | None = None, tell: Tell = untold) -> Planned:
    """Find the drives that carry a part over way-points; with `output`, write NAME_planned.toml and NAME_plan.png.

    threads: how many paths are found at a time, by default one on each processor; the result is the same for any.
    tell: gets how many paths have been found, and of how many at most.
    Upon Ctrl-C the legs so far count, if there is one.
    """
    surface = interruptible(build_scene, route.case).surface
    found = plan_over(surface, route, threads, tell)
    if output is None:
        return found
    folder, through = Path(output), route.through[: len(found.arrivals)]
    places = ", ".join(f"({shown_length(x)}, {shown_length(y)})" for x, y in through)
    file = write_case(found.case, folder / f"{route.name}_planned.toml", f"The drives carry the part over {places}.")
    picture = folder / f"{route.name}_plan.png"
    draw_path_and_ends(route.name, found.case, found.trajectory, through, found.scatter, picture)
    return replace(found, files=(file, picture))


def plan_over(surface: SurfaceMotion, route: Route, threads: int | None = None, tell: Tell = untold) -> Planned:
    """The same over a surface that is there already."""
    start, now, used, interrupted = route.case.part.position, 0.0, 0, False
    legs: list[Leg] = []
    arrivals: list[float] = []
    for number in range(len(route.through)):
        task = route.leg(number, start)
        try:
            found = aim_over(surface, task, threads, partial(_tell_leg, tell, number, len(route.through)))
        except KeyboardInterrupt:
            if not legs:
                raise
            interrupted = True
            break
        used += found.paths
        legs.append(Leg(now, found.case.actuators, task.movers))
        rest = found.trajectory.at_rest_since
        last = max(lasting(found.case.actuators, task.movers), task.case.run.duration if rest is None else rest)
        now = round(now + math.ceil((last + PAUSE) / STEP) * STEP, 9)
        whole = scheduled(route.case, legs, now).model_copy(update={"name": f"{route.name}_planned"})
        path = path_of(Paths(whole, surface, threads), whole)
        arrivals.append(now)
        if path.at_rest_since is None or found.interrupted:
            interrupted = found.interrupted
            break
        x, y = path.position[-1].tolist()
        start = (x, y)
    settings, target = route.settings, route.through[len(arrivals) - 1]
    scatter = scattered(Paths(whole, surface, threads), whole, target, settings.scatter, settings.seed)
    return Planned(route, whole, path, tuple(arrivals), scatter, used, interrupted)


def _tell_leg(tell: Tell, leg: int, legs: int, done: int, of: int) -> None:
    tell(leg * of + done, legs * of)
