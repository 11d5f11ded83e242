"""The plate's material and thickness."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class PlateSection:
    """A homogeneous, isotropic plate of constant thickness.

    Parameters
    ----------
    youngs_modulus : float
        Young's modulus [Pa].
    poisson_ratio : float
        Poisson's ratio, in [0, 0.5).
    thickness : float
        Thickness [m].
    density : float, optional
        Mass per volume [kg/m^3]; only frequencies need it.

    Raises
    ------
    ValueError
        Names every field that is out of range.
    """

    youngs_modulus: float  # Pa
    poisson_ratio: float  # 1
    thickness: float  # m
    density: float | None = None  # kg/m^3; only frequencies need it

    def __post_init__(self) -> None:
        mistakes = []
        for name in ("youngs_modulus", "thickness", "density"):
            value = getattr(self, name)
            if value is not None and not (math.isfinite(value) and value > 0):
                mistakes.append(f"Input {name} of PlateSection must be positive; got {value!r}")
        if not 0 <= self.poisson_ratio < 0.5:
            mistakes.append(f"Input poisson_ratio of PlateSection must be in [0, 0.5); got {self.poisson_ratio!r}")
        if mistakes:
            raise ValueError("; ".join(mistakes))

    @property
    def rigidity(self) -> float:
        """Flexural rigidity D = E t^3 / (12 (1 - nu^2)) [N m]."""
        return self.youngs_modulus * self.thickness**3 / (12 * (1 - self.poisson_ratio**2))
