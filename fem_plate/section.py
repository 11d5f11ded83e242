"""The plate's material and thickness."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fem_plate.types import FloatArray


def bending_law(poisson_ratio: float) -> FloatArray:
    """The matrix (3, 3) of M(v):H(q) as a bilinear form of the second derivatives (xx, xy, yy) of v and q."""
    nu = poisson_ratio
    return np.array([[1.0, 0.0, nu], [0.0, 2 * (1 - nu), 0.0], [nu, 0.0, 1.0]])


def not_positive(section: str, **values: float | None) -> list[str]:
    """A message for each value that is given and not a positive number."""
    return [
        f"Input {name} of {section} must be positive; got {value!r}"
        for name, value in values.items()
        if value is not None and not (math.isfinite(value) and value > 0)
    ]


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
        values = dict(youngs_modulus=self.youngs_modulus, thickness=self.thickness, density=self.density)
        mistakes = not_positive("PlateSection", **values)
        if not 0 <= self.poisson_ratio < 0.5:
            mistakes.append(f"Input poisson_ratio of PlateSection must be in [0, 0.5); got {self.poisson_ratio!r}")
        if mistakes:
            raise ValueError("; ".join(mistakes))

    @property
    def rigidity(self) -> float:
        """Flexural rigidity D = E t^3 / (12 (1 - nu^2)) [N m]."""
        return self.youngs_modulus * self.thickness**3 / (12 * (1 - self.poisson_ratio**2))

    @property
    def membrane_stiffness(self) -> FloatArray:
        """Forces per length (xx, yy, xy) from strains (xx, yy, 2 xy) of the mid-plane, (3, 3) [N/m]."""
        nu = self.poisson_ratio
        unit = np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])
        return self.youngs_modulus * self.thickness / (1 - nu**2) * unit

    @property
    def law(self) -> FloatArray:
        """The matrix (3, 3) of M(v):H(q) over the rigidity, in the second derivatives (xx, xy, yy)."""
        return bending_law(self.poisson_ratio)
