"""Fields of a case by their paths, such as `actuators.*.stroke`, and cases with other values in them."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, Final, Literal, NamedTuple, get_args, get_origin

from pydantic import TypeAdapter, ValidationError

from coupling.case.actuators import LatticeCase
from coupling.case.table import Location, Table, location_text, mistakes_of, stated, tables_in
from coupling.case.tables import CaseTables
from coupling.case.values import (
    UNITS_REQUIRED,
    kinds_of_items,
    of_kind,
    parts_of,
    quantity_of,
    quoted,
)
from coupling.suggestion import near

if TYPE_CHECKING:
    from coupling.case.case import Case

Value = float | int | str

ALL: Final = "*"
ONE_RUN: Final = ("scheme", "frames", "time_step")
"""Keys of [run] that say nothing to a sweep: it locates events, and writes no frames."""
FIXED: Final = {"plate.mesh": "names a file", "plate.motion": "names a file", "friction.file": "names a file"} | (
    dict.fromkeys(("plate.shape", "friction.model"), "selects which other keys exist")
)
"""Fields that cannot be varied, and why."""


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
            raise ValueError("; ".join(message for _, message in mistakes_of(error, CaseTables, value))) from None
        if self.kind == "text" and isinstance(value, str):
            return value  # also where it is read as an expression
        if isinstance(read, bool):
            return str(read).lower()
        types = {"number": (int, float), "whole": (int,), "text": (str,)}[self.kind]
        if not isinstance(read, types):
            name = {"number": "number", "whole": "whole number", "text": "text"}[self.kind]
            raise ValueError(f"must be one {name}; got {quoted(value)}")
        return float(read) if self.kind == "number" else read


class _End(NamedTuple):
    """Where a path leads to: what is there, and the annotation of its field, marks included."""

    location: Location
    value: Any
    annotation: Any


def find_field(case: Case, lattice: Mapping[str, Any] | None, path: str) -> Field:
    """The field of a case at a path; ValueError, which says what there is, when there is none.

    lattice: the [lattice] of the case's file, whose actuators the case has by now.
    """
    if path.startswith("run.") and path[4:] in ONE_RUN:
        raise ValueError(f"must be a field that changes a path; got {path}, which a sweep does not use")
    if path in FIXED:
        raise ValueError(f"cannot be varied: {path} {FIXED[path]}")
    ends = _ends(case, lattice, path)
    first, annotation = ends[0].value, ends[0].annotation
    kind = _kind(annotation, first)
    if kind is None:
        raise ValueError(f"must be a single value; got {path}, which is a list or table; name one in it")
    quantity = quantity_of(annotation, lists=False)
    unit = quantity.unit if quantity else "" if kind == "text" else "1"
    same = all(end.value == first for end in ends) and isinstance(first, (int, float, str))
    base = None if not same else str(first).lower() if isinstance(first, bool) else first
    base = float(base) if kind == "number" and base is not None else base
    return Field(path, tuple(end.location for end in ends), unit, kind, _reader(annotation), base)


@cache
def _reader(annotation: Any) -> TypeAdapter[Any]:
    return TypeAdapter(annotation)


def locations_of(case: Case, lattice: Mapping[str, Any] | None, path: str) -> list[Location]:
    """Where the values are that a path stands for, single ones, lists or tables; raises as `find_field` does."""
    return [end.location for end in _ends(case, lattice, path)]


def _ends(case: Case, lattice: Mapping[str, Any] | None, path: str) -> list[_End]:
    """Where a path leads to."""
    if "[" in path:
        dotted = re.sub(r"\[([\d*]+)\]", r".\1", path)
        raise ValueError(f"must be a field of the case; got {path}; write {dotted}")
    first, *keys = path.split(".")
    if first not in CaseTables.model_fields:
        inner = _inner(first, case)
        meant = f"did you mean {' or '.join(inner)}?" if inner else _known(first, CaseTables.model_fields)
        raise ValueError(f"must be a field of the case; the case has no {first or quoted(first)}; {meant}")
    value = getattr(case, first)
    if first == "lattice":
        if not lattice:
            raise ValueError("must be a field of the case; it has no [lattice]")
        value = LatticeCase.model_validate(lattice, context=UNITS_REQUIRED)
    ends = [_End((first,), value, CaseTables.model_fields[first].rebuild_annotation())]
    for key in keys:
        ends = [inner for end in ends for inner in _below(end, key)]
    return ends


def _below(end: _End, key: str) -> Iterator[_End]:
    """Yield what a key leads to from a value."""
    location, value = end.location, end.value
    if isinstance(value, Table | dict):
        fields: Mapping[str, Any] = value if isinstance(value, dict) else type(value).model_fields
        if key not in fields:
            table = location_text(location)
            raise ValueError(f"must be a field of the case; {table} has no {key or quoted(key)}; {_known(key, fields)}")
        if isinstance(value, dict):
            yield _End((*location, key), value[key], get_args(of_kind(end.annotation, dict))[1])
        else:
            yield _End((*location, key), getattr(value, key), fields[key].rebuild_annotation())
        return
    if not isinstance(value, tuple) or not value:
        has = "is not given" if value is None else "is empty" if value == () else "is a single value"
        raise ValueError(f"must be a field of the case; its {location_text(location)} {has}")
    if key != ALL and not (key.isdecimal() and int(key) < len(value)):
        counted = f"are counted from 0 to {len(value) - 1}, * for all"
        raise ValueError(f"must be a field of the case; its {location_text(location)} {counted}; got {key}")
    kinds = kinds_of_items(end.annotation, len(value))
    for index in range(len(value)) if key == ALL else [int(key)]:
        yield _End((*location, index), value[index], kinds[index])


def _inner(key: str, case: Case) -> list[str]:
    """The paths of a field of this name in the tables of a case."""
    paths = []
    for name in CaseTables.model_fields:
        value = getattr(case, name)
        table = value[0] if isinstance(value, tuple) and value else value
        if isinstance(table, Table) and key in type(table).model_fields:
            paths.append(f"{name}.{key}" if table is value else f"{name}.*.{key}")
    return paths


def _known(key: str, known: Mapping[str, Any]) -> str:
    meant = near(key, known)
    return f"did you mean {meant}?" if meant else f"it has {', '.join(known)}"


def _kind(annotation: Any, value: Any) -> Literal["number", "whole", "text"] | None:
    """What a value is, by the annotation of its field, or by itself where that may be a list or table; None: those."""
    parts = parts_of(annotation)
    if quantity_of(annotation, lists=False):
        return "number"
    if tables_in(annotation) or any(get_origin(part) in (tuple, dict) for part in parts):
        return "text" if isinstance(value, str) else "number" if isinstance(value, float) else None
    return "number" if float in parts else "whole" if int in parts else "text"


def plain_case(case: Case) -> dict[str, Any]:
    """The tables of a case by their keys."""
    return {key: getattr(case, key) for key in CaseTables.model_fields}


def lattice_of(case: Case) -> tuple[dict[str, Any] | None, int]:
    """The [lattice] in the text of a case, and how many actuators are given beside it one by one."""
    written = tomllib.loads(case.source) if case.source else {}
    # Beside a lattice that is written none need be, and those of the case are the lattice's.
    return written.get("lattice"), len(written.get("actuators", () if "lattice" in written else case.actuators))


def put_value(value: Any, location: Location, new: Any) -> Any:
    """The same tables with another value at a location; ValueError where there is no such table or list any more."""
    if not location:
        return new
    key, rest = location[0], location[1:]
    if isinstance(value, Table):
        return {**stated(value), key: put_value(getattr(value, str(key)), rest, new)}
    if isinstance(value, dict):
        return {**value, key: put_value(value.get(key), rest, new)}
    if isinstance(value, (tuple, list)) and isinstance(key, int) and key < len(value):
        return (*value[:key], put_value(value[key], rest, new), *value[key + 1 :])
    raise ValueError(f"must be in a table or list that has it; got {quoted(value)} there")
