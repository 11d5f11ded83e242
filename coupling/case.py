"""The case: what one run simulates, read from a TOML file or built in Python.

Every quantity is stored as a float in SI units, and every position as (x, y) from the centre of the plate. Built in
Python, a float is taken as SI and text with a unit is converted; in a file every quantity must state its unit.
Python gets a `pydantic.ValidationError` for a wrong value, `read_case` raises a `CaseError`.
"""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import Annotated, Any, Final, Literal, Self

from pydantic import (
    BaseModel,
    Field,
    ModelWrapValidatorHandler,
    StrictFloat,
    StrictInt,
    StrictStr,
    ValidationError,
    ValidationInfo,
    field_validator,
    model_validator,
)

from coupling import friction_points, units
from coupling.any_plate import PLATES, PLATFORM, AnyPlate, kind
from coupling.case_lines import CaseError as CaseError
from coupling.case_lines import Problem as Problem
from coupling.case_lines import find_problems, load
from coupling.drive_case import ActuatorCase as ActuatorCase
from coupling.drive_case import SegmentCase
from coupling.drive_case import amplitude as amplitude
from coupling.lattice_case import LatticeCase as LatticeCase
from coupling.places import Places
from coupling.platform_case import AXES, BY_DRIVES, AxisCase, MotionCase
from coupling.table import Table
from coupling.units import Length, Point

PAPER_PLASTICITY_INDEX: Final = 4.9128
MOST_STEPS: Final = 100_000_000  # of a fixed scheme


class PartCase(Table):
    """The micropart at the start: `mass` in kg, `position` in m, `velocity` in m/s, `size` (side length) in m.

    `squeeze` in N presses it onto the surface, along the normal. On a platform place and velocity count from that.
    """

    mass: units.Mass = Field(gt=0)
    position: Point
    velocity: units.Velocity = (0.0, 0.0)
    size: Length | None = Field(default=None, gt=0)
    squeeze: units.Force = Field(default=0.0, ge=0)


def _plasticity_index(data: dict[str, Any]) -> float:
    return PAPER_PLASTICITY_INDEX if data.get("preset") == "paper" else 2.5


class KogutEtsionCase(Table):
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
    limit: units.Force = Field(ge=0)


class CoulombCase(Table):
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
        if static_coefficient is not None and coefficient == 0:
            raise ValueError(f"must not be given with coefficient = 0; got {static_coefficient:g}")
        return static_coefficient


class TableCase(Table):
    """Friction measured at points: `limits` over the net `loads`, in N; `file` holds both in place of the two.

    The file is read with the case, which then has its points and no `file`.
    """

    model: Literal["table"] = "table"
    loads: friction_points.Forces | None = None
    limits: friction_points.Forces | None = None
    static_ratio: StrictFloat = Field(default=1.0, ge=1)
    file: StrictStr | None = None

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


class RunCase(Table):
    """The run: `duration` in s, `gravity` in m/s^2 towards the plate or along x, y, z, `tolerance` without dimension.

    `surface_tolerance` is how well the moving surface is fitted to the plate's shapes, of a unit stroke.
    `frames` is the number of time steps in the result files, `time_step` in s that of a scheme of fixed steps.
    """

    duration: units.Time = Field(gt=0)
    gravity: units.Gravity = 9.80665
    tolerance: StrictFloat = Field(default=1e-9, ge=1e-12, le=1e-2)
    surface_tolerance: StrictFloat = Field(default=1e-8, ge=1e-13, le=1e-3)
    frames: StrictInt | None = Field(default=None, ge=2)
    scheme: Literal["events", "fixed", "paper"] = "events"
    time_step: units.Time | None = Field(default=None, gt=0)
    after_detachment: Literal["stop", "fly"] = "stop"

    @field_validator("time_step")
    @classmethod
    def _of_fixed_steps(cls, time_step: float | None, info: ValidationInfo) -> float | None:
        if time_step is not None and info.data.get("scheme") == "events":
            raise ValueError('must not be given with scheme = "events", which chooses its steps by the tolerance')
        duration = info.data.get("duration")
        if time_step is not None and duration is not None:
            # Half of it is run as well, as a check of the path.
            least, most = 2 * duration / MOST_STEPS, duration / 10
            if not least <= time_step <= most:
                raise ValueError(f"must be from {least:g} s to {most:g} s in this run; got {time_step:g} s")
        return time_step

    @field_validator("after_detachment")
    @classmethod
    def _flies_by_events(cls, after: str, info: ValidationInfo) -> str:
        if after == "fly" and info.data.get("scheme", "events") != "events":
            raise ValueError(f'must be "stop" with scheme = "{info.data["scheme"]}"; only "events" follows flights')
        return after


class _CaseTables(Table):
    """All that a case file holds; a platform has no actuators.

    A lattice becomes actuators, after those that are given one by one; then there is no `lattice` any more.
    """

    plate: AnyPlate
    actuators: tuple[ActuatorCase, ...]
    lattice: LatticeCase | None = None
    part: PartCase
    friction: AnyFriction
    run: RunCase

    @model_validator(mode="wrap")
    @classmethod
    def _check_places(cls, data: Any, handler: ModelWrapValidatorHandler[Self], info: ValidationInfo) -> Self:
        if isinstance(data, dict) and (kind(data.get("plate")) == PLATFORM or data.get("lattice") is not None):
            data = {"actuators": ()} | data
        # Around the fields rather than after them, so that a wrong field elsewhere does not hide a misplaced actuator.
        errors: list[Any] = []
        try:
            case = handler(data)
        except ValidationError as error:
            if not isinstance(data, dict):
                raise
            errors += error.errors()
        else:
            lattice, mistakes = Places.model_validate(case).check()
        if isinstance(data, dict) and (errors or mistakes):
            # From what was written, which has the units for the messages.
            lattice, mistakes = Places.model_validate(data, context=info.context).check(info.context)
        told = {error["loc"] for error in errors}
        for location, message in (mistake for mistake in mistakes if mistake[0] not in told):
            context = {"error": ValueError(message)}
            errors.append({"type": "value_error", "loc": location, "input": None, "ctx": context})
        if errors:
            raise ValidationError.from_exception_data(cls.__name__, errors)
        if lattice:
            # The model is frozen from here on.
            object.__setattr__(case, "actuators", case.actuators + lattice)
            object.__setattr__(case, "lattice", None)
        return case


class Case(_CaseTables):
    """What one run simulates; `name` is the stem of the file it was read from, and `source` the text of that file."""

    name: str = "case"
    source: str | None = None


_FRICTION: dict[str, type[BaseModel]] = {
    "kogut-etsion": KogutEtsionCase,
    "constant": ConstantCase,
    "coulomb": CoulombCase,
    "table": TableCase,
}
TABLES: dict[str, type[BaseModel]] = {
    "": _CaseTables,
    "actuators": ActuatorCase,
    "lattice": LatticeCase,
    "segments": SegmentCase,
    **dict.fromkeys(AXES, AxisCase),
    BY_DRIVES: MotionCase,
    "part": PartCase,
    "run": RunCase,
    **_FRICTION,
    **PLATES,
}
"""The models by the names of their tables, of those with several by what tells them apart."""


def read_case(path: str | os.PathLike[str]) -> Case:
    """Read the case file at `path`; CaseError with every mistake in it, or with the reason why it cannot be read."""
    text, data = load(path)
    try:
        tables = _CaseTables.model_validate(
            data, context=units.UNITS_REQUIRED | {"folder": Path(path).absolute().parent}
        )
    except ValidationError as error:
        raise CaseError(os.fspath(path), find_problems(error, text, data, TABLES)) from None
    return Case.model_construct(**dict(tables), name=Path(path).stem, source=text)
