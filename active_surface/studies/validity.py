"""Validity: where the model of a sweep's plates stops holding, by the checks of a run at a few of its points."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from typing import Any, Final

import numpy as np

from active_surface.studies.engine import Engine
from active_surface.studies.points import Points
from active_surface.studies.study import Study
from coupling import (
    FAILURES,
    PlateSummary,
    air_figures,
    build_friction,
    follow_part,
    one_blas_thread,
    plate_figures,
    quick_summary,
    report,
)
from coupling.case import Case, PlatformCase
from coupling.scene import PlateScene
from particle import interruptible

CHECKED: Final = 4  # corners, besides the base case
SEARCHED: Final = 4096  # points searched for corners, unless they form a grid
FIGURES: Final = (
    "plate_error",
    "surface_error",
    "deflection_over_thickness",
    "linear_path_error",
    "largest_slope",
    "largest_strain",
    "drive_over_first",
    "quasi_static_error",
    "plate_rings",
    "part_curvature",
    "part_sag_over_roughness",
    "tipping",
    "tips",
    "energy_balance",
)
OF_AIR: Final = ("load_share", "breathing", "sag_over_gap")


def model_warnings(engine: Engine) -> tuple[str, ...]:
    """The warnings of a run, each with the worst figure of the base case and a few corners of the study's axes.

    They are those of the surfaces that an engine's paths share. Points that a sweep refuses are left out, and so are
    warnings about a run's files and the digits of its path. One that cannot be checked is a warning of its own. A rigid
    platform has no warnings.
    """
    if isinstance(engine.study.case.plate, PlatformCase):
        return ()
    first: PlateSummary | None = None
    figures, unchecked = list[dict[str, Any]](), dict[str, None]()
    with one_blas_thread():
        for case in _cases(engine.study):
            try:
                found = _figures(engine, case) if first else quick_summary(case, engine.scene(case))
            except FAILURES as error:
                unchecked[f"The model could not be checked at a corner of the axes: {error}."] = None
                continue
            if isinstance(found, PlateSummary):
                first, found = found, vars(found)
            if isinstance(found, dict):
                figures.append(found)
    if first is None:
        return tuple(unchecked)
    known = {name: [one[name] for one in figures if one[name] is not None] for name in FIGURES}
    worst: dict[str, Any] = {name: max(values, default=None) for name, values in known.items()}
    stretched = [one["stretch_error"] for one in figures if one["stretch_error"]]
    if first.air is not None:
        airs = [vars(one["air"]) for one in figures if one["air"]]
        largest: dict[str, Any] = {name: max(air[name] or 0.0 for air in airs) for name in OF_AIR}
        worst["air"] = replace(first.air, **largest)
    worst["stretch_error"] = max(stretched, key=lambda error: error.largest, default=None)
    return (*report.warnings(replace(first, frames_per_cycle=None, **worst)), *unchecked)


def _figures(engine: Engine, case: Case) -> dict[str, Any] | None:
    """What the model's validity is judged by; None: there is no plate."""
    scene, friction = engine.scene(case), build_friction(case)
    if not isinstance(scene, PlateScene):
        return None
    path = interruptible(follow_part, case, scene.surface, friction)
    own = {"energy_balance": path.energy.balance, "air": air_figures(case, scene, path, friction)}
    return vars(plate_figures(case, scene, path, friction, with_sag=False)) | own


def _cases(study: Study) -> Iterator[Case]:
    yield study.case
    points = study.points
    for point in corners(points):
        path = point * points.repeats
        if not study.refusals(path):
            yield study.case_at(points.values([path])[0])


def corners(points: Points) -> list[int]:
    """A few points at which axes have their smallest or largest value."""
    if points.sampling == "grid":
        ends = [_ends(np.array(axis.values, axis.kind)) for axis in points.axes]
        numbers = [int(np.ravel_multi_index(at, [len(axis.values) for axis in points.axes])) for at in product(*ends)]
    else:
        count = min(points.dimensions["point"], SEARCHED)
        numbers = [end for column in points.columns(range(count)) for end in _ends(column)]
    numbers = list(dict.fromkeys(numbers))
    return [numbers[k] for k in sorted({*np.linspace(0, len(numbers) - 1, CHECKED).astype(int).tolist()})]


def _ends(values: np.ndarray[tuple[int], np.dtype[np.generic]]) -> tuple[int, int]:
    """Where values (n,) are smallest and largest; texts: the first and the last."""
    if values.dtype == object:
        return 0, len(values) - 1
    return int(np.argmin(values)), int(np.argmax(values))
