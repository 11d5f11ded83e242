"""What is written below the fields of a table: one text for schemas, templates and readers of the source."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Iterator

from pydantic import BaseModel

from coupling.case.annotations import parts_of
from coupling.case.table import Table


def field_texts(table: type[BaseModel]) -> dict[str, str]:
    """The text below each field in the sources of a table and of those that it extends."""
    texts: dict[str, str] = {}
    for owner in reversed(table.__mro__):
        if issubclass(owner, Table) and owner is not Table:
            texts |= _own(owner)
    return {key: text for key, text in texts.items() if key in table.model_fields}


def _own(table: type[Table]) -> dict[str, str]:
    (body,) = ast.parse(textwrap.dedent(inspect.getsource(table))).body
    assert isinstance(body, ast.ClassDef)
    texts = {}
    for field, text in zip(body.body, body.body[1:], strict=False):
        if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name) and isinstance(text, ast.Expr):
            texts[field.target.id] = str(ast.literal_eval(text.value))
    return texts


def tables_in(annotation: object) -> list[type[Table]]:
    """The tables that an annotation is made of, in its order."""
    return [part for part in parts_of(annotation) if isinstance(part, type) and issubclass(part, Table)]


def all_tables(table: type[Table]) -> Iterator[type[Table]]:
    """Yield a table and all those in its fields, some of them several times."""
    yield table
    for field in table.model_fields.values():
        for inner in tables_in(field.annotation):
            yield from all_tables(inner)
