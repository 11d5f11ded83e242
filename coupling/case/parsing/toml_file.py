"""Parsing: a TOML file as plain tables, with the line of everything in it; and the mistakes in it by their lines."""

from __future__ import annotations

import codecs
import os
import re
import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final, NamedTuple

from pydantic import BaseModel

from coupling.case.mistakes import (
    Location,
    home_of_keys,
    in_file,
    location_text,
    message_of,
    misspelt_in,
    mistakes_in,
    models_in,
    table_at,
    value_at,
)
from coupling.case.parsing.other_file import folder_text, what_else
from coupling.case.parsing.repair import loads, repaired
from coupling.case.values import UNITS_REQUIRED
from coupling.files import MAX_TEXT, contents, control_in, why
from coupling.suggestion import near, near_file

MAX_NAME: Final = 200  # bytes, so that there is room for the endings of results
_TOKEN = re.compile(
    r'"""(?:\\.|[^\\])*?"""\"{0,2}|\'\'\'.*?\'\'\'\'{0,2}'  # texts of several lines
    r'|"(?:\\.|[^"\\])*"|\'[^\']*\'|#[^\n]*'  # texts and comments
    r"|[\[\]{}\n]",
    re.DOTALL,
)


@dataclass(frozen=True)
class Problem:
    """One mistake: its line, None for the file as a whole; the field, "" for the text itself; and what is wrong."""

    line: int | None
    field: str
    message: str


class CaseError(ValueError):
    """A case file that cannot be used; `problems` holds every mistake in it, in the order of their lines."""

    def __init__(self, file: str, problems: Iterable[Problem]) -> None:
        self.file = file
        self.problems = sorted(problems, key=lambda problem: problem.line or 0)
        super().__init__(file, self.problems)

    def __str__(self) -> str:
        count = len(self.problems)
        places = [f"line {problem.line}" if problem.line else "the file" for problem in self.problems]
        width = max(map(len, places), default=0)
        lines = [f"{self.file}: {count} mistake{'' if count == 1 else 's'}"]
        for place, problem in zip(places, self.problems, strict=True):
            lines.append(f"  {place:{width}}  " + f"{problem.field} {problem.message}".lstrip())
        return "\n".join(lines)


class TomlFile(NamedTuple):
    """A file: where it is, its text, and the tables in that."""

    path: str
    text: str
    tables: dict[str, Any]
    problems: tuple[Problem, ...] = ()  # of the text; the tables are those that are meant
    meant: str = ""  # the text that these tables have, where that differs
    renamed: Mapping[str, str] = MappingProxyType({})  # what tables are called in the text, by their names here
    parts: tuple[str, ...] = ()  # tables of the text that are parts of others

    @property
    def misread(self) -> bool:
        """Whether the tables are not those of the text, but what is meant by it."""
        return bool(self.problems or self.renamed)

    def as_meant(self, model: type[BaseModel]) -> TomlFile:
        """The file with its tables under the names that a model has; those of other names are reported by `error`.

        A table whose keys all belong to another, as a [material], is understood as a part of that.
        """
        names = [key for key, field in model.model_fields.items() if models_in(field.annotation)]
        tables, renamed, parts = dict(self.tables), {}, []
        for key in self.tables:
            meant = near(key, names) if key not in model.model_fields else None
            if meant and meant not in tables and isinstance(tables[key], (dict, list)):
                tables[meant], renamed[meant] = tables.pop(key), key
            elif key not in model.model_fields and isinstance(tables[key], dict):
                home = home_of_keys(tables[key], model) or ""
                if isinstance(tables.get(home), dict):
                    tables[home] = tables[key] | tables[home]
                    parts.append(key)
        return self._replace(tables=tables, renamed=renamed, parts=tuple(parts))

    def error(self, errors: Iterable[Any], model: type[BaseModel]) -> CaseError:
        """The mistakes in its text, and those in its tables, from the errors of their validation by a model."""
        lines = dict(_lines(self.meant or self.text))
        details = mistakes_in(errors)
        misspelt = misspelt_in(details, model, self.tables, UNITS_REQUIRED)
        if ("lattice",) in misspelt:
            misspelt.add(("actuators",))
        problems = list(self.problems)
        for meant, name in self.renamed.items():
            problems.append(Problem(lines.get((name,)), name, f"is not known; did you mean {meant}?"))
        for detail in details:
            location = in_file(detail, model)
            beside = table_at(self.tables, location[:-1])
            message = message_of(detail, value_at(self.tables, location), model, beside, UNITS_REQUIRED)
            if message.startswith("is missing") and detail["loc"] in misspelt:
                continue
            written = self._as_written(location, lines)
            line = next((lines[written[:n]] for n in range(len(written), 0, -1) if written[:n] in lines), None)
            problems.append(Problem(line, location_text(written), message))
        return CaseError(self.path, problems)

    def _as_written(self, location: Location, lines: Mapping[Location, int]) -> Location:
        """Where in the text a location in the tables is."""
        first, rest = location[0], location[1:]
        names = [self.renamed.get(str(first), first), *(name for name in self.parts if rest)]
        return next(((name, *rest) for name in names if (name, *rest) in lines), (names[0], *rest))


def parse(path: str | os.PathLike[str], lenient: bool = False) -> TomlFile:
    """The file at `path`.

    Raises CaseError if it cannot be read as TOML; `lenient`: only where it is not clear what is meant, so that all
    other mistakes can be reported with those of its text.
    """
    name = os.fspath(path)
    try:
        data = contents(path, MAX_TEXT)
        if message := what_else(Path(path), data):
            raise _unreadable(name, message)
        text = text_of(data)
    except FileNotFoundError as error:
        meant = near_file(Path(path))
        hint = f"; did you mean {meant}?" if meant else ""
        raise _unreadable(name, f"cannot be read: {why(error)}{hint}") from None
    except IsADirectoryError:
        raise _unreadable(name, folder_text(Path(path))) from None
    except CaseError:
        raise
    except OSError as error:
        raise _unreadable(name, f"cannot be read: {why(error)}") from None
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        message = f"is not UTF-8 text; got the byte 0x{error.object[error.start]:02x}; save it as UTF-8"
        raise _unreadable(name, message, line) from None
    except ValueError as error:  # also where no file can have such a name
        message = str(error)
        raise _unreadable(name, message if message.startswith("is ") else f"cannot be read: {message}") from None
    unfit = [Problem(None, "", message)] if (message := unfit_name(Path(path).stem)) else []
    try:
        return TomlFile(name, text, loads(text), tuple(unfit))
    except tomllib.TOMLDecodeError:
        right, wrong = repaired(text)
    problems = (*unfit, *(Problem(*one) for one in wrong))
    if lenient:
        with suppress(tomllib.TOMLDecodeError):
            return TomlFile(name, text, loads(right), problems, right)
    raise CaseError(name, problems)


def unfit_name(stem: str) -> str:
    """What is wrong with the name of a file, without its ending, which its results take over; "": nothing."""
    if control := control_in(stem):
        return f"must have a name that can be printed, as its results have it, too; got U+{ord(control):04X} in it"
    if (size := len(stem.encode())) > MAX_NAME:
        return f"must have a name of at most {MAX_NAME} bytes, as its results have it, too; got {size}"
    return ""


def _unreadable(file: str, message: str, line: int | None = None) -> CaseError:
    return CaseError(file, [Problem(line, "", message)])


def text_of(data: bytes) -> str:
    """The text that a file has; ValueError, saying what it is, where that is no text in UTF-8."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        raise ValueError("is UTF-16 text; save it as UTF-8")
    return data.decode("utf-8-sig")


def _lines(text: str) -> Iterator[tuple[Location, int]]:
    """Yield each table and key in `text`, which is valid TOML, with its line; the last first."""
    places: list[tuple[Location, int]] = []
    counts: Counter[Location] = Counter()
    table: Location = ()
    for line, statement in _statements(text):
        content = tomllib.loads(statement)
        if statement.lstrip().startswith("["):
            table = table_opened(content, counts)
            places += [(table[:depth], line) for depth in range(1, len(table) + 1)]
        else:
            places += [(location, line) for location in _locations(content, table)]
    return reversed(places)  # where a place comes again, its first line is to stay


def _statements(text: str) -> Iterator[tuple[int, str]]:
    """Yield each header, and each key with its value, and the line where it begins."""
    start, line, first, depth = 0, 1, 1, 0
    for token in _TOKEN.finditer(text + "\n"):
        kind = token[0]
        if kind in "[{":
            depth += 1
        elif kind in "]}":
            depth -= 1
        line += kind.count("\n")
        if kind == "\n" and depth == 0:
            yield first, text[start : token.end()]
            start, first = token.end(), line


def table_opened(header: dict[str, Any], counts: Counter[Location]) -> Location:
    """The table that `header` opens; `counts` keeps how many tables each [[array]] has so far."""
    location: Location = ()
    while header:
        ((key, content),) = header.items()
        location += (key,)
        if isinstance(content, list):
            counts[location] += 1
            content = content[0]
        if counts[location]:
            location += (counts[location] - 1,)
        header = content
    return location


def _locations(content: dict[str, Any] | list[Any], parent: Location) -> Iterator[Location]:
    """Yield the location of everything inside `content`."""
    for key, value in content.items() if isinstance(content, dict) else enumerate(content):
        yield (*parent, key)
        if isinstance(value, (dict, list)):
            yield from _locations(value, (*parent, key))
