"""The template of a file: every table and field, with what it is, what it must be, and its default."""

from __future__ import annotations

import json
import re
import textwrap
from collections.abc import Iterator, Sequence
from typing import Any, Final, get_args, get_origin

from pydantic.fields import FieldInfo

from coupling.case.mistakes import RULES, one_of
from coupling.case.table import WRONG, KeyedTable, Table, tables_in
from coupling.case.values import parts_of
from coupling.case.writing.text import written

HEAD: Final = """\
# A template: every field there is. `active-surface check FILE` tells whether a file is right, and every mistake if not.
# Lines such as #name = "value" are fields that may be left out: take the # away to give one.
"""
WIDTH: Final = 110
_BOUNDS: Final = {"gt": "greater_than", "ge": "greater_than_equal", "lt": "less_than", "le": "less_than_equal"}


def template(model: type[Table]) -> str:
    """The text of a file whose tables are the fields of a model.

    What must be given stands, and the rest is commented out, with its default or an example.
    """
    return HEAD + "".join(f"\n{block}\n" for block in _Template(model).blocks())


class _Template:
    def __init__(self, model: type[Table]) -> None:
        self._model = model
        self._shown: list[type[Table]] = []  # of the tables in tables

    def blocks(self) -> Iterator[str]:
        for key, field in self._model.model_fields.items():
            first, *others = [table for table in tables_in(field.annotation) if table.model_config["extra"] == "forbid"]
            mark = "" if field.is_required() else "#"
            lines = [*_comment(field.description), mark + _header(key, field), *self._fields(first, mark)]
            for other in others:
                lines += ["", *_comment(f"Or: {str(other.__doc__).splitlines()[0]}"), *self._fields(other, "#", first)]
                lines += self._inner(key, other, short=True)
            yield "\n".join([*lines, *self._inner(key, first)])

    def _fields(
        self, table: type[Table], mark: str, beside: type[Table] | None = None, short: bool = False
    ) -> Iterator[str]:
        """Yield the lines for the fields of a table, without those of another that stands already.

        short: without those that may be left out, too.
        """
        needed, known = _needed(table), beside.model_fields if beside else {}
        for key, field in sorted(table.model_fields.items(), key=lambda one: not _names(one[1])):
            told = key in known and known[key].description == field.description and not _names(field)
            if told or (short and key not in needed) or _tables_only(field):
                continue
            how = "Required" if key in needed else _without(field)
            yield from _comment(f"{field.description} {how}: {_wanted(field)}.")
            yield f"{mark if key in needed else '#'}{key} = {_value(field)}"

    def _inner(self, name: str, table: type[Table], short: bool = False) -> Iterator[str]:
        """Yield the lines for the tables in a table's fields; short: without what may be left out."""
        for key, field in table.model_fields.items():
            for inner in tables_in(field.annotation):
                if all(map(_tables_only, inner.model_fields.values())):
                    yield from self._inner(f"{name}.{key}", inner, short)
                    continue
                again, header = inner in self._shown or short, _header(f"{name}.{key}", field)
                self._shown.append(inner)
                yield from ["", *_comment(field.description), f"#{header}", *self._fields(inner, "#", short=again)]


def _needed(table: type[Table]) -> set[str]:
    """The fields that must be given, and the first choice where one of several must."""
    needed = {key: WRONG for key, field in table.model_fields.items() if field.is_required() or _names(field)}
    while issubclass(table, KeyedTable):
        missing = [key for key, message in table.contradictions(needed) if message.startswith("is missing")]
        if not missing:
            break
        needed |= dict.fromkeys(missing, WRONG)
    return set(needed)


def _names(field: FieldInfo) -> bool:
    """Whether a field only names the table that has it, as the model of a law."""
    return (
        get_origin(field.annotation) is not None
        and len(get_args(field.annotation)) == 1
        and not _marks(field.metadata, field.annotation)
    )


def _wanted_by(metadata: Sequence[Any], annotation: Any) -> list[str]:
    """What marks want of a value, those of the whole before those of its parts."""
    return [str(mark.expected) for mark in _marks(metadata, annotation) if hasattr(mark, "expected")]


def _marks(metadata: Sequence[Any], annotation: Any) -> list[Any]:
    """What marks an annotation and its parts."""
    return [*metadata, *(mark for part in parts_of(annotation) for mark in getattr(part, "__metadata__", ()))]


def _tables_only(field: FieldInfo) -> bool:
    """Whether a field is nothing but a table or several."""
    return bool(tables_in(field.annotation)) and str not in parts_of(field.annotation)


def _header(name: str, field: FieldInfo) -> str:
    several = any(get_origin(part) is tuple for part in parts_of(field.annotation))
    return f"[[{name}]]" if several else f"[{name}]"


def _comment(text: str | None) -> list[str]:
    """A text as lines of a comment, which do not break what is in quotes."""
    whole = re.sub(r'"[^"]*"', lambda quoted: quoted[0].replace(" ", "\0"), text or "")
    lines = textwrap.wrap(whole, WIDTH, initial_indent="# ", subsequent_indent="#   ", break_long_words=False)
    return [line.replace("\0", " ") for line in lines]


def _without(field: FieldInfo) -> str:
    """What becomes of a field that is left out."""
    return f"Optional, by default {_value(field)}" if _has_default(field) else "Optional"


def _has_default(field: FieldInfo) -> bool:
    return not field.is_required() and field.default is not None and field.default_factory is None


def _wanted(field: FieldInfo) -> str:
    """What a value must be, in words."""
    kinds, marks = parts_of(field.annotation), _wanted_by(field.metadata, field.annotation)
    item = next((get_args(kind)[0] for kind in kinds if get_origin(kind) is tuple and kind.__args__[-1] is ...), None)
    of_items = item is not None and marks == _wanted_by([], item)
    choices = next((get_args(kind) for kind in kinds if str(get_origin(kind)) == "typing.Literal"), ())
    words = {bool: "true or false", int: "a whole number", float: "a number", str: "text"}
    plain = next((word for kind, word in words.items() if kind in kinds), "a value")
    word = marks[0] if marks else one_of(choices) if choices else plain
    word = f"a list, each item {word}" if of_items else word
    bounds = [
        RULES[rule].format(**{name: bound})
        for name, rule in _BOUNDS.items()
        for mark in field.metadata
        if (bound := getattr(mark, name, None)) is not None
    ]
    return ", ".join([word, *bounds])


def _value(field: FieldInfo) -> str:
    """The default, an example or the first choice, as TOML."""
    annotation = field.rebuild_annotation()
    if _has_default(field):
        return written(field.default, annotation)
    if field.examples:
        example = field.examples[0]
        return written(example, annotation) if isinstance(example, dict) else json.dumps(example, ensure_ascii=False)
    for mark in _marks(field.metadata, field.annotation):
        if hasattr(mark, "example"):
            return _example(mark)
    kind = next(kind for kind in parts_of(annotation) if str(get_origin(kind)) == "typing.Literal")
    return json.dumps(get_args(kind)[0])


def _example(mark: Any) -> str:
    return json.dumps(mark.example) if not mark.example.startswith("[") else str(mark.example)
