"""Variants: the case at a point of a study, from the base case and the values of the axes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Any, Final, NamedTuple

from active_surface.studies.axis import Axis
from active_surface.studies.points import Points
from coupling.case import Case, PlatformCase
from coupling.scene import actuator_stiffness

Values = tuple[Any, ...]

OF_PLATE: Final = ("position", "stiffness")
"""Keys of an actuator that change the plate's shapes."""
DEEP_OF_RUN: Final = (("run", "surface_tolerance"), ("run", "start"))
"""Keys of the run that change the surface."""


class Base(NamedTuple):
    """A case with the values of those axes that change what the part moves over."""

    case: Case
    ground: str  # the same for cases whose parts move over the same shapes


class Variants:
    """The cases of a study."""

    def __init__(self, case: Case, axes: Sequence[Axis]) -> None:
        self._case, self._axes = case, axes
        self._deep = [axis for axis in axes if is_deep(case, axis)]
        self._deep_places = [k for k, axis in enumerate(axes) if axis in self._deep]
        self.drives_vary = any(axis.field.locations[0][0] in ("actuators", "lattice") for axis in axes)
        self.base = lru_cache(16)(self._base)

    def paths_of_a_base(self, points: Points) -> int:
        """How many paths that follow each other share what they move over, about."""
        if not self._deep:
            return len(points)
        shared = [len(axis.values) for axis in points.axes if axis not in self._deep]
        return points.repeats * (math.prod(shared) if points.sampling == "grid" else 1)

    def grounds(self, points: Points) -> int:
        """How many different things to move over are to be kept at a time so that none is made twice."""
        listed = [len(axis.values) for axis in self._deep]
        return 1 if points.sampling == "grid" or 0 in listed else math.prod(listed)

    def deep(self, values: Values) -> Values:
        """Those of the values of all axes that the base depends on."""
        return tuple(values[k] for k in self._deep_places)

    def at(self, values: Values) -> tuple[Case, Base]:
        """The case at a point, and the one that it shares its shapes with; raises InputError when there is none."""
        base = self.base(self.deep(values))
        pairs = [
            (axis, value)
            for k, (axis, value) in enumerate(zip(self._axes, values, strict=True))
            if k not in self._deep_places
        ]
        return (base.case.vary({axis.field.path: value for axis, value in pairs}) if pairs else base.case), base

    def _base(self, deep: Values) -> Base:
        changes = {axis.field.path: value for axis, value in zip(self._deep, deep, strict=True)}
        case = self._case.vary(changes) if changes else self._case
        held = [
            (actuator.position, spring)
            for actuator, spring in zip(case.actuators, actuator_stiffness(case), strict=True)
        ]
        plate = case.plate.model_dump_json()
        return Base(case, f"{plate} {held} {case.run.surface_tolerance!r} {case.run.start}")


def is_deep(case: Case, axis: Axis) -> bool:
    """Whether an axis changes what the part moves over, so that the case is checked as a whole."""
    first = axis.field.locations[0]
    if first[0] == "actuators":
        return first[2] in OF_PLATE
    on_platform = isinstance(case.plate, PlatformCase) and first == ("run", "duration")  # a measured motion has an end
    return first[0] in ("plate", "lattice") or first in DEEP_OF_RUN or on_platform
