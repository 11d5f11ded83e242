"""The case: what one run simulates, read from a TOML file or built in Python.

Every quantity is stored as a float in SI units, and every position as (x, y) from the centre of the plate. Built in
Python, a float is taken as SI and text with a unit is converted; in a file every quantity must state its unit.
Python gets a `pydantic.ValidationError` for a wrong value, `read_case` raises a `CaseError`.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from itertools import combinations
from pathlib import Path
from typing import Annotated, Any, Final, Literal, Self, TypeVar

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    ModelWrapValidatorHandler,
    StrictFloat,
    StrictInt,
    ValidationError,
    ValidationInfo,
    ValidatorFunctionWrapHandler,
    WrapValidator,
    field_validator,
    model_validator,
)

from coupling import units
from coupling.case_lines import CaseError as CaseError
from coupling.case_lines import Location, find_problems, load, shown_location
from coupling.case_lines import Problem as Problem
from coupling.units import Length, Point, shown_length

PAPER_PLASTICITY_INDEX: Final = 4.9128
SAME_PLACE: Final = 1e-9
"""Places closer than this fraction of the plate's radius count as one."""


class _Table(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class PlateCase(_Table):
    """The plate: `radius`, `thickness` and `cell_size` in m, `youngs_modulus` in Pa, `density` in kg/m^3."""

    shape: Literal["disc"]
    radius: Length = Field(gt=0)
    supports: Literal["clamped"] = "clamped"
    youngs_modulus: units.Pressure = Field(gt=0)
    poisson_ratio: StrictFloat = Field(ge=0, lt=0.5)
    thickness: Length = Field(gt=0)
    density: units.Density | None = Field(default=None, gt=0)
    cell_size: Length | None = Field(default=None, gt=0)

    @field_validator("cell_size")
    @classmethod
    def _fits_plate(cls, cell_size: float | None, info: ValidationInfo) -> float | None:
        radius = info.data.get("radius")
        if cell_size is not None and radius is not None and cell_size > radius:
            raise ValueError(f"must not exceed the radius, {shown_length(radius)}; got {shown_length(cell_size)}")
        return cell_size


class ActuatorCase(_Table):
    """A point actuator: `position` and `stroke` in m, `frequency` in Hz, `delay` in s.

    `cycles` is the number of up-down cycles, None for no end.
    """

    position: Point
    stroke: Length
    frequency: units.Frequency = Field(gt=0)
    cycle: Literal["up-down", "up"] = "up-down"
    cycles: StrictInt | None = Field(default=None, ge=1)
    delay: units.Time = Field(default=0.0, ge=0)

    @field_validator("cycles")
    @classmethod
    def _only_up_down(cls, cycles: int | None, info: ValidationInfo) -> int | None:
        if cycles is not None and info.data.get("cycle") == "up":
            raise ValueError('must not be given with cycle = "up"; it counts up-down cycles')
        return cycles


class PartCase(_Table):
    """The micropart at the start: `mass` in kg, `position` in m, `velocity` in m/s, `size` (side length) in m."""

    mass: units.Mass = Field(gt=0)
    position: Point
    velocity: units.Velocity = (0.0, 0.0)
    size: Length | None = Field(default=None, gt=0)


def _plasticity_index(data: dict[str, Any]) -> float:
    return PAPER_PLASTICITY_INDEX if data.get("preset") == "paper" else 2.5


class KogutEtsionCase(_Table):
    """Friction of rough surfaces with adhesion, after Kogut and Etsion.

    `roughness` and `intermolecular_distance` in m, `contact_area` in m^2, `hardness` in Pa, `adhesion_energy` in
    J/m^2. The preset "paper" sets the plasticity index to 4.9128.
    """

    model: Literal["kogut-etsion"] = "kogut-etsion"
    preset: Literal["paper"] | None = None
    roughness: Length = Field(default=20e-9, gt=0)
    contact_area: units.Area = Field(default=1e-8, gt=0)
    hardness: units.Pressure = Field(default=1.96133e9, gt=0)
    poisson_ratio: StrictFloat = Field(default=0.3, ge=0, lt=0.5)
    adhesion_energy: units.SurfaceEnergy = Field(default=1.0, gt=0)
    plasticity_index: StrictFloat = Field(default_factory=_plasticity_index, gt=0)
    # The model takes the root of 1 - 3.717e-4 / asperity_beta^2.
    asperity_beta: StrictFloat = Field(default=0.0601, gt=math.sqrt(3.717e-4))
    intermolecular_distance: Length = Field(default=0.3e-9, gt=0)
    coefficients: Literal["printed", "unrounded"] = "printed"

    @field_validator("plasticity_index")
    @classmethod
    def _not_with_preset(cls, plasticity_index: float, info: ValidationInfo) -> float:
        if info.data.get("preset") == "paper":
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


class ConstantCase(_Table):
    """A friction force of at most `limit`, in N, whatever the normal force."""

    model: Literal["constant"] = "constant"
    limit: units.Force = Field(ge=0)


class CoulombCase(_Table):
    """Friction in proportion to the normal force and `adhesion`, in N; `static_coefficient` is for a part at rest."""

    model: Literal["coulomb"] = "coulomb"
    coefficient: StrictFloat = Field(ge=0)
    adhesion: units.Force = Field(default=0.0, ge=0)
    static_coefficient: StrictFloat | None = Field(default=None, ge=0)

    @field_validator("static_coefficient")
    @classmethod
    def _at_least_sliding(cls, static_coefficient: float | None, info: ValidationInfo) -> float | None:
        coefficient = info.data.get("coefficient")
        if static_coefficient is not None and coefficient is not None and static_coefficient < coefficient:
            raise ValueError(f"must be at least coefficient, {coefficient:g}; got {static_coefficient:g}")
        return static_coefficient


class RunCase(_Table):
    """The run: `duration` in s, `gravity` in m/s^2 towards the plate, `tolerance` without dimension.

    `frames` is the number of time steps in the result files.
    """

    duration: units.Time = Field(gt=0)
    gravity: units.Acceleration = 9.80665
    tolerance: StrictFloat = Field(default=1e-9, ge=1e-12, le=1e-2)
    frames: StrictInt | None = Field(default=None, ge=2)


_T = TypeVar("_T")


def _none_if_wrong(value: Any, handler: ValidatorFunctionWrapHandler) -> Any:
    try:
        return handler(value)
    except ValidationError:
        return None


_IfValid = Annotated[_T | None, WrapValidator(_none_if_wrong)]


class _Disc(BaseModel, from_attributes=True):
    radius: _IfValid[Annotated[Length, Field(gt=0)]] = None


class _Spot(BaseModel, from_attributes=True):
    position: _IfValid[Point] = None


class _Places(BaseModel, from_attributes=True):
    """The places in a case; each is None where it is missing or wrong, whatever else is."""

    plate: _IfValid[_Disc] = None
    actuators: _IfValid[tuple[_IfValid[_Spot], ...]] = None
    part: _IfValid[_Spot] = None

    def mistakes(self) -> Iterator[tuple[Location, str]]:
        """Yield where a place is wrong, and why."""
        if self.actuators == ():
            yield ("actuators",), "must be at least one table, written [[actuators]]; got none"
        radius = self.plate.radius if self.plate else None
        if radius is None:
            return
        spots = [(("actuators", index), spot) for index, spot in enumerate(self.actuators or ())]
        places = {(*table, "position"): spot.position for table, spot in spots if spot and spot.position}
        part = {("part", "position"): self.part.position} if self.part and self.part.position else {}
        for location, place in [*places.items(), *part.items()]:
            distance = math.hypot(*place)
            if distance >= radius * (1 - SAME_PLACE):
                limit = f"inside the rim, less than {shown_length(radius)} from the centre"
                yield location, f"must be {limit}; got a point {shown_length(distance)} from it"
        shared = set()
        for (one, here), (other, there) in combinations(places.items(), 2):
            if other not in shared and math.dist(here, there) < SAME_PLACE * radius:
                shared.add(other)
                yield other, f"must differ from {shown_location(one)}; got the same point"


class _CaseTables(_Table):
    """All that a case file holds."""

    plate: PlateCase
    actuators: tuple[ActuatorCase, ...]
    part: PartCase
    friction: Annotated[KogutEtsionCase | ConstantCase | CoulombCase, Field(discriminator="model")]
    run: RunCase

    @model_validator(mode="wrap")
    @classmethod
    def _check_places(cls, data: Any, handler: ModelWrapValidatorHandler[Self], info: ValidationInfo) -> Self:
        # Around the fields rather than after them, so that a wrong field elsewhere does not hide a misplaced actuator.
        try:
            case = handler(data)
        except ValidationError as error:
            if not isinstance(data, dict):
                raise
            places = _Places.model_validate(data, context=info.context)
            errors: list[Any] = list(error.errors())
        else:
            places, errors = _Places.model_validate(case), []
        for location, message in places.mistakes():
            context = {"error": ValueError(message)}
            errors.append({"type": "value_error", "loc": location, "input": None, "ctx": context})
        if errors:
            raise ValidationError.from_exception_data(cls.__name__, errors)
        return case


class Case(_CaseTables):
    """What one run simulates; `name` is the stem of the file it was read from, and `source` the text of that file."""

    name: str = "case"
    source: str | None = None


_FRICTION: dict[str, type[BaseModel]] = {
    "kogut-etsion": KogutEtsionCase,
    "constant": ConstantCase,
    "coulomb": CoulombCase,
}
_TABLES: dict[str, type[BaseModel]] = {
    "": _CaseTables,
    "plate": PlateCase,
    "actuators": ActuatorCase,
    "part": PartCase,
    "run": RunCase,
}


def read_case(path: str | os.PathLike[str]) -> Case:
    """Read the case file at `path`; CaseError with every mistake in it, or with the reason why it cannot be read."""
    text, data = load(path)
    try:
        tables = _CaseTables.model_validate(data, context=units.UNITS_REQUIRED)
    except ValidationError as error:
        raise CaseError(os.fspath(path), find_problems(error, text, data, _TABLES | _FRICTION)) from None
    return Case(**dict(tables), name=Path(path).stem, source=text)
