"""One aim, from task to drive: this file reads as the pipeline.

task -> surface -> approach, leg by leg: knobs, search -> case and path -> case file -> scatter and picture
"""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from active_surface.steering.aimed import Aimed
from active_surface.steering.approach import Approach
from active_surface.steering.paths import Paths
from active_surface.steering.picture import draw_aim
from active_surface.steering.result import check_free, drawn, prepared, with_scatter
from active_surface.steering.task import Task
from coupling import ProgressCallback, no_progress
from coupling.case import length_text, write_case
from particle import SurfaceMotion, unbroken


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
    if output is None:
        return aim_over(prepared(task.case), task, threads, tell)
    file, picture = Path(output) / f"{task.name}_aimed.toml", Path(output) / f"{task.name}_aim.png"
    check_free((file, picture), overwrite)
    result = aim_over(prepared(task.case), task, threads, tell, file)
    return drawn(result, draw_aim, picture)


def aim_over(
    surface: SurfaceMotion,
    task: Task,
    threads: int | None = None,
    tell: ProgressCallback = no_progress,
    file: Path | None = None,
) -> Aimed:
    """The same over a surface that is there already; writes a case file at most, which is there before the scatter."""
    approach, interrupted = Approach(surface, task, threads, tell), False
    result: Aimed | None = None
    try:
        with ExitStack() as shield:
            try:
                approach.run()
            except KeyboardInterrupt:
                shield.enter_context(unbroken())
                interrupted = True
            else:
                shield.enter_context(unbroken())
            case, path = approach.close()
            case = case.model_copy(update={"name": f"{task.name}_aimed"})
            result = Aimed(
                task=task,
                case=case,
                trajectory=path,
                legs=approach.legs,
                paths=approach.paths,
                interrupted=interrupted,
            )
            if file is not None:
                x, y = (length_text(place) for place in task.target)
                said = f"The drives bring the part to ({x}, {y}), but for {length_text(result.distance)}."
                result = replace(result, files=(write_case(case, file, said),))
    except KeyboardInterrupt:  # what was found before it stays
        if result is None:
            raise
        return replace(result, interrupted=True)
    return with_scatter(result, Paths(case, surface, threads), task.target, task.settings)
