"""What the annotation of a field tells: the kinds that it is made of, and the quantity that it is marked with."""

from __future__ import annotations

from functools import cache
from typing import Any, get_args, get_origin

from pydantic import BaseModel, TypeAdapter

from coupling.case.values.quantities import Directed
from coupling.case.values.units import Quantity


def parts_of(annotation: Any) -> list[Any]:
    """An annotation and all that it is made of."""
    return [annotation, *(part for inner in get_args(annotation) for part in parts_of(inner))]


def of_kind(annotation: Any, kind: type) -> Any:
    """The first part of an annotation that is a generic of a kind, such as tuple."""
    return next(part for part in parts_of(annotation) if get_origin(part) is kind)


def quantity_of(annotation: Any, metadata: list[Any], alone: bool = False) -> Quantity | None:
    """What marks a number, or several of one kind, as a quantity; metadata: what marks all of the annotation.

    alone: what marks a single number, where a list of others may stand as well.
    """
    parts = _single(annotation) if alone else parts_of(annotation)
    marks = [*metadata, *(mark for part in parts for mark in getattr(part, "__metadata__", ()))]
    quantities = [mark.quantity if isinstance(mark, Directed) else mark for mark in marks]
    return next((mark for mark in quantities if isinstance(mark, Quantity)), None)


def _single(annotation: Any) -> list[Any]:
    """An annotation and all that it is made of, but for what is in lists."""
    inner = () if get_origin(annotation) is tuple else get_args(annotation)
    return [annotation, *(part for one in inner for part in _single(one))]


@cache
def adapter(model: type[BaseModel], key: str) -> TypeAdapter[Any]:
    """What validates one field of a table by itself."""
    return TypeAdapter(model.model_fields[key].rebuild_annotation())
