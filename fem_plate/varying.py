"""A plate whose thickness varies."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fem_plate.anisotropic import AnisotropicSection
from fem_plate.section import PlateSection
from fem_plate.types import FloatArray

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
