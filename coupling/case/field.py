"""Field: one field of a case, or the same one of all actuators, found by its path."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal, get_args, get_origin

from pydantic import TypeAdapter, ValidationError
from pydantic.fields import FieldInfo

from coupling.case.actuators import LatticeCase
from coupling.case.mistakes import Location, location_text, message_of
from coupling.case.table import Table, adapter
from coupling.case.tables import CaseTables
from coupling.case.values import UNITS_REQUIRED, Directed, of_kind, parts_of, quantity_of, quoted
from coupling.case.variation import value_at
from coupling.suggestion import near, same_values

if TYPE_CHECKING:
    from coupling.case.case import Case

Value = float | int | str

ALL: Final = "*"
ONE_RUN: Final = ("scheme", "frames", "time_step")
"""Keys of [run] that say nothing to a sweep: it locates events, and writes no frames."""
FIXED: Final = {"plate.mesh": "a file", "plate.motion": "a file", "friction.file": "a file"} | dict.fromkeys(
    ("plate.shape", "friction.model"), "which other keys there are"
)
"""Fields that cannot be varied, and what they tell."""


@dataclass(frozen=True)
class Field:
    """A field by its path, such as `actuators.*.stroke`; indices count from 0, and * stands for all of them."""

    path: str
    locations: tuple[Location, ...]  # of each that takes the value
    unit: str  # in SI; "1" of a plain number, "" of a text
    kind: Literal["number", "whole", "text"]
    reader: TypeAdapter[Any]
    base: Value | None = None  # what the case has there; None: nothing, no single value, or not the same everywhere

    def read(self, value: object, in_si: bool = False) -> Value:
        """A value as a study has it, in SI units; ValueError, saying what is wrong with it.

        in_si: whether numbers without a unit are in SI units, not wrong.
        """
        try:
            read: Any = self.reader.validate_python(value, context=None if in_si else UNITS_REQUIRED)
        except ValidationError as error:
            raise ValueError("; ".join(message_of(detail, value, CaseTables) for detail in error.errors())) from None
        if self.kind == "text" and isinstance(value, str):
            return value  # also where it is read as an expression
        if isinstance(read, bool):
            return str(read).lower()
        types = {"number": (int, float), "whole": (int,), "text": (str,)}[self.kind]
        if not isinstance(read, types):
            name = {"number": "number", "whole": "whole number", "text": "text"}[self.kind]
            raise ValueError(f"must be one {name}; got {quoted(value)}")
        return float(read) if self.kind == "number" else read


def find_field(case: Case, lattice: Mapping[str, Any] | None, path: str) -> Field:
    """The field of a case at a path; ValueError, which says what there is, when there is none.

    lattice: the [lattice] of the case's file, whose actuators the case has by now.
    """
    if "[" in path:
        dotted = re.sub(r"\[([\d*]+)\]", r".\1", path)
        find_field(case, lattice, dotted)
        raise ValueError(f"must be a field of the case; got {path}; write {dotted}")
    keys = path.split(".")
    if keys[0] == "run" and keys[1:] and keys[1] in ONE_RUN:
        raise ValueError(f"must be a field that changes a path; got {path}, which a sweep does not use")
    if path in FIXED:
        raise ValueError(f"must be a field that can be varied; got {path}, which tells {FIXED[path]}")
    ends = _found(case, lattice, keys)
    locations = tuple(location for location, *_ in ends)
    _, owner, key, annotation, metadata = ends[0]
    quantity, kind = quantity_of(annotation, metadata), _kind(annotation, metadata)
    if kind is None:
        raise ValueError(f"must be a single value; got {path}, which is a list or table; name one in it")
    marked: Any = Annotated[float, quantity] if quantity else annotation
    reader = adapter(owner, key) if owner else TypeAdapter(marked)
    unit = quantity.unit if quantity else "" if kind == "text" else "1"
    base = _base(case, lattice, locations)
    base = float(base) if kind == "number" and base is not None else base
    return Field(path, locations, unit, kind, reader, base)


def locations_of(case: Case, lattice: Mapping[str, Any] | None, path: str) -> list[Location]:
    """Where the values are that a path stands for, single ones, lists or tables; raises as `find_field` does."""
    return [location for location, *_ in _found(case, lattice, path.split("."))]


def _found(case: Case, lattice: Mapping[str, Any] | None, keys: list[str]) -> list[_End]:
    return list(_ends(keys, (), case, CaseTables.model_fields, lattice))


def _base(case: Case, lattice: Mapping[str, Any] | None, locations: tuple[Location, ...]) -> Value | None:
    """The value that a case has at all of some locations; None: there is none, or they differ."""
    tables: Any = case
    if locations[0][0] == "lattice":
        tables = {"lattice": LatticeCase.model_validate(lattice, context=UNITS_REQUIRED)}
    values = [value_at(tables, location) for location in locations]
    first = str(values[0]).lower() if isinstance(values[0], bool) else values[0]
    same = all(value == values[0] for value in values)
    return first if same and isinstance(first, (int, float, str)) else None


_End = tuple[Location, Any, str, Any, list[Any]]
"""A location, the model and key that have it (an item of a list: None), its annotation and what marks that."""


def _ends(
    keys: list[str], at: Location, value: Any, fields: Mapping[str, FieldInfo], lattice: Mapping[str, Any] | None
) -> Iterable[_End]:
    """Yield where a path leads to from a table with these fields."""
    key, *rest = keys
    if key not in fields:
        inner = [] if at else _inner(key, value)
        meant = f"the case has no {key}; did you mean {' or '.join(inner)}?" if inner else _unknown(key, at, fields)
        raise ValueError(f"must be a field of the case; {meant}")
    here = (*at, key)
    field = fields[key]
    if here == ("lattice",):
        if not lattice:
            raise ValueError("must be a field of the case; it has no [lattice]")
        if not rest:
            raise ValueError("must be a single value; got lattice, which is a table")
        read = LatticeCase.model_validate(lattice, context=UNITS_REQUIRED)
        yield from _ends(rest, here, read, LatticeCase.model_fields, None)
        return
    within = getattr(value, key, None)
    if not rest:
        # Supports are one text or a table of texts, damping is a number or pairs of them.
        single = _kind(field.annotation, field.metadata) is None and type(within) in (str, float)
        annotation = type(within) if single else field.annotation
        yield here, type(value), key, annotation, field.metadata
    else:
        yield from _inside(rest, here, within, field.annotation, field.metadata)


def _inside(keys: list[str], at: Location, value: Any, annotation: Any, metadata: list[Any]) -> Iterable[_End]:
    """Yield where a path leads to from a value."""
    key, *rest = keys
    if isinstance(value, Table):
        yield from _ends(keys, at, value, type(value).model_fields, None)
        return
    if isinstance(value, dict):
        if key not in value:
            raise ValueError(f"must be a field of the case; {_unknown(key, at, value)}")
        yield (*at, key), None, key, get_args(of_kind(annotation, dict))[1], []
        return
    name = location_text(at)
    if not isinstance(value, tuple) or not value:
        has = "is not given" if value is None else "is empty" if value == () else "is a single value"
        raise ValueError(f"must be a field of the case; its {name} {has}")
    if key != ALL and not (key.isdecimal() and int(key) < len(value)):
        raise ValueError(
            f"must be a field of the case; its {name} are counted from 0 to {len(value) - 1}, * for all; got {key}"
        )
    types = get_args(of_kind(annotation, tuple))
    for index in range(len(value)) if key == ALL else [int(key)]:
        item = types[0] if types[-1:] == (...,) else types[index]
        here = (*at, index)
        # What marks the whole holds for items without a mark of their own, as the time and the height in a table have.
        quantity = None if quantity_of(item, []) else quantity_of(annotation, metadata)
        marks = [quantity] if quantity else []
        if rest:
            yield from _inside(rest, here, value[index], item, marks)
        else:
            yield here, None, key, item, marks


def _inner(key: str, case: Case) -> list[str]:
    """The paths of a field of this name in the tables of a case."""
    paths = []
    for name in CaseTables.model_fields:
        value = getattr(case, name, None)
        several = isinstance(value, tuple) and len(value) > 0
        table = value[0] if several and isinstance(value, tuple) else value
        if isinstance(table, Table) and key in type(table).model_fields:
            paths.append(f"{name}.*.{key}" if several else f"{name}.{key}")
    return paths


def _unknown(key: str, at: Location, known: Iterable[str]) -> str:
    known = [*known]
    meant = near(key, known)
    owner = location_text(at) if at else "the case"
    return f"{owner} has no {key or quoted(key)}; " + (
        f"did you mean {meant}?{'' if same_values(key, known) else f' Its values are not those of the {key}'}"
        if meant
        else f"it has {', '.join(known)}"
    )


def _kind(annotation: Any, metadata: list[Any]) -> Literal["number", "whole", "text"] | None:
    """What a value is; None where it is several."""
    parts = parts_of(annotation)
    if any(isinstance(mark, Directed) for mark in metadata):
        return "number"
    if any(get_origin(part) in (tuple, dict) or (isinstance(part, type) and issubclass(part, Table)) for part in parts):
        return None
    return "number" if float in parts else "whole" if int in parts else "text"
