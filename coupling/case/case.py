"""The case: what one run simulates, read from a TOML file or built in Python.

Every quantity is stored as a float in SI units, and every position as (x, y) from the centre of the plate. Built in
Python, a float is taken as SI and text with a unit is converted; in a file every quantity must state its unit.
Python gets an `InputError` for wrong values, and from `read_case` a `CaseError`; both are a ValueError.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal, Self

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    ModelWrapValidatorHandler,
    StrictFloat,
    StrictInt,
    ValidationError,
    ValidationInfo,
    field_validator,
    model_validator,
)

from coupling.case import units
from coupling.case.any_plate import PLATES, PLATFORM, AnyPlate, kind
from coupling.case.drive import ActuatorCase as ActuatorCase
from coupling.case.drive import SegmentCase
from coupling.case.drive import amplitude as amplitude
from coupling.case.friction import FRICTIONS
from coupling.case.friction import AnyFriction as AnyFriction
from coupling.case.friction import ConstantCase as ConstantCase
from coupling.case.friction import CoulombCase as CoulombCase
from coupling.case.friction import FrictionCase as FrictionCase
from coupling.case.friction import KogutEtsionCase as KogutEtsionCase
from coupling.case.friction import TableCase as TableCase
from coupling.case.lattice import LatticeCase as LatticeCase
from coupling.case.lines import CaseError as CaseError
from coupling.case.lines import Problem as Problem
from coupling.case.lines import find_problems, load
from coupling.case.places import Places
from coupling.case.platform import AXES, BY_DRIVES, AxisCase, MotionCase
from coupling.case.table import Table
from coupling.case.units import Length, Point

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_STEPS: Final = 100_000_000  # of a fixed scheme


class PartCase(Table):
    """The micropart at the start, in kg, m, m/s and N."""

    mass: units.Mass = Field(gt=0)
    """Its mass."""
    position: Point = Field(examples=[["100 um", "50 um"]])
    """Where it is at the start; on the plate, or counted from the platform."""
    velocity: units.Velocity = (0.0, 0.0)
    """How fast it moves at the start, over the platform if there is one."""
    size: Length | None = Field(default=None, gt=0, examples=["100 um"])
    """The side of its footprint, for the check of curvature; without it the root of the contact area."""
    squeeze: units.Force = Field(default=0.0, ge=0)
    """A constant force that presses it onto the surface, along the normal."""


class RunCase(Table):
    """The run, in s and m/s^2."""

    duration: units.Time = Field(gt=0, examples=["50 ms"])
    """How long the part is followed."""
    gravity: units.Gravity = 9.80665
    """Towards the plate; or three, along x, y and z, on a tilted device."""
    tolerance: StrictFloat = Field(default=1e-9, ge=1e-12, le=1e-2)
    """The error of one step of the integrator, relative to half of the plate's longer side."""
    surface_tolerance: StrictFloat = Field(default=1e-8, ge=1e-13, le=1e-3)
    """The error of the moving surface, relative to a stroke."""
    frames: StrictInt | None = Field(default=None, ge=2, examples=[200])
    """The time steps in the result files; without it 20 a cycle, from 100 to 1000."""
    scheme: Literal["events", "fixed", "paper"] = "events"
    """How the path is found: by located events, or for comparison by fixed steps."""
    time_step: units.Time | None = Field(default=None, gt=0, examples=["0.1 us"])
    """That of fixed steps; without it 1e-4 of the shortest stroke."""
    after_detachment: Literal["stop", "fly"] = "stop"
    """Whether the run ends where the part comes off, or follows its flight."""

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


def _actuators_or(schema: dict[str, Any]) -> None:
    """Has a JSON schema ask for what a case with that plate needs: actuators, a lattice or neither."""
    schema["required"].remove("actuators")
    platform = {"properties": {"shape": {"const": "platform"}}, "required": ["shape"]}
    schema["anyOf"] = [
        {"required": ["actuators"]},
        {"required": ["lattice"]},
        {"properties": {"plate": platform}},
    ]


class CaseTables(Table):
    """All that a case file holds; a platform has no actuators.

    A lattice becomes actuators, after those that are given one by one; then there is no `lattice` any more.
    """

    model_config = ConfigDict(json_schema_extra=_actuators_or)

    plate: AnyPlate
    """The plate, or a platform."""
    actuators: tuple[ActuatorCase, ...]
    """The actuators, one table each; none with a platform, and none needed beside a lattice."""
    lattice: LatticeCase | None = None
    """Many actuators in rows and columns, which come after those that are given one by one."""
    part: PartCase
    """The part, which lies on the surface."""
    friction: AnyFriction
    """The friction between part and surface."""
    run: RunCase
    """How long the part is followed, and how exactly."""

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


class Case(CaseTables):
    """What one run simulates; `name` is the stem of the file it was read from, and `source` the text of that file."""

    name: str = "case"
    source: str | None = None

    def __repr__(self) -> str:
        count, part, friction = len(self.actuators), self.part, self.friction.model
        over = f"{count} actuator{'s' * (count != 1)} under a plate" if count else "a platform"
        moved = f"a part of {part.mass:.4g} kg at ({part.position[0]:.4g}, {part.position[1]:.4g}) m"
        return f"Case {self.name!r}: {over}, {moved}, {friction} friction, {self.run.duration:.4g} s"

    __str__ = __repr__

    def plot(self, axes: Axes | None = None) -> Figure:
        """Draw the plate from above with its actuators, and where the part starts, into axes in m or new ones."""
        from coupling.pictures import draw_case  # here, because reading a case is to be quick
        from meshes import plotted

        return plotted(lambda axes: draw_case(self, axes), axes)

    def _repr_html_(self) -> str:
        from meshes import notebook_html

        return notebook_html(self)


TABLES: dict[str, type[BaseModel]] = {
    "": CaseTables,
    "actuators": ActuatorCase,
    "lattice": LatticeCase,
    "segments": SegmentCase,
    **dict.fromkeys(AXES, AxisCase),
    BY_DRIVES: MotionCase,
    "part": PartCase,
    "run": RunCase,
    **FRICTIONS,
    **PLATES,
}
"""The models by the names of their tables, of those with several by what tells them apart."""


def read_case(path: str | os.PathLike[str]) -> Case:
    """Read the case file at `path`; CaseError with every mistake in it, or with the reason why it cannot be read."""
    text, data = load(path)
    try:
        tables = CaseTables.model_validate(
            data, context=units.UNITS_REQUIRED | {"folder": Path(path).absolute().parent}
        )
    except ValidationError as error:
        raise CaseError(os.fspath(path), find_problems(error, text, data, TABLES)) from None
    return Case.model_construct(**dict(tables), name=Path(path).stem, source=text)
