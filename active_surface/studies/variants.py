"""Variants: the case at a point of a study, and what plates that answer their drives are solved for."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from contextlib import suppress
from typing import Any, Final

import numpy as np

from active_surface.studies.axes import Axis
from active_surface.studies.points import Points
from active_surface.studies.study import Study
from coupling import answers_drives, build_drives
from coupling.case import Case, InputError, PlatformCase
from particle import AnyDrive

Values = tuple[Any, ...]

OF_PLATE: Final = ("position", "stiffness")
"""Keys of an actuator that change the plate's shapes."""
DEEP_OF_RUN: Final = (("run", "surface_tolerance"), ("run", "start"))
"""Keys of the run that change the surface."""
SPREAD: Final = 48  # points whose drives stand for those of all
THEORIES: Final = ("plate.theory", "plate.inertia")
"""Fields that decide whether a plate answers its drives."""


def case_at(study: Study, values: Values) -> Case:
    """The case at a point of a study, by the values of its axes; raises InputError when there is none."""
    changes = {axis.field.path: value for axis, value in zip(study.points.axes, values, strict=True)}
    return study.case.vary(changes)


def is_deep(case: Case, axis: Axis) -> bool:
    """Whether an axis changes what the part moves over."""
    first = axis.field.locations[0]
    if first[0] == "actuators":
        return first[2] in OF_PLATE
    on_platform = isinstance(case.plate, PlatformCase) and first == ("run", "duration")  # a measured motion has an end
    return first[0] in ("plate", "lattice") or first in DEEP_OF_RUN or on_platform


def drives_vary(axes: Sequence[Axis]) -> bool:
    """Whether an axis changes drives of actuators."""
    return any(axis.field.locations[0][0] in ("actuators", "lattice") for axis in axes)


def drive_sets(study: Study, case: Case) -> list[list[AnyDrive]]:
    """Drives that stand for those of all paths over the plate of a case of a study, which answers them."""
    own = build_drives(case)
    if not drives_vary(study.points.axes):
        return [own]
    sets = []
    for values in _samples(study.points):
        with suppress(InputError, ArithmeticError):
            sample = case_at(study, values)
            sets += [build_drives(sample)] if len(sample.actuators) == len(own) else []
    return sets or [own]


def heights_key(study: Study) -> str:
    """A hash of what all paths share beyond the case and their own values; "": they share nothing."""
    theories = any(axis.field.path in THEORIES for axis in study.points.axes)
    if not answers_drives(study.case) and not theories:
        return ""
    samples: list[Any] = []
    if drives_vary(study.points.axes):
        fields = [axis.field.path for axis in study.points.axes]
        samples = [sorted(zip(fields, values, strict=True)) for values in _samples(study.points)]
    return hashlib.sha256(repr((longest_duration(study), samples)).encode()).hexdigest()


def longest_duration(study: Study) -> float:
    """The duration [s] of the longest run."""
    return max(largest(study.points, "run.duration"), default=study.case.run.duration)


def largest(points: Points, path: str) -> list[float]:
    """The largest value of each axis over a field whose path ends with this one."""
    axes = [axis for axis in points.axes if f".{axis.field.path}".endswith(f".{path}")]
    return [max(axis.values or (axis.low, axis.high)) for axis in axes]


def _samples(points: Points) -> list[Values]:
    """The values where all axes are lowest, where all are highest, and at points spread between."""
    count = len(points) // points.repeats
    rows = np.unique(np.linspace(0, count - 1, SPREAD).astype(np.int64))
    ends = [tuple(axis.end(which) for axis in points.axes) for which in (0, -1)]
    return [*ends, *points.values(rows * points.repeats)]
