"""Batch: many paths at once, those over one surface side by side, and many cases with each plate solved once."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Final, NamedTuple

from coupling.case import Case, RunCase
from coupling.margins import PathLoads
from coupling.part import build_friction, build_part
from coupling.progress import Progress, ProgressCallback, no_progress, silent
from coupling.result import Result
from coupling.run import check_case, one_blas_thread, simulate_run, tighter_run
from coupling.scene import PlateScene, Scene
from coupling.shared import answers_drives
from coupling.solved_plates import SolvedPlates
from coupling.summary import summarise
from particle import (
    AnyDrive,
    Body,
    Micropart,
    SurfaceMotion,
    Trajectory,
    interruptible,
    processors,
    simulate_many,
)
from particle.friction import Contact

AT_ONCE: Final = 256  # paths in memory at a time: each takes 0.13 MB, however short; larger batches are slower
FAILURES: Final = (ValueError, ArithmeticError, RuntimeError)


class PathTask(NamedTuple):
    """A path to be followed."""

    surface: SurfaceMotion
    part: Micropart | Body
    friction: Contact
    run: RunCase
    drives: Sequence[AnyDrive] | None = None  # one an actuator; None: the surface's own


def follow(
    tasks: Sequence[PathTask], threads: int | None = None, tell: ProgressCallback = no_progress
) -> list[Trajectory]:
    """The path of each task, with the bits of a single run; raises as `simulate` does for the first that has none.

    Paths over one surface object with equal runs are followed side by side, at most `threads` at a time.
    """
    found: dict[int, Trajectory] = {}
    for number, path in follow_each(tasks, threads):
        if isinstance(path, Exception):
            raise path
        found[number] = path
        tell(len(found), len(tasks))
    return [found[number] for number in range(len(tasks))]


def follow_each(tasks: Sequence[PathTask], threads: int | None = None) -> Iterator[tuple[int, Trajectory | Exception]]:
    """Yield the number of each task with its path, or with the error because of which it has none."""
    groups: dict[tuple[int, RunCase, bool], list[int]] = defaultdict(list)
    for number, task in enumerate(tasks):
        groups[id(task.surface), task.run, task.drives is None].append(number)
    for group in groups.values():
        for first in range(0, len(group), AT_ONCE):
            lot = group[first : first + AT_ONCE]
            yield from zip(lot, _paths([tasks[number] for number in lot], threads), strict=True)


def _paths(tasks: Sequence[PathTask], threads: int | None) -> Sequence[Trajectory | Exception]:
    """The paths of tasks over one surface with one run; where they fail together each is tried by itself."""
    try:
        return _together(tasks, threads)
    except FAILURES as error:
        return [error] if len(tasks) == 1 else [path for task in tasks for path in _paths([task], threads)]


def _together(tasks: Sequence[PathTask], threads: int | None) -> list[Trajectory]:
    run = tasks[0].run
    if run.scheme != "events":
        pool = ThreadPoolExecutor(threads or processors())
        try:
            return interruptible(lambda: list(pool.map(lambda task: simulate_run(*task), tasks)))
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
    return simulate_many(
        tasks[0].surface,
        [task.part for task in tasks],
        [task.friction for task in tasks],
        run.duration,
        run.gravity,
        run.tolerance,
        run.after_detachment,
        [task.drives for task in tasks if task.drives is not None] or None,
        threads,
        None,
        run.after_tipping,
    )


def run_cases(cases: Sequence[Case], threads: int | None = None, progress: Progress = silent) -> list[Result]:
    """Run many cases, as `run_case` does with the same bits, and write nothing.

    Cases of one plate with the same places of actuators share its influence shapes, whatever else differs. Where the
    plate only bends they share the moving surface's cells too. Paths over one surface with the same `run` table are
    followed side by side. A plate that stretches or vibrates gets a model for each case.

    Parameters
    ----------
    cases : sequence of Case
        The cases, such as those of `Case.vary`.
    threads : int, optional
        Number of paths at a time, by default one on each processor.
    progress : Progress, optional
        Reports the progress of a stage, for progress bars.

    Returns
    -------
    results : list of Result
        One for each case.

    Raises
    ------
    ValueError
        A case cannot be run; names it by its number from 0. Or `threads` is less than 1, or `cases` are no cases.
    Interrupted
        Ctrl-C.
    """
    if threads is not None and threads < 1:
        raise ValueError(f"Input threads of run_cases must be at least 1; got {threads!r}")
    if isinstance(cases, (Case, str)) or not isinstance(cases, Iterable):
        raise ValueError(f"Input cases of run_cases must be a list of cases; got {cases!r}")
    cases = list(cases)
    for number, case in enumerate(cases):
        check_case(case, f"cases[{number}] of run_cases")
    plates = SolvedPlates(progress)
    with one_blas_thread():
        scenes, tasks = [], []
        for number, case in enumerate(cases):
            try:
                scenes.append(plates.scene(case))
                tasks += _tasks(case, scenes[-1], plates)
            except ValueError as error:
                raise ValueError(f"Input cases[{number}] of run_cases cannot be run: {error}") from error
        with progress("Following the parts") as tell:
            paths = follow(tasks, threads, lambda done, of: tell(done // 2, of // 2))
        results = []
        with progress("Checking the model's validity") as tell:
            for case, scene, path, tighter in zip(cases, scenes, paths[::2], paths[1::2], strict=True):
                friction = build_friction(case)
                loads = PathLoads(case, scene.surface, path, friction)
                summary = summarise(case, scene, loads, tighter, friction)
                results.append(Result(case, scene, path, summary, loads))
                tell(len(results), len(cases))
    return results


def _tasks(case: Case, scene: Scene, plates: SolvedPlates) -> list[PathTask]:
    """The path of a run and the one that it is compared with; over a surface of many cases where they share one."""
    part, friction, run = build_part(case), build_friction(case), case.run
    surface, drives = scene.surface, None
    if run.scheme == "events" and isinstance(scene, PlateScene) and not answers_drives(case):
        surface, drives = plates.surface(case, list, run.duration), scene.lifts
    return [PathTask(surface, part, friction, one, drives) for one in (run, tighter_run(run, surface))]
