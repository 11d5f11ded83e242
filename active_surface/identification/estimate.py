"""Estimate: one field that was found, with its interval."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from common import quantity_text

MOST_DIGITS: Final = 9


@dataclass(frozen=True)
class Estimate:
    """A field with its 95 % interval by the profile of the likelihood."""

    field: str
    case: str | None  # whose own it is; None of a field that all tracks share
    unit: str  # SI, "1" of a plain number
    value: float  # in it
    low: float  # in it; a bound of the search where `open_low`
    high: float  # in it
    open_low: bool  # the data do not say how small it may be
    open_high: bool  # nor how large

    @property
    def label(self) -> str:
        """The field, with the case whose own it is."""
        return self.field if self.case is None else f"{self.field} of {self.case}"

    @property
    def determined(self) -> bool:
        """Whether the data bound it on either side."""
        return not (self.open_low and self.open_high)

    @property
    def text(self) -> str:
        """The value with its interval, in words."""
        low, high = (self._written(value) for value in (self.low, self.high))
        if not self.determined:
            return f"not determined: any value from {low} to {high} describes the track as well"
        if self.open_low or self.open_high:
            return f"{self._written(self.value)}, at {f'most {high}' if self.open_low else f'least {low}'} (95 %)"
        return f"{self._written(self.value)}, from {low} to {high} (95 %)"

    def _written(self, value: float) -> str:
        """A value with as many digits as tell the ends apart."""
        size, width = abs(self.value), self.high - self.low
        digits = (
            MOST_DIGITS if not width else int(np.clip(np.ceil(np.log10(max(size / width, 1.0))) + 2, 3, MOST_DIGITS))
        )
        return f"{value:.{digits}g}" if self.unit == "1" else quantity_text(value, self.unit, digits)
