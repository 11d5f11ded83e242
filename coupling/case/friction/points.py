"""The points of a measured friction law: in the case file, or in a file beside it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Final, NamedTuple

from pydantic import BeforeValidator, TypeAdapter, ValidationError

from coupling.case.mistakes import Mistake
from coupling.case.values import Force, Quantity, by_line, name_and_unit, quoted, read_rows, unreadable
from particle import MIN_POINTS, point_mistakes

EXAMPLE: Final = '["-1 uN", "0 N", "5 uN"]'
HEADER: Final = "load [uN], limit [nN]"
FORCE: Final = Quantity("N", "2 uN")
COLUMNS: Final = {"loads": "load", "limits": "limit"}

Points = Mapping[str, tuple[float, ...]]
"""The `loads` and `limits` of a law [N]."""


def _several(value: object) -> object:
    if not isinstance(value, (list, tuple)):
        raise ValueError(f"must be a list of forces such as {EXAMPLE}; got {quoted(value)}")
    return value


Forces = Annotated[tuple[Force, ...], BeforeValidator(_several)]
_forces: Final = TypeAdapter(Forces)


def mistakes(table: Mapping[str, Any], context: Any) -> Iterator[Mistake]:
    """Yield what is wrong with the points in a table, beyond each of its fields by itself.

    context: of the validation.
    """
    if table.get("file") is not None:
        yield from (
            ((name,), "must not be given with a file, which holds the points") for name in COLUMNS if name in table
        )
        return
    if table.get("loads") is None:
        yield ("loads",), f'is missing; it must be forces such as {EXAMPLE}, or have file = "friction.csv" in its place'
    elif table.get("limits") is None:
        yield ("limits",), "is missing; it must be as many forces as the loads"
    values = {name: _valid(table.get(name), context) for name in COLUMNS}
    loads, limits = values["loads"], values["limits"]
    # In place of those that are wrong or missing stand some that fit the others.
    length = max(len(loads or limits or ()), MIN_POINTS)
    both = loads is not None and limits is not None
    for name, point, message in point_mistakes(
        range(-1, length - 1) if loads is None else loads, [0.0] * length if limits is None else limits
    ):
        if values[name] is not None and (both or point is not None):
            yield (name,) if point is None else (name, point), message


def _valid(value: Any, context: Any) -> tuple[float, ...] | None:
    try:
        return _forces.validate_python(value, context=context)
    except ValidationError:
        return None


class PointsFile(NamedTuple):
    """What a file of points holds."""

    points: Points
    mistakes: list[str]


def read_points(path: Path) -> PointsFile:
    """The points of a CSV file and what is wrong with it, by its lines.

    Below a header that names the columns and their units there is a line for each point. Columns of other names, empty
    lines and lines that begin with # are left out.
    """
    try:
        read = read_rows(path, HEADER)
    except (OSError, ValueError) as error:
        return PointsFile({}, [unreadable(path.name, error)])
    points: Points = {}
    if isinstance(read, str):
        wrong = [read]
    else:
        columns, wrong = _columns(read.header)
        wrong = [f"line {read.header_line} {message}" for message in wrong]
        if not wrong:
            points, wrong = _points(columns, read.rows, read.mistakes)
    return PointsFile(points, [f"in {path.name}: {message}" for message in wrong])


def _columns(header: list[str]) -> tuple[dict[str, tuple[int, str]], list[str]]:
    """The place and the unit of each column, and what is wrong with the header."""
    columns, wrong = {}, []
    cells = [name_and_unit(cell) for cell in header]
    for name, column in COLUMNS.items():
        matches = [(k, unit) for k, (other, unit) in enumerate(cells) if other == column and unit is not None]
        if len(matches) != 1:
            named = f'column "{column}" and its unit, as in "{HEADER}"'
            wrong.append(f"must name one {named}; got {quoted(', '.join(header))}")
            continue
        columns[name] = matches[0]
        try:
            FORCE.parse(f"1 {matches[0][1]}")
        except ValueError:
            wrong.append(f"must give the {column} in a unit of force, such as uN; got [{matches[0][1]}]")
    return columns, wrong


def _points(
    columns: Mapping[str, tuple[int, str]], rows: list[tuple[int, list[str]]], uneven: list[tuple[int, str]]
) -> tuple[Points, list[str]]:
    """The points in rows, and what is wrong with them and with other lines."""
    wrong = list(uneven)
    points: dict[str, list[float]] = {name: [] for name in COLUMNS}
    lines = []
    for number, cells in rows:
        values = {}
        for name, (k, unit) in columns.items():
            try:
                values[name] = FORCE.parse(f"{cells[k]} {unit}")
            except ValueError as error:
                wrong.append((number, f"{COLUMNS[name]} {error}"))
        if len(values) == len(COLUMNS):
            lines.append(number)
            for name, value in values.items():
                points[name].append(value)
    for name, point, message in point_mistakes(points["loads"], points["limits"]):
        if point is not None:
            wrong.append((lines[point], f"{COLUMNS[name]} {message}"))
        elif not wrong:
            return {}, [f"has too few points; {name} {message}"]
    return {name: tuple(values) for name, values in points.items()}, by_line(wrong)
