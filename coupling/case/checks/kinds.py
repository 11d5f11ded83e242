"""Kinds: the plate's shape, or the friction model, that is meant where another word or none is written."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any, Final, NamedTuple

from pydantic import BaseModel

from coupling.case.friction import ConstantCase, CoulombCase, KogutEtsionCase, TableCase
from coupling.case.mistakes import Mistake, one_of
from coupling.case.plates import PLATES, MeshCase, ShapelessCase
from coupling.case.values import quoted
from coupling.suggestion import near
from coupling.synonyms import SIDES, plain, synonyms

_LAWS: Final[dict[str, type[BaseModel]]] = {
    "kogut-etsion": KogutEtsionCase,
    "constant": ConstantCase,
    "coulomb": CoulombCase,
    "table": TableCase,
}


class _Kind(NamedTuple):
    table: str
    key: str  # which names the kind
    models: Sequence[tuple[str, type[BaseModel]]]  # by that name; a polygon has two


_SHAPES: Final = [
    (name.split('"')[1], model) for name, model in PLATES.items() if model not in (MeshCase, ShapelessCase)
]
_KINDS: Final = (_Kind("plate", "shape", _SHAPES), _Kind("friction", "model", [*_LAWS.items()]))


def with_meant_kinds(tables: Mapping[str, Any]) -> tuple[dict[str, Any], list[Mistake]]:
    """The tables of a case of the kinds that are meant, so that the rest of them can be checked, and what is wrong."""
    meant = dict(tables)
    mistakes: list[Mistake] = []
    for kind in _KINDS:
        table = tables.get(kind.table)
        if isinstance(table, dict):
            name, sides, message = _meant(kind, table)
            if name:
                meant[kind.table] = ({"sides": sides} if sides else {}) | table | {kind.key: name}
                mistakes.append(((kind.table, kind.key), message))
    return meant, mistakes


def _meant(kind: _Kind, table: dict[str, Any]) -> tuple[str | None, int | None, str]:
    """The name that is meant, how many sides such a polygon has, and what is wrong; None: it is right, or unclear."""
    names = list(dict.fromkeys(name for name, _ in kind.models))
    written = table.get(kind.key)
    if kind.key not in table and "mesh" not in table:
        name = _implied(kind, table)
        return name, None, f"is missing; it must be {one_of(names)}; write {kind.key} = {quoted(name)}"
    if not isinstance(written, str) or written in names:
        return None, None, ""
    name, sides = near(written, names), SIDES.get(plain(written)) if kind.key == "shape" else None
    instead = f'; did you mean "{name}"?'
    if sides:
        own = "" if "sides" in table else f" and sides = {sides}"
        instead = f"; write shape = {quoted(name)}{own}"
    return name, sides, f"must be {one_of(names)}; got {quoted(written)}{instead}"


def _implied(kind: _Kind, table: Mapping[str, Any]) -> str | None:
    """The only name of a model that has all keys of a table, and needs no others; None: there are several, or none."""
    counts = Counter(key for _, model in kind.models for key in model.model_fields)
    shared = {key for key, count in counts.items() if count == len(kind.models)} | {kind.key}
    fits = []
    for name, model in kind.models:
        meant = [
            {key} if key in model.model_fields else {s.keys[0] for s in synonyms(key, model.model_fields)}
            for key in table
        ]
        has = {key for keys in meant for key in keys} - shared
        needs = {key for key, field in model.model_fields.items() if field.is_required()} - shared
        if all(meant) and has and needs <= has:
            fits.append(name)
    return fits[0] if len(fits) == 1 else None
