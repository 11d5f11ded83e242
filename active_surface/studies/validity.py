"""Validity: where the model of a sweep's plates stops holding, by the checks of a run at a few of its points."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from typing import Any, Final

import numpy as np
from threadpoolctl import threadpool_limits

from active_surface.studies.engine import FAILURES
from active_surface.studies.points import Points
from active_surface.studies.refusal import refusals
from active_surface.studies.study import Study
from active_surface.studies.variants import Variants
from coupling import PlateSummary, SolvedPlates, quick_summary, report
from coupling.case import Case, PlatformCase

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
    "tipping",
    "tips",
    "energy_balance",
)


def model_warnings(study: Study) -> tuple[str, ...]:
    """The warnings of a run, each with the worst figure of the base case and a few corners of the study's axes.

    Points that a sweep refuses are left out, and so are warnings about a run's files and the digits of its path. One
    that cannot be checked is a warning of its own. A rigid platform has no warnings.
    """
    if isinstance(study.case.plate, PlatformCase):
        return ()
    summaries, plates, unchecked = [], SolvedPlates(keep=1), dict[str, None]()
    # Many small systems: BLAS threads would only wait for each other.
    with threadpool_limits(limits=1, user_api="blas"):
        for case in _cases(study):
            try:
                summary = quick_summary(case, plates.scene(case))
            except FAILURES as error:
                unchecked[f"The model could not be checked at a corner of the axes: {error}."] = None
                continue
            if isinstance(summary, PlateSummary):
                summaries.append(summary)
    if not summaries:
        return tuple(unchecked)
    known = {name: [value for one in summaries if (value := getattr(one, name)) is not None] for name in FIGURES}
    worst: dict[str, Any] = {name: max(values, default=None) for name, values in known.items()}
    stretched = [one.stretch_error for one in summaries if one.stretch_error]
    worst["stretch_error"] = max(stretched, key=lambda error: error.largest, default=None)
    return (*report.warnings(replace(summaries[0], frames_per_cycle=None, **worst)), *unchecked)


def _cases(study: Study) -> Iterator[Case]:
    yield study.case
    variants, points = Variants(study.case, study.points.axes), study.points
    for point in corners(points):
        path = point * points.repeats
        if not refusals(study, variants, path):
            yield variants.at(points.values([path])[0])[0]


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
