"""Aims and plans, from task or route to drives: this file reads as the pipeline.

task -> surface -> approach, leg by leg: knobs, search -> case and path -> case file -> scatter and picture. A plan
makes one approach after the other, and the schedule of all their legs.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TypeVar

import numpy as np

from active_surface.steering.legs import Approach, Leg, scheduled
from active_surface.steering.objectives import prepared
from active_surface.steering.paths import Paths, affordable, path_of, settled
from active_surface.steering.picture import draw_aim, draw_plan
from active_surface.steering.probes import Unmoved
from active_surface.steering.result import Aimed, Planned, SteeringResult
from active_surface.steering.robustness import REPORTED, Scatter, deviations, draws
from active_surface.steering.task import Route, Task, end_of
from coupling import ProgressCallback, check_free, doing, no_progress, run_case, warnings
from coupling.case import write_case
from particle import SurfaceMotion, Trajectory, interruptible, unbroken

SCATTERED, FEW = 100, 25  # disturbed runs, and how many there are at least where runs are long
SCATTERED_CYCLES = 20_000  # in all of them

Kind = TypeVar("Kind", Aimed, Planned)


def aim(
    task: Task,
    output: str | Path | None = None,
    threads: int | None = None,
    tell: ProgressCallback = no_progress,
    overwrite: bool = False,
) -> Aimed:
    """Find the drives that bring a part to a target.

    Upon Ctrl-C the best drives so far count, if there are any.

    Parameters
    ----------
    task : Task
        The case and its target.
    output : path, optional
        Folder for NAME_aimed.toml and NAME_aim.png.
    threads : int, optional
        Number of paths at a time, by default one on each processor; the result is the same for any.
    tell : callable
        Called with the number of paths so far, and the largest number of paths.
    overwrite : bool
        Replace those files.

    Returns
    -------
    aimed : Aimed
        The drives, and how near the part comes.

    Raises
    ------
    ValueError
        The case cannot be run, or those files exist and are not to be replaced.
    KeyboardInterrupt
        Ctrl-C before there are any drives.
    """
    files = _files(task, output, "aimed", "aim", overwrite)
    found = aim_over(prepared(task.case, task.settings), task, threads, tell, files[0] if files else None)
    return _drawn(found, draw_aim, files[1]) if files else found


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
    files = _files(route, output, "planned", "plan", overwrite)
    found = plan_over(prepared(route.case, route.settings), route, threads, tell, files[0] if files else None)
    return _drawn(found, draw_plan, files[1]) if files else found


def aim_over(
    surface: SurfaceMotion,
    task: Task,
    threads: int | None = None,
    tell: ProgressCallback = no_progress,
    file: Path | None = None,
    watch: Callable[[Callable[[], Trajectory | None]], object] | None = None,
) -> Aimed:
    """The same as `aim` over an existing surface; writes a case file at most, before it looks at the scatter.

    watch: gets, after each batch of paths, what finds the path of the best drives so far.
    """

    def count(done: int, of: int) -> None:
        tell(done, of)
        if watch is not None:
            watch(approach.look)

    def result() -> Aimed | None:
        if (way := approach.best) is None:
            return None
        case = way.case.model_copy(update={"name": f"{task.name}_aimed"})
        return Aimed(task=task, case=case, trajectory=way.path, legs=way.legs, stops=way.stops, paths=approach.paths)

    approach = Approach(surface, task, threads, count)
    return _found(approach.run, result, file, surface, threads, tell)


def plan_over(
    surface: SurfaceMotion,
    route: Route,
    threads: int | None = None,
    tell: ProgressCallback = no_progress,
    file: Path | None = None,
) -> Planned:
    """The same as `plan` over an existing surface; writes a case file at most, before it looks at the scatter."""
    work = _Plan(surface, route, threads, tell)
    return _found(work.run, lambda: work.planned, file, surface, threads, tell)


class _Plan:
    """A plan, as its legs are found; `planned` has those so far, also after Ctrl-C."""

    def __init__(self, surface: SurfaceMotion, route: Route, threads: int | None, tell: ProgressCallback) -> None:
        self._surface, self._route, self._threads, self._tell = surface, route, threads, tell
        self._legs: tuple[Leg, ...] = ()
        self.planned: Planned | None = None

    def run(self) -> None:
        """Find leg after leg, until one fails."""
        route, place = self._route, self._route.case.part.position
        for number, target in enumerate(route.through):
            if done := self.planned:
                if done.failure:
                    return
                place = end_of(done.trajectory)
                if math.dist(place, target) <= route.settings.tolerance:  # the part rests there already
                    arrivals, stops = (*done.arrivals, done.arrivals[-1]), (*done.stops, ())
                    self.planned = replace(done, arrivals=arrivals, stops=stops, tried=done.tried + 1)
                    continue
            try:
                task = route.leg(number, place)
            except ValueError as error:
                assert done  # the first leg was checked with the route
                self.planned = replace(done, failure=f"leg {number}: {error}")
                return
            tell = partial(_tell_leg, self._tell, number, len(route.through))
            approach = Approach(self._surface, task, self._threads, tell, joined=True)
            try:
                approach.run()
            except Unmoved as error:
                if self.planned is None:
                    raise
                self.planned = replace(self.planned, failure=f"leg {number}: {error}.")
            finally:
                with unbroken():
                    self._join(approach)

    def _join(self, approach: Approach) -> None:
        """Take the best legs of an approach into the schedule, and find out where the whole of it leads."""
        done, way = self.planned, approach.best
        arrivals, tried, paths = (done.arrivals, done.tried, done.paths) if done else ((), 0, 0)
        paths += approach.paths
        stops = done.stops if done else ()
        if way is None:
            self.planned = done and replace(done, paths=paths)
            return
        now = arrivals[-1] if arrivals else 0.0
        end = round(now + way.end, 9)
        self._legs += tuple(leg._replace(start=leg.start + now) for leg in way.legs)
        case = scheduled(self._route.case, self._legs, end)
        case = case.model_copy(update={"name": f"{self._route.name}_planned"})
        path = path_of(case, self._surface)
        failure = "" if settled(path) else f"leg {len(arrivals)}: {path.sentence} At {path.time[-1] * 1e3:g} ms."
        self.planned = Planned(
            route=self._route,
            case=case,
            trajectory=path,
            arrivals=arrivals if failure else (*arrivals, end),
            stops=(*stops, way.stops),
            tried=tried + 1,
            paths=paths,
            failure=failure,
        )


def _tell_leg(tell: ProgressCallback, leg: int, legs: int, done: int, of: int) -> None:
    tell(leg * of + done, legs * of)


def _files(task: Task | Route, output: str | Path | None, case: str, picture: str, overwrite: bool) -> tuple[Path, ...]:
    """The case file and the picture, none without a folder; ValueError where results would be lost or not written."""
    if output is None:
        return ()
    folder = Path(output)
    files = folder / f"{task.name}_{case}.toml", folder / f"{task.name}_{picture}.png"
    check_free(files, overwrite)
    return files


def _found(
    run: Callable[[], object],
    best: Callable[[], Kind | None],
    file: Path | None,
    surface: SurfaceMotion,
    threads: int | None,
    tell: ProgressCallback,
) -> Kind:
    """The result of a search, with its case file, if any, and its scatter; after Ctrl-C the best so far, without.

    Raises KeyboardInterrupt where there are no drives yet.
    """
    result, interrupted = None, False
    try:
        try:
            run()
        except KeyboardInterrupt:
            interrupted = True
        with unbroken():
            if (result := best()) is None:
                raise KeyboardInterrupt
            result = replace(result, interrupted=interrupted)
            if file is not None:
                result = replace(result, files=(write_case(result.case, file, result.head),))
        if interrupted:
            return result
        tell(result.paths, result.paths)
        doing("paths; runs with disturbances")
        return replace(result, scatter=_scatter(result, surface, threads))
    except KeyboardInterrupt:  # the result so far stays
        if result is None:
            raise
        return replace(result, interrupted=True)


def _scatter(result: SteeringResult, surface: SurfaceMotion, threads: int | None) -> Scatter:
    """The ends of disturbed runs of a case with the best drives, and how far off the last target they are."""
    case, settings, paths = result.case, result.settings, Paths(result.case, surface, threads)
    count = settings.scatter or affordable(case, case.run.duration, SCATTERED_CYCLES, FEW, SCATTERED)
    ways = draws(count, deviations(case, settings.disturbances), settings.seed, REPORTED)
    trajectories = paths.of([(case.actuators, way) for way in ways])
    ends = np.array([path.position[-1] for path in trajectories])
    lost = np.array([path.time[-1] < case.run.duration for path in trajectories])
    return Scatter(ends, np.where(lost, np.inf, [result.off(path) for path in trajectories]))


def _drawn(result: Kind, draw: Callable[[Kind, Path], Path], picture: Path) -> Kind:
    """The result with its picture and the warnings of a run; without them after Ctrl-C, and without an old picture."""
    try:
        with suppress(OSError):  # where it cannot be removed it cannot be written either, which is said below
            picture.unlink(missing_ok=True)
        if result.interrupted:
            return result
        cautions = tuple(warnings(interruptible(run_case, result.case).summary))
        result = replace(result, warnings=cautions)
        if result.scatter is not None:
            result = replace(result, files=(*result.files, draw(result, picture)))
    except KeyboardInterrupt:
        return replace(result, interrupted=True)
    except OSError as error:
        return replace(result, warnings=(*result.warnings, f"The picture could not be written: {error}"))
    return result
