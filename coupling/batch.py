"""Batch: many paths at once, those over one surface side by side; many cases, each plate solved once; many parts."""

from __future__ import annotations

import json
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Final, NamedTuple

from coupling.case import PART_NAME, Case, RunCase, plain_case
from coupling.files import check_folder
from coupling.part import build_friction, build_part
from coupling.parts import PartsResult, overlaps_of
from coupling.progress import Progress, ProgressCallback, no_progress, silent
from coupling.result import Result
from coupling.results import Output, record_of, write_results
from coupling.run import (
    build_scene,
    check_case,
    draw_picture,
    judged,
    one_blas_thread,
    simulate_run,
    tighter_run,
)
from coupling.scene import PlateScene, Scene
from coupling.shared import answers_drives
from coupling.solved_plates import SolvedPlates
from fem_plate import PlateShapes
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
                results.append(judged(case, scene, path, tighter))
                tell(len(results), len(cases))
    return results


def run_parts(
    cases: Sequence[Case],
    name: str = "parts",
    output: str | Path | None = None,
    progress: Progress = silent,
    csv: bool = False,
    save_surface: bool = False,
    forces: bool = False,
    shapes: PlateShapes | None = None,
    picture: bool = True,
) -> PartsResult:
    """Run cases that differ in their parts only, which move over one surface and do not feel each other.

    Each path has the bits of `run_case`. Where two faces overlap, or a point is on a face, both go on.

    Parameters
    ----------
    cases : sequence of Case
        One for each part, named as it is: those of `read_parts`, or `case.vary({"part.position": ...}, "left")`.
    name : str
        NAME of the files.
    output : path, optional
        Folder for NAME.plate.vtkhdf, a NAME.PART.part.vtkhdf for each part and NAME.png.
    progress, csv, save_surface, forces, shapes, picture
        As of `run_case`; there is a NAME.PART.csv for each part.

    Returns
    -------
    result : PartsResult
        The results by the names of the parts, and their overlaps.

    Raises
    ------
    ValueError
        Cases differ in more than their parts, or two have one name; else as `run_case`.
    OSError
        A file that the cases read is gone.
    """
    for number, case in enumerate(cases):
        check_case(case, f"cases[{number}] of run_parts")
    names = [case.name for case in cases]
    grounds = [{key: table for key, table in plain_case(case).items() if key != "part"} for case in cases]
    fit = bool(names) and len({*names}) == len(names) and all(re.match(PART_NAME, part) for part in names)
    if not fit or any(ground != grounds[0] for ground in grounds):
        raise ValueError(
            "Input cases of run_parts must be cases that differ in [part] only, each with a name of its own, at most "
            "40 letters, digits, - and _"
        )
    of_parts = [f"{name}.{part}" for part in names]
    wanted = None if output is None else Output(Path(output), csv, save_surface, forces, picture)
    if wanted is not None:
        check_folder(wanted.folder)
        for file in (name, *of_parts):
            wanted.check(file)
    with one_blas_thread():
        records = [record_of(case) for case in cases] if wanted else []  # files may be others when paths are found
        scene = build_scene(cases[0], progress, shapes)
        runs = cases[0].run, tighter_run(cases[0].run, scene.surface)
        tasks = [PathTask(scene.surface, build_part(case), build_friction(case), run) for run in runs for case in cases]
        with progress("Following the parts") as tell:
            paths = follow(tasks, tell=tell)
        results: dict[str, Result] = {}
        with progress("Checking the model's validity") as tell:
            for case, path, tighter in zip(cases, paths, paths[len(cases) :], strict=False):
                results[case.name] = judged(case, scene, path, tighter)
                tell(len(results), len(cases))
        found = PartsResult(name, results, overlaps_of(results))
        if wanted is None:
            return found
        with progress("Writing the results") as tell:
            of_run = dict(zip(of_parts, zip(results.values(), records, strict=True), strict=True))
            of_all = {"parts": json.dumps(names), "summary": json.dumps(found.as_dict())}
            first, further = write_results(name, of_run, wanted, tell, of_all)
            return replace(found, files=(*first, *draw_picture(found, name, wanted), *further))


def _tasks(case: Case, scene: Scene, plates: SolvedPlates) -> list[PathTask]:
    """The path of a run and the one that it is compared with; over a surface of many cases where they share one."""
    part, friction, run = build_part(case), build_friction(case), case.run
    surface, drives = scene.surface, None
    if run.scheme == "events" and isinstance(scene, PlateScene) and not answers_drives(case):
        surface, drives = plates.surface(case, list, run.duration), scene.lifts
    return [PathTask(surface, part, friction, one, drives) for one in (run, tighter_run(run, surface))]
