"""Robustness: how runs deviate from their case, field by field, and how far from the target they end."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np
from pydantic import TypeAdapter, ValidationError

from active_surface.arrays import FloatArray
from coupling.case import ActuatorCase, Case, Location, Quantity, SegmentCase, Table, find_field, lattice_of, quoted

FRICTION: Final = "friction"  # as a whole, which no field of a case is
START: Final = "part.position"
DEFAULTS: Final[Mapping[str, str]] = {FRICTION: "1 %", START: "1 um", "actuators.*.stroke": "1 %"}
DEFAULT_TEXT: Final = "friction and strokes up to 1 %, starts up to 1 um off"
OF_PLATE: Final = ("position", "stiffness")
SEARCHED, REPORTED = 0, 1  # independent streams of random numbers


class Deviation(NamedTuple):
    """By how much a field deviates at most; each of its locations does so by itself."""

    path: str
    locations: tuple[Location, ...]
    size: float  # in SI units, or a share of the value
    is_relative: bool
    reader: TypeAdapter[Any] | None = None


class Change(NamedTuple):
    """A deviation at one of its locations."""

    location: Location
    amount: float
    deviation: Deviation

    def of(self, value: float) -> float:
        """The changed value; one that the field cannot have is changed the other way, or not at all."""
        for amount in (self.amount, -self.amount):
            changed = value * (1 + amount) if self.deviation.is_relative else value + amount
            if self.deviation.reader is None or _is_valid(self.deviation.reader, changed):
                return changed
        return value


class Disturbance(NamedTuple):
    """How a run differs from its case."""

    friction: float = 1.0  # factor of the law as a whole
    shift: tuple[float, float] = (0.0, 0.0)  # m, of the start
    changes: tuple[Change, ...] = ()


def deviations(case: Case, sizes: Mapping[str, object] | None) -> tuple[Deviation, ...]:
    """The deviations of a case: of fields by their paths, `friction` and `part.position` among them.

    sizes: texts such as "2 %" or "1 um"; None: those of DEFAULTS.

    Raises ValueError with every wrong path and size.
    """
    found, wrong = [], []
    for path, size in (DEFAULTS if sizes is None else sizes).items():
        try:
            found.append(_deviation(case, path, size))
        except ValueError as error:
            wrong.append(f"{path} {error}")
    if wrong:
        raise ValueError("\n".join(wrong))
    first = (FRICTION, START)
    return tuple(sorted(found, key=lambda one: first.index(one.path) if one.path in first else len(first)))


def _deviation(case: Case, path: str, size: object) -> Deviation:
    if path in (FRICTION, START):
        amount, is_relative = _size(size, "m" if path == START else "")
        if path == START and is_relative:
            raise ValueError(f'must be a length such as "1 um", of which nothing is a share; got {quoted(size)}')
        return Deviation(path, (), amount, is_relative)
    field = find_field(case, lattice_of(case)[0], path)
    head = field.locations[0]
    if head[0] not in ("part", "friction", "air", "actuators") or (head[0] == "actuators" and head[2] in OF_PLATE):
        raise ValueError(
            "must be a field of the part, the friction, the air or what drives an actuator; "
            f"got {path}, which a sweep can vary: it changes more than the path"
        )
    if field.kind != "number":
        raise ValueError(f"must be a field that is a number; got {path}, which is a {_KINDS[field.kind]}")
    if not any(_has_value(case, location) for location in field.locations):
        raise ValueError(f"must be a field that the case has a value of; got {path}, which is not given")
    amount, is_relative = _size(size, field.unit)
    return Deviation(path, field.locations, amount, is_relative, field.reader)


_KINDS: Final = {"whole": "whole number", "text": "text"}


def _size(size: object, unit: str) -> tuple[float, bool]:
    """The largest deviation in a text, in SI units or as a share of the value; whether it is a share.

    unit: of the field in SI; "": only a share will do, "1": a plain number.
    """
    is_share = isinstance(size, str) and size.rstrip().endswith("%")
    try:
        if is_share:
            amount = float(str(size).rstrip()[:-1]) / 100
        elif unit == "1" and isinstance(size, (int, float)) and not isinstance(size, bool):
            amount = float(size)
        elif unit not in ("", "1") and isinstance(size, str):
            amount = Quantity(unit, f"1 {unit}").parse(size)
        else:
            raise ValueError
    except ValueError:
        other = {"": "", "1": " or a number"}.get(unit, f" or a quantity in {unit}")
        raise ValueError(f'must deviate by a share such as "2 %"{other}; got {quoted(size)}') from None
    if not 0 <= amount < (1 if is_share else math.inf):
        less = ", and by less than 100 %" if is_share else ""
        raise ValueError(f"must deviate by 0 or more{less}; got {quoted(size)}")
    return amount, is_share


def draws(count: int, deviating: Sequence[Deviation], seed: int, stream: int) -> list[Disturbance]:
    """Disturbances, each a function of seed, stream and its number alone.

    All are independent and uniform: up to their sizes above and below the values, the start on a disc around its place.
    """
    numbers = sum(2 if one.path == START else max(1, len(one.locations)) for one in deviating)
    return [_drawn(np.random.default_rng((seed, stream, k)).random(numbers).tolist(), deviating) for k in range(count)]


def _drawn(uniform: Sequence[float], deviating: Sequence[Deviation]) -> Disturbance:
    numbers = iter(uniform)
    friction, shift = 1.0, (0.0, 0.0)
    changes: list[Change] = []
    for one in deviating:
        if one.path == FRICTION:
            friction = 1 + one.size * (2 * next(numbers) - 1)
        elif one.path == START:
            radius, angle = one.size * math.sqrt(next(numbers)), 2 * math.pi * next(numbers)
            shift = radius * math.cos(angle), radius * math.sin(angle)
        else:
            changes += [Change(place, one.size * (2 * next(numbers) - 1), one) for place in one.locations]
    return Disturbance(friction, shift, tuple(changes))


def disturbed(case: Case, changes: Sequence[Change]) -> Case:
    """A case with changed values in its part, its friction and its drives; those of segments with their actuator's."""
    tables: dict[str, Any] = {"part": case.part, "friction": case.friction}
    actuators = list(case.actuators)
    for change in changes:
        head, *keys = change.location
        if head == "actuators":
            actuators[int(keys[0])] = _changed(actuators[int(keys[0])], keys[1:], change)
        else:
            tables[str(head)] = _changed(tables[str(head)], keys, change)
    part = tables["part"]
    if part.face is not None:  # whose mass, height and outline follow from its fields
        tables["part"] = type(part)(**{key: getattr(part, key) for key in part.model_fields_set})
    return case.model_copy(update={**tables, "actuators": tuple(actuators), "source": None})


def _changed(value: Any, keys: Sequence[Any], change: Change) -> Any:
    """The same with the value at some keys changed; one that is absent, or a stroke of 0, which rests, stays."""
    if not keys:
        return value if value is None else change.of(value)
    key, *rest = keys
    if _is_in_segments(value, key) and not rest:
        return value.model_copy(update={"segments": tuple(_changed(one, keys, change) for one in value.segments)})
    if not isinstance(value, Table):
        return (*value[: int(key)], _changed(value[int(key)], rest, change), *value[int(key) + 1 :])
    if (key == "stroke" and not getattr(value, key)) or (key == "dwell" and getattr(value, "cycle", "") == "hold"):
        return value
    return value.model_copy(update={key: _changed(getattr(value, key), rest, change)})


def _is_in_segments(value: Any, key: object) -> bool:
    """Whether the segments of an actuator have the values of a key."""
    return isinstance(value, ActuatorCase) and value.segments is not None and key in SegmentCase.model_fields


def stroke_room(deviating: Sequence[Deviation], actuator: int, largest: float) -> float:
    """The largest factor by which deviations make a stroke of up to `largest` [m] longer."""
    factor = 1.0
    for one in deviating:
        if ("actuators", actuator, "stroke") in one.locations:
            factor *= 1 + (one.size if one.is_relative else one.size / largest if largest else 0.0)
    return factor


def disturbance_text(sizes: Mapping[str, object] | None) -> str:
    """The deviations in words."""
    if sizes is None:
        return DEFAULT_TEXT
    return ", ".join(f"{path} up to {size}" for path, size in sizes.items()) or "no disturbances"


def _has_value(case: Case, location: Location) -> bool:
    """Whether a case has a value at a location, or its actuator has segments that have one."""
    value: Any = case
    for key in location:
        owner, value = value, getattr(value, key) if isinstance(key, str) else value[key]
    return value is not None or _is_in_segments(owner, location[-1])


def _is_valid(reader: TypeAdapter[Any], value: float) -> bool:
    try:
        reader.validate_python(value)
    except ValidationError:
        return False
    return True


@dataclass(frozen=True, eq=False)
class Scatter:
    """The ends of disturbed runs, and their distances from the target."""

    ends: FloatArray  # (n, 2) m
    distance: FloatArray  # (n,) m, inf for lost parts: detached, beyond the rim or the like

    @property
    def lost(self) -> int:
        """How many were lost."""
        return int(np.isinf(self.distance).sum())

    def quantile(self, share: float) -> float:
        """The distance [m] within which a share of the parts ends; inf where too many were lost."""
        # That of one of the parts: between two of them, or between one and inf, there is none.
        return float(np.quantile(self.distance, share, method="inverted_cdf"))

    def cvar(self, share: float) -> float:
        """The conditional value at risk: the mean distance [m] of parts beyond a quantile; inf where one is lost."""
        return float(conditional_value_at_risk(self.distance, share)) if not self.lost else math.inf

    def as_dict(self) -> dict[str, Any]:
        """Its figures by name, in SI units; None where too many were lost."""
        quantiles = {
            name: self.quantile(share) for name, share in (("median", 0.5), ("nine_in_ten", 0.9), ("worst", 1.0))
        }
        figures = quantiles | {"cvar_nine_in_ten": self.cvar(0.9)}
        within = {name: distance if math.isfinite(distance) else None for name, distance in figures.items()}
        return {"count": len(self.distance), **within, "lost": self.lost}


def conditional_value_at_risk(distances: FloatArray, share: float) -> FloatArray:
    """The mean of the largest 1 - share of distances (..., n), by Rockafellar and Uryasev's (2000) formula."""
    # The one in which the share ends counts in part, so that it is continuous in the share.
    quantile = np.quantile(distances, share, axis=-1, method="inverted_cdf", keepdims=True)
    beyond = np.maximum(distances - quantile, 0).mean(axis=-1) / (1 - share)
    return np.asarray(quantile[..., 0] + beyond)
