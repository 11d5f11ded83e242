"""The micropart."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from particle.checks import finite, not_negative, positive, refuse


@dataclass(frozen=True)
class Micropart:
    """A part that lies on the surface; (x, y) is the point of the plate's mid-plane under it.

    Raises
    ------
    ValueError
        A field is wrong; names each.
    """

    mass: float  # kg
    position: tuple[float, float]  # m
    velocity: tuple[float, float] = (0.0, 0.0)  # m/s
    squeeze: float = 0.0  # N, a constant force that presses it onto the surface, along the normal
    centre_height: float = 0.0  # m, of its centre of mass over the surface that it lies on

    def __post_init__(self) -> None:
        pairs = {name: getattr(self, name) for name in ("position", "velocity")}
        refuse(
            "Micropart",
            [
                (positive(self.mass), "mass", "positive, in kg", self.mass),
                (not_negative(self.squeeze), "squeeze", "0 or a positive force in N", self.squeeze),
                (not_negative(self.centre_height), "centre_height", "0 or a positive length in m", self.centre_height),
                *((_is_pair(value), name, "two finite numbers", value) for name, value in pairs.items()),
            ],
        )


def _is_pair(value: Any) -> bool:
    return np.shape(value) == (2,) and all(finite(part) for part in value)
