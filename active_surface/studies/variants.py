"""Variants: the case at a point of a study, from the base case and the values of the axes."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any, Final, NamedTuple

from pydantic import TypeAdapter, ValidationError

from active_surface.studies.axis import Axis
from active_surface.studies.points import Points
from coupling.case import (
    ActuatorCase,
    AnyFriction,
    Case,
    LatticeCase,
    Location,
    PartCase,
    PlatformCase,
    RunCase,
    lattice_of,
    plain_case,
    put_value,
)
from coupling.scene import actuator_stiffness

Values = tuple[Any, ...]

OF_PLATE: Final = ("position", "stiffness")
"""Keys of an actuator that change the plate's shapes."""
DEEP_OF_RUN: Final = (("run", "surface_tolerance"), ("run", "start"))
"""Keys of the run that change the surface."""
KEPT: Final = 4096  # tables


class Base(NamedTuple):
    """A case with the values of those axes that change what the part moves over."""

    case: Case
    plain: Mapping[str, Any]  # the same as tables of SI values
    ground: str  # the same for cases whose parts move over the same shapes


class Variants:
    """The cases of a study."""

    def __init__(self, case: Case, axes: Sequence[Axis]) -> None:
        self._deep = [axis for axis in axes if is_deep(case, axis)]
        self._deep_places = [k for k, axis in enumerate(axes) if axis in self._deep]
        self._plain = plain_case(case)
        if any(axis.field.locations[0][0] == "lattice" for axis in axes):
            lattice, alone = lattice_of(case)
            assert lattice is not None
            # A centre that is not written may be varied in part, too.
            whole = {"centre": LatticeCase.model_fields["centre"].default} | lattice
            self._plain |= {"lattice": whole, "actuators": self._plain["actuators"][:alone]}
        heads: dict[Location, list[tuple[int, Location]]] = {}
        for k, axis in enumerate(axes):
            for location in axis.field.locations if k not in self._deep_places else ():
                depth = 2 if location[0] == "actuators" else 1
                heads.setdefault(location[:depth], []).append((k, location[depth:]))
        self._heads = heads
        self.drives_vary = any(axis.field.locations[0][0] in ("actuators", "lattice") for axis in axes)
        self.base = lru_cache(16)(self._base)
        self._tables: dict[tuple[str, str], Any] = {}

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
        """The case at a point, and the one that it shares its shapes with.

        Raises pydantic's ValidationError when there is none.
        """
        deep = self.deep(values)
        base = self.base(deep)
        changed: dict[str, Any] = {}
        actuators = list(base.case.actuators) if self._heads else []
        errors: list[Any] = []
        for head, places in self._heads.items():
            try:
                table = self._table(deep, head, tuple(values[k] for k, _ in places))
            except ValidationError as error:
                errors += [detail | {"loc": (*head, *detail["loc"])} for detail in error.errors()]
                continue
            if head[0] == "actuators":
                actuators[int(head[1])] = table
            else:
                changed[str(head[0])] = table
        if errors:
            raise ValidationError.from_exception_data("Case", errors)
        if any(head[0] == "actuators" for head in self._heads):
            changed["actuators"] = tuple(actuators)
        return base.case.model_copy(update=changed) if changed else base.case, base

    def _base(self, deep: Values) -> Base:
        plain = self._plain
        for axis, value in zip(self._deep, deep, strict=True):
            for location in axis.field.locations:
                plain = put_value(plain, location, value)
        case = Case.model_validate(plain)
        plate = case.plate.model_dump_json()
        held = [
            (actuator.position, spring)
            for actuator, spring in zip(case.actuators, actuator_stiffness(case), strict=True)
        ]
        return Base(case, plain_case(case), f"{plate} {held} {case.run.surface_tolerance!r} {case.run.start}")

    def _table(self, deep: Values, head: Location, values: Values) -> Any:
        plain: Any = self.base(deep).plain
        for key in head:
            plain = plain[key]
        for (_, location), value in zip(self._heads[head], values, strict=True):
            plain = put_value(plain, location, value)
        # Actuators that differ in nothing but their places, which do not vary here, are checked once.
        own = {"position": plain["position"]} if head[0] == "actuators" else {}
        known = str(head[0]), repr({key: value for key, value in plain.items() if key not in own})
        if known not in self._tables:
            if len(self._tables) == KEPT:
                self._tables.clear()
            self._tables[known] = _reader(head).validate_python(plain)
        return self._tables[known].model_copy(update=own) if own else self._tables[known]


def is_deep(case: Case, axis: Axis) -> bool:
    """Whether an axis changes what the part moves over, so that the case is checked as a whole."""
    first = axis.field.locations[0]
    if first[0] == "actuators":
        return first[2] in OF_PLATE
    on_platform = isinstance(case.plate, PlatformCase) and first == ("run", "duration")  # a measured motion has an end
    return first[0] in ("plate", "lattice") or first in DEEP_OF_RUN or on_platform


def _reader(head: Location) -> TypeAdapter[Any]:
    return _READERS[str(head[0])]


_READERS: Final[dict[str, TypeAdapter[Any]]] = {
    "actuators": TypeAdapter(ActuatorCase),
    "part": TypeAdapter(PartCase),
    "friction": TypeAdapter(AnyFriction),
    "run": TypeAdapter(RunCase),
}
