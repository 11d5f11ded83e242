"""What is wrong with tables, in the words of files rather than of pydantic."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Any, Literal, NamedTuple, get_args, get_origin

from pydantic import BaseModel, Tag, ValidationError
from pydantic.fields import FieldInfo

from coupling.case.values import AXES, parts_of, quoted
from coupling.suggestion import near

Location = tuple[int | str, ...]
"""The keys, and indices from 0, that lead to a value in a file."""
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

LACKS_DEFAULT = "default_factory_not_called"
"""The type of an error that is no mistake of its own: a default depends on a wrong field."""

_EACH = {"actuators": "actuator", "segments": "segment", "axes": "axis"}
"""Tables in double brackets, and what there is one of for each."""


class InputError(ValueError):
    """`problems` has each field of the table `owner` that is wrong, and what is wrong with it."""

    def __init__(self, owner: str, problems: list[tuple[str, str]]) -> None:
        super().__init__(owner, problems)
        self.owner, self.problems = owner, problems

    def __str__(self) -> str:
        return "\n".join(f"Input {field} of {self.owner} {message}" for field, message in self.problems)


def input_error(table: Any, error: ValidationError) -> InputError:
    """What is wrong with the values of a table that was to be made in Python."""
    problems = []
    for detail in mistakes_in(error.errors()):
        if not table.whole_file:  # its name stands for the header that it would have
            detail["loc"] = (table.__name__, *detail["loc"])
        location = in_file(detail, table)[0 if table.whole_file else 1 :]
        value = detail["input"]
        if detail["type"].startswith("union_tag") and isinstance(value, dict):
            value = value.get("model")
        problems.append((location_text(location), message_of(detail, value, table)))
    return InputError(table.__name__, problems)


def mistakes_in(errors: Iterable[Any]) -> list[Any]:
    """Those of pydantic's errors that are mistakes of their own."""
    return [error for error in errors if error["type"] != LACKS_DEFAULT]


def location_text(location: Location) -> str:
    """The name of the field at a location, which counts from 0: actuators[0].stroke."""
    return "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in location).lstrip(".")


def in_file(error: Any, root: type[BaseModel]) -> Location:
    """Where in a file an error is: its location without what pydantic chose between, as the model of [friction]."""
    location = _place(error["loc"], root).location
    return (*location, "model") if error["type"].startswith("union_tag") else location


def message_of(error: Any, value: object, root: type[BaseModel]) -> str:
    """What is wrong with a value; root: the table in which it was validated."""
    kind, location, context = error["type"], error["loc"], error.get("ctx", {})
    got = f"; got {quoted(value)}"
    match kind:
        case "value_error":
            return str(context["error"])
        case "missing" if len(location) == 1:
            return f"is missing; it must be a table, written {_header(location, root)}"
        case "missing":
            return f"is missing; it must be {_expected(_place(location, root).table.model_fields[location[-1]])}"
        case "extra_forbidden":
            meant = meant_key(location, root)
            return "is not known; " + (f"did you mean {meant}?" if meant else _known(location, root))
        case "union_tag_not_found":
            return f"is missing; it must be {one_of(list(_choices(_place(location, root).field)))}"
        case "literal_error" | "union_tag_invalid":
            choices = re.findall("'([^']*)'", context["expected" if kind == "literal_error" else "expected_tags"])
            meant = near(value, choices) if isinstance(value, str) else None
            return f"must be {one_of(choices)}{got}" + (f'; did you mean "{meant}"?' if meant else "")
        case "tuple_type":
            header = _header((*location, 0), root)
            return in_double_brackets(header) + (f"; got {header[1:-1]}" if isinstance(value, dict) else got)
        case "model_type" | "model_attributes_type":
            return f"must be a table, written {_header(location, root)}{got}"
        case _:
            in_quotes = isinstance(value, str) and kind in ("float_type", "int_type")
            rule = RULES.get(kind, "different").format(**context)
            return f"must be {rule}{got}" + (", in quotes" if in_quotes else "")


def meant_key(location: Location, root: type[BaseModel]) -> str | None:
    """The key that may be meant by the last of a location."""
    return near(str(location[-1]), _keys(location, root))


def in_double_brackets(header: str) -> str:
    """That a header such as [[actuators]] is written so."""
    return f"must be written {header}, in double brackets, once for each {_EACH[header.strip('[]').split('.')[-1]]}"


def one_of(choices: Sequence[str]) -> str:
    """Choices in quotes, joined by commas and "or"."""
    *others, last = (f'"{choice}"' for choice in choices)
    return f"{', '.join(others)} or {last}" if others else last


class _Place(NamedTuple):
    location: Location  # without the tags that pydantic puts into it
    table: type[BaseModel]  # which holds the last key
    field: FieldInfo | None  # the last that was entered


def _place(location: Location, root: type[BaseModel]) -> _Place:
    """Where a location of one of pydantic's errors leads to; it may begin with the name of the root itself."""
    kept: list[int | str] = []
    owner = table = root
    field: FieldInfo | None = None
    choices: dict[Any, type[BaseModel] | None] = {}
    for n, key in enumerate(location):
        if key in choices:
            table, choices = choices[key] or table, {}
            continue
        kept.append(key)
        owner = table
        if isinstance(key, str) and not (n == 0 and key == root.__name__):
            field = table.model_fields.get(key)
            choices = _choices(field)
            models = _models(field.annotation) if field else []
            table = models[0] if len(models) == 1 else table
    return _Place(tuple(kept), owner, field)


def _choices(field: FieldInfo | None) -> dict[Any, type[BaseModel] | None]:
    """What a field is chosen from, by pydantic's tags; None for what is no table."""
    if field is None:
        return {}
    if isinstance(field.discriminator, str):
        models = _models(field.annotation)
        return {get_args(model.model_fields[field.discriminator].annotation)[0]: model for model in models}
    return {
        mark.tag: next(iter(_models(part)), None)
        for part in parts_of(field.annotation)
        for mark in getattr(part, "__metadata__", ())
        if isinstance(mark, Tag)
    }


def _models(annotation: Any) -> list[type[BaseModel]]:
    parts = parts_of(annotation)
    return list(dict.fromkeys(part for part in parts if isinstance(part, type) and issubclass(part, BaseModel)))


def _header(location: Location, root: type[BaseModel]) -> str:
    """How the table is written that is at a location, or that holds the value there."""
    keys = _place(location, root).location
    if keys[:2] == ("plate", "motion"):
        name = ".".join(str(key) for key in keys if key in ("plate", "motion", *AXES, "segments"))
        return f"[[{name}]]" if len(keys) > 4 and keys[3] == "segments" else f"[{name}]"
    name = str(location[0])
    if "segments" in location[1:-1]:
        return f"[[{name}.segments]]"
    return f"[[{name}]]" if name in _EACH else f"[{name}]"


def _keys(location: Location, root: type[BaseModel]) -> list[str]:
    """The keys that there may be beside that at a location; of a whole file only its tables."""
    fields = _place(location, root).table.model_fields.items()
    return [key for key, field in fields if len(location) > 1 or _models(field.annotation)]


def _known(location: Location, root: type[BaseModel]) -> str:
    """Which keys there are beside one that is not known."""
    keys = _keys(location, root)
    if len(location) == 1:
        return "the file has " + ", ".join(_header((key,), root) for key in keys)
    model = f' with model = "{location[1]}"' if location[0] == "friction" else ""
    model = f" with {location[1]}" if location[0] == "plate" and len(location) == 3 else model
    return f"{_header(location, root)}{model} has {', '.join(key for key in keys if key != 'model')}"


def _expected(field: FieldInfo) -> str:
    """What a value of a field must be, in words."""
    for mark in field.metadata:
        if hasattr(mark, "expected"):
            return str(mark.expected)
    if get_origin(field.annotation) is Literal:
        return one_of(get_args(field.annotation))
    return "a whole number" if field.annotation is int else "a number"
