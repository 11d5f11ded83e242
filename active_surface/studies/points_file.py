"""Points file: the points of a study in a CSV or parquet file, a column for each field and a row for each point."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

from coupling.case import Field, Value, quoted
from coupling.case.values import by_line, first_of, name_and_unit, read_rows, unreadable

EXAMPLE: Final = "actuators.*.frequency [Hz], part.mass [kg]"
ENDINGS: Final = (".csv", ".parquet")
TRUTHS: Final = {"true": True, "false": False}


class Column(NamedTuple):
    """The cells of a column, and the unit of those that are numbers; None: they are in SI units."""

    name: str
    unit: str | None
    cells: Sequence[object]


class PointsFile(NamedTuple):
    """The columns of a file, and what is wrong with it."""

    name: str
    columns: Sequence[Column]
    lines: Sequence[int]  # of its rows, from 1; of a parquet file the rows' own numbers
    line: str  # what these are called
    mistakes: Sequence[str]

    def told(self, wrong: Sequence[str]) -> list[str]:
        """Mistakes with the file's name."""
        return [f"in {self.name}: {message}" for message in wrong]

    def read(self, field: Field, column: Column) -> tuple[list[Value], list[tuple[int, str]]]:
        """The values of a field, in SI units, and by line what is wrong with the others."""
        values: list[Value] = []
        wrong = []
        for line, cell in zip(self.lines, column.cells, strict=True):
            try:
                values.append(_value(field, cell, column.unit))
            except ValueError as error:
                wrong.append((line, f"{column.name} {error}"))
        return values, wrong

    def by_line(self, wrong: Sequence[tuple[int, str]]) -> list[str]:
        """Mistakes in the order of their lines, the first of many."""
        return self.told(first_of([text.replace("line", self.line, 1) for text in by_line(wrong)]))


def read_points_file(path: Path) -> PointsFile:
    """The points in a file, and what is wrong with it.

    Below a header that names the columns, each with a unit in brackets if its numbers are not in SI units, there is a
    line for each point. Empty lines of a CSV file and those that begin with # are left out.
    """
    try:
        return _parquet(path) if path.suffix.lower() == ".parquet" else _csv(path)
    except (OSError, ValueError) as error:
        return PointsFile(path.name, [], [], "line", [unreadable(path.name, error)])


def _csv(path: Path) -> PointsFile:
    read = read_rows(path, EXAMPLE)
    if isinstance(read, str):
        return PointsFile(path.name, [], [], "line", [f"in {path.name}: {read}"])
    lines = [line for line, _ in read.rows]
    columns = [[cells[k] for _, cells in read.rows] for k in range(len(read.header))]
    return _file(path, read.header, columns, lines, "line", read.header_line, read.mistakes)


def _parquet(path: Path) -> PointsFile:
    try:
        import pandas
        import pyarrow  # noqa: F401
    except ImportError:
        raise ValueError("it needs pyarrow, which comes with pip install 'active-surface[parquet]'") from None
    try:
        table = pandas.read_parquet(path, engine="pyarrow")
    except pyarrow.ArrowException as error:
        raise ValueError(f"it is no parquet file ({str(error).splitlines()[0]})") from None
    columns = [table[name].tolist() for name in table.columns]
    return _file(path, [str(name) for name in table.columns], columns, list(range(1, len(table) + 1)), "row", None, [])


def _file(
    path: Path,
    header: Sequence[str],
    cells: Sequence[Sequence[object]],
    lines: Sequence[int],
    word: str,
    at: int | None,
    uneven: Sequence[tuple[int, str]],
) -> PointsFile:
    head = "the header" if at is None else f"line {at}"
    columns = [Column(*name_and_unit(name), one) for name, one in zip(header, cells, strict=True)]
    wrong = []
    if any(not column.name for column in columns):
        wrong.append(f"{head} has a column without a name; pandas leaves its index out with index=False")
    doubled = {column.name for k, column in enumerate(columns) if column.name in {one.name for one in columns[:k]}}
    wrong += [f"{head} has two columns {quoted(name)}" for name in sorted(doubled)]
    file = PointsFile(path.name, [column for column in columns if column.name], lines, word, [])
    if not lines and not uneven:
        wrong.append("has no points below its header")
    return file._replace(mistakes=[*file.told(wrong), *file.by_line(uneven)])


def _value(field: Field, cell: object, unit: str | None) -> Value:
    """The value of a field in a cell, in SI units; ValueError, which says what is wrong with it."""
    if cell is None or cell == "" or (isinstance(cell, float) and math.isnan(cell)):
        raise ValueError("must not be empty")
    number = _number(cell)
    if unit is not None:
        if number is None:
            raise ValueError(f"must be a number, as the column is in {unit}; got {quoted(cell)}")
        return field.read(f"{str(cell).strip()} {unit}")
    if number is None or field.kind == "text":
        return field.read(TRUTHS.get(cell.lower(), cell) if isinstance(cell, str) else cell)
    if not math.isfinite(number):
        raise ValueError(f"must be a finite number; got {quoted(cell)}")
    return field.read(int(number) if field.kind == "whole" and number.is_integer() else number, in_si=True)


def _number(cell: object) -> float | None:
    if isinstance(cell, bool):
        return None
    try:
        return float(cell)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return None


def tables_of(file: PointsFile, axes: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """The axes of a study, each with its column as values, and one more for each other column; None: it has none."""
    columns = {column.name: column for column in file.columns}
    tables: list[Mapping[str, Any]] = []
    for table in axes:
        name = next((name for name in (table["name"], table["field"]) if isinstance(name, str) and name in columns), "")
        tables.append({**table, "values": columns.pop(name, None)})
    keys = {"range": None, "count": None, "spacing": "linear", "name": None}
    return [*tables, *({**keys, "field": name, "values": column} for name, column in columns.items())]
