"""Layout: which tables and keys the models of a file have, and where in it a location of an error is."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple, get_args

from pydantic import BaseModel, Tag
from pydantic.fields import FieldInfo

from coupling.case.values import AXES, parts_of
from coupling.synonyms import synonyms

Location = tuple[int | str, ...]
"""The keys, and indices from 0, that lead to a value in a file."""

EACH = {"actuators": "actuator", "segments": "segment", "axes": "axis"}
"""Tables in double brackets, and what there is one of for each."""


class Place(NamedTuple):
    location: Location  # without the tags that pydantic puts into it
    table: type[BaseModel]  # which holds the last key
    field: FieldInfo | None  # the last that was entered


def place_of(location: Location, root: type[BaseModel]) -> Place:
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
            choices = choices_of(field)
            models = models_in(field.annotation) if field else []
            table = models[0] if len(models) == 1 else table
    return Place(tuple(kept), owner, field)


def choices_of(field: FieldInfo | None) -> dict[Any, type[BaseModel] | None]:
    """What a field is chosen from, by pydantic's tags; None for what is no table."""
    if field is None:
        return {}
    if isinstance(field.discriminator, str):
        models = models_in(field.annotation)
        return {get_args(model.model_fields[field.discriminator].annotation)[0]: model for model in models}
    return {
        mark.tag: next(iter(models_in(part)), None)
        for part in parts_of(field.annotation)
        for mark in getattr(part, "__metadata__", ())
        if isinstance(mark, Tag)
    }


def models_in(annotation: Any) -> list[type[BaseModel]]:
    parts = parts_of(annotation)
    return list(dict.fromkeys(part for part in parts if isinstance(part, type) and issubclass(part, BaseModel)))


def header_of(location: Location, root: type[BaseModel]) -> str:
    """How the table is written that is at a location, or that holds the value there."""
    keys = place_of(location, root).location
    if keys[:2] == ("plate", "motion"):
        name = ".".join(str(key) for key in keys if key in ("plate", "motion", *AXES, "segments"))
        return f"[[{name}]]" if len(keys) > 4 and keys[3] == "segments" else f"[{name}]"
    name = str(location[0])
    if "segments" in location[1:-1]:
        return f"[[{name}.segments]]"
    return f"[[{name}]]" if name in EACH else f"[{name}]"


def keys_at(location: Location, root: type[BaseModel]) -> list[str]:
    """The keys that there may be beside that at a location; of a whole file only its tables."""
    fields = place_of(location, root).table.model_fields.items()
    return [key for key, field in fields if len(location) > 1 or models_in(field.annotation)]


def inner_tables(model: type[BaseModel], name: str) -> Iterator[tuple[str, type[BaseModel]]]:
    """Yield the tables inside another, with the headers that they have there."""
    for key, field in model.model_fields.items():
        for inner in models_in(field.annotation):
            yield f"[{name}.{key}]", inner
            yield from inner_tables(inner, f"{name}.{key}")


def home_of_keys(words: Iterable[str], root: type[BaseModel]) -> str | None:
    """The first table that has all of some keys, or what they stand for; None: there is none."""
    keys = [*words]
    for name, field in root.model_fields.items():
        there = {key for model in models_in(field.annotation) for key in model.model_fields}
        if there and keys and all(key in there or synonyms(key, there) for key in keys):
            return name
    return None


def home_of(location: Location, root: type[BaseModel]) -> str:
    """Where else a key belongs to: to other kinds of its own table, or to other tables; "" where to none."""
    key, own = str(location[-1]), root.model_fields.get(str(location[0]))
    choices = choices_of(own)
    chosen = choices.get(location[1])
    for header, table in inner_tables(chosen, str(location[0])) if chosen and len(location) == 3 else ():
        if key in table.model_fields:
            return f"it belongs to {header}"
        if synonym := next(iter(synonyms(key, table.model_fields)), None):
            return f"did you mean {synonym.keys[0]} in {header}?"
    tags = [
        tag if "=" in tag else f'model = "{tag}"'
        for tag, model in choices.items()
        if model and key in model.model_fields and ("=" in tag or location[0] == "friction")
    ]
    if tags:
        return f"it goes with {' or '.join(tags)}"
    for name, other in root.model_fields.items():
        if name != location[0] and any(key in model.model_fields for model in models_in(other.annotation)):
            return f"it belongs to {header_of((name,), root)}"
    return ""


def value_at(tables: Any, location: Location) -> Any:
    """What stands at a location in tables; None where nothing does."""
    value = tables
    for key in location:
        try:
            value = value[key]
        except (KeyError, IndexError, TypeError):
            return None
    return value


def table_at(tables: Any, location: Location) -> Mapping[str, Any]:
    """The table at a location in others; an empty one where there is none."""
    value = value_at(tables, location)
    return value if isinstance(value, Mapping) else {}
