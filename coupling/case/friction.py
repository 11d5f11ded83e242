"""The `[friction]` table of a case file: which law, and its parameters."""

from __future__ import annotations

import math
from typing import Annotated, Any, Final, Literal, Self

from pydantic import (
    BaseModel,
    Field,
    ModelWrapValidatorHandler,
    StrictFloat,
    StrictStr,
    ValidationError,
    ValidationInfo,
    field_validator,
    model_validator,
)

from coupling.case import friction_points, units
from coupling.case.table import Table
from coupling.case.units import Length

PAPER_PLASTICITY_INDEX: Final = 4.9128


def _plasticity_index(data: dict[str, Any]) -> float:
    return PAPER_PLASTICITY_INDEX if data.get("preset") == "paper" else 2.5


class KogutEtsionCase(Table):
    """Friction of rough surfaces with adhesion, after Kogut and Etsion, in m, m^2, Pa and J/m^2."""

    model: Literal["kogut-etsion"] = "kogut-etsion"
    """The law: rough surfaces with adhesion, after Kogut and Etsion."""
    preset: Literal["paper"] | None = None
    """All parameters as the paper has them, the plasticity index 4.9128 among them."""
    roughness: Length = Field(default=20e-9, gt=0)
    """The standard deviation of the heights of asperities."""
    contact_area: units.Area = Field(default=1e-8, gt=0)
    """The nominal area of contact, the footprint of the part."""
    hardness: units.Pressure = Field(default=1.96133e9, gt=0)
    """The hardness of the softer material."""
    poisson_ratio: StrictFloat = Field(default=0.3, ge=0, lt=0.5)
    """That of the softer material."""
    adhesion_energy: units.SurfaceEnergy = Field(default=1.0, gt=0)
    """The work of adhesion of the two surfaces."""
    plasticity_index: StrictFloat = Field(default_factory=_plasticity_index, gt=0, examples=[2.5])
    """How far asperities yield: well below 1 they are elastic, well above plastic. Without it 2.5."""
    # The model takes the root of 1 - 3.717e-4 / asperity_beta^2.
    asperity_beta: StrictFloat = Field(default=0.0601, gt=math.sqrt(3.717e-4))
    """Density of asperities times their radius times the roughness."""
    intermolecular_distance: Length = Field(default=0.3e-9, gt=0)
    """The distance of atoms in equilibrium."""
    coefficients: Literal["printed", "unrounded"] = "printed"
    """Numbers of the model as its authors printed them, or without their rounding."""

    @field_validator("plasticity_index")
    @classmethod
    def _not_with_preset(cls, plasticity_index: float, info: ValidationInfo) -> float:
        stated = not info.context and plasticity_index == PAPER_PLASTICITY_INDEX  # by a case that was written down
        if info.data.get("preset") == "paper" and not stated:
            raise ValueError(f'must not be given with preset = "paper", which sets it to {PAPER_PLASTICITY_INDEX}')
        return plasticity_index

    @field_validator("coefficients")
    @classmethod
    def _printed_with_preset(cls, coefficients: str, info: ValidationInfo) -> str:
        if info.data.get("preset") == "paper" and coefficients != "printed":
            raise ValueError(
                f'must be "printed" with preset = "paper", which is for those coefficients only; got "{coefficients}"'
            )
        return coefficients


class ConstantCase(Table):
    """A friction force of at most `limit`, in N, whatever the normal force."""

    model: Literal["constant"] = "constant"
    """The law: a limit that does not depend on the load."""
    limit: units.Force = Field(ge=0, examples=["40 nN"])
    """The largest friction force."""


class CoulombCase(Table):
    """Friction in proportion to the normal force and `adhesion`, in N; `static_coefficient` is for a part at rest."""

    model: Literal["coulomb"] = "coulomb"
    """The law: in proportion to the load, with adhesion added to it."""
    coefficient: StrictFloat = Field(ge=0, examples=[0.3])
    """Friction force over load while the part slides."""
    adhesion: units.Force = Field(default=0.0, ge=0)
    """A force added to the load; the part comes off where it is pulled harder."""
    static_coefficient: StrictFloat | None = Field(default=None, ge=0, examples=[0.4])
    """The same while the part rests; without it as while it slides."""

    @field_validator("static_coefficient")
    @classmethod
    def _at_least_sliding(cls, static_coefficient: float | None, info: ValidationInfo) -> float | None:
        coefficient = info.data.get("coefficient")
        if static_coefficient is not None and coefficient is not None and static_coefficient < coefficient:
            raise ValueError(f"must be at least coefficient, {coefficient:g}; got {static_coefficient:g}")
        if static_coefficient is not None and coefficient == 0:
            raise ValueError(f"must not be given with coefficient = 0; got {static_coefficient:g}")
        return static_coefficient


class TableCase(Table):
    """Friction measured at points: `limits` over the net `loads`, in N; `file` holds both in place of the two.

    The file is read with the case, which then has its points and no `file`.
    """

    model: Literal["table"] = "table"
    """The law: as measured at points."""
    loads: friction_points.Forces | None = Field(default=None, examples=[["-1 uN", "0 uN", "2 uN", "5 uN"]])
    """Net loads, increasing; the first is minus the pull-off force."""
    limits: friction_points.Forces | None = Field(default=None, examples=[["4 nN", "18 nN", "35 nN", "52 nN"]])
    """The largest friction force at each load; it does not fall."""
    static_ratio: StrictFloat = Field(default=1.0, ge=1)
    """The limit at rest over that of sliding."""
    file: StrictStr | None = Field(default=None, examples=["friction.csv"])
    """A CSV file with a column of each, in place of the two lists, beside the case file."""

    @model_validator(mode="wrap")
    @classmethod
    def _check_points(cls, data: Any, handler: ModelWrapValidatorHandler[Self], info: ValidationInfo) -> Self:
        # Around the fields, so that what is wrong with one does not hide what is wrong with another.
        if not isinstance(data, dict):
            return handler(data)
        errors: list[Any] = []
        try:
            case = handler(data)
        except ValidationError as error:
            errors = list(error.errors())
        points, mistakes = friction_points.of_table(data, info.context or {})
        for location, message in mistakes:
            context = {"error": ValueError(message)}
            errors.append({"type": "value_error", "loc": location, "input": None, "ctx": context})
        if errors:
            raise ValidationError.from_exception_data(cls.__name__, errors)
        for name, value in points.items():
            object.__setattr__(case, name, value)  # the model is frozen from here on
        return case


FrictionCase = KogutEtsionCase | ConstantCase | CoulombCase | TableCase
AnyFriction = Annotated[FrictionCase, Field(discriminator="model")]
FRICTIONS: Final[dict[str, type[BaseModel]]] = {
    "kogut-etsion": KogutEtsionCase,
    "constant": ConstantCase,
    "coulomb": CoulombCase,
    "table": TableCase,
}
"""The models by the names of their laws."""
