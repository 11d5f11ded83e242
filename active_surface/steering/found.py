"""Found: what aims and plans have in common, a case and its path, and how both are told."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeVar

import numpy as np

from active_surface.steering.paths import Paths
from active_surface.steering.scatter import TOLD, Scatter, disturbances
from active_surface.steering.tables import Settings
from coupling import build_friction, build_scene, follow_part, run_case, warnings
from coupling.case import Case
from particle import SurfaceMotion, Trajectory, interruptible


@dataclass(frozen=True, eq=False, kw_only=True)
class Found:
    """A case with the drives that were found, and its path; `files` were written.

    scatter: None where it was not looked for any more.  paths: how many were followed to find the drives.
    interrupted: whether Ctrl-C came before the end.  warnings: what is to be known before the path is trusted.
    """

    case: Case
    trajectory: Trajectory = field(repr=False)
    paths: int
    scatter: Scatter | None = field(default=None, repr=False)
    interrupted: bool = False
    warnings: tuple[str, ...] = ()
    files: tuple[Path, ...] = ()


Kind = TypeVar("Kind", bound=Found)
Place = tuple[float, float]


def prepared(case: Case) -> SurfaceMotion:
    """The moving surface of a case. Whatever paths need is compiled, so that Ctrl-C is heard from then on."""
    surface = interruptible(build_scene, case).surface
    interruptible(follow_part, case, surface, build_friction(case))
    return surface


def with_scatter(found: Kind, paths: Paths, target: Place, settings: Settings) -> Kind:
    """What was found with its scatter about a target [m]; without after Ctrl-C."""
    if found.interrupted:
        return found
    try:
        return replace(found, scatter=scattered(paths, found.case, target, settings.scatter, settings.seed))
    except KeyboardInterrupt:
        return replace(found, interrupted=True)


def drawn(found: Kind, draw: Callable[[Kind, Path], Path], picture: Path) -> Kind:
    """What was found with its picture, and with what a run of it warns of; without after Ctrl-C."""
    if found.interrupted:
        return found
    try:
        said = tuple(warnings(interruptible(run_case, found.case).summary))
        found = replace(found, warnings=said)
        if found.scatter is not None:
            found = replace(found, files=(*found.files, draw(found, picture)))
    except KeyboardInterrupt:
        return replace(found, interrupted=True)
    except OSError as error:
        return replace(found, warnings=(*found.warnings, f"The picture could not be written: {error}"))
    return found


def check_free(files: tuple[Path, ...], overwrite: bool) -> None:
    """Raises ValueError where results would be lost, or could not be written: better before the search than after."""
    for file in files:
        if file.is_dir():
            raise ValueError(f"Input output must be free for {file.name}; got {file.parent}, where that is a folder")
    there = [file.name for file in files if file.exists()]
    if there and not overwrite:
        names = " and ".join(there)
        raise ValueError(
            f"Input output must be free of other results; got {files[0].parent}, which has {names}: "
            "--overwrite replaces them"
        )


def scattered(paths: Paths, case: Case, target: Place, count: int, seed: int) -> Scatter:
    """The ends of so many disturbed runs of a case, and their distances from a target [m]."""
    ways = disturbances(count, len(case.actuators), seed, TOLD)
    found = paths.of([(case.actuators, way) for way in ways])
    ends = np.array([path.position[-1] for path in found])
    lost = np.array([path.time[-1] < case.run.duration for path in found])
    return Scatter(ends, np.where(lost, np.inf, np.hypot(*(ends - target).T)))
