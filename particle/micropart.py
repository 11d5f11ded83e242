"""The micropart."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from particle.checks import finite, not_negative, positive, refuse


@dataclass(frozen=True)
class Micropart:
    """A part, modelled as a point on the surface.

    Raises
    ------
    ValueError
        A field is wrong; names each.
    """

    mass: float  # kg
    position: tuple[float, float]  # m
    velocity: tuple[float, float] = (0.0, 0.0)  # m/s
    squeeze: float = 0.0  # N, a constant force that presses it onto the surface, along the normal

    def __post_init__(self) -> None:
        pairs = {name: getattr(self, name) for name in ("position", "velocity")}
        refuse(
            "Micropart",
            [
                (positive(self.mass), "mass", "positive, in kg", self.mass),
                (not_negative(self.squeeze), "squeeze", "0 or a positive force in N", self.squeeze),
                *((_is_pair(value), name, "two finite numbers", value) for name, value in pairs.items()),
            ],
        )


def _is_pair(value: Any) -> bool:
    return np.shape(value) == (2,) and all(finite(part) for part in value)
