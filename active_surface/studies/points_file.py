"""Points file: the points of a study in a CSV or parquet file, a column for each field and a row for each point."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final, NamedTuple

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
    """The columns of a file by their names, and what is wrong with it."""

    name: str
    columns: Mapping[str, Column]
    lines: Sequence[int]  # of its rows, from 1; of a parquet file the rows' own numbers
    line: str  # what these are called
    mistakes: Sequence[str]

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
        return [f"in {self.name}: {text}" for text in first_of([f"{self.line}{text[4:]}" for text in by_line(wrong)])]


def read_points_file(path: Path) -> PointsFile:
    """The points in a file, and what is wrong with it.

    Below a header that names the columns, each with a unit in brackets if its numbers are not in SI units, there is a
    line for each point. Empty lines of a CSV file and those that begin with # are left out.
    """
    parquet = path.suffix.lower() == ".parquet"
    try:
        read = _parquet_rows(path) if parquet else read_rows(path, EXAMPLE)
    except (OSError, ValueError) as error:
        return PointsFile(path.name, {}, [], "line", [unreadable(path.name, error)])
    if isinstance(read, str):
        return PointsFile(path.name, {}, [], "line", [f"in {path.name}: {read}"])
    header, header_line, rows, uneven = read
    columns: dict[str, Column] = {}
    wrong = []
    for k, cell in enumerate(header):
        name, unit = name_and_unit(cell)
        if not name:
            wrong.append("has a column without a name; pandas leaves its index out with index=False")
        elif name in columns:
            wrong.append(f"has two columns {quoted(name)}")
        else:
            columns[name] = Column(name, unit, [cells[k] for _, cells in rows])
    head = "the header" if parquet else f"line {header_line}"
    told = [f"in {path.name}: {head} {message}" for message in dict.fromkeys(wrong)]
    if not rows and not uneven:
        told.append(f"in {path.name}: has no points below its header")
    file = PointsFile(path.name, columns, [line for line, _ in rows], "row" if parquet else "line", told)
    return file._replace(mistakes=[*told, *file.by_line(uneven)])


def _parquet_rows(path: Path) -> tuple[list[str], int, list[tuple[int, Sequence[object]]], list[tuple[int, str]]]:
    """The names of the columns, and the rows with their numbers from 1, as of `read_rows`."""
    try:
        import pandas
        import pyarrow  # noqa: F401
    except ImportError:
        raise ValueError("it needs pyarrow, which comes with pip install 'active-surface[parquet]'") from None
    try:
        table = pandas.read_parquet(path, engine="pyarrow")
    except pyarrow.ArrowException as error:
        raise ValueError(f"it is no parquet file ({str(error).splitlines()[0]})") from None
    cells = [table.iloc[:, k].tolist() for k in range(len(table.columns))]
    return [str(name) for name in table.columns], 0, list(enumerate(zip(*cells, strict=True), 1)), []


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
