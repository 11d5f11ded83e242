"""What the plate is made of."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class PlateSection:
    """A homogeneous, isotropic plate of constant thickness.

    Raises
    ------
    ValueError
        A field is wrong; names each.
    """

    youngs_modulus: float  # Pa
    poisson_ratio: float  # 1
    thickness: float  # m
    density: float | None = None  # kg/m^3; only frequencies need it

    def __post_init__(self) -> None:
        wrong = []
        for name in ("youngs_modulus", "thickness", "density"):
            value = getattr(self, name)
            if value is not None and not (math.isfinite(value) and value > 0):
                wrong.append(f"Input {name} of PlateSection must be positive; got {value!r}")
        if not 0 <= self.poisson_ratio < 0.5:
            wrong.append(f"Input poisson_ratio of PlateSection must be in [0, 0.5); got {self.poisson_ratio!r}")
        if wrong:
            raise ValueError("; ".join(wrong))

    @property
    def rigidity(self) -> float:
        """Flexural rigidity D = E t^3 / (12 (1 - nu^2)) [N m]."""
        return self.youngs_modulus * self.thickness**3 / (12 * (1 - self.poisson_ratio**2))
