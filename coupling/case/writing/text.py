"""A case as the text of a case file, which has every quantity to the last bit."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterator, Mapping, Sequence
from decimal import Decimal
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final, Literal, get_args, get_origin

from pydantic.fields import FieldInfo

from coupling.case.case import Case
from coupling.case.table import Table
from coupling.case.values import Quantity, of_kind, prefixed, quantity_of, unit_of
from coupling.files import whole_file

PREFIXED: Final = {"m": ("um", 6), "s": ("ms", 3), "N": ("uN", 6), "Pa": ("GPa", -9)}
"""What is written in place of an SI unit, and how many powers of ten smaller it is."""
SMALLEST, LARGEST = Decimal("1e-4"), Decimal("1e6")  # numbers that are written without a power of ten
FILES: Final = (("plate", "mesh"), ("plate", "motion"), ("friction", "file"))
"""Fields that may name a file, which is counted from the case file's folder."""


def write_case(case: Case, path: Path, said: str = "") -> Path:
    """Writes a case to a file, made as a whole or not at all; returns its path.

    said: a comment to begin with.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole_file(path) as partial:
        partial.write_text(commented(said) + case_text(case, path.parent), encoding="utf-8")
    return path


def commented(said: str) -> str:
    """A text as a comment at the head of a file, with an empty line below it."""
    return "".join(f"# {line}\n" for line in said.splitlines()) + ("\n" if said else "")


def case_text(case: Case, folder: Path) -> str:
    """The text of a file in a folder from which `read_case` gets the same case."""
    blocks: list[str] = []
    for key in Case.model_fields:
        value = getattr(case, key)
        if isinstance(value, Table):
            blocks.append("\n".join([f"[{key}]", *_lines(value, key, folder)]))
        elif isinstance(value, tuple):
            blocks += [block(key, item, folder, {}) for item in value]
    return "\n\n".join(blocks) + "\n"


def block(key: str, table: Table, folder: Path, like: Mapping[str, Any]) -> str:
    """A table in double brackets, with its segments below it; like: values by key whose units it takes."""
    lines = [f"[[{key}]]", *_lines(table, key, folder, like, without="segments")]
    for segment in getattr(table, "segments", None) or ():
        lines += ["", f"[[{key}.segments]]", *_lines(segment, "segments", folder)]
    return "\n".join(lines)


def _lines(
    table: Table, name: str, folder: Path, like: Mapping[str, Any] = MappingProxyType({}), without: str = ""
) -> Iterator[str]:
    """Yield a line for each key of a table that is not what it would be anyway."""
    for key, field in type(table).model_fields.items():
        value = getattr(table, key)
        if key == without or not _needed(table, key, field, value):
            continue
        if (name, key) in FILES and isinstance(value, str):
            value = os.path.relpath(value, folder)
        yield f"{key} = {written(value, field.rebuild_annotation(), like.get(key))}"


def _needed(table: Table, key: str, field: FieldInfo, value: Any) -> bool:
    if value is None:
        return False
    if field.default_factory is not None:
        return key in table.model_fields_set
    names_its_table = get_origin(field.annotation) is Literal and len(get_args(field.annotation)) == 1
    return names_its_table or field.is_required() or value != field.default


def written(value: Any, annotation: Any, like: Any = None, marks: Sequence[Any] = ()) -> str:
    """A value as TOML; annotation: of the field that has it, like: what a file had there, whose units it takes.

    marks: of all items of a list, for an item that has none of its own.
    """
    if isinstance(value, Table):
        keys = type(value).model_fields.items()
        found = [(key, field, getattr(value, key)) for key, field in keys]
        kept = [(key, field, item) for key, field, item in found if _needed(value, key, field, item)]
        return (
            "{ " + ", ".join(f"{key} = {written(item, field.rebuild_annotation())}" for key, field, item in kept) + " }"
        )
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{json.dumps(key)} = {written(item, str)}" for key, item in value.items()) + " }"
    if isinstance(value, tuple):
        alike = like if isinstance(like, list) and len(like) == len(value) else [like] * len(value)
        items = zip(items_of(value, annotation), alike, strict=True)
        return "[" + ", ".join(written(item, kind, one, marks) for (item, kind, marks), one in items) + "]"
    quantity = quantity_of(annotation, lists=False) or next(iter(marks), None)
    if quantity is None or not isinstance(value, float):
        whole = isinstance(value, float) and isinstance(like, int) and value.is_integer()
        return json.dumps(int(value) if whole else value, ensure_ascii=False)
    return f'"{_in_unit_of(like, value, quantity) or _in_usual_unit(value, quantity)}"'


def items_of(value: tuple[Any, ...], annotation: Any) -> Iterator[tuple[Any, Any, list[Any]]]:
    """Yield each item of a list, its annotation, and the marks of all; annotation: of the list."""
    types = get_args(of_kind(annotation, tuple))
    kinds = [types[0]] * len(value) if types[-1] is Ellipsis else types
    marks = [mark for mark in [quantity_of(annotation, lists=False)] if mark]
    for item, kind in zip(value, kinds, strict=True):
        yield item, kind, marks


def _in_usual_unit(value: float, quantity: Quantity) -> str:
    number, (unit, power) = Decimal(repr(float(value))), PREFIXED.get(quantity.unit, (quantity.unit, 0))
    if abs(number.scaleb(power)) >= LARGEST or (power < 0 and abs(number.scaleb(power)) < SMALLEST):
        unit, power = quantity.unit, 0
    return f"{_plain(number.scaleb(power))} {unit}"


def _in_unit_of(like: Any, value: float, quantity: Quantity) -> str:
    """A quantity in the unit of a text; "" where it has none, or where that is inexact or less readable than usual."""
    unit = unit_of(like) if isinstance(like, str) else ""
    if not unit:
        return ""
    base, power = prefixed(unit)
    if base == quantity.unit:
        number = Decimal(repr(value)).scaleb(-power)
    else:
        number = Decimal(f"{value / quantity.value_of(like, '1', unit):.12g}")
    text = f"{_plain(number)} {unit}"
    worse = not _readable(number) and "e" not in like.removesuffix(unit) + _in_usual_unit(value, quantity).split()[0]
    return "" if worse or not math.isclose(quantity.parse(text), value, rel_tol=1e-15) else text


def _readable(number: Decimal) -> bool:
    return number == 0 or SMALLEST <= abs(number) < LARGEST


def _plain(number: Decimal) -> str:
    """A number, without a power of ten where that is readable."""
    return f"{number.normalize():{'f' if _readable(number) else 'e'}}"
