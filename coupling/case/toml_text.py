"""A text in TOML: the line of each key, and edits that leave all else as somebody wrote it, to the byte."""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from typing import Any, Final

from coupling.case.table import Location

_TEXT: Final = r'"""(?:\\.|[^\\])*?"{3,5}|\'\'\'.*?\'{3,5}|"(?:\\.|[^"\\])*"|\'[^\']*\''
_NAME: Final = rf"(?:{_TEXT}|[\w-]+)"
_KEY: Final = re.compile(rf"{_NAME}(?:[ \t]*\.[ \t]*{_NAME})*", re.DOTALL)
_HEADER: Final = re.compile(rf"\[\[?[ \t]*{_KEY.pattern}[ \t]*\]\]?", re.DOTALL)
_VALUE: Final = re.compile(
    rf"{_TEXT}|\d{{4}}-\d\d-\d\d \d\d:[^\s,\]}}#]+|[^\s,\]}}#]+", re.DOTALL
)  # lists and tables are taken apart
_SPACE: Final = re.compile(r"(?:\s|#[^\n]*)*")
_LINE: Final = re.compile(r"[^\n]*\n?")


class TomlText:
    """Edits of a text that is valid TOML; those of places that it does not have raise LookupError."""

    def __init__(self, text: str) -> None:
        self.tables = tomllib.loads(text)
        self.statements: dict[Location, tuple[int, int]] = {}  # lines of a header, or of a key and its value
        self._text, self._edits = text, list[tuple[int, int, str]]()
        self._values: dict[Location, tuple[int, int]] = {}
        self._inline: dict[Location, tuple[int, int]] = {}  # keys between braces, with the comma before them
        self._ends: dict[Location, tuple[int, str]] = {}  # where a table takes a key, and how that begins
        self._read()

    def __str__(self) -> str:
        pieces, done = [], 0
        for start, end, new in sorted(self._edits, key=lambda edit: edit[:2]):
            pieces += [self._text[done:start], new]
            done = end
        return "".join([*pieces, self._text[done:]])

    def lines(self) -> dict[Location, int]:
        """The line of each header, and of each key with all of its value."""
        lines: dict[Location, int] = {}
        number, last = 1, 0
        for location, (start, _) in self.statements.items():
            number, last = number + self._text.count("\n", last, start), start
            for depth in range(1, len(location) + 1):
                lines.setdefault(location[:depth], number)
        return lines

    def put(self, location: Location, value: str) -> None:
        """Give a key or an item of a list a value, as TOML."""
        if location in self._values:
            self._edits.append((*self._values[location], value))
            return
        table = location[:-1]
        place, head = self._ends[table]
        key = f"{head}{location[-1]} = {value}"
        if table in self._values:  # between braces
            self._edits.append((place, place, key))
        else:
            self.insert(place, key)

    def remove(self, location: Location) -> None:
        """Take a key away, with its line where that is its own."""
        self._edits.append((*(self.statements.get(location) or self._inline[location]), ""))

    def insert(self, place: int, lines: str) -> None:
        """Have lines at the beginning of a line, or at the end of the text."""
        ends = "\r\n" if "\r\n" in self._text else "\n"
        begin = "" if self._text[:place].endswith("\n") else ends
        self._edits.append((place, place, begin + lines.replace("\n", ends) + ends))

    def replace(self, start: int, end: int, lines: str) -> None:
        """Replace lines by others."""
        self._edits.append((start, end, ""))
        self.insert(start, lines)

    def _read(self) -> None:
        text, counts = self._text, Counter[Location]()
        table: Location = ()
        names: Location
        at = self._past_space(0)
        while at < len(text):
            start, names = text.rfind("\n", 0, at) + 1, ()
            head = text[start:at]
            if text[at] == "[":
                header = _found(_HEADER, text, at)
                table, at = _opened(tomllib.loads(header[0]), counts), header.end()
            else:
                names, at = self._pair(table, at)
            at = _found(_LINE, text, at).end()
            self.statements[(*table, *names)] = start, at
            for depth in range(max(len(names), 1)):
                self._ends[(*table, *names[:depth])] = at, head + "".join(f"{name}." for name in names[:depth])
            at = self._past_space(at)

    def _pair(self, table: Location, at: int) -> tuple[Location, int]:
        """The names of a key in a table, and the place behind its value."""
        key = _found(_KEY, self._text, at)
        names: Location = ()
        content: Any = tomllib.loads(f"{key[0]} = 0")
        while isinstance(content, dict):
            names = (*names, *content)
            content = content[names[-1]]
        return names, self._value((*table, *names), self._past_space(self._text.index("=", key.end()) + 1))

    def _value(self, location: Location, at: int) -> int:
        """The place behind a value."""
        start, opens, index = at, self._text[at], 0
        if opens not in "[{":
            end = _found(_VALUE, self._text, at).end()
        else:
            last = at = at + 1
            while self._text[at := self._past_space(at)] not in "]}":
                if self._text[at] == ",":
                    at += 1
                elif opens == "[":
                    last = at = self._value((*location, index), at)
                    index += 1
                else:
                    names, at = self._pair(location, at)
                    if last > start + 1:  # a comma stands before it
                        self._inline[(*location, *names)] = last, at
                    last = at
            end = at + 1
            if opens == "{":
                self._ends[location] = last, " " if last == start + 1 else ", "
        self._values[location] = start, end
        return end

    def _past_space(self, at: int) -> int:
        return _found(_SPACE, self._text, at).end()


def _opened(header: dict[str, Any], counts: Counter[Location]) -> Location:
    """The table that a header opens; `counts` has how many tables each [[array]] has so far."""
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


def _found(pattern: re.Pattern[str], text: str, at: int) -> re.Match[str]:
    match = pattern.match(text, at)
    if match is None:
        raise LookupError(at)
    return match
