"""Parse a TOML file into plain tables, and say the mistakes in it by their lines."""

from __future__ import annotations

import codecs
import os
import re
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, NamedTuple

from coupling.case.table import Mistake, location_text
from coupling.case.toml_text import TomlText
from coupling.case.values import quoted
from coupling.files import MAX_TEXT, contents, control_in, why
from coupling.suggestion import near_file

MAX_NAME: Final = 200  # bytes, so that there is room for the endings of results
_HDF5: Final = b"\x89HDF"
MAX_DEPTH: Final = 20  # tables and lists inside each other


@dataclass(frozen=True)
class Problem:
    """One mistake: its line, None for the file as a whole; the field, "" for the text itself; and what is wrong."""

    line: int | None
    field: str
    message: str


class CaseError(ValueError):
    """A case file that cannot be used; `problems` has every mistake in it, in the order of their lines."""

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

    def error(self, mistakes: Iterable[Mistake]) -> CaseError:
        """The error that says mistakes with their lines: those of the key, or of the table that should have it."""
        lines = TomlText(self.text).lines()
        problems = []
        for location, message in mistakes:
            heads = (location[:n] for n in range(len(location), 0, -1))
            line = next((lines[head] for head in heads if head in lines), None)
            problems.append(Problem(line, location_text(location), message))
        return CaseError(self.path, problems)


def parse(path: str | os.PathLike[str]) -> TomlFile:
    """The file at `path`; CaseError, with the line of the first mistake, if it cannot be read as TOML."""
    if not isinstance(path, (str, os.PathLike)):
        raise CaseError("the file", [Problem(None, "", f"must be named by a path, as text; got {quoted(path)}")])
    name = os.fspath(path)
    line: int | None = None
    if unfit := unfit_name(Path(path).stem):
        raise CaseError(name, [Problem(None, "", unfit)])
    try:
        data = contents(path, MAX_TEXT)
        if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE, _HDF5)) or b"\0" in data[:1000]:
            shown = f"; `active-surface view {name}` shows a result" if data.startswith(_HDF5) else ""
            raise CaseError(name, [Problem(None, "", f"is not UTF-8 text, as cases, studies and aims must be{shown}")])
        text = data.decode("utf-8-sig")
        return TomlFile(name, text, _within_depth(tomllib.loads(text)))
    except CaseError:
        raise
    except FileNotFoundError as error:
        meant = near_file(Path(path))
        message = f"cannot be read: {why(error)}" + (f"; did you mean {meant}?" if meant else "")
    except IsADirectoryError:
        message = "is a folder; name a file in it"
    except OSError as error:
        message = f"cannot be read: {why(error)}"
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        message = f"is not UTF-8 text; got the byte 0x{error.object[error.start]:02x}; save it as UTF-8"
    except RecursionError:
        message = f"must not have tables or lists nested more than {MAX_DEPTH} deep"
    except ValueError as error:  # of tomllib, or of an integer with more digits than Python reads
        reason, _, place = str(error).rpartition(" (at ")
        at = re.match(r"line (\d+)", place)
        line = int(at[1]) if at else text.rstrip().count("\n") + 1 if reason else None
        message = (
            "is not valid TOML: " + _sentence(reason or "a number has too many digits") + _hint(text, line, reason)
        )
    raise CaseError(name, [Problem(line, "", message)]) from None


def _sentence(reason: str) -> str:
    """What tomllib says, to follow a colon, with names of tables as they are written: [a.b] and not ('a', 'b')."""
    named = re.sub(r"\('(.*?)',?\)", lambda found: "[" + found[1].replace("', '", ".") + "]", reason)
    return named[:1].lower() + named[1:]


def _hint(text: str, line: int | None, reason: str) -> str:
    """What is most often wrong there: a table in single brackets, or a value with a unit and no quotes."""
    if again := re.match(r"Cannot declare .*'(actuators|segments|axes|parts)'", reason):
        return f"; a table that comes again needs double brackets, as [[{again[1]}]]"
    if re.match(r"Cannot declare .*'part'", reason):
        return "; many parts are written [[parts]]"
    if re.search(r"=\s*[+-]?\d+,\d+\s*(?:#.*)?$", line_text := text.split("\n")[(line or 1) - 1]):
        return "; decimals are written with a point"
    bare = re.search(r"=\s*([+-]?[\d.]+\s*[A-Za-z][\w/^*]*)\s*(?:#.*)?$", line_text)
    return f'; a value with a unit needs quotes: "{bare[1]}"' if bare else ""


def _within_depth(tables: dict[str, Any]) -> dict[str, Any]:
    """The tables; raises RecursionError if they are nested too deeply."""
    inner: list[Any] = [tables]
    for _ in range(MAX_DEPTH + 1):
        inner = [one for item in inner for one in (item.values() if isinstance(item, dict) else item)]
        inner = [item for item in inner if isinstance(item, (dict, list)) and item]
        if not inner:
            return tables
    raise RecursionError


def unfit_name(stem: str) -> str:
    """What is wrong with the name of a file, without its ending, which its results take over; "": nothing."""
    if control := control_in(stem):
        return f"must have a name that can be printed, as its results have it, too; got U+{ord(control):04X} in it"
    if (size := len(stem.encode())) > MAX_NAME:
        return f"must have a name of at most {MAX_NAME} bytes, as its results have it, too; got {size}"
    return ""
