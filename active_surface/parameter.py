"""A number of the case between two bounds, as studies, searches and sliders vary it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from active_surface.arrays import FloatArray
from coupling.case import Field


@dataclass(frozen=True)
class Parameter:
    """A field of the case that varies from `low` to `high` [SI], by equal factors where it is logarithmic."""

    field: Field
    low: float
    high: float
    logarithmic: bool = False

    def value(self, share: float | FloatArray) -> Any:
        """The value at a share of the way from `low` to `high`, from 0 to 1."""
        if self.logarithmic:
            return self.low * (self.high / self.low) ** share
        return self.low + (self.high - self.low) * share
