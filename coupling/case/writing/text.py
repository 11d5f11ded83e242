"""A case as the text of a case file, which has every quantity to the last bit."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterator, Mapping
from decimal import Decimal
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final, NamedTuple

from coupling.case.case import Case
from coupling.case.fields import ALL, plain_case
from coupling.case.table import Location, Table, stated
from coupling.case.values import Quantity, kinds_of_items, prefixed, quantity_of, unit_of
from coupling.files import whole_file

PREFIXED: Final = {"m": ("um", 6), "s": ("ms", 3), "N": ("uN", 6), "Pa": ("GPa", -9)}
"""What is written instead of an SI unit, and how many powers of ten smaller it is."""
SMALLEST, LARGEST = Decimal("1e-4"), Decimal("1e6")  # numbers that are written without a power of ten
LEAST_OF_LARGER: Final = Decimal("1e-3")  # of a unit larger than the SI unit
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
            blocks.append(block(key, value, folder))
        elif isinstance(value, tuple):
            blocks += [block(key, item, folder, brackets=2) for item in value]
    return "\n\n".join(blocks) + "\n"


def block(
    name: str, table: Table, folder: Path, like: Mapping[str, Any] = MappingProxyType({}), brackets: int = 1
) -> str:
    """A table below its header, with its segments below it; like: values by key whose units it takes."""
    lines, below = ["[" * brackets + name + "]" * brackets], []
    for key, value, annotation in _stated(table):
        if isinstance(value, tuple) and value and isinstance(value[0], Table):
            below += [block(f"{name}.{key}", item, folder, brackets=2) for item in value]
            continue
        if (name, key) in FILES and isinstance(value, str):
            value = os.path.relpath(value, folder)
        lines.append(f"{key} = {written(value, annotation, like.get(key))}")
    return "\n\n".join(["\n".join(lines), *below])


def _stated(table: Table) -> Iterator[tuple[str, Any, Any]]:
    """Yield each key of a table that is not what it would be anyway, its value and its annotation."""
    for key, value in stated(table).items():
        yield key, value, type(table).model_fields[key].rebuild_annotation()


def written(value: Any, annotation: Any, like: Any = None) -> str:
    """A value as TOML; annotation: of the field that has it, like: what a file had there, whose units it takes."""
    if isinstance(value, Table):
        return "{ " + ", ".join(f"{key} = {written(item, kind)}" for key, item, kind in _stated(value)) + " }"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{json.dumps(key)} = {written(item, str)}" for key, item in value.items()) + " }"
    if isinstance(value, tuple):
        alike = like if isinstance(like, list) and len(like) == len(value) else [like] * len(value)
        return "[" + ", ".join(map(written, value, kinds_of_items(annotation, len(value)), alike)) + "]"
    quantity = quantity_of(annotation, lists=False)
    if quantity is None or not isinstance(value, float):
        whole = isinstance(value, float) and isinstance(like, int) and value.is_integer()
        return json.dumps(int(value) if whole else value, ensure_ascii=False)
    return f'"{_in_unit_of(like, value, quantity) or _in_usual_unit(value, quantity)}"'


def _in_usual_unit(value: float, quantity: Quantity) -> str:
    number, (unit, power) = Decimal(repr(float(value))), PREFIXED.get(quantity.unit, (quantity.unit, 0))
    if abs(number.scaleb(power)) >= LARGEST or (power < 0 and abs(number.scaleb(power)) < LEAST_OF_LARGER):
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


class Difference(NamedTuple):
    """A field in which two cases differ, and its values with their units; "-": it has none there."""

    field: str  # its place as in studies; with * for all actuators
    first: str
    second: str


def differences(first: Case, second: Case) -> Iterator[Difference]:
    """Yield the fields in which two cases differ; a field that names a file where that has other contents."""
    one, other = dict(_leaves(plain_case(first))), dict(_leaves(plain_case(second)))
    found: dict[Location, list[Difference]] = {}
    for place in one | other:
        (value, text, given), (value_2, text_2, given_2) = (
            side.get(place, (None, "-", False)) for side in (one, other)
        )
        if value != value_2 and (given or given_2):
            general = (place[0], ALL, *place[2:]) if place[0] == "actuators" else place
            again = f" ({'other contents' if isinstance(value, bytes) else 'by rounding'})" if text == text_2 else ""
            found.setdefault(general, []).append(Difference(".".join(map(str, place)), text, text_2 + again))
    count = len(first.actuators) if len(first.actuators) == len(second.actuators) else 0
    for place, rows in found.items():
        alike = 1 < len(rows) == count and len({row[1:] for row in rows}) == 1
        yield from [Difference(".".join(map(str, place)), *rows[0][1:])] if alike else rows


def _leaves(
    value: Any, annotation: Any = None, place: Location = (), given: bool = True
) -> Iterator[tuple[Location, Any]]:
    """Yield the place of each field that has a value; its value, its text, and whether it is not what it would be."""
    if isinstance(value, Table):
        for key, field in type(value).model_fields.items():
            yield from _leaves(getattr(value, key), field.rebuild_annotation(), (*place, key), key in stated(value))
    elif not place or (isinstance(value, tuple) and value and isinstance(value[0], Table)):
        for name, item in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _leaves(item, None, (*place, name))
    elif (place[0], place[-1]) in FILES and isinstance(value, str):
        yield place, (Path(value).read_bytes(), Path(value).name, given)
    elif value is not None and value != ():
        quantity = quantity_of(annotation, lists=False)
        angle = quantity and quantity.unit == "rad"
        text = written(value, annotation, "0 deg") if angle else written(_rounded(value), annotation)
        yield place, (value, text.replace('"', ""), given)


def _rounded(value: Any) -> Any:
    """The value with its numbers to twelve digits, as people read them."""
    if isinstance(value, tuple):
        return tuple(map(_rounded, value))
    return float(f"{value:.12g}") if isinstance(value, float) else value
