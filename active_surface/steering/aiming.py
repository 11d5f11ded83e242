"""One aim, from task to drive: this file reads as the pipeline.

task -> surface -> approach, leg by leg: knobs, search -> case and path -> case file -> scatter and picture
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from active_surface.steering.approach import Approach
from active_surface.steering.paths import Paths
from active_surface.steering.picture import draw_aim
from active_surface.steering.result import Aimed
from active_surface.steering.stages import check_free, drawn, prepared, searched, with_scatter
from active_surface.steering.task import Task
from coupling import ProgressCallback, no_progress
from coupling.case import length_text
from particle import SurfaceMotion, Trajectory


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
        return aim_over(prepared(task.case, task.settings), task, threads, tell)
    file, picture = Path(output) / f"{task.name}_aimed.toml", Path(output) / f"{task.name}_aim.png"
    check_free((file, picture), overwrite)
    return drawn(aim_over(prepared(task.case, task.settings), task, threads, tell, file), draw_aim, picture)


def aim_over(
    surface: SurfaceMotion,
    task: Task,
    threads: int | None = None,
    tell: ProgressCallback = no_progress,
    file: Path | None = None,
    watch: Callable[[Callable[[], Trajectory | None]], object] | None = None,
) -> Aimed:
    """The same over an existing surface; writes a case file at most, before it looks at the scatter.

    watch: gets, after each batch of paths, what finds the path of the best drives so far.
    """

    def told(done: int, of: int) -> None:
        tell(done, of)
        if watch is not None:
            watch(approach.look)

    approach = Approach(surface, task, threads, told)

    def close() -> Aimed:
        way = approach.close()
        case = way.case.model_copy(update={"name": f"{task.name}_aimed"})
        return Aimed(task=task, case=case, trajectory=way.path, legs=way.legs, stops=way.stops, paths=approach.paths)

    result = searched(approach.run, close, file, _comment)
    return with_scatter(result, Paths(result.case, surface, threads), task.target, task.settings)


def _comment(result: Aimed) -> str:
    """The first line of a file of the drives: how near they bring the part to the target."""
    x, y = map(length_text, result.task.target)
    return f"The drives bring the part to ({x}, {y}), but for {length_text(result.distance)}."
