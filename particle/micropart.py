"""The micropart."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Micropart:
    """A part, taken as a point on the surface.

    Raises ValueError when the mass is not positive or another number is not finite.
    """

    mass: float  # kg
    position: tuple[float, float]  # m
    velocity: tuple[float, float] = (0.0, 0.0)  # m/s
    squeeze: float = 0.0  # N, a constant force that presses it onto the surface, along the normal

    def __post_init__(self) -> None:
        if not (math.isfinite(self.mass) and self.mass > 0):
            raise ValueError(f"Input mass of Micropart must be positive, in kg; got {self.mass!r}")
        if not 0 <= self.squeeze < math.inf:
            raise ValueError(f"Input squeeze of Micropart must be 0 or a positive force in N; got {self.squeeze!r}")
        for name in ("position", "velocity"):
            value = getattr(self, name)
            if len(value) != 2 or not all(math.isfinite(v) for v in value):
                raise ValueError(f"Input {name} of Micropart must be two finite numbers; got {value!r}")
