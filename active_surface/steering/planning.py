"""One plan, from route to schedule: this file reads as the pipeline.

route -> surface -> leg by leg: task -> approach -> schedule so far -> place reached -> case file -> scatter and picture
"""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path

from active_surface.steering.approach import Approach, next_start
from active_surface.steering.paths import Paths, path_of, settled
from active_surface.steering.picture import draw_plan
from active_surface.steering.result import Planned
from active_surface.steering.route import Route
from active_surface.steering.schedule import Leg, scheduled
from active_surface.steering.stages import check_free, drawn, prepared, searched, with_scatter
from coupling import ProgressCallback, no_progress
from coupling.case import Case, length_text
from particle import SurfaceMotion, Trajectory


def plan(
    route: Route,
    output: str | Path | None = None,
    threads: int | None = None,
    tell: ProgressCallback = no_progress,
    overwrite: bool = False,
) -> Planned:
    """Find the drives that carry a part over way-points.

    Upon Ctrl-C the legs so far count, if there are any.

    Parameters
    ----------
    route : Route
        The case and its way-points.
    output : path, optional
        Folder for NAME_planned.toml and NAME_plan.png.
    threads : int, optional
        Number of paths at a time, by default one on each processor; the result is the same for any.
    tell : callable
        Called with the number of paths so far, and the largest number of paths.
    overwrite : bool
        Replace those files.

    Returns
    -------
    planned : Planned
        The schedule, and how each leg ended.

    Raises
    ------
    ValueError
        The case cannot be run, or those files exist and are not to be replaced.
    KeyboardInterrupt
        Ctrl-C before there are any legs.
    """
    if output is None:
        return plan_over(prepared(route.case, route.settings), route, threads, tell)
    file, picture = Path(output) / f"{route.name}_planned.toml", Path(output) / f"{route.name}_plan.png"
    check_free((file, picture), overwrite)
    return drawn(plan_over(prepared(route.case, route.settings), route, threads, tell, file), draw_plan, picture)


def plan_over(
    surface: SurfaceMotion,
    route: Route,
    threads: int | None = None,
    tell: ProgressCallback = no_progress,
    file: Path | None = None,
) -> Planned:
    """The same over an existing surface; writes a case file at most, before it looks at the scatter."""
    work = _Work(surface, route, threads, tell)
    result = searched(work.run, work.close, file, _comment)
    return with_scatter(result, Paths(result.case, surface, threads), result.targets[-1], route.settings)


class _Work:
    """The legs of a plan, as they are found."""

    def __init__(self, surface: SurfaceMotion, route: Route, threads: int | None, tell: ProgressCallback) -> None:
        self._surface, self._route, self._threads, self._tell = surface, route, threads, tell
        self._approach: Approach | None = None
        self._legs: tuple[Leg, ...] = ()
        self._arrivals: tuple[float, ...] = ()
        self._now, self._paths, self._tried, self._failure = 0.0, 0, 0, ""
        self._whole: tuple[Case, Trajectory] | None = None

    def run(self) -> None:
        """Find leg after leg, until one fails; after Ctrl-C `close` has those so far."""
        route, place = self._route, self._route.case.part.position
        for number, target in enumerate(route.through):
            if number and math.dist(place, target) <= route.settings.tolerance:
                self._stay()
                continue
            try:
                task = route.leg(number, place)
            except ValueError as error:
                self._failure = f"leg {number}: {error}"
                return
            tell = partial(_tell_leg, self._tell, number, len(route.through))
            self._approach = Approach(self._surface, task, self._threads, tell, joined=True)
            self._approach.run()
            path = self._end_leg()
            if self._failure:
                return
            x, y = path.position[-1].tolist()
            place = (x, y)

    def _stay(self) -> None:
        """Count a way-point where the part rests already as reached, without a leg."""
        self._arrivals, self._tried = (*self._arrivals, self._now), self._tried + 1

    def close(self) -> Planned:
        """What was found; KeyboardInterrupt where there is nothing."""
        if self._approach is not None:
            try:
                self._end_leg()
            except KeyboardInterrupt:
                if not self._legs:
                    raise
        assert self._whole is not None
        case, path = self._whole
        return Planned(
            route=self._route,
            case=case,
            trajectory=path,
            arrivals=self._arrivals,
            tried=self._tried,
            paths=self._paths,
            failure=self._failure,
        )

    def _end_leg(self) -> Trajectory:
        """Take the leg that is under way into the schedule, and find out where the whole of it leads."""
        assert self._approach is not None
        approach, self._approach = self._approach, None
        self._paths += approach.paths
        way = approach.close()
        end = round(self._now + next_start(way.legs, way.path), 9)
        self._legs += tuple(leg._replace(start=leg.start + self._now) for leg in way.legs)
        case = scheduled(self._route.case, self._legs, end)
        case = case.model_copy(update={"name": f"{self._route.name}_planned"})
        path = path_of(Paths(case, self._surface, self._threads), case)
        self._whole, self._tried = (case, path), self._tried + 1
        if settled(path):
            self._arrivals, self._now = (*self._arrivals, end), end
        else:
            self._failure = f"leg {len(self._arrivals)}: {path.sentence} At {path.time[-1] * 1e3:g} ms."
        return path


def _comment(result: Planned) -> str:
    """What a file of the drives begins with: how near they bring the part to each way-point, and why no farther."""
    legs = zip(result.route.through, result.distances, strict=False)
    places = [f"({length_text(x)}, {length_text(y)}) but for {length_text(off)}" for (x, y), off in legs]
    sentences = [f"The drives carry the part over {', '.join(places)}."] if places else []
    return "\n".join([*sentences, result.failure] if result.failure else sentences)


def _tell_leg(tell: ProgressCallback, leg: int, legs: int, done: int, of: int) -> None:
    tell(leg * of + done, legs * of)
