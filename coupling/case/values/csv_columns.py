"""Measured numbers in a CSV file, whose header gives each column its name and unit: time [ms], x [um].

Instruments and trackers write it in their own ways. What is unambiguous is read: semicolons and tabs instead
of commas, decimal commas between these, UTF-16 and Windows-1252, units in parentheses or in rows below the header.
"""

from __future__ import annotations

import codecs
import csv
import math
import os
import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from coupling.case.values.units import DIMENSIONS, Quantity, quoted
from coupling.files import MAX_NUMBERS, contents, why
from coupling.suggestion import near, near_file

MAX_MISTAKES = 10  # of a file that are listed one by one
DECIMAL_COMMA = re.compile(r"^([-+]?\d*),(\d+(?:[eE].*)?)$")
TRACKMATE = {"position_x": "x", "position_y": "y", "position_t": "time"}  # its names of columns

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
    lost: int = 0  # rows with a time and no other number, as of frames in which a tracker found nothing


def read_rows(path: Path, example: str) -> Rows | str:
    """The rows of a file, or why it has none; empty lines and lines that begin with # are left out.

    Cells are separated as those of the header: by semicolons, else tabs, else commas.

    example: a header, for messages.
    Raises OSError when the file cannot be read, and ValueError when no file can have that name.
    """
    text = _text(contents(path, MAX_NUMBERS))
    if text is None:
        return "is not text in UTF-8, UTF-16 or Windows-1252"
    lines = [
        (number, line)
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not lines:
        return f'is empty; it must begin with a header such as "{example}"'
    delimiter = next((mark for mark in ";\t" if mark in lines[0][1]), ",")
    try:
        rows = [
            (number, [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter, skipinitialspace=True))])
            for number, line in lines
        ]
    except csv.Error:
        return f"has a cell of more than {csv.field_size_limit()} characters, the most that is read"
    if delimiter != ",":
        rows = [(number, [DECIMAL_COMMA.sub(r"\1.\2", cell) for cell in row]) for number, row in rows]
    (header_line, header), *rows = rows
    uneven = [
        (number, f"must have {len(header)} columns; got {len(cells)}")
        for number, cells in rows
        if len(cells) != len(header)
    ]
    return Rows(header, header_line, [row for row in rows if len(row[1]) == len(header)], uneven)


def _text(data: bytes) -> str | None:
    """The text in the bytes of a file; None: it is none."""
    marked = data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    for encoding in ("utf-16",) if marked else ("utf-8-sig", "cp1252"):
        with suppress(UnicodeDecodeError):
            text = data.decode(encoding)
            return None if "\0" in text else text
    return None


def name_and_unit(cell: str) -> tuple[str, str | None]:
    """The name and the unit, in brackets or parentheses, in a cell of a header; None where it has no unit."""
    match = re.fullmatch(r"([^\[\]()]*?)\s*(?:\[(.*)\]|\((.*)\))?", cell)
    return (match[1], match[2] if match[3] is None else match[3]) if match else (cell, None)


def _with_units_below(read: Rows, known: Mapping[str, Quantity]) -> Rows:
    """The rows with the names that are known, and with the units of a row without numbers below the header."""
    header = [_known_name(cell, known) for cell in read.header]
    texts = 0
    while texts < len(read.rows) and not any(_number(cell) is not None for cell in read.rows[texts][1]):
        texts += 1
    if not texts or any(name_and_unit(cell)[1] is not None for cell in header):
        return read._replace(header=header)
    units = [cell.strip("()[]") for cell in read.rows[texts - 1][1]]
    header = [f"{name} [{unit}]" if name in known and unit else name for name, unit in zip(header, units, strict=True)]
    return read._replace(header=header, rows=read.rows[texts:])


def _known_name(cell: str, known: Mapping[str, Quantity]) -> str:
    """A cell of a header with the name in lower case, or that of TrackMate's column, where this is known."""
    name = name_and_unit(cell)[0]
    meant = TRACKMATE.get(name.lower(), name.lower())
    return meant + cell[len(name) :] if name not in known and meant in known else cell


def read_columns(
    path: Path, known: Mapping[str, Quantity], needed: Sequence[Sequence[str]], example: str, exact: bool = False
) -> MeasuredColumns:
    """The columns of a file, and what is wrong with it, by its lines. Columns of other names are ignored.

    known: the quantity of each column that there may be.  needed: groups of names, one of each of which must be there.
    example: a header, for messages.  exact: convert each number as a decimal, to the bit as in a case file, which is
    slow.  Raises as `read_rows`.
    """
    read = read_rows(path, example)
    if isinstance(read, str):
        return MeasuredColumns({}, (), [read])
    read = _with_units_below(read, known)
    header, line = read.header, read.header_line
    if any(_number(cell) is not None for cell in header):
        message = f'line {line} must be a header such as "{example}"; got {quoted(", ".join(header))}'
        return MeasuredColumns({}, (), [message])
    columns, ignored, mistakes = _header(header, known)
    got = quoted(", ".join(read.header))
    mistakes += [
        f'must have a column {_either(names)}, as in "{example}"; got {got}'
        for names in needed
        if not columns.keys() & {*names}
    ]
    if mistakes:
        return MeasuredColumns({}, (), [f"line {line} {mistake}" for mistake in mistakes])
    wrong = list(read.mistakes)
    measured = [k for name, (k, *_) in columns.items() if name != "time"]
    rows = [row for row in read.rows if any(row[1][k].lower() not in ("", "nan") for k in measured)]
    filled = {}
    for name, (k, unit, factor) in columns.items():
        numbers = [(line, cells[k], _number(cells[k])) for line, cells in rows]
        rule = f"must have a finite number as {name}"
        wrong += [(line, f"{rule}; got {quoted(cell)}") for line, cell, number in numbers if number is None]
        filled[name] = tuple(
            known[name].value_of(cell, cell, unit) if exact else number * factor
            for _, cell, number in numbers
            if number is not None
        )
    lines, lost = tuple(number for number, _ in rows), len(read.rows) - len(rows)
    return MeasuredColumns(filled, lines, first_of(by_line(wrong)), ignored, lost)


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
) -> tuple[dict[str, tuple[int, str, float]], tuple[str, ...], list[str]]:
    """Each known column's place, unit and how much in SI units one of that is; those ignored, and what is wrong.

    A name that looks like one that is known, and is missing, is a mistake.
    """
    columns: dict[str, tuple[int, str, float]] = {}
    ignored, mistakes = [], []
    there = {name_and_unit(cell)[0] for cell in header}
    for k, cell in enumerate(header):
        name, unit = name_and_unit(cell)
        if name not in known:
            if (like := near(name, known)) and like not in there:
                mistakes.append(f"has a column {quoted(cell)} that is not known; did you mean {like}?")
            ignored.append(cell)
            continue
        if name in columns:
            mistakes.append(f"has two columns {name}")
        quantity, factor = known[name], math.nan
        try:
            factor = quantity.parse(f"1 {unit or ''}")
        except ValueError:
            of = f"a unit of {DIMENSIONS[quantity.unit].partition(' ')[2]}"
            got = f"; got [{unit}]" if unit else ""
            mistakes.append(f'must give {name} in {of}, as in "{name} [{quantity.example.split()[-1]}]"{got}')
        columns[name] = k, unit or "", factor
    return columns, tuple(ignored), mistakes


def _either(names: Sequence[str]) -> str:
    return f"{', '.join(names[:-1])} or {names[-1]}" if len(names) > 1 else names[0]


def _number(cell: str) -> float | None:
    try:
        value = float(cell)
    except ValueError:
        return None
    return value if math.isfinite(value) else None
