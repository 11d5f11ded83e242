"""Checks of what people give: every wrong field is named in one error."""

from __future__ import annotations

import math
from collections.abc import Iterable
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from particle.types import FloatArray

CLOSEST = 1e-12  # of the whole time: points in time must be further apart


def finite(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)


def positive(value: Any) -> bool:
    return finite(value) and value > 0 and math.isfinite(1 / value)


def not_negative(value: Any) -> bool:
    return finite(value) and value >= 0


def whole(value: Any) -> bool:
    """Whether it is a whole number of at least 1."""
    return finite(value) and value >= 1 and value == int(value)


def refuse(owner: str, checks: Iterable[tuple[bool, str, str, Any]]) -> None:
    """ValueError unless all are fine; a check is whether it is, the field's name, what it must be and what it is."""
    wrong = [f"Input {name} of {owner} must be {wanted}; got {got!r}" for fine, name, wanted, got in checks if not fine]
    if wrong:
        raise ValueError("; ".join(wrong))


def as_row(values: ArrayLike) -> FloatArray:
    """The values as an array that cannot be changed; empty if they are no row of numbers."""
    try:
        row = np.array(values, dtype=float)
    except (TypeError, ValueError):
        row = np.zeros(0)
    row = row if row.ndim == 1 else np.zeros(0)
    row.setflags(write=False)
    return row


def times_fault(times: FloatArray) -> str | None:
    """What is wrong with a row of times that must increase from 0; None: nothing."""
    if len(times) < 2:
        return f"{len(times)} times"
    if not np.isfinite(times).all():
        return f"{times[~np.isfinite(times)][0]}"
    if times[0] != 0:
        return f"{times[0]:g} as the first"
    late = np.flatnonzero(np.diff(times) <= CLOSEST * times[-1])
    return f"{times[late[0] + 1]:g} after {times[late[0]]:g}" if len(late) else None
