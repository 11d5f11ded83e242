"""What is wrong with tables, in the words of files rather than of pydantic."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from coupling.case.mistakes.layout import (
    EACH,
    Location,
    choices_of,
    header_of,
    home_of,
    home_of_keys,
    keys_at,
    place_of,
    table_at,
)
from coupling.case.mistakes.meaning import Meaning, meaning_of
from coupling.case.values import adapter, quoted
from coupling.suggestion import near
from coupling.synonyms import plain, synonyms

Mistake = tuple[Location, str]
"""Where a mistake is, and what is wrong there."""

RULES = {
    "float_type": "a number",
    "int_type": "a whole number",
    "finite_number": "a finite number",
    "string_type": "text",
    "bool_type": "true or false",
    "greater_than": "greater than {gt:.4g}",
    "greater_than_equal": "at least {ge:.4g}",
    "less_than": "less than {lt:.4g}",
    "less_than_equal": "at most {le:.4g}",
}
"""What a value must be, by the type of pydantic's error."""

_TRUTHS = {
    **dict.fromkeys(("yes", "true", "on", "1", "y"), "true"),
    **dict.fromkeys(("no", "false", "off", "0", "n", "none"), "false"),
}
"""What other languages write for the two."""

_REMARKS = ("title", "name", "description", "comment", "author", "version", "date", "notes", "note")
"""What people call what is no input."""

LACKS_DEFAULT = "default_factory_not_called"
"""The type of an error that is no mistake of its own: a default depends on a wrong field."""


class InputError(ValueError):
    """`problems` has each field of the table `owner` that is wrong, and what is wrong with it."""

    def __init__(self, owner: str, problems: list[tuple[str, str]]) -> None:
        super().__init__(owner, problems)
        self.owner, self.problems = owner, problems

    def __str__(self) -> str:
        return "\n".join(f"Input {field} of {self.owner} {message}" for field, message in self.problems)


def input_error(table: Any, error: ValidationError, values: Mapping[str, Any]) -> InputError:
    """What is wrong with the values of a table that was to be made of them in Python."""
    problems, details, tables = [], mistakes_in(error.errors()), values
    if not table.whole_file:  # its name stands for the header that it would have
        details = [detail | {"loc": (table.__name__, *detail["loc"])} for detail in details]
        tables = {table.__name__: values}
    misspelt = misspelt_in(details, table, tables, None)
    for detail in details:
        if detail["type"] != "extra_forbidden" and detail["loc"] in misspelt:
            continue
        location = in_file(detail, table)
        value = detail["input"]
        if detail["type"].startswith("union_tag") and isinstance(value, dict):
            value = value.get("model")
        message = message_of(detail, value, table, table_at(tables, location[:-1]))
        problems.append((location_text(location[0 if table.whole_file else 1 :]), message))
    return InputError(table.__name__, problems)


def misspelt_in(details: Iterable[Any], root: type[BaseModel], tables: Any, context: Any) -> set[Location]:
    """The keys that are meant by unknown ones in tables, and so are not missing as well."""
    meant: set[Location] = set()
    for detail in details:
        if detail["type"] == "extra_forbidden":
            beside = table_at(tables, in_file(detail, root)[:-1])
            meaning = meaning_at(detail["loc"], root, beside, context)
            meant |= {(*detail["loc"][:-1], key) for key in (meaning.keys if meaning else ())}
    return meant


def mistakes_in(errors: Iterable[Any]) -> list[Any]:
    """Those of pydantic's errors that are mistakes of their own."""
    return [error for error in errors if error["type"] != LACKS_DEFAULT]


def location_text(location: Location) -> str:
    """The name of the field at a location, which counts from 0: actuators[0].stroke."""
    return "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in location).lstrip(".")


def in_file(error: Any, root: type[BaseModel]) -> Location:
    """Where in a file an error is: its location without what pydantic chose between, as the model of [friction]."""
    location = place_of(error["loc"], root).location
    return (*location, "model") if error["type"].startswith("union_tag") else location


def message_of(
    error: Any, value: object, root: type[BaseModel], beside: Mapping[str, Any] | None = None, context: Any = None
) -> str:
    """What is wrong with a value.

    root: the table in which it was validated.  beside: the table that holds it, and context: that of the validation,
    by which a key that is not known is understood.
    """
    kind, location, limits = error["type"], error["loc"], error.get("ctx", {})
    got = f"; got {quoted(value)}"
    match kind:
        case "value_error":
            return str(limits["error"])
        case "missing" if len(location) == 1:
            return f"is missing; it must be a table, written {header_of(location, root)}"
        case "missing":
            return f"is missing; it must be {_expected(place_of(location, root).table.model_fields[location[-1]])}"
        case "extra_forbidden":
            return f"is not known; {_instead(location, root, beside or {location[-1]: value}, context)}"
        case "union_tag_not_found":
            return f"is missing; it must be {one_of(list(choices_of(place_of(location, root).field)))}"
        case "literal_error" | "union_tag_invalid":
            choices = re.findall("'([^']*)'", limits["expected" if kind == "literal_error" else "expected_tags"])
            return f"must be {one_of(choices)}{got}{_meant_choice(value, choices)}"
        case "tuple_type":
            header = header_of((*location, 0), root)
            return in_double_brackets(header) + (f"; got {header[1:-1]}" if isinstance(value, dict) else got)
        case "model_type" | "model_attributes_type":
            return f"must be a table, written {header_of(location, root)}{got}"
        case "bool_type" if truth := _TRUTHS.get(str(value).lower()):
            return f"must be true or false{got}; write {truth}, without quotes"
        case _:
            in_quotes = isinstance(value, str) and kind in ("float_type", "int_type")
            rule = RULES.get(kind, "different").format(**limits)
            return f"must be {rule}{got}" + (f", in quotes{_bare_number(value, kind)}" if in_quotes else "")


def _meant_choice(value: object, choices: Sequence[str]) -> str:
    meant = near(value, choices) if isinstance(value, str) else None
    return f'; did you mean "{meant}"?' if meant else ""


def _bare_number(text: object, kind: str) -> str:
    """The number in a text that needs no quotes, if it is one."""
    plain = str(text).strip().replace(",", ".")
    pattern = r"[+-]?\d+" if kind == "int_type" else r"[+-]?\d+(\.\d+)?([eE][+-]?\d+)?"
    return f"; write {plain}" if re.fullmatch(pattern, plain) and str(text).count(",") <= ("." not in str(text)) else ""


def why_wrong(table: type[BaseModel], context: Any) -> Callable[[str, Any], str]:
    """What says what is wrong with a value of a key of a table; "" for nothing."""

    def why(key: str, value: Any) -> str:
        try:
            adapter(table, key).validate_python(value, context=context)
        except ValidationError as error:
            detail: Any = error.errors()[0]
            if detail["type"] == "value_error" or detail["type"] in RULES or detail["type"] == "literal_error":
                at = "".join(f"[{part}]" for part in detail["loc"] if isinstance(part, int))
                return f"{at} {message_of(detail, detail['input'], table)}".lstrip()
            return "is a table of its own"
        return ""

    return why


def meaning_at(location: Location, root: type[BaseModel], beside: Mapping[str, Any], context: Any) -> Meaning | None:
    """What is meant by the last key of a location, which is not known; `beside` is the table that holds it."""
    table, key = place_of(location, root).table, str(location[-1])
    keys = keys_at(location, root)
    fields = {name: field for name, field in table.model_fields.items() if name in keys}
    return meaning_of(key, beside if key in beside else {key: None, **beside}, fields, why_wrong(table, context))


def _instead(location: Location, root: type[BaseModel], beside: Mapping[str, Any], context: Any) -> str:
    """What to write in place of a key that is not known."""
    key = str(location[-1])
    if len(location) == 1:
        return _instead_of_table(key, beside.get(key), root) or _known(location, root)
    meaning = meaning_at(location, root, beside, context)
    home = "" if meaning and synonyms(key, keys_at(location, root)) else home_of(location, root)
    return home or (meaning.text if meaning else _known(location, root))


def _instead_of_table(key: str, value: object, root: type[BaseModel]) -> str:
    """What to write in place of what stands before or beside all tables; "" where that is not known."""
    names = keys_at((key,), root)
    if plain(key) in _REMARKS and isinstance(value, str):
        return f"a remark is a comment, which begins with #; write # {value}"
    if meant := near(key, names):
        return f"did you mean {meant}?"
    home = home_of_keys([*value] if isinstance(value, dict) else [key], root)
    if home is None:
        return ""
    its = f"its {_and([*value])} belong{'s' * (len(value) == 1)}" if isinstance(value, dict) else "it belongs"
    return f"{its} to {header_of((home,), root)}"


def _and(words: Sequence[str]) -> str:
    return f"{', '.join(words[:-1])} and {words[-1]}" if len(words) > 1 else words[0]


def in_double_brackets(header: str) -> str:
    """That a header such as [[actuators]] is written so."""
    return f"must be written {header}, in double brackets, once for each {EACH[header.strip('[]').split('.')[-1]]}"


def one_of(choices: Sequence[str]) -> str:
    """Choices in quotes, joined by commas and "or"."""
    *others, last = (f'"{choice}"' for choice in choices)
    return f"{', '.join(others)} or {last}" if others else last


def _known(location: Location, root: type[BaseModel]) -> str:
    """Which keys there are beside one that is not known."""
    keys = keys_at(location, root)
    if len(location) == 1:
        return "the file has " + ", ".join(header_of((key,), root) for key in keys)
    model = f' with model = "{location[1]}"' if location[0] == "friction" else ""
    model = f" with {location[1]}" if location[0] == "plate" and len(location) == 3 else model
    return f"{header_of(location, root)}{model} has {', '.join(key for key in keys if key != 'model')}"


def _expected(field: FieldInfo) -> str:
    """What a value of a field must be, in words."""
    for mark in field.metadata:
        if hasattr(mark, "expected"):
            return str(mark.expected)
    if get_origin(field.annotation) is Literal:
        return one_of(get_args(field.annotation))
    return "a whole number" if field.annotation is int else "a number"
