"""Parsing: a TOML file as plain tables, with the line of everything in it; and the mistakes in it by their lines."""

from __future__ import annotations

import os
import re
import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import BaseModel

from coupling.case.messages import (
    Location,
    in_double_brackets,
    in_file,
    location_text,
    meant_key,
    message_of,
    mistakes_in,
)

_SYNTAX = {
    "Cannot overwrite a value": "this is given twice",
    r"Illegal character '\n'": "a text lacks its closing quote",
}
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

    def error(self, errors: Iterable[Any], model: type[BaseModel]) -> CaseError:
        """The mistakes in its tables, from the errors of their validation by a model."""
        lines = dict(_lines(self.text))
        details = mistakes_in(errors)
        # A key is not missing as well where it is only misspelt.
        misspelt: set[Location] = {
            (*detail["loc"][:-1], meant_key(detail["loc"], model) or "")
            for detail in details
            if detail["type"] == "extra_forbidden"
        }
        if ("lattice",) in misspelt:
            misspelt.add(("actuators",))
        problems = []
        for detail in details:
            location = in_file(detail, model)
            message = message_of(detail, self._value(location), model)
            if message.startswith("is missing") and detail["loc"] in misspelt:
                continue
            line = next((lines[location[:n]] for n in range(len(location), 0, -1) if location[:n] in lines), None)
            problems.append(Problem(line, location_text(location), message))
        return CaseError(self.path, problems)

    def _value(self, location: Location) -> object:
        value: Any = self.tables
        for key in location:
            try:
                value = value[key]
            except (KeyError, IndexError, TypeError):
                return None
        return value


def parse(path: str | os.PathLike[str]) -> TomlFile:
    """The file at `path`; raises CaseError if it cannot be read as TOML."""
    text = ""
    try:
        text = Path(path).read_bytes().decode("utf-8-sig")
        return TomlFile(os.fspath(path), text, tomllib.loads(text))
    except OSError as error:
        problem = Problem(None, "", f"cannot be read: {(error.strerror or str(error)).lower()}")
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        problem = Problem(line, "", f"is not UTF-8 text; got the byte 0x{error.object[error.start]:02x}")
    except tomllib.TOMLDecodeError as error:
        problem = _syntax_problem(str(error), text)
    except ValueError as error:  # no file can have such a name
        problem = Problem(None, "", f"cannot be read: {error}")
    raise CaseError(os.fspath(path), [problem])


def _syntax_problem(error: str, text: str) -> Problem:
    """The problem that tomllib reports as `error`, which ends with its place in `text`."""
    reason, _, place = error.rpartition(" (at ")
    match = re.match(r"line (\d+)", place)
    number = int(match[1]) if match else text.rstrip().count("\n") + 1
    line = text.split("\n")[number - 1]
    for name in ("actuators", "actuators.segments", "lattice.segments"):
        single = re.search(rf"^[ \t]*\[[ \t]*{re.escape(name)}[ \t]*\]", text, re.MULTILINE)
        if single and re.match(rf"\s*\[\[?\s*{re.escape(name)}\s*\]", line):
            number = text.count("\n", 0, single.start()) + 1
            return Problem(number, name, f"{in_double_brackets(f'[[{name}]]')}; got [{name}]")
    unquoted = re.search(r"[=[,]\s*([+-]?[\d.]+(?:[eE][+-]?\d+)?\s*[^\W\d][^,\]#]*)", line)
    hint = f'; a value with a unit needs quotes, "{unquoted[1].strip()}"' if unquoted else ""
    reason = re.sub(r"\('([^']*)',\)", r"[\1]", _SYNTAX.get(reason, reason[:1].lower() + reason[1:]))
    return Problem(number, "", f"is not valid TOML: {reason}{hint}")


def _lines(text: str) -> Iterator[tuple[Location, int]]:
    """Yield each table and key in `text`, which is valid TOML, with its line; the last first."""
    places: list[tuple[Location, int]] = []
    counts: Counter[Location] = Counter()
    table: Location = ()
    for line, statement in _statements(text):
        content = tomllib.loads(statement)
        if statement.lstrip().startswith("["):
            table = _table(content, counts)
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


def _table(header: dict[str, Any], counts: Counter[Location]) -> Location:
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
