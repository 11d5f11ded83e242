"""The JSON schema of a file: what its tables may have, as far as a schema can tell."""

from __future__ import annotations

import json
import tomllib
from typing import Any, Final

from pydantic.fields import FieldInfo

from coupling.case.table import Table, all_tables
from coupling.case.values import POSITIVE, WRITTEN
from coupling.case.writing.text import written

DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"


def json_schema(model: type[Table], title: str) -> dict[str, Any]:
    """The schema of a file whose tables are the fields of a model.

    Defaults are as a file states them, and descriptions are the texts below the fields. Units and what depends on other
    fields are left to `active-surface check`.
    """
    schema = model.model_json_schema()
    tables = {table.__name__: table for table in all_tables(model)}
    for name, definition in [(model.__name__, schema), *schema.get("$defs", {}).items()]:
        _finish(definition, tables[name])
    return {"$schema": DIALECT} | schema | {"title": title}


def _finish(definition: dict[str, Any], table: type[Table]) -> None:
    """Has a table's definition speak of files rather than of Python."""
    properties = definition.get("properties", {})
    for key in properties:
        field = table.model_fields[key]
        properties[key].pop("default", None)
        known = properties[key] = _without_null(properties[key])
        known.pop("title", None)
        if not field.is_required() and field.default is not None and field.default_factory is None:
            known["default"] = _plain(written(field.default, field.rebuild_annotation()))
        if _positive(field):
            _forbid_signs(known)


def _plain(text: str) -> Any:
    value = tomllib.loads(f"value = {text}")["value"]
    return json.loads(json.dumps(value))


def _without_null(known: dict[str, Any]) -> dict[str, Any]:
    """A field's schema without null, which TOML does not have."""
    options = known.get("anyOf", [])
    left = [option for option in options if option != {"type": "null"}]
    if len(left) == len(options):
        return known
    rest = {key: value for key, value in known.items() if key != "anyOf"}
    return left[0] | rest if len(left) == 1 else {"anyOf": left} | rest


def _positive(field: FieldInfo) -> bool:
    bounds = [getattr(mark, name, None) for mark in field.metadata for name in ("gt", "ge")]
    return any(bound is not None and bound >= 0 for bound in bounds)


def _forbid_signs(known: dict[str, Any]) -> None:
    """Has a text that states a quantity begin without a minus sign."""
    if known.get("pattern") == WRITTEN:
        known["pattern"] = POSITIVE
        known.pop("gt", None)
