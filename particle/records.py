"""Records: rows of named numbers that kernels read and write by name, compiled or in plain Python."""

from __future__ import annotations

from functools import cache
from operator import itemgetter
from typing import TYPE_CHECKING, Any, TypeVar, get_type_hints

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    _Row = np.generic  # numpy's stubs forbid subclasses of np.void
else:
    _Row = np.void

_KINDS = {float: np.float64, int: np.int64}


class Record(_Row):
    """One row. A subclass names its numbers by annotations: `name: float`, `name: int`, and of arrays of floats

    `name: Annotated[FloatArray, 3, 4]` with their shapes.
    """

    def __init_subclass__(cls) -> None:
        for name in cls.__annotations__:
            setattr(cls, name, property(itemgetter(name), _setter(name)))


AnyRecord = TypeVar("AnyRecord", bound=Record)


@cache
def record_type(kind: type[Record]) -> np.dtype[Any]:
    """The type of arrays of such rows."""
    fields: list[Any] = []
    for name, hint in get_type_hints(kind, include_extras=True).items():
        shape = getattr(hint, "__metadata__", None)
        fields.append((name, np.float64, shape) if shape else (name, _KINDS[hint]))
    return np.dtype((kind, fields))


def new_records(kind: type[AnyRecord], count: int = 1) -> NDArray[AnyRecord]:
    """Rows of zeros, (count,)."""
    return np.zeros(count, record_type(kind))  # type: ignore[arg-type]  # classes are hashable


def _setter(name: str) -> Any:
    def put(record: Any, value: float) -> None:
        record[name] = value

    return put
