"""One aim, from task to drive: this file reads as the pipeline.

task -> surface -> knobs -> search -> case -> path and scatter -> case file and picture
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from coupling.case import Case
from coupling.case_text import write_case
from coupling.progress import Tell, interruptible, untold
from coupling.run import build_scene
from coupling.units import shown_length
from particle import SurfaceMotion
from steering.aimed import Aimed, path_of, scattered
from steering.knobs import Knobs
from steering.objective import Objective
from steering.paths import Paths
from steering.picture import draw_aim
from steering.search import NEAR, search, search_robust
from steering.task import Task


def aim(task: Task, output: str | Path | None = None, threads: int | None = None, tell: Tell = untold) -> Aimed:
    """Find the drives that bring a part to a target; with `output`, a folder, write NAME_aimed.toml and NAME_aim.png.

    threads: how many paths are found at a time, by default one on each processor; the result is the same for any.
    tell: gets how many paths have been found, and of how many at most.
    Upon Ctrl-C the best drive so far counts, if there is one.
    """
    surface = interruptible(build_scene, task.case).surface
    found = aim_over(surface, task, threads, tell)
    if output is None:
        return found
    folder, name = Path(output), task.name
    x, y = (shown_length(place) for place in task.target)
    said = f"The drives bring the part to ({x}, {y}), but for {shown_length(found.distance)}."
    file = write_case(found.case, folder / f"{name}_aimed.toml", said)
    return replace(found, files=(file, draw_aim(found, folder / f"{name}_aim.png")))


def aim_over(surface: SurfaceMotion, task: Task, threads: int | None = None, tell: Tell = untold) -> Aimed:
    """The same over a surface that is there already."""
    paths = Paths(task.case, surface, threads)
    knobs = Knobs(task.case, task.settings, task.movers)
    settings, near, interrupted = task.settings, NEAR * surface.size, False
    robust = settings.quantile is not None
    objective = nominal = Objective(task, knobs, paths, tell, settings.most // 2 if robust else settings.most)
    try:
        if robust:
            objective = Objective(task, knobs, paths, tell, settings.most, disturbed=True)
            search_robust(knobs, nominal, objective, near, settings.seed)
        else:
            search(knobs, nominal, near, settings.seed)
    except KeyboardInterrupt:
        objective = objective if np.isfinite(objective.best.cost) else nominal
        if not np.isfinite(objective.best.cost):
            raise
        interrupted = True
    used = paths.found
    case = _named(knobs.turned(objective.best.values), f"{task.name}_aimed")
    scatter = scattered(paths, case, task.target, task.settings.scatter, task.settings.seed)
    return Aimed(task, case, path_of(paths, case), scatter, used, interrupted)


def _named(case: Case, name: str) -> Case:
    return case.model_copy(update={"name": name})
