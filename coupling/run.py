"""One run, from case to result: this file reads as the pipeline.

case -> scene (mesh -> plate influence shapes, or a platform's drives -> surface motion) -> trajectory -> summary
-> result files and picture
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field, replace
from functools import cache, partial
from pathlib import Path
from warnings import warn

import scipy.linalg  # noqa: F401 (its BLAS is among those whose threads are limited)
from threadpoolctl import ThreadpoolController

import particle
from coupling.case import Case, PlatformCase, RunCase
from coupling.environment import versions
from coupling.files import check_folder
from coupling.margins import PathLoads
from coupling.part import build_friction, build_part
from coupling.progress import Progress, silent
from coupling.result import Result
from coupling.results import CaseRecord, Output, SavedRun, record_of, write_results
from coupling.scene import Scene, plate_scene, platform_scene
from coupling.summary import Summary, summarise
from fem_plate import PlateShapes
from particle import AnyDrive, Body, Micropart, SurfaceMotion, Trajectory, interruptible, side_by_side
from particle.fixed import default_step
from particle.friction import Contact

STAGES = 5  # of a platform, and of a plate that only bends


def run_case(
    case: Case,
    output: str | Path | None = None,
    progress: Progress = silent,
    csv: bool = False,
    save_surface: bool = False,
    forces: bool = False,
    shapes: PlateShapes | None = None,
    picture: bool = True,
) -> Result:
    """Run a case.

    Parameters
    ----------
    case : Case
        The case.
    output : path, optional
        Folder for NAME.plate.vtkhdf, NAME.part.vtkhdf and NAME.png.
    progress : Progress, optional
        Reports the progress of a stage, for progress bars.
    csv : bool
        Also write the trajectory to NAME.csv.
    save_surface : bool
        Also write the moving surface, with the cells that the part came to, to NAME.surface.h5 (`read_surface`).
    forces : bool
        Also write the parts of the contact's force to the part's file and the CSV file (`Trajectory.contact_at`).
    shapes : InfluenceShapes or PatchedShapes, optional
        Those of another result, `result.shapes`, with the same plate and places of actuators: the plate is not solved
        again. Of a plate that stretches or vibrates only its influence shapes are taken; the equilibria or modes
        beyond these, which depend on the drives, are found anew.
    picture : bool
        Whether there is NAME.png among the files. One that cannot be drawn is left out, with a RuntimeWarning.

    Returns
    -------
    result : Result
        Trajectory, summary and files.

    Raises
    ------
    ValueError
        The case cannot be run, `shapes` are of another plate or other actuators or, before any work, the folder cannot
        be made or written to, or NAME.csv or NAME.surface.h5 holds something else.
    OSError
        A file that the case reads is gone.
    """
    check_case(case, "case of run_case")
    wanted = None if output is None else Output(Path(output), csv, save_surface, forces, picture)
    if wanted is not None:
        check_folder(wanted.folder)
        wanted.check(case.name)
    with one_blas_thread():
        record = None if wanted is None else record_of(case)  # its files may be others when the path is found
        return run_over(case, build_scene(case, progress, shapes), wanted, progress, record)


def check_case(case: object, where: str) -> None:
    """Raises ValueError unless it is a case."""
    if not isinstance(case, Case):
        raise ValueError(f"Input {where} must be a Case, as read_case reads it from a file; got {case!r}")


_threads = cache(ThreadpoolController)  # 5 ms to make


def one_blas_thread() -> AbstractContextManager[object]:
    """Has BLAS use one thread in its block: with many small systems several take two to four times as long."""
    return _threads().limit(limits=1, user_api="blas")


def run_over(
    case: Case,
    scene: Scene,
    output: Output | None = None,
    progress: Progress = silent,
    record: CaseRecord | None = None,
) -> Result:
    """Run a case over its scene, as `run_case` does.

    record: of the case, for the files; None: it is taken now.
    """
    if output is not None and record is None:
        record = record_of(case)
    with progress("Following the part"):
        friction = build_friction(case)
        _ = friction.law  # found once, before both paths ask for it
        paths = [partial(follow_part, case, scene.surface, friction, is_tighter) for is_tighter in (False, True)]
        if output is not None and output.surface:  # whose cells are in the order in which paths come to them
            trajectory, tighter = map(interruptible, paths)
        else:
            trajectory, tighter = side_by_side(*paths)
    with progress("Checking the model's validity"):
        result = judged(case, scene, trajectory, tighter)
    if output is None or record is None:
        return result
    with progress("Writing the results") as tell:
        of_run, further = write_results(case.name, {case.name: (result, record)}, output, tell)
        picture = draw_picture(result, case.name, output)
    return replace(result, files=(*of_run, *picture, *further))


def judged(case: Case, scene: Scene, trajectory: Trajectory, tighter: Trajectory) -> Result:
    """The result of a path; tighter: the one that it is compared with."""
    friction = build_friction(case)
    loads = PathLoads(case, scene.surface, trajectory, friction)
    return Result(case, scene, trajectory, summarise(case, scene, loads, tighter, friction), loads)


def draw_picture(run: object, name: str, output: Output) -> tuple[Path, ...]:
    """Draw the picture of a run, if it is wanted and that can be."""
    path = output.folder / f"{name}.png"
    try:
        if not output.picture:
            return ()
        from coupling.pictures import draw_run  # here, because it loads matplotlib

        return (draw_run(run, path),)
    except Exception as error:  # the run is finished, whatever becomes of its picture
        warn(f"{path} could not be drawn: {error}", RuntimeWarning, stacklevel=2)
        return ()


def stage_count(case: Case) -> int:
    """How many stages a run of a case reports, with its files."""
    if isinstance(case.plate, PlatformCase):
        return STAGES
    return STAGES + (2 if case.plate.theory == "von-karman" else int(case.plate.inertia))


def quick_summary(case: Case, scene: Scene) -> Summary:
    """The summary of a run without its second path, whose error counts as zero."""
    friction = build_friction(case)
    trajectory = interruptible(follow_part, case, scene.surface, friction)
    return summarise(case, scene, PathLoads(case, scene.surface, trajectory, friction), trajectory, friction)


def build_scene(case: Case, progress: Progress = silent, shapes: PlateShapes | None = None) -> Scene:
    """What the part moves over: a plate on actuators, or a platform.

    shapes: of the same plate and actuators, if they are known; raises ValueError for others.
    """
    if isinstance(case.plate, PlatformCase):
        if shapes is not None:
            raise ValueError("Input shapes of run_case must not be given for a platform, which has none")
        return platform_scene(case.plate, progress)
    return plate_scene(case, case.plate, progress, shapes)


def build_surface(case: Case) -> SurfaceMotion:
    """The moving surface of a case, without a path; raises ValueError when its plate cannot be solved."""
    return build_scene(case).surface


def follow_part(case: Case, surface: SurfaceMotion, friction: Contact, tighter: bool = False) -> Trajectory:
    """The part's path over the surface; tighter: at a hundredth of the tolerance, or with half the time step."""
    return simulate_run(surface, build_part(case), friction, tighter_run(case.run, surface) if tighter else case.run)


def tighter_run(run: RunCase, surface: SurfaceMotion) -> RunCase:
    """The run that a path is compared with: at a hundredth of its tolerance, or with half its time step."""
    if run.scheme == "events":
        return run.model_copy(update={"tolerance": max(run.tolerance / 100, 1e-13)})
    step = run.time_step or default_step(surface, run.duration)
    return run.model_copy(update={"time_step": step / 2})


def simulate_run(
    surface: SurfaceMotion,
    part: Micropart | Body,
    friction: Contact,
    run: RunCase,
    drives: Sequence[AnyDrive] | None = None,
) -> Trajectory:
    """The path of a part by the settings of a run, under a surface's own drives or others; raises as `simulate`."""
    driven, settings = surface if drives is None else surface.driven_by(drives), (run.scheme, run.after_detachment)
    try:
        return particle.simulate(
            driven,
            part,
            friction,
            run.duration,
            run.gravity,
            run.tolerance,
            *settings,
            run.time_step,
            run.after_tipping,
        )
    except MemoryError:
        text = "run.duration must be shorter, as the steps of the path take more memory than there is"
        raise ValueError(f"{text}; got {run.duration:g} s") from None


@dataclass(frozen=True, eq=False)
class Rerun:
    """A run and its repetition."""

    saved: SavedRun
    result: Result
    changed: dict[str, tuple[str, str]] = field(default_factory=dict)  # versions then and now, where they differ

    @property
    def same_end(self) -> bool:
        """Whether both end at the same time and place, bit for bit."""
        return self._end == (self.result.summary.end_time, *self.result.summary.end_position)

    @property
    def moved(self) -> float:
        """How far [m] the ends are from each other."""
        return math.dist(self._end[1:], self.result.summary.end_position)

    @property
    def _end(self) -> tuple[float, float, float]:
        return (self.saved.summary["end_time"], *self.saved.summary["end_position"])


def rerun(saved: SavedRun, output: str | Path | None = None, progress: Progress = silent) -> Rerun:
    """Run the case of a saved run again; output: as of `run_case`.

    Raises ValueError when the output is the folder of the saved run, whose files would be replaced.
    """
    if output is not None and Path(output).resolve() == saved.part_path.parent.resolve():
        raise ValueError(f"Input output of rerun must be another folder than that of the result; got {output}")
    now = versions()
    changed = {key: (old, now.get(key, "none")) for key, old in saved.versions.items() if now.get(key) != old}
    return Rerun(saved, run_case(saved.case, output, progress), changed)
