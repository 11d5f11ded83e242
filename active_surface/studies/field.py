"""Field: one field of a case, or the same one of all actuators, found by its path."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Final, Literal, get_args, get_origin

from pydantic import TypeAdapter, ValidationError
from pydantic.fields import FieldInfo

from coupling import near
from coupling.case import (
    UNITS_REQUIRED,
    Case,
    Directed,
    LatticeCase,
    Location,
    Table,
    adapter,
    location_text,
    message_of,
    of_kind,
    parts_of,
    quantity_of,
    quoted,
)

Value = float | int | str

ALL: Final = "*"
LEFT_OUT: Final = ("name", "source")  # of a case, what no file has
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

    def read(self, value: object) -> Value:
        """A value as a study has it, in SI units; ValueError, saying what is wrong with it."""
        try:
            read: Any = self.reader.validate_python(value, context=UNITS_REQUIRED)
        except ValidationError as error:
            raise ValueError("; ".join(message_of(detail, value, Case) for detail in error.errors())) from None
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
    keys = path.split(".")
    if keys[0] == "run" and keys[1:] and keys[1] in ONE_RUN:
        raise ValueError(f"must be a field that changes a path; got {path}, which a sweep does not use")
    if path in FIXED:
        raise ValueError(f"must be a field that can be varied; got {path}, which tells {FIXED[path]}")
    fields = {key: field for key, field in Case.model_fields.items() if key not in LEFT_OUT}
    ends = list(_ends(keys, (), case, fields, lattice))
    locations = tuple(location for location, *_ in ends)
    _, owner, key, annotation, metadata = ends[0]
    quantity, kind = quantity_of(annotation, metadata), _kind(annotation, metadata)
    if kind is None:
        raise ValueError(f"must be a single value; got {path}, which is a list or table; name one in it")
    marked: Any = Annotated[float, quantity] if quantity else annotation
    reader = adapter(owner, key) if owner else TypeAdapter(marked)
    return Field(path, locations, quantity.unit if quantity else "" if kind == "text" else "1", kind, reader)


_End = tuple[Location, Any, str, Any, list[Any]]
"""A location, the model and key that have it (an item of a list: None), its annotation and what marks that."""


def _ends(
    keys: list[str], at: Location, value: Any, fields: Mapping[str, FieldInfo], lattice: Mapping[str, Any] | None
) -> Iterable[_End]:
    """Yield where a path leads to from a table with these fields."""
    key, *rest = keys
    if key not in fields:
        raise ValueError(f"must be a field of the case; {_unknown(key, at, fields)}")
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
        # Supports are one text or a table of texts.
        annotation = str if isinstance(within, str) else field.annotation
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


def _unknown(key: str, at: Location, known: Iterable[str]) -> str:
    meant = near(key, known)
    owner = location_text(at) if at else "the case"
    return f"{owner} has no {key or quoted(key)}; " + (
        f"did you mean {meant}?" if meant else f"it has {', '.join(known)}"
    )


def _kind(annotation: Any, metadata: list[Any]) -> Literal["number", "whole", "text"] | None:
    """What a value is; None where it is several."""
    parts = parts_of(annotation)
    if any(isinstance(mark, Directed) for mark in metadata):
        return "number"
    if any(get_origin(part) in (tuple, dict) or (isinstance(part, type) and issubclass(part, Table)) for part in parts):
        return None
    return "number" if float in parts else "whole" if int in parts else "text"
