"""Columns of measured numbers in a CSV file, whose header gives each its name and unit: time [ms], x [um]."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from coupling.case.units import DIMENSIONS, Quantity, shown
from coupling.suggestion import near

MOST_MISTAKES = 10  # of a file that are told one by one

Columns = dict[str, tuple[float, ...]]


class File(NamedTuple):
    """What a file holds."""

    columns: Columns  # in SI units; not whole where there are mistakes
    lines: tuple[int, ...]  # of its rows, from 1
    mistakes: list[str]


def read_columns(path: Path, known: Mapping[str, Quantity], needed: Sequence[Sequence[str]], example: str) -> File:
    """The columns of a file, and what is wrong with it, by its lines.

    known: the quantity of each column that there may be.  needed: names, of each of which there must be one at least.
    example: a header, for messages.
    Empty lines and lines that begin with # are left out.
    Raises OSError when the file cannot be read.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        return File({}, (), ["is not UTF-8 text"])
    rows = [
        (number, [cell.strip() for cell in line.split(",")])
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not rows:
        return File({}, (), [f'is empty; it must begin with a header such as "{example}"'])
    (number, header), *rows = rows
    if any(_number(cell) is not None for cell in header):
        message = f'line {number} must be a header such as "{example}"; got {shown(", ".join(header))}'
        return File({}, (), [message])
    columns, mistakes = _header(header, known)
    meant = {like for cell in header if (like := near(cell.partition("[")[0], known))}
    mistakes += [f'must have a column {_either(names)}, as in "{example}"' for names in needed if not meant & {*names}]
    if mistakes:
        return File({}, (), [f"line {number} {mistake}" for mistake in mistakes])
    values: list[list[float]] = [[] for _ in header]
    for number, cells in rows:
        if len(cells) != len(header):
            mistakes.append(f"line {number} must have {len(header)} columns; got {len(cells)}")
            continue
        for (name, factor), cell, column in zip(columns, cells, values, strict=True):
            value = _number(cell)
            if value is None:
                mistakes.append(f"line {number} must have a finite number as {name}; got {shown(cell)}")
            else:
                column.append(value * factor)
    whole = {name: tuple(column) for (name, _), column in zip(columns, values, strict=True)}
    return File(whole, tuple(number for number, _ in rows), told(mistakes))


def unreadable(file: str, error: OSError | ValueError) -> str:
    """That a file cannot be read, and why; ValueError where no file can have such a name."""
    reason = (error.strerror if isinstance(error, OSError) else None) or str(error)
    return f"must be a file that can be read; got {shown(file)}: {reason.lower()}"


def told(mistakes: Sequence[str]) -> list[str]:
    """The first mistakes, and how many more there are."""
    more = len(mistakes) - MOST_MISTAKES
    return [*mistakes[:MOST_MISTAKES], *([f"has {more} more mistake{'s' * (more > 1)}"] if more > 0 else [])]


def _header(header: Sequence[str], known: Mapping[str, Quantity]) -> tuple[list[tuple[str, float]], list[str]]:
    """Each column's name and how much in SI units one of its unit is, and what is wrong with the header."""
    columns: list[tuple[str, float]] = []
    mistakes = []
    for cell in header:
        match = re.fullmatch(r"([^\[\]]*?)\s*(?:\[(.*)\])?", cell)
        name, unit = match.groups() if match else (cell, None)
        if name not in known:
            like = near(name, known)
            hint = f"did you mean {like}?" if like else f"there may be {', '.join(known)}"
            mistakes.append(f"has a column {shown(cell)} that is not known; {hint}")
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
    return columns, mistakes


def _either(names: Sequence[str]) -> str:
    return f"{', '.join(names[:-1])} or {names[-1]}" if len(names) > 1 else names[0]


def _number(cell: str) -> float | None:
    try:
        value = float(cell)
    except ValueError:
        return None
    return value if math.isfinite(value) else None
