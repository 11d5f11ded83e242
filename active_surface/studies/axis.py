"""Axis: a field of the case that a study varies, and the values that it takes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from active_surface.arrays import FloatArray
from active_surface.parameter import Parameter
from coupling.case import Field


@dataclass(frozen=True)
class Axis:
    """A field and its values in SI units: those that are listed, or all between two bounds."""

    name: str
    field: Field
    values: tuple[Any, ...]  # those of a grid or list; empty: any within the bounds
    low: float = 0.0
    high: float = 0.0
    logarithmic: bool = False

    @cached_property
    def array(self) -> NDArray[Any]:
        """Its values (n,)."""
        return np.array(self.values, self.kind)

    @property
    def kind(self) -> Any:
        """The type of its values in arrays."""
        return {"number": np.float64, "whole": np.int64, "text": object}[self.field.kind]

    def end(self, which: int) -> Any:
        """The lowest value (0) or the highest (-1), as a point has it; of texts the first or the last."""
        if not self.values:
            return (self.low, self.high)[which]
        return (self.values if self.kind is object else sorted(self.values))[which]

    def spread(self, units: FloatArray) -> NDArray[Any]:
        """Its values (n,) at places (n,) in [0, 1)."""
        if self.values:
            return self.array[(units * len(self.values)).astype(np.int64)]
        values: FloatArray = Parameter(self.field, self.low, self.high, self.logarithmic).value(units)
        return values


def spaced(low: float, high: float, count: int, logarithmic: bool) -> tuple[float, ...]:
    """So many values from one to another, both among them; equal fractions of a range are equal to the last bit."""
    fractions = np.arange(1, count - 1) / (count - 1)
    between = low * (high / low) ** fractions if logarithmic else low + (high - low) * fractions
    return (low, *between.tolist(), high)


def counted(number: str, unit: str) -> str:
    """A number with its unit, if it has one."""
    return number if unit in ("", "1") else f"{number} {unit}"
