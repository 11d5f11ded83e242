"""The points of a measured friction law: in the case file, or in a file beside it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Final

from pydantic import BeforeValidator, TypeAdapter, ValidationError

from coupling.case.csv_columns import unreadable
from coupling.case.units import Force, Quantity, shown

Location = tuple[int | str, ...]
Mistakes = list[tuple[Location, str]]

EXAMPLE: Final = '["-1 uN", "0 N", "5 uN"]'
HEADER: Final = "load [uN], limit [nN]"
FORCE: Final = Quantity("N", "2 uN")
COLUMNS: Final = {"loads": "load", "limits": "limit"}


def _several(value: object) -> object:
    if not isinstance(value, (list, tuple)):
        raise ValueError(f"must be a list of forces such as {EXAMPLE}; got {shown(value)}")
    return value


Forces = Annotated[tuple[Force, ...], BeforeValidator(_several)]
_forces: Final = TypeAdapter(Forces)


def of_table(table: Mapping[str, Any], context: Mapping[str, Any]) -> tuple[dict[str, Any], Mistakes]:
    """The `loads` and `limits` [N] that a file gives a friction table, and what is wrong with its points.

    What the validation of each field finds is left to that. `context` is that of the validation.
    """
    file = table.get("file")
    if file is None:
        return {}, list(_given(table, context))
    mistakes: Mistakes = [
        ((name,), "must not be given with a file, which holds the points") for name in COLUMNS if name in table
    ]
    if not isinstance(file, str):
        return {}, mistakes
    points, wrong = _read(Path(context.get("folder", ""), file))
    where = f"in {Path(file).name}: "
    told = [message if message.startswith("must be a file") else where + message for message in wrong]
    return points | {"file": None}, mistakes + [(("file",), message) for message in told]


def _given(table: Mapping[str, Any], context: Mapping[str, Any]) -> Iterator[tuple[Location, str]]:
    """What is wrong with points in the case file itself."""
    from particle.friction import FEWEST, mistakes  # here, because loading it takes longer than reading a case

    if table.get("loads") is None:
        yield ("loads",), f'is missing; it must be forces such as {EXAMPLE}, or have file = "friction.csv" in its place'
    elif table.get("limits") is None:
        yield ("limits",), "is missing; it must be as many forces as the loads"
    values = {name: _valid(table.get(name), context) for name in COLUMNS}
    loads, limits = values["loads"], values["limits"]
    # For one that is wrong or missing stands one that fits the other.
    length = max(len(loads or limits or ()), FEWEST)
    whole = loads is not None and limits is not None
    for name, point, message in mistakes(
        range(-1, length - 1) if loads is None else loads, [0.0] * length if limits is None else limits
    ):
        if values[name] is not None and (whole or point is not None):
            yield (name,) if point is None else (name, point), message


def _valid(value: Any, context: Mapping[str, Any]) -> tuple[float, ...] | None:
    try:
        return _forces.validate_python(value, context=dict(context))
    except ValidationError:
        return None


def _read(path: Path) -> tuple[dict[str, Any], list[str]]:
    """The points of a file and what is wrong with it, by its lines.

    Below a header that names the columns and their units there is a line for each point. Columns of other names, empty
    lines and lines that begin with # are left out.
    """
    from particle.friction import mistakes

    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        return {}, ["is not UTF-8 text"]
    except (OSError, ValueError) as error:
        return {}, [unreadable(path.name, error)]
    rows = [
        (number, [cell.strip() for cell in line.split(",")])
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not rows:
        return {}, [f'is empty; it must begin with a header such as "{HEADER}"']
    (number, header), *rows = rows
    units, unnamed = _units(header)
    if unnamed:
        return {}, [f"line {number} {message}" for message in unnamed]
    wrong: list[tuple[int, str]] = []
    points: dict[str, list[float]] = {name: [] for name in COLUMNS}
    lines = []
    for number, cells in rows:
        if len(cells) != len(header):
            wrong.append((number, f"must have {len(header)} columns; got {len(cells)}"))
            continue
        values = {}
        for name, (k, unit) in units.items():
            try:
                values[name] = FORCE.parse(f"{cells[k]} {unit}")
            except ValueError as error:
                wrong.append((number, f"{COLUMNS[name]} {error}"))
        if len(values) == len(COLUMNS):
            lines.append(number)
            for name, value in values.items():
                points[name].append(value)
    for name, point, message in mistakes(points["loads"], points["limits"]):
        if point is not None:
            wrong.append((lines[point], f"{COLUMNS[name]} {message}"))
        elif not wrong:
            return {}, [f"has too few points; {name} {message}"]
    by_line = [f"line {number} {message}" for number, message in sorted(wrong, key=lambda one: one[0])]
    return {name: tuple(values) for name, values in points.items()}, by_line


def _units(header: list[str]) -> tuple[dict[str, tuple[int, str]], list[str]]:
    """The place and the unit of each column, and what is wrong with the header."""
    units, wrong = {}, []
    for name, column in COLUMNS.items():
        matches = [re.fullmatch(rf"{column}\s*\[(.*)\]", cell) for cell in header]
        found = [(k, match[1]) for k, match in enumerate(matches) if match]
        if len(found) != 1:
            named = f'column "{column}" and its unit, as in "{HEADER}"'
            wrong.append(f"must name one {named}; got {shown(', '.join(header))}")
            continue
        units[name] = found[0]
        try:
            FORCE.parse(f"1 {found[0][1]}")
        except ValueError:
            wrong.append(f"must give the {column} in a unit of force, such as uN; got [{found[0][1]}]")
    return units, wrong
