"""One run, from case to result: this file reads as the pipeline.

case -> scene (mesh -> plate influence shapes, or a platform's drives -> surface motion) -> trajectory -> summary
-> result files and picture
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits

import particle
from coupling.case import Case, PlatformCase, RunCase
from coupling.drives import build_drives as build_drives
from coupling.part import build_friction, build_part
from coupling.progress import Progress, silent
from coupling.result import Result
from coupling.results import CaseRecord, check_csv, record_of, write_results
from coupling.scene import Scene, plate_scene, platform_scene
from coupling.summary import Summary, summarise
from coupling.surface import check_surface, write_surface
from fem_plate import PlateShapes
from particle import SurfaceMotion, Trajectory, interruptible
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

    Returns
    -------
    result : Result
        Trajectory, summary and files.

    Raises
    ------
    ValueError
        The case cannot be run, `shapes` are of another plate or other actuators or, before any work, NAME.csv or
        NAME.surface.h5 holds something else.
    OSError
        A file that the case reads is gone.
    """
    if output is not None and csv:
        check_csv(Path(output) / f"{case.name}.csv")
    if output is not None and save_surface:
        check_surface(Path(output) / f"{case.name}.surface.h5")
    # Many small systems: BLAS threads would only wait for each other, and take two to four times as long.
    with threadpool_limits(limits=1, user_api="blas"):
        folder = None if output is None else Path(output)
        return _run(case, folder, progress, csv, save_surface, forces, shapes)


def _run(
    case: Case,
    output: Path | None,
    progress: Progress,
    csv: bool,
    save_surface: bool,
    forces: bool,
    shapes: PlateShapes | None,
) -> Result:
    record = None if output is None else record_of(case)  # its files may be others when the path is found
    return run_over(case, build_scene(case, progress, shapes), output, progress, csv, save_surface, forces, record)


def run_over(
    case: Case,
    scene: Scene,
    output: Path | None = None,
    progress: Progress = silent,
    csv: bool = False,
    save_surface: bool = False,
    forces: bool = False,
    record: CaseRecord | None = None,
    picture: bool = True,
) -> Result:
    """Run a case over its scene, as `run_case` does.

    record: of the case, for the files; None: it is taken now.  picture: whether there is one among the files.
    """
    if output is not None and record is None:
        record = record_of(case)
    with progress("Following the part"):
        friction = build_friction(case)
        trajectory = interruptible(follow_part, case, scene.surface, friction)
        tighter = interruptible(follow_part, case, scene.surface, friction, True)
    with progress("Checking the model's validity"):
        summary = summarise(case, scene, trajectory, tighter, friction)
    if output is None or record is None:
        return Result(case, scene, trajectory, summary)
    with progress("Writing the results") as tell:
        law = friction if forces else None
        files = write_results(case, record, scene, trajectory, summary, output, csv, tell, law, picture)
        if save_surface:
            files += (write_surface(scene.surface, output / f"{case.name}.surface.h5"),)
    return Result(case, scene, trajectory, summary, files)


def stage_count(case: Case) -> int:
    """How many stages a run of a case reports, with its files."""
    if isinstance(case.plate, PlatformCase):
        return STAGES
    return STAGES + (2 if case.plate.theory == "von-karman" else int(case.plate.inertia))


def quick_summary(case: Case, scene: Scene) -> Summary:
    """The summary of a run without its second path, whose error counts as zero."""
    friction = build_friction(case)
    trajectory = interruptible(follow_part, case, scene.surface, friction)
    return summarise(case, scene, trajectory, trajectory, friction)


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


def tighter_tolerance(run: RunCase) -> float:
    """The tolerance of the path that one is compared with."""
    return max(run.tolerance / 100, 1e-13)


def follow_part(case: Case, surface: SurfaceMotion, friction: Contact, tighter: bool = False) -> Trajectory:
    """The part's path over the surface; tighter: at a hundredth of the tolerance, or with half the time step."""
    part, run = build_part(case), case.run
    tolerance = tighter_tolerance(run) if tighter else run.tolerance
    steps: dict[str, Any] = {}
    if run.scheme != "events" and (run.time_step or tighter):
        time_step = run.time_step or default_step(surface, run.duration)
        steps = {"time_step": time_step / 2 if tighter else time_step}
    try:
        return particle.simulate(
            surface, part, friction, run.duration, run.gravity, tolerance, run.scheme, run.after_detachment, **steps
        )
    except MemoryError:
        text = "run.duration must be shorter, as the steps of the path take more memory than there is"
        raise ValueError(f"{text}; got {run.duration:g} s") from None
