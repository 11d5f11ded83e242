"""The plate's material and thickness, which may vary."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fem_plate.anisotropic import AnisotropicSection
from fem_plate.inputs import not_positive
from fem_plate.types import FloatArray


def bending_law(poisson_ratio: float) -> FloatArray:
    """The matrix (3, 3) of M(v):H(q) as a bilinear form of the second derivatives (xx, xy, yy) of v and q."""
    nu = poisson_ratio
    return np.array([[1.0, 0.0, nu], [0.0, 2 * (1 - nu), 0.0], [nu, 0.0, 1.0]])


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


Field = Callable[[FloatArray, FloatArray], FloatArray]  # of x and y (n,) [m]


@dataclass(frozen=True)
class VaryingSection:
    """A plate whose thickness varies slowly over its area; its mid-plane is flat.

    Parameters
    ----------
    section : PlateSection or AnisotropicSection
        The material, and a thickness for reference: that of the whole-plate figures, such as `rigidity`.
    thickness_at : callable
        The thickness (n,) [m] at x and y, both (n,) [m]. It is smooth, and defined a little beyond the rim of a hole,
        too.

    Raises
    ------
    ValueError
        The section is of another kind, or the thickness no callable. `Plate` raises it where the thickness is not
        positive on the plate.
    """

    section: PlateSection | AnisotropicSection
    thickness_at: Field

    def __post_init__(self) -> None:
        wrong: list[str] = []
        if not isinstance(self.section, PlateSection | AnisotropicSection):
            wrong.append(
                f"Input section of VaryingSection must be a PlateSection or AnisotropicSection; got {self.section!r}"
            )
        if not callable(self.thickness_at):
            got = repr(self.thickness_at)
            wrong.append(f"Input thickness_at of VaryingSection must be a callable of x and y; got {got}")
        if wrong:
            raise ValueError("; ".join(wrong))

    def relative_thickness(self, xy: FloatArray) -> FloatArray:
        """The thickness at points (n, 2) [m] over that for reference, (n,)."""
        return values_at(self.thickness_at, xy, "thickness_at of VaryingSection", "m", positive=True) / self.thickness

    @property
    def thickness(self) -> float:
        """The thickness for reference [m]."""
        return self.section.thickness

    @property
    def density(self) -> float | None:
        """Mass per volume [kg/m^3]."""
        return self.section.density

    @property
    def rigidity(self) -> float:
        """Flexural rigidity where the plate is as thick as for reference [N m]."""
        return self.section.rigidity

    @property
    def law(self) -> FloatArray:
        """As of the section for reference."""
        return self.section.law

    @property
    def poisson_ratio(self) -> float:
        """As of the section for reference."""
        return self.section.poisson_ratio


Section = PlateSection | AnisotropicSection | VaryingSection


def values_at(field: Field, xy: FloatArray, name: str, unit: str, positive: bool = False) -> FloatArray:
    """A field's values at points (n, 2) [m], (n,).

    Raises ValueError where they are no numbers, not finite, or not positive where they must be, with the first place.
    """
    try:
        with np.errstate(all="ignore"):  # what is not finite is refused below
            values = np.asarray(field(xy[:, 0], xy[:, 1]))
    except (TypeError, ValueError) as failure:
        raise ValueError(
            f"Input {name} must be a function of two arrays, x and y, both ({len(xy)},): {failure}"
        ) from None
    try:
        values = np.broadcast_to(values, len(xy)).astype(float, casting="same_kind")
    except (ValueError, TypeError):
        raise ValueError(
            f"Input {name} must return one real number for each point, ({len(xy)},); got {values.dtype} {values.shape}"
        ) from None
    wrong = ~np.isfinite(values) | (positive & (values <= 0))
    if wrong.any():
        first = int(np.argmax(wrong))
        x, y = xy[first].tolist()
        what = "positive" if positive else "finite"
        raise ValueError(
            f"Input {name} must be {what} on the plate; got {values[first]:.6g} {unit} at ({x:.6g}, {y:.6g}) m"
        )
    return values
