"""Heights: what a plate that answers its drives is solved for, which all paths of a study decide together."""

from __future__ import annotations

import hashlib
from contextlib import suppress
from typing import Any, Final

import numpy as np
from pydantic import ValidationError

from active_surface.studies.points import Points
from active_surface.studies.study import Study
from active_surface.studies.variants import Base, Values, Variants
from coupling import answers_drives, build_drives
from particle import AnyDrive

SPREAD: Final = 48  # points whose drives stand for those of all
THEORIES: Final = ("plate.theory", "plate.inertia")
"""Fields that decide whether a plate answers its drives."""


def drive_sets(study: Study, variants: Variants, base: Base) -> list[list[AnyDrive]]:
    """Drives that stand for those of all paths over a plate that stretches or vibrates; none over another."""
    if not answers_drives(base.case):
        return []
    own = build_drives(base.case)
    if not variants.drives_vary:
        return [own]
    sets = []
    for values in _samples(study.points):
        with suppress(ValidationError, ArithmeticError):
            case = variants.at(values)[0]
            sets += [build_drives(case)] if len(case.actuators) == len(own) else []
    return sets or [own]


def heights_key(study: Study) -> str:
    """A hash of what all paths share beyond the case and their own values; "": they share nothing."""
    theories = any(axis.field.path in THEORIES for axis in study.points.axes)
    if not answers_drives(study.case) and not theories:
        return ""
    duration = max(largest(study.points, "run.duration"), default=study.case.run.duration)
    samples: list[Any] = []
    if Variants(study.case, study.points.axes).drives_vary:
        fields = [axis.field.path for axis in study.points.axes]
        samples = [sorted(zip(fields, values, strict=True)) for values in _samples(study.points)]
    return hashlib.sha256(repr((duration, samples)).encode()).hexdigest()


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
