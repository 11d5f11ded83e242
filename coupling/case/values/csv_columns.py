"""Measured numbers in a CSV file, whose header gives each column its name and unit: time [ms], x [um]."""

from __future__ import annotations

import csv
import math
import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from coupling.case.values.dimensions import DIMENSIONS
from coupling.case.values.units import Quantity, quoted
from coupling.files import MAX_NUMBERS, contents, why
from coupling.suggestion import near, near_file

MAX_MISTAKES = 10  # of a file that are listed one by one

Columns = dict[str, tuple[float, ...]]


class Rows(NamedTuple):
    """The cells of a file as text."""

    header: list[str]
    header_line: int  # from 1, as those of the rows
    rows: list[tuple[int, list[str]]]  # the line and the cells of each that is as long as the header
    mistakes: list[tuple[int, str]]  # the line of each other row, and what is wrong with it


class MeasuredColumns(NamedTuple):
    """The numbers in a file."""

    columns: Columns  # in SI units; incomplete where there are mistakes
    lines: tuple[int, ...]  # of its rows, from 1
    mistakes: list[str]
    ignored: tuple[str, ...] = ()  # the cells of the header whose columns have another name than those known


def read_rows(path: Path, example: str) -> Rows | str:
    """The rows of a file, or why it has none; empty lines and lines that begin with # are left out.

    example: a header, for messages.
    Raises OSError when the file cannot be read, and ValueError when no file can have that name.
    """
    try:
        text = contents(path, MAX_NUMBERS).decode("utf-8-sig")
    except UnicodeDecodeError:
        return "is not UTF-8 text"
    try:
        rows = [
            (number, [cell.strip() for cell in next(csv.reader([line], skipinitialspace=True))])
            for number, line in enumerate(text.splitlines(), 1)
            if line.strip() and not line.lstrip().startswith("#")
        ]
    except csv.Error:
        return f"has a cell of more than {csv.field_size_limit()} characters, the most that is read"
    if not rows:
        return f'is empty; it must begin with a header such as "{example}"'
    (header_line, header), *rows = rows
    uneven = [
        (number, f"must have {len(header)} columns; got {len(cells)}")
        for number, cells in rows
        if len(cells) != len(header)
    ]
    return Rows(header, header_line, [row for row in rows if len(row[1]) == len(header)], uneven)


def name_and_unit(cell: str) -> tuple[str, str | None]:
    """The name and the unit in a cell of a header; None where it has no unit."""
    match = re.fullmatch(r"([^\[\]]*?)\s*(?:\[(.*)\])?", cell)
    return (match[1], match[2]) if match else (cell, None)


def read_columns(
    path: Path, known: Mapping[str, Quantity], needed: Sequence[Sequence[str]], example: str
) -> MeasuredColumns:
    """The columns of a file, and what is wrong with it, by its lines. Columns of other names are ignored.

    known: the quantity of each column that there may be.  needed: groups of names, one of each of which must be there.
    example: a header, for messages.  Raises as `read_rows`.
    """
    read = read_rows(path, example)
    if isinstance(read, str):
        return MeasuredColumns({}, (), [read])
    header, line = read.header, read.header_line
    if any(_number(cell) is not None for cell in header):
        message = f'line {line} must be a header such as "{example}"; got {quoted(", ".join(header))}'
        return MeasuredColumns({}, (), [message])
    columns, ignored, mistakes = _header(header, known)
    meant = {like for cell in header if (like := near(cell.partition("[")[0], known))}
    mistakes += [f'must have a column {_either(names)}, as in "{example}"' for names in needed if not meant & {*names}]
    if mistakes:
        return MeasuredColumns({}, (), [f"line {line} {mistake}" for mistake in mistakes])
    wrong = list(read.mistakes)
    values: list[list[float]] = [[] for _ in header]
    for number, cells in read.rows:
        for (name, factor), cell, column in zip(columns, cells, values, strict=True):
            value = _number(cell)
            if name in ignored:
                continue
            if value is None:
                wrong.append((number, f"must have a finite number as {name}; got {quoted(cell)}"))
            else:
                column.append(value * factor)
    filled = {name: tuple(column) for (name, _), column in zip(columns, values, strict=True) if name not in ignored}
    return MeasuredColumns(filled, tuple(number for number, _ in read.rows), first_of(by_line(wrong)), ignored)


def by_line(wrong: Sequence[tuple[int, str]]) -> list[str]:
    """Mistakes in the order of their lines, each with its line."""
    return [f"line {number} {message}" for number, message in sorted(wrong, key=lambda one: one[0])]


def unreadable(file: str, error: OSError | ValueError) -> str:
    """That a file cannot be read, and why; ValueError where no file can have such a name."""
    reason = why(error) if isinstance(error, OSError) else str(error)
    path = Path(str(error.filename)) if isinstance(error, FileNotFoundError) else None
    meant = near_file(path, path.suffix) if path else None
    hint = f"; did you mean {quoted(os.path.relpath(meant, path.parent))}?" if path and meant else ""
    return f"must be a file that can be read; got {quoted(file)}: {reason}{hint}"


def first_of(mistakes: Sequence[str]) -> list[str]:
    """The first mistakes, and how many more there are."""
    more = len(mistakes) - MAX_MISTAKES
    return [*mistakes[:MAX_MISTAKES], *([f"has {more} more mistake{'s' * (more > 1)}"] if more > 0 else [])]


def _header(
    header: Sequence[str], known: Mapping[str, Quantity]
) -> tuple[list[tuple[str, float]], tuple[str, ...], list[str]]:
    """Each column's name and how much in SI units one of its unit is, those ignored, and what is wrong with the header.

    A name that looks like one that is known, and is missing, is a mistake.
    """
    columns: list[tuple[str, float]] = []
    ignored, mistakes = [], []
    there = {name_and_unit(cell)[0] for cell in header}
    for cell in header:
        name, unit = name_and_unit(cell)
        if name not in known:
            if (like := near(name, known)) and like not in there:
                mistakes.append(f"has a column {quoted(cell)} that is not known; did you mean {like}?")
            columns.append((cell, math.nan))
            ignored.append(cell)
            continue
        if any(name == other for other, _ in columns):
            mistakes.append(f"has two columns {name}")
        quantity = known[name]
        columns.append((name, math.nan))
        if not unit:
            mistakes.append(f'must give the unit of {name}, as in "{name} [{quantity.example.split()[-1]}]"')
            continue
        try:
            columns[-1] = name, quantity.parse(f"1 {unit}")
        except ValueError as error:
            reason = str(error).partition(f'got "1 {unit}"')[2].replace('"1 ', '"')
            mistakes.append(f"must give {name} in a unit of {DIMENSIONS[quantity.unit][2:]}; got [{unit}]{reason}")
    return columns, tuple(ignored), mistakes


def _either(names: Sequence[str]) -> str:
    return f"{', '.join(names[:-1])} or {names[-1]}" if len(names) > 1 else names[0]


def _number(cell: str) -> float | None:
    try:
        value = float(cell)
    except ValueError:
        return None
    return value if math.isfinite(value) else None
