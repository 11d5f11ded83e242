"""Batch: many cases at once, each plate solved once and all paths followed side by side."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from threadpoolctl import threadpool_limits

from coupling.case import Case, RunCase
from coupling.progress import Progress, silent
from coupling.result import Result
from coupling.run import build_friction, build_part, follow_part, tighter_tolerance
from coupling.scene import PlateScene, Scene
from coupling.shared import answers_drives
from coupling.solved_plates import SolvedPlates
from coupling.summary import summarise
from particle import AnyDrive, Micropart, SurfaceMotion, Trajectory, interruptible, simulate_many
from particle.friction import Contact


class _Job(NamedTuple):
    """A case whose path is to be followed."""

    number: int
    case: Case
    scene: Scene
    friction: Contact
    part: Micropart


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
        A case cannot be run; names it by its number from 0. Or `threads` is less than 1.
    Interrupted
        Ctrl-C.
    """
    if threads is not None and threads < 1:
        raise ValueError(f"Input threads of run_cases must be at least 1; got {threads!r}")
    plates = SolvedPlates(progress)
    # Many small systems: BLAS threads would only wait for each other.
    with threadpool_limits(limits=1, user_api="blas"):
        jobs = [_job(number, case, plates) for number, case in enumerate(cases)]
        paths: dict[int, tuple[Trajectory, Trajectory]] = {}
        with progress("Following the parts") as tell:
            for group in _groups(jobs):
                both = (_follow(group, threads, tighter) for tighter in (False, True))
                paths |= {job.number: pair for job, *pair in zip(group, *both, strict=True)}  # type: ignore[misc]
                tell(len(paths), len(jobs))
        results = []
        with progress("Checking the model's validity") as tell:
            for job in jobs:
                path, tighter = paths[job.number]
                summary = summarise(job.case, job.scene, path, tighter, job.friction)
                results.append(Result(job.case, job.scene, path, summary))
                tell(len(results), len(jobs))
    return results


def _job(number: int, case: Case, plates: SolvedPlates) -> _Job:
    try:
        return _Job(number, case, plates.scene(case), build_friction(case), build_part(case))
    except ValueError as error:
        raise ValueError(f"Input cases[{number}] of run_cases cannot be run: {error}") from error


def _groups(jobs: Sequence[_Job]) -> Iterator[list[_Job]]:
    """Yield jobs that are followed side by side: over one plate with the same run."""
    groups: dict[tuple[int, RunCase], list[_Job]] = defaultdict(list)
    for job in jobs:
        alone = job.case.run.scheme != "events" or not isinstance(job.scene, PlateScene) or answers_drives(job.case)
        groups[-1 - job.number if alone else id(job.scene.surface.store), job.case.run].append(job)
    yield from groups.values()


def _follow(group: Sequence[_Job], threads: int | None, tighter: bool) -> list[Trajectory]:
    """The paths of jobs over one surface, or of a single job."""
    first, run = group[0], group[0].case.run
    if len(group) == 1:
        return [interruptible(follow_part, first.case, first.scene.surface, first.friction, tighter)]
    surface: SurfaceMotion = first.scene.surface
    drives: list[Sequence[AnyDrive]] = [job.scene.lifts for job in group]
    return simulate_many(
        surface,
        [job.part for job in group],
        [job.friction for job in group],
        run.duration,
        run.gravity,
        tighter_tolerance(run) if tighter else run.tolerance,
        run.after_detachment,
        drives,
        threads,
    )
