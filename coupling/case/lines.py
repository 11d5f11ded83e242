"""The mistakes in a case file: where each one is, and what would be right there."""

from __future__ import annotations

import os
import re
import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from coupling.case.any_plate import TAGS
from coupling.case.platform import AXES
from coupling.case.units import shown
from coupling.suggestion import near

Location = tuple[int | str, ...]
"""The keys, and indices from 0, that lead to a value in the file."""

RULES = {
    "float_type": "a number",
    "int_type": "a whole number",
    "finite_number": "a finite number",
    "string_type": "text",
    "greater_than": "greater than {gt:.4g}",
    "greater_than_equal": "at least {ge:.4g}",
    "less_than": "less than {lt:.4g}",
    "less_than_equal": "at most {le:.4g}",
}
"""What a value must be, by the kind of a failed validation."""

LACKS_DEFAULT = "default_factory_not_called"
"""The kind of a failed validation that is no mistake of its own: a default depends on a wrong field."""

_SYNTAX = {
    "Cannot overwrite a value": "this is given twice",
    r"Illegal character '\n'": "a text lacks its closing quote",
}
_EACH = {"actuators": "actuator", "segments": "segment", "axes": "axis"}
"""What is written in double brackets, and once for each of what."""


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


def load(path: str | os.PathLike[str]) -> tuple[str, dict[str, Any]]:
    """Return the text of the file at `path` and the tables in it; CaseError if it cannot be read as TOML."""
    try:
        text = Path(path).read_bytes().decode("utf-8-sig")
        return text, tomllib.loads(text)
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


def find_problems(
    error: ValidationError, text: str, data: dict[str, Any], tables: Mapping[str, type[BaseModel]]
) -> list[Problem]:
    """Return the problems that `error` found in `data`, the content of `text`.

    `tables` gives the model of each table by name, those of [friction] by their `model` and the whole file's as "".
    """
    lines = _lines(text)
    details = [detail for detail in error.errors() if detail["type"] != LACKS_DEFAULT]
    # Nor is it one that a key is missing where it is only misspelt.
    misspelt = {
        (*detail["loc"][:-1], _near(detail["loc"], tables)) for detail in details if detail["type"] == "extra_forbidden"
    }
    if ("lattice",) in misspelt:
        misspelt.add(("actuators",))
    problems = []
    for detail in details:
        location = in_file(detail)
        message = message_of(detail, _value(data, location), tables)
        if message.startswith("is missing") and detail["loc"] in misspelt:
            continue
        line = next((lines[location[:n]] for n in range(len(location), 0, -1) if location[:n] in lines), None)
        problems.append(Problem(line, shown_location(location), message))
    return problems


def shown_location(location: Location) -> str:
    """Return the name of the field at `location`, which counts from 1: actuators[1].stroke."""
    return "".join(f"[{key + 1}]" if isinstance(key, int) else f".{key}" for key in location).lstrip(".")


def message_of(detail: ErrorDetails, value: object, tables: Mapping[str, type[BaseModel]]) -> str:
    """Return what is wrong with `value`, in the words of the case file rather than of the validation."""
    kind, location, context = detail["type"], detail["loc"], detail.get("ctx", {})
    got = f"; got {shown(value)}"
    match kind:
        case "value_error":
            return str(context["error"])
        case "missing" if len(location) == 1:
            return f"is missing; it must be a table, written {_header(location)}"
        case "missing":
            return f"is missing; it must be {_wanted(_fields(location, tables)[str(location[-1])])}"
        case "extra_forbidden":
            meant = _near(location, tables)
            return "is not known; " + (f"did you mean {meant}?" if meant else _known(location, tables))
        case "union_tag_not_found":
            models = [name for name, model in tables.items() if "model" in model.model_fields]
            return f"is missing; it must be {one_of(models)}"
        case "literal_error" | "union_tag_invalid":
            choices = re.findall("'([^']*)'", context["expected" if kind == "literal_error" else "expected_tags"])
            meant = near(value, choices) if isinstance(value, str) else None
            return f"must be {one_of(choices)}{got}" + (f'; did you mean "{meant}"?' if meant else "")
        case "tuple_type":
            header = _header((*location, 0))
            return _doubled(header) + (f"; got {header[1:-1]}" if isinstance(value, dict) else got)
        case "model_type" | "model_attributes_type":
            return f"must be a table, written {_header(location)}{got}"
        case _:
            quoted = isinstance(value, str) and kind in ("float_type", "int_type")
            return f"must be {RULES.get(kind, 'different').format(**context)}{got}" + (", in quotes" if quoted else "")


def in_file(detail: ErrorDetails) -> Location:
    """Return where in the file an error is: without what validation chose between, as the model of [friction]."""
    location = tuple(key for key in detail["loc"] if key not in TAGS)
    if detail["type"].startswith("union_tag"):
        return (*location, "model")
    return ("friction", *location[2:]) if location[0] == "friction" else location


def _value(data: Any, location: Location) -> object:
    for key in location:
        try:
            data = data[key]
        except (KeyError, IndexError, TypeError):
            return None
    return data


def _header(location: Location) -> str:
    """Return how the table is written that is at a location, or that holds the value there."""
    keys = [key for key in location if key not in TAGS]
    if keys[:2] == ["plate", "motion"]:
        name = ".".join(str(key) for key in keys if key in ("plate", "motion", *AXES, "segments"))
        return f"[[{name}]]" if len(keys) > 4 and keys[3] == "segments" else f"[{name}]"
    name = str(location[0])
    if "segments" in location[1:-1]:
        return f"[[{name}.segments]]"
    return f"[[{name}]]" if name in _EACH else f"[{name}]"


def _doubled(header: str) -> str:
    """Return that a header such as [[actuators]] is written so."""
    return f"must be written {header}, in double brackets, once for each {_EACH[header.strip('[]').split('.')[-1]]}"


def _fields(location: Location, tables: Mapping[str, type[BaseModel]]) -> dict[str, FieldInfo]:
    """Return the fields of the table that holds the key at `location`; for the whole file, its tables."""
    table = next((key for key in reversed(location[:-1]) if isinstance(key, str)), "")
    return tables[table].model_fields


def _near(location: Location, tables: Mapping[str, type[BaseModel]]) -> str | None:
    return near(str(location[-1]), _fields(location, tables))


def _known(location: Location, tables: Mapping[str, type[BaseModel]]) -> str:
    keys = [key for key in _fields(location, tables) if key != "model"]
    if len(location) == 1:
        return "the file has " + ", ".join(_header((key,)) for key in keys)
    model = f' with model = "{location[1]}"' if location[0] == "friction" else ""
    model = f" with {location[1]}" if location[0] == "plate" and len(location) == 3 else model
    return f"{_header(location)}{model} has {', '.join(keys)}"


def _wanted(field: FieldInfo) -> str:
    """Return what a value of `field` must be, in words."""
    for mark in field.metadata:
        if hasattr(mark, "wanted"):
            return str(mark.wanted)
    if get_origin(field.annotation) is Literal:
        return one_of(get_args(field.annotation))
    return "a whole number" if field.annotation is int else "a number"


def one_of(choices: Sequence[str]) -> str:
    *others, last = (f'"{choice}"' for choice in choices)
    return f"{', '.join(others)} or {last}" if others else last


def _syntax_problem(error: str, text: str) -> Problem:
    """Return the problem that tomllib reports as `error`, which ends with its place in `text`."""
    reason, _, place = error.rpartition(" (at ")
    found = re.match(r"line (\d+)", place)
    number = int(found[1]) if found else text.rstrip().count("\n") + 1
    line = text.split("\n")[number - 1]
    for name in ("actuators", "actuators.segments", "lattice.segments"):
        single = re.search(rf"^[ \t]*\[[ \t]*{re.escape(name)}[ \t]*\]", text, re.MULTILINE)
        if single and re.match(rf"\s*\[\[?\s*{re.escape(name)}\s*\]", line):
            number = text.count("\n", 0, single.start()) + 1
            return Problem(number, name, f"{_doubled(f'[[{name}]]')}; got [{name}]")
    bare = re.search(r"[=[,]\s*([+-]?[\d.]+(?:[eE][+-]?\d+)?\s*[^\W\d][^,\]#]*)", line)
    hint = f'; a value with a unit needs quotes, "{bare[1].strip()}"' if bare else ""
    reason = re.sub(r"\('([^']*)',\)", r"[\1]", _SYNTAX.get(reason, reason[:1].lower() + reason[1:]))
    return Problem(number, "", f"is not valid TOML: {reason}{hint}")


def _lines(text: str) -> dict[Location, int]:
    """Return the line of each table and key in `text`, which is valid TOML."""
    lines: dict[Location, int] = {}
    counts: Counter[Location] = Counter()
    table: Location = ()
    start, statement = 1, ""
    for number, line in enumerate(text.split("\n"), 1):
        statement += line + "\n"
        try:
            content = tomllib.loads(statement)
        except tomllib.TOMLDecodeError:
            continue  # An array or a text that goes on in the next line.
        if statement.lstrip().startswith("["):
            table = _table(content, counts)
            for depth in range(1, len(table) + 1):
                lines.setdefault(table[:depth], start)
        else:
            for location in _locations(content, table):
                lines.setdefault(location, start)
        start, statement = number + 1, ""
    return lines


def _table(header: dict[str, Any], counts: Counter[Location]) -> Location:
    """Return the table that `header` opens; `counts` keeps how many tables each [[array]] has so far."""
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
