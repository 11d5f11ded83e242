"""The tables of a case file: all that it may have, and [run]."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, Final, Literal

from pydantic import ConfigDict, Field, StrictBool, StrictFloat, StrictInt

from coupling.case.actuators import ActuatorCase, LatticeCase
from coupling.case.friction import AnyFriction
from coupling.case.part import UNUSED, NamedPart, PartCase
from coupling.case.plates import AnyPlate
from coupling.case.table import Contradictions, Table
from coupling.case.values import Gravity, Length, LoadPressure, PositiveTime, Temperature

MAX_STEPS: Final = 100_000_000  # of a fixed scheme


class RunCase(Table):
    """The run, in s and m/s^2."""

    duration: PositiveTime = Field(examples=["50 ms"])
    """How long the part is followed."""
    start: Literal["rest", "steady"] = "rest"
    """Whether a plate with inertia begins at rest, or in the steady state of drives that have always been running."""
    gravity: Gravity = 9.80665
    """Towards the plate; or three, along x, y and z, on a tilted device."""
    tolerance: StrictFloat = Field(default=1e-9, ge=1e-12, le=1e-2)
    """The error of one step of the integrator, relative to half of the plate's longer side."""
    surface_tolerance: StrictFloat = Field(default=1e-8, ge=1e-13, le=1e-3)
    """The error of the moving surface, relative to a stroke."""
    frames: StrictInt | None = Field(default=None, ge=2, le=1_000_000, examples=[200])
    """The time steps in the result files; without it 20 to a cycle of the fastest drive, up to about 300 MB."""
    scheme: Literal["events", "fixed", "paper"] = "events"
    """How the path is found: by located events, or for comparison by fixed steps."""
    time_step: PositiveTime | None = Field(default=None, examples=["0.1 us"])
    """The step of the schemes with fixed steps; without it 1e-4 of the shortest stroke."""
    after_detachment: Literal["stop", "fly"] = "stop"
    """Whether the run ends where the part comes off, or follows its flight."""
    after_tipping: Literal["stop", "ignore"] = "stop"
    """Whether the run ends where an edge of a part with a footprint lifts, or takes the part to stay flat."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        scheme, step, duration = given.get("scheme", "events"), given.get("time_step"), given["duration"]
        if step is not None and scheme == "events":
            yield "time_step", 'must not be given with scheme = "events", which chooses its steps by the tolerance'
        elif step is not None and not 2 * duration / MAX_STEPS <= step <= duration / 10:  # half of it is run as well
            least, most = 2 * duration / MAX_STEPS, duration / 10
            yield "time_step", f"must be from {least:g} s to {most:g} s in this run; got {step:g} s"
        if given.get("after_detachment") == "fly" and scheme != "events":
            message = f'must be "stop" with scheme = "{scheme}"; only "events" follows flights'
            yield "after_detachment", message


class AirCase(Table):
    """The air around the part, in Pa, K and m."""

    pressure: LoadPressure = Field(default=101325.0, ge=0, le=1e6)
    """Its pressure; 0 in a vacuum."""
    temperature: Temperature = 293.15
    """Its temperature."""
    bow: Length = Field(default=0.0, ge=0, le=1e-4, examples=["0.5 um"])
    """What a face that is not flat, or stands on feet, adds to the gap under it."""
    film: StrictBool = False
    """Whether the path includes the film of air under a point's square, a rectangle or a disc, which bears load."""


def _alternatives(schema: dict[str, Any]) -> None:
    """Has a JSON schema ask for one part or many, and for actuators, a lattice or neither, as that plate needs it."""
    schema["required"] = [key for key in schema["required"] if key not in ("actuators", "part")]
    schema["oneOf"] = [{"required": ["part"]}, {"required": ["parts"]}]
    platform = {"properties": {"shape": {"const": "platform"}}, "required": ["shape"]}
    schema["anyOf"] = [
        {"required": ["actuators"]},
        {"required": ["lattice"]},
        {"properties": {"plate": platform}},
    ]


class CaseTables(Table):
    """All tables of a case file; a platform has no actuators."""

    model_config = ConfigDict(json_schema_extra=_alternatives)

    whole_file: ClassVar[bool] = True

    plate: AnyPlate
    """The plate, or a platform."""
    actuators: tuple[ActuatorCase, ...]
    """The actuators, one table each; none with a platform, and none needed beside a lattice."""
    lattice: LatticeCase | None = None
    """Many actuators in rows and columns, which come after those that are given one by one."""
    part: PartCase
    """The part, which lies on the surface."""
    parts: tuple[NamedPart, ...] = ()
    """Many parts in place of one, with the fields of [part]."""
    friction: AnyFriction
    """The friction between part and surface."""
    air: AirCase | None = None
    """The air around the part, which drags at it as it slips; without it the path has none."""
    run: RunCase
    """How long the part is followed, and how exactly."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        if (parts := given.get("parts")) and given["part"] is not UNUSED:
            yield "parts", "must not be given with [part]; it may be one of them"
        names = [part.named(number).casefold() for number, part in enumerate(parts or ())]
        for number, name in enumerate(names):
            if name in names[:number]:
                yield ("parts", number, "name"), f'must differ from those before it; got "{name}" again'
