"""The actuators of a case: where each one is, and how it is driven over time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Final, Literal

from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler, StrictFloat, StrictInt
from pydantic_core import CoreSchema, core_schema

from coupling.case.actuators.heights import heights_of, limit_faults
from coupling.case.table import WRONG, Contradictions, KeyedTable
from coupling.case.values import (
    Angle,
    Force,
    Frequency,
    Length,
    Point,
    PositiveForce,
    PositiveLength,
    Stiffness,
    Time,
    quoted,
)

ENDLESS: Final = "endless"
MAX_PASSES: Final = 1_000_000_000
MAX_CYCLES: Final = 1_000_000  # of segments
"""Cycles, or repeats, of a drive."""
MIN_SPACING: Final = 1e-12  # of points of a table, over its whole time


@dataclass(frozen=True)
class _Passes:
    """Marks how often a table or schedule is run through."""

    expected = f'a whole number of at least 1, or "{ENDLESS}"'

    def validate(self, value: object) -> object:
        if value == ENDLESS or (isinstance(value, int) and not isinstance(value, bool) and value >= 1):
            if isinstance(value, int) and value > MAX_PASSES:
                raise ValueError(f'must be at most {MAX_PASSES}, or "{ENDLESS}"; got {quoted(value)}')
            return value
        raise ValueError(f"must be {self.expected}; got {quoted(value)}")

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.validate)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"anyOf": [{"type": "integer", "minimum": 1, "maximum": MAX_PASSES}, {"const": ENDLESS}]}


@dataclass(frozen=True)
class _Points:
    """Marks a tuple as points in time: at each a time and a height, the times increasing from 0."""

    expected = 'two or more points, each a time and a height, such as [["0 ms", "0 um"], ["1 ms", "50 um"]]'

    def validate(self, value: object, handler: Any) -> object:
        if not isinstance(value, (list, tuple)) or len(value) < 2 or not all(map(_is_pair, value)):
            raise ValueError(f"must be {self.expected}; got {quoted(value)}")
        points = handler(value)
        times = [time for time, _ in points]
        if times[0] != 0:
            raise ValueError(f"must begin at the time 0; got {quoted(value[0][0])}; a delay is a key of its own")
        closest = MIN_SPACING * max(times)
        for k in range(1, len(times)):
            if times[k] - times[k - 1] <= closest:
                raise ValueError(
                    f"must have increasing times; got {quoted(value[k][0])} after {quoted(value[k - 1][0])}"
                )
        return points

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_wrap_validator_function(self.validate, handler(source))


@dataclass(frozen=True)
class _Ramp:
    """Marks a number of cycles over which a wave grows."""

    shortest: ClassVar[float] = 0.01
    longest: ClassVar[float] = 1000
    expected: ClassVar[str] = f"0, or a number of cycles from {shortest} to {longest}"

    def validate(self, value: float) -> float:
        if value == 0 or self.shortest <= value <= self.longest:
            return value
        raise ValueError(f"must be {self.expected}; got {quoted(value)}")

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_after_validator_function(self.validate, handler(source))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"type": "number", "minimum": 0, "maximum": self.longest}


def _is_pair(value: object) -> bool:
    return isinstance(value, (list, tuple)) and len(value) == 2


Cycle = Literal["up-down", "up", "sine", "cosine"]
Ramp = Annotated[StrictFloat, _Ramp()]
Points = Annotated[tuple[tuple[Time, Length], ...], _Points()]
Repeats = Annotated[int | Literal["endless"], _Passes()]


class SegmentCase(KeyedTable):
    """A part of a schedule, in m, Hz and s; a hold has only a `dwell`."""

    stroke: Length | None = Field(default=None, examples=["50 um"])
    """How far it rises from where it is; negative: down. Not with "hold"."""
    frequency: Frequency | None = Field(default=None, gt=0)
    """A stroke takes half of one over this, with "up" all of it. Not with "hold"."""
    cycle: Literal["up-down", "up", "hold"] = "up-down"
    """Up and down again, up to stay, or a wait of one dwell."""
    cycles: StrictInt = Field(default=1, ge=1, le=MAX_CYCLES)
    """How often; several of "up" climb on."""
    dwell: Time = Field(default=0.0, ge=0)
    """The rest after each stroke; with "hold" how long it waits."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        if given.get("cycle") == WRONG:
            return
        if given.get("cycle") != "hold":
            if "stroke" not in given:
                yield "stroke", 'is missing; it must be a length such as "150 um"'
            if "frequency" not in given:
                yield "frequency", 'is missing; it must be a frequency such as "300 Hz"'
            return
        for key in ("stroke", "frequency", "cycles"):
            if key in given:
                yield key, 'must not be given with cycle = "hold", which only waits for the time dwell'
        if "dwell" not in given:
            yield "dwell", 'is missing; with cycle = "hold" it must be the time to wait, such as "1 ms"'
        elif given["dwell"] == 0:
            yield "dwell", 'must be greater than 0 with cycle = "hold"; got 0 s'


class Driven(KeyedTable):
    """A table with the keys of a drive: which of them go together."""

    owner: ClassVar[str] = "a drive"
    drivers: ClassVar[tuple[str, ...]] = ("stroke", "table", "segments")
    in_place: ClassVar[str] = "a table or segments"
    """What a stroke may be replaced by, in words."""
    segments_table: ClassVar[str] = "[[segments]]"

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        drivers = [key for key in cls.drivers if key in given]
        for key in drivers[1:]:
            only = f"{cls.owner} is driven by one of {', '.join(cls.drivers[:-1])} and {cls.drivers[-1]}"
            yield key, f"must not be given with {_NAMED[drivers[0]]}; {only}"
        if not drivers:
            yield "stroke", f'is missing; it must be a length such as "150 um", or have {cls.in_place} in its place'
        if drivers and drivers[0] in ("table", "segments"):
            yield from cls._beside_times(drivers[0], given)
        else:
            yield from cls._of_cycles(given)
        if "force" in given and "stiffness" in given:
            yield "stiffness", "must not be given with a force, which is the same whatever the stiffness"
        if "force" in given and "max_stroke" in given:
            yield "max_stroke", "must not be given with a force, which has no stroke; max_force limits it"

    @classmethod
    def _of_cycles(cls, given: Mapping[str, Any]) -> Contradictions:
        """What does not go with a stroke or force that comes again and again."""
        if "frequency" not in given:
            yield "frequency", 'is missing; it must be a frequency such as "300 Hz"'
        cycle = given.get("cycle", "up-down")
        if "cycles" in given and cycle == "up":
            yield "cycles", 'must not be given with cycle = "up"; it counts cycles that go on'
        if "dwell" in given and cycle in ("up", "sine", "cosine"):
            yield "dwell", f'must not be given with cycle = "{cycle}"; it is the rest after each stroke of "up-down"'
        if "phase" in given and cycle == "up":
            yield "phase", 'must not be given with cycle = "up"; it is where in a cycle that goes on the drive begins'
        yield from cls._of_ramp(given, cycle)
        if "repeats" in given:
            yield "repeats", "must not be given without a table or segments; cycles counts those of a stroke"

    @classmethod
    def _of_ramp(cls, given: Mapping[str, Any], cycle: object) -> Contradictions:
        """What does not go with a ramp."""
        ramp, cycles = given.get("ramp", 0.0), given.get("cycles")
        if "ramp" in given and cycle in ("up-down", "up"):
            yield "ramp", f'must not be given with cycle = "{cycle}"; only a "sine" and a "cosine" grow'
        elif isinstance(ramp, float | int) and isinstance(cycles, int) and 2 * ramp > cycles:
            why = f"half of cycles, {cycles / 2:g}: the wave grows over the first cycles and decays over the last"
            yield "ramp", f"must be at most {why}; got {ramp:g}"

    @classmethod
    def _beside_times(cls, driver: str, given: Mapping[str, Any]) -> Contradictions:
        """What does not go with a table or segments, which say themselves what happens when."""
        why = "whose points have their own times" if driver == "table" else "which have their own"
        for key in ("frequency", "cycle", "cycles", "dwell", "phase", "ramp"):
            if key in given:
                yield key, f"must not be given with {_NAMED[driver]}, {why}"
        if driver == "segments" and given["segments"] == ():
            yield "segments", f"must be at least one table, written {cls.segments_table}; got none"
        if driver == "segments" and isinstance(given["segments"], tuple):
            count = sum(one.cycles for one in given["segments"] if isinstance(one, SegmentCase))
            if count > MAX_CYCLES:
                yield "segments", f"must have at most {MAX_CYCLES} cycles together; got {count}"
        heights = heights_of(given[driver])
        if given.get("repeats", 1) != 1 and heights and abs(heights[-1] - heights[0]) > 1e-12 * max(map(abs, heights)):
            ends = "whose last height is not its first" if driver == "table" else "which do not end at height 0"
            yield "repeats", f"must not be given with {_NAMED[driver]} {ends}"


class DriveCase(Driven):
    """A drive over time, in m, Hz and s: a `stroke` with a `frequency`, a `table`, or `segments`, a schedule."""

    stroke: Length | None = Field(default=None, examples=["50 um"])
    """How far it rises; 0: it only holds the plate; negative: down."""
    frequency: Frequency | None = Field(default=None, gt=0)
    """One cycle takes one over this, and the dwells."""
    cycle: Cycle = "up-down"
    """Up in the first half and down in the second; up once and held; or sines."""
    cycles: StrictInt | None = Field(default=None, ge=1, le=MAX_PASSES, examples=[5])
    """How many cycles there are, after which it rests where it began; without it they do not end."""
    dwell: Time = Field(default=0.0, ge=0)
    """The rest after each stroke, up and down."""
    phase: Angle = Field(default=0.0, examples=["90 deg"])
    """Where in its cycle it begins; a whole cycle, dwells included, has 360 deg. Not with "up"."""
    ramp: Ramp = Field(default=0.0, examples=[3])
    """Cycles over which a "sine" or "cosine" grows from rest, and decays over the last of its cycles."""
    table: Points | None = Field(default=None, examples=[[["0 ms", "0 um"], ["1 ms", "50 um"], ["3 ms", "20 um"]]])
    """In place of a stroke: heights at given times, with a smooth stroke from each to the next."""
    segments: tuple[SegmentCase, ...] | None = None
    """In place of a stroke: a schedule, one table after the other."""
    repeats: Repeats = 1
    """How often a table or schedule comes."""
    delay: Time = Field(default=0.0, ge=0)
    """The rest before all this."""


class _Place(KeyedTable):
    position: Point = Field(examples=[["0 um", "0 um"]])
    """Where it stands, inside the rim."""
    force: Force | None = Field(default=None, examples=["1 mN"])
    """In place of a stroke: it floats and pushes with this force; negative: it pulls."""
    stiffness: Stiffness | None = Field(default=None, gt=0)
    """That of a spring between actuator and plate; without it there is none. Not with a force."""
    max_stroke: PositiveLength | None = Field(default=None, gt=0, examples=["150 um"])
    """The largest height, up or down, that it can reach. Not with a force."""
    max_force: PositiveForce | None = Field(default=None, gt=0, examples=["100 mN"])
    """The largest force, up or down, that it can bear."""


class ActuatorCase(DriveCase, _Place):
    """A point actuator, in m, N/m and N, and what drives it: a drive, or a `force` in place of its stroke."""

    owner: ClassVar[str] = "an actuator"
    drivers: ClassVar[tuple[str, ...]] = ("stroke", "force", "table", "segments")
    in_place: ClassVar[str] = 'a force such as "1 mN", a table or segments'
    segments_table: ClassVar[str] = "[[actuators.segments]]"

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        yield from super().contradictions(given)
        yield from limit_faults(given)


_NAMED: Final = {"stroke": "a stroke", "force": "a force", "table": "a table", "segments": "segments"}
