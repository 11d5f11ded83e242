"""Tables of a file as pydantic models in SI units, and their mistakes in the words of the file.

A table whose keys depend on each other yields its `contradictions` once each key is right by itself.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from typing import TYPE_CHECKING, Any, ClassVar, Final, Self, get_args, get_origin

from pydantic import (
    BaseModel,
    ConfigDict,
    ModelWrapValidatorHandler,
    Tag,
    ValidationError,
    ValidationInfo,
    model_validator,
)

from coupling.case.values import TAG, expected_of, names_its_table, one_of, parts_of, quoted, tables_in
from coupling.suggestion import near

if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass
else:
    ModelMetaclass = type(BaseModel)

Location = tuple[int | str, ...]
"""The keys, and indices from 0, that lead to a value in a file."""
Mistake = tuple[Location, str]
"""Where a mistake is, and what is wrong there."""
Contradictions = Iterator[tuple[str | Location, str]]
"""A key, or the location of an item in its value, and what is wrong with it."""

RULES: Final = {
    "float_type": "a number",
    "int_type": "a whole number",
    "finite_number": "a finite number",
    "string_type": "text",
    "string_pattern_mismatch": "at most 40 letters, digits, - and _",
    "bool_type": "true or false",
    "greater_than": "greater than {gt:.4g}",
    "greater_than_equal": "at least {ge:.4g}",
    "less_than": "less than {lt:.4g}",
    "less_than_equal": "at most {le:.4g}",
}
"""What a value must be, by the type of pydantic's error."""


class Faults(ValueError):
    """Mistakes in places at or below the one where it is raised."""

    def __init__(self, mistakes: Iterable[Mistake]) -> None:
        self.mistakes = list(mistakes)
        super().__init__(self.mistakes)


class InputError(ValueError):
    """`problems` has each field of the table `owner` that is wrong, and what is wrong with it."""

    def __init__(self, owner: str, problems: list[tuple[str, str]]) -> None:
        super().__init__(owner, problems)
        self.owner, self.problems = owner, problems

    def __str__(self) -> str:
        return "\n".join(
            " ".join(filter(None, ("Input", field, "of", self.owner, message))) for field, message in self.problems
        )


class _Refusing(ModelMetaclass):
    """Describes what is wrong with a table that is made in Python in the words of files."""

    def __call__(cls, *arguments: Any, **values: Any) -> Any:
        with _in_words(cls, values := {key: _plain(value) for key, value in values.items()}):
            return super().__call__(*arguments, **values)


@contextmanager
def _in_words(table: Any, values: Any) -> Iterator[None]:
    """Turns pydantic's error into an InputError."""
    try:
        yield
    except ValidationError as error:
        problems = [(location_text(at), message) for at, message in mistakes_of(error, table, values)]
        raise InputError(table.__name__, problems) from None


def _plain(value: Any) -> Any:
    """The same value without arrays and numbers of numpy."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return value.tolist() if type(value).__module__ == "numpy" else value


class Table(BaseModel, metaclass=_Refusing):
    """Raises InputError, a ValueError, with every wrong field when it is made of values that it cannot have."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, use_attribute_docstrings=True)

    whole_file: ClassVar[bool] = False
    """Whether its fields are the tables of a file."""
    in_template: ClassVar[tuple[str, ...]] = ()
    """Keys that a template states although a table may do without them, as the first of several choices."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        """Yield each key that does not go with the others, or is missing because of them, and why.

        given: the values that are stated, by their keys; each is right by itself.
        """
        yield from ()

    @classmethod
    def model_validate(cls, obj: Any, **options: Any) -> Self:
        """As in pydantic; without a validation context it raises InputError, as Python's own tables do."""
        if "context" in options:
            return super().model_validate(obj, **options)
        with _in_words(cls, obj := _plain(obj)):
            return super().model_validate(obj, **options)

    @model_validator(mode="wrap")
    @classmethod
    def _consistent(cls, data: Any, handler: ModelWrapValidatorHandler[Self], info: ValidationInfo) -> Self:
        self = handler(data)
        if self is data:  # a table already, which is right
            return self
        # In Python a default may be given, as in the dump of a case that is made again.
        keys = self.model_fields_set
        given = (
            {key: value for key in keys if (value := getattr(self, key)) is not None} if info.context else stated(self)
        )
        found = cls.contradictions(given)
        if wrong := [((at,) if isinstance(at, str) else at, message) for at, message in found]:
            raise Faults(wrong)
        return self


def stated(table: Table) -> dict[str, Any]:
    """The values of a table, by their keys, that are not what they would be anyway."""
    values = vars(table)
    usual = _usual(type(table)).items()
    return {key: value for key, of in usual if (value := values[key]) is not None and value != of(values)}


@cache
def _usual(model: type[Table]) -> dict[str, Callable[[Any], Any]]:
    """What gives the value of each field where it is not given, from all values; None for those always stated."""
    usual = {key: None if names_its_table(field) else field.default for key, field in model.model_fields.items()}
    made: dict[str, Any] = {key: field.default_factory for key, field in model.model_fields.items()}
    return {key: made[key] or (lambda _, value=value: value) for key, value in usual.items()}


def named(key: str, names: Iterable[str], instead: str = "") -> Callable[[Any], Any]:
    """What checks that a table says which of several it is; instead: another key by which it may say so."""
    choices = one_of(names := list(names))

    def check(table: Any) -> Any:
        if not isinstance(table, Mapping):
            return table
        if key not in table and not (instead and instead in table):
            raise Faults([((key,), f"is missing; it must be {choices}{f', or use {instead} instead' * bool(instead)}")])
        if key in table and table[key] not in names:
            raise Faults([((key,), f"must be {choices}; got {quoted(table[key])}{_meant(table[key], names)}")])
        return table

    return check


def mistakes_of(error: ValidationError | Faults, root: type[BaseModel], tables: Any = None) -> list[Mistake]:
    """The mistakes in tables of a model, without the keys that are missing because they are misspelt.

    tables: as they are written, to say what each value was.
    """
    if isinstance(error, Faults):
        return error.mistakes
    mistakes: list[Mistake] = []
    misspelt: set[Location] = set()
    for detail in error.errors():
        inner = detail.get("ctx", {}).get("error")
        at = tuple(key for key in detail["loc"] if not (isinstance(key, str) and key.startswith(TAG)))
        if isinstance(inner, Faults):
            mistakes += [((*at, *below), message) for below, message in inner.mistakes]
        elif detail["type"] != "default_factory_not_called":  # it depends on a field that is wrong
            written = value_at(tables, at)
            mistakes.append((at, _message(detail, detail["input"] if written is None else written, root)))
        if detail["type"] == "extra_forbidden":
            fields = _table_at(detail["loc"][:-1], root)[0].model_fields
            meant = near(str(at[-1]), fields)
            several = meant and any(get_origin(part) is tuple for part in parts_of(fields[meant].annotation))
            values = isinstance(detail["input"], list) and not any(isinstance(one, dict) for one in detail["input"])
            if meant and (several or not values):  # several values stand for no single one
                misspelt.add((*at[:-1], meant))
    if ("lattice",) in misspelt:
        misspelt.add(("actuators",))
    return [one for one in mistakes if not (one[0] in misspelt and one[1].startswith("is missing"))]


def value_at(tables: Any, location: Location) -> Any:
    """What stands at a location in plain tables; None where nothing does."""
    for key in location:
        try:
            tables = tables[key]
        except (KeyError, IndexError, TypeError):
            return None
    return tables


def location_text(location: Location) -> str:
    """The name of the field at a location, which counts from 0: actuators[0].stroke."""
    named = (key if isinstance(key, int) or re.fullmatch(r"[\w-]+", key) else quoted(key) for key in location)
    return "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in named).lstrip(".")


def _meant(value: object, choices: Iterable[str]) -> str:
    meant = near(value, choices) if isinstance(value, str) else None
    return f'; did you mean "{meant}"?' if meant else ""


def _message(detail: Any, value: Any, root: type[BaseModel]) -> str:
    """What is wrong with a value, from one of pydantic's errors."""
    kind, location, limits = detail["type"], detail["loc"], detail.get("ctx", {})
    got = f"; got {quoted(value)}"
    header = header_of(location, root) if getattr(root, "whole_file", False) or len(location) > 1 else ""
    written = f", written {header}" if header else " of its fields"
    if kind == "value_error":
        return str(limits["error"])
    if kind == "missing":
        field = _table_at(location[:-1], root)[0].model_fields[location[-1]]
        wanted = f"a table{written}" if tables_in(field.annotation) else expected_of(field)
        return f"is missing; it must be {wanted}"
    if kind == "extra_forbidden":
        return f"is not known; {_instead(location, root)}"
    if kind == "literal_error":
        choices = re.findall("'([^']*)'", limits["expected"])
        return f"must be {one_of(choices)}{got}{_meant(value, choices)}"
    if kind == "tuple_type" and header.startswith("[["):
        return f"must be written {header}, in double brackets, once for each{got}"
    if kind in ("model_type", "model_attributes_type"):
        return f"must be a table{written}{got}"
    return f"must be {RULES.get(kind, 'different').format(**limits)}{got}"


def _instead(location: tuple[Any, ...], root: type[BaseModel]) -> str:
    """What to write instead of a key that is not known."""
    key, (owner, header) = str(location[-1]), _table_at(location[:-1], root)
    for name, field in root.model_fields.items():
        tables = tables_in(field.annotation)
        if others := [table.model_fields for table in tables if key in table.model_fields]:
            if owner not in tables:
                return f"it belongs to {header_of((name,), root)}"
            kinds = [(kind, one[kind]) for one in others for kind in ("shape", "model") if kind in one]
            with_these = dict.fromkeys(f'{kind} = "{get_args(field.annotation)[0]}"' for kind, field in kinds)
            return f"it goes with {' or '.join(with_these) or 'mesh, without a shape'}"
    if meant := near(key, owner.model_fields):
        return f"did you mean {meant}?"
    if owner is root and tables_in(next(iter(root.model_fields.values())).annotation):
        return "the file has " + ", ".join(filter(None, (header_of((name,), root) for name in root.model_fields)))
    return f"{header or 'it'} has {', '.join(owner.model_fields)}"


def header_of(location: tuple[Any, ...], root: type[BaseModel]) -> str:
    """How the table is written that is at a location, or that has the value there: [part], [[actuators]]."""
    return _table_at(location, root)[1]


def _table_at(location: tuple[Any, ...], root: type[BaseModel]) -> tuple[type[BaseModel], str]:
    """The table at a location, or that has the value there, and how it is written; pydantic's tags may be in it."""
    table, annotation, names, several = root, None, [], False
    for key in (key for key in location if isinstance(key, str)):
        if key in table.model_fields:
            annotation = table.model_fields[key].rebuild_annotation()
            if inner := tables_in(annotation):
                table, several = inner[0], any(get_origin(part) is tuple for part in parts_of(annotation))
                names.append(key)
        elif annotation is not None:
            tagged = [part for part in parts_of(annotation) if Tag(key) in getattr(part, "__metadata__", ())]
            table = next((inner for part in tagged for inner in tables_in(part)), table)
    name = ".".join(names)
    return table, f"[[{name}]]" if several else f"[{name}]" if name else ""
