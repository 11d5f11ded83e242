"""What a file may have: its JSON schema, and a template with every table and field."""

from __future__ import annotations

import json
import re
import textwrap
from collections.abc import Iterator
from typing import Any, Final, Literal, get_args, get_origin

from pydantic.fields import FieldInfo
from pydantic.json_schema import GenerateJsonSchema

from coupling.case.table import RULES, Table, expected_of, header_of, names_its_table, tables_in
from coupling.case.values import marks_of, parts_of, quantity_of
from coupling.case.writing.text import written

HEAD: Final = """\
# A template: every field there is. `active-surface check FILE` says whether a file is right, or lists its mistakes.
# Lines such as #name = "value" are fields that may be left out: take the # away to give one.
"""
WIDTH: Final = 110
_BOUNDS: Final = {"gt": "greater_than", "ge": "greater_than_equal", "lt": "less_than", "le": "less_than_equal"}


class _Schema(GenerateJsonSchema):
    """Leaves out defaults, which Python has in SI units, and null, which TOML does not have."""

    def default_schema(self, schema: Any) -> dict[str, Any]:
        return self.generate_inner(schema["schema"])

    def nullable_schema(self, schema: Any) -> dict[str, Any]:
        return self.generate_inner(schema["schema"])


def json_schema(model: type[Table], title: str) -> dict[str, Any]:
    """The schema of a file whose tables are the fields of a model; descriptions are the texts below the fields.

    Units and what depends on other fields are left to `active-surface check`.
    """
    schema = model.model_json_schema(schema_generator=_Schema)
    return {"$schema": GenerateJsonSchema.schema_dialect} | schema | {"title": title}


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
        shown: list[type[Table]] = []
        for key, field in self._model.model_fields.items():
            first, *others = tables_in(field.annotation)
            mark, like = (
                "" if field.is_required() else "#",
                next((one for one in shown if issubclass(first, one)), None),
            )
            shown.append(first)
            header = mark + header_of((key,), self._model)
            lines = [*_comment(field.description), header, *self._fields(first, mark, like)]
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
        for key, field in sorted(table.model_fields.items(), key=lambda one: not names_its_table(one[1])):
            stands = key in known and known[key].description == field.description and not names_its_table(field)
            if stands or (short and key not in needed) or _tables_only(field):
                continue
            default = f"Optional, by default {_value(field)}" if _has_default(field) else "Optional"
            yield from _comment(f"{field.description} {'Required' if key in needed else default}: {_wanted(field)}.")
            yield f"{mark if key in needed else '#'}{key} = {_value(field)}"

    def _inner(self, name: str, table: type[Table], short: bool = False) -> Iterator[str]:
        """Yield the lines for the tables in a table's fields; short: without what may be left out."""
        for key, field in table.model_fields.items():
            for inner in tables_in(field.annotation):
                if all(map(_tables_only, inner.model_fields.values())):
                    yield from self._inner(f"{name}.{key}", inner, short)
                    continue
                again, brackets = inner in self._shown or short, header_of((key,), table)
                self._shown.append(inner)
                header = brackets.replace(key, f"{name}.{key}")
                yield from ["", *_comment(field.description), f"#{header}", *self._fields(inner, "#", short=again)]


def _needed(table: type[Table]) -> set[str]:
    """The fields that must be given, and the first choice where one of several must."""
    fields = table.model_fields.items()
    return {key for key, field in fields if field.is_required() or names_its_table(field)} | {*table.in_template}


def _tables_only(field: FieldInfo) -> bool:
    """Whether a field is nothing but a table or several."""
    return bool(tables_in(field.annotation)) and str not in parts_of(field.annotation)


def _comment(text: str | None) -> list[str]:
    """A text as lines of a comment, which do not break what is in quotes."""
    whole = re.sub(r'"[^"]*"', lambda quoted: quoted[0].replace(" ", "\0"), text or "")
    lines = textwrap.wrap(whole, WIDTH, initial_indent="# ", subsequent_indent="#   ", break_long_words=False)
    return [line.replace("\0", " ") for line in lines]


def _has_default(field: FieldInfo) -> bool:
    return not field.is_required() and field.default is not None and field.default_factory is None


def _wanted(field: FieldInfo) -> str:
    """What a value must be, in words."""
    bounds = [
        RULES[rule].format(**{name: bound})
        for name, rule in _BOUNDS.items()
        for mark in field.metadata
        if (bound := getattr(mark, name, None)) is not None
    ]
    if (quantity := quantity_of(field.rebuild_annotation(), lists=False)) and quantity.positive:
        bounds.append("greater than 0")
    return ", ".join([expected_of(field), *bounds])


def _value(field: FieldInfo) -> str:
    """The default, an example or the first choice, as TOML."""
    annotation = field.rebuild_annotation()
    if _has_default(field):
        return written(field.default, annotation)
    if field.examples:
        example = field.examples[0]
        return written(example, annotation) if isinstance(example, dict) else json.dumps(example, ensure_ascii=False)
    for mark in marks_of(annotation):
        if example := getattr(mark, "example", None):
            return example if example.startswith("[") else json.dumps(example)
    return json.dumps(get_args(next(kind for kind in parts_of(annotation) if get_origin(kind) is Literal))[0])
