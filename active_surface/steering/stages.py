"""Stages that aims and plans share: surface, search and case file, scatter, picture."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

import numpy as np

from active_surface.steering.disturbances import REPORTED, deviations, draws
from active_surface.steering.paths import Paths
from active_surface.steering.result import SteeringResult
from active_surface.steering.route import Place
from active_surface.steering.scatter import Scatter
from active_surface.steering.spread import spread_drives
from active_surface.steering.tables import Settings
from active_surface.steering.task import able
from coupling import answers_drives, build_friction, follow_part, run_case, shared_surface, warnings
from coupling.case import Case, write_case
from particle import AnyDrive, SurfaceMotion, interruptible, unbroken

Kind = TypeVar("Kind", bound=SteeringResult)


def searched(
    run: Callable[[], object], close: Callable[[], Kind], file: Path | None, comment: Callable[[Kind], str]
) -> Kind:
    """The result of a search, with its case file, if any; after Ctrl-C the best so far.

    Raises KeyboardInterrupt where there are no drives yet.
    """
    result: Kind | None = None
    interrupted = False
    try:
        try:
            run()
        except KeyboardInterrupt:
            interrupted = True
        with unbroken():
            result = replace(close(), interrupted=interrupted)
            if file is not None:
                result = replace(result, files=(write_case(result.case, file, comment(result)),))
    except KeyboardInterrupt:  # the result so far stays
        if result is None:
            raise
        return replace(result, interrupted=True)
    return result


def prepared(case: Case, settings: Settings) -> SurfaceMotion:
    """The moving surface for a search; compiles all that paths need, so that Ctrl-C works from then on."""
    sets: list[list[AnyDrive]] = []
    if answers_drives(case):
        chosen = able(case, settings)
        sets = spread_drives(case, settings, chosen, len(chosen) if settings.actuators else settings.nearest)
    surface = interruptible(shared_surface, case, sets, case.run.duration)
    interruptible(follow_part, case, surface, build_friction(case))
    return surface


def with_scatter(result: Kind, paths: Paths, target: Place, settings: Settings) -> Kind:
    """The result with its scatter about a target [m]; without it after Ctrl-C."""
    if result.interrupted:
        return result
    try:
        return replace(result, scatter=scattered(paths, result.case, target, settings))
    except KeyboardInterrupt:
        return replace(result, interrupted=True)


def drawn(result: Kind, draw: Callable[[Kind, Path], Path], picture: Path) -> Kind:
    """The result with its picture and the warnings of a run; without them after Ctrl-C."""
    if result.interrupted:
        return result
    try:
        cautions = tuple(warnings(interruptible(run_case, result.case).summary))
        result = replace(result, warnings=cautions)
        if result.scatter is not None:
            result = replace(result, files=(*result.files, draw(result, picture)))
    except KeyboardInterrupt:
        return replace(result, interrupted=True)
    except OSError as error:
        return replace(result, warnings=(*result.warnings, f"The picture could not be written: {error}"))
    return result


def check_free(files: tuple[Path, ...], overwrite: bool) -> None:
    """Raise ValueError before the search where results would be lost or could not be written."""
    for file in files:
        if file.is_dir():
            raise ValueError(f"Input output must be free for {file.name}; got {file.parent}, where that is a folder")
    existing = [file.name for file in files if file.exists()]
    if existing and not overwrite:
        names = " and ".join(existing)
        raise ValueError(
            f"Input output must be free of other results; got {files[0].parent}, which has {names}: "
            "--overwrite replaces them"
        )


def scattered(paths: Paths, case: Case, target: Place, settings: Settings) -> Scatter:
    """The ends of disturbed runs of a case, and their distances from a target [m]."""
    ways = draws(settings.scatter, deviations(paths.case, settings.disturbances), settings.seed, REPORTED)
    trajectories = paths.of([(case.actuators, way) for way in ways])
    ends = np.array([path.position[-1] for path in trajectories])
    lost = np.array([path.time[-1] < case.run.duration for path in trajectories])
    return Scatter(ends, np.where(lost, np.inf, np.hypot(*(ends - target).T)))
