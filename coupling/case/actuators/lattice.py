"""The lattice of a case: many actuators in rows and columns, whose drives follow formulas."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Final, Literal

from pydantic import Field, GetCoreSchemaHandler, StrictInt, ValidationError, ValidatorFunctionWrapHandler
from pydantic_core import CoreSchema, core_schema

from coupling.case.actuators.drive import MAX_PASSES, ActuatorCase, Cycle, Driven, Points, Ramp, Repeats, SegmentCase
from coupling.case.mistakes import RULES
from coupling.case.table import WRONG, Contradictions
from coupling.case.values import (
    RANGES,
    Amount,
    Choice,
    Condition,
    Directed,
    Formula,
    Length,
    Point,
    PositiveForce,
    PositiveLength,
    Quantity,
    adapter,
    quoted,
)

MAX_PLACES: Final = 100_000  # actuators
AMOUNTS: Final = {
    "stroke": Amount("m", "150 um"),
    "force": Amount("N", "2 uN"),
    "stiffness": Amount("N/m", "1e4 N/m"),
    "frequency": Amount("Hz", "300 Hz"),
    "dwell": Amount("s", "50 ms"),
    "delay": Amount("s", "50 ms"),
    "phase": Amount("rad", "90 deg"),
}
"""The keys of an actuator that may be formulas."""
SHARED: Final = ("cycle", "cycles", "ramp", "table", "segments", "repeats", "max_stroke", "max_force")
"""Its keys that are the same for all."""


def broken_rule(key: str, value: float) -> str:
    """What a value of a key of AMOUNTS must be in an actuator, in words; "" where it is that."""
    try:
        adapter(ActuatorCase, key).validate_python(value)
    except ValidationError as error:
        detail: Any = error.errors()[0]
        if detail["type"] == "value_error":
            least, most = RANGES[AMOUNTS[key].unit]
            return f"from {least:g} to {most:g} {AMOUNTS[key].unit}"
        return RULES[detail["type"]].format(**detail.get("ctx", {}))
    return ""


@dataclass(frozen=True)
class _Ruled:
    """Marks an amount to which the rule for a key of an actuator applies; that of a formula is looked at elsewhere."""

    key: str

    def validate(self, value: object, handler: ValidatorFunctionWrapHandler) -> object:
        amount = handler(value)
        if isinstance(amount, float) and (rule := broken_rule(self.key, amount)):
            raise ValueError(f"must be {rule}; got {quoted(value)}")
        return amount

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_wrap_validator_function(self.validate, handler(source))


@dataclass(frozen=True)
class _Apart:
    """Marks a distance, or one along each axis, that is greater than 0."""

    def validate(self, value: object, handler: ValidatorFunctionWrapHandler) -> object:
        pitch = handler(value)
        if any(length <= 0 for length in (pitch if isinstance(pitch, tuple) else (pitch,))):
            raise ValueError(f"must be greater than 0; got {quoted(value)}")
        return pitch

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_wrap_validator_function(self.validate, handler(source))


class LatticeCase(Driven):
    """Actuators in `rows` along y and `columns` along x, `pitch` apart, around a `centre`, in m.

    In a hexagonal lattice rows are sqrt(3)/2 pitches apart, and every second one, counted from the middle one (of an
    even number the lower of the two), is half a pitch further to the right.

    Those nearer than `margin` in m to the rim, or beyond it, are left out, None: none is; and those for which the
    `Condition` `where` is false. The other keys are those of an actuator; a `Formula` gives each its own value.
    """

    owner: ClassVar[str] = ActuatorCase.owner
    drivers: ClassVar[tuple[str, ...]] = ActuatorCase.drivers
    in_place: ClassVar[str] = ActuatorCase.in_place
    segments_table: ClassVar[str] = "[[lattice.segments]]"

    rows: StrictInt = Field(ge=1, examples=[3])
    """How many rows there are, along y."""
    columns: StrictInt = Field(ge=1, examples=[3])
    """How many columns there are, along x."""
    pitch: Annotated[float | tuple[float, float], Directed(Quantity("m", "150 um"), "xy"), _Apart()] = Field(
        examples=["100 um"]
    )
    """The distance of neighbours, or two: along x and along y; in a hexagonal lattice one."""
    centre: Point = (0.0, 0.0)
    """The lattice's middle."""
    kind: Literal["rectangular", "hexagonal"] = "rectangular"
    """Rows above each other, or every second row moved by half a pitch, so that all neighbours are one pitch apart."""
    margin: Length | None = Field(default=None, ge=0, examples=["20 um"])
    """Actuators nearer than this to the rim, or beyond it, are left out; without it they are a mistake."""
    where: Annotated[Condition, Choice()] | None = Field(default=None, examples=["not (row == 1 and column == 1)"])
    """An expression of row, column, x and y that is true where there is an actuator."""
    force: Annotated[float | Formula, AMOUNTS["force"], _Ruled("force")] | None = Field(default=None, examples=["1 mN"])
    """As of an actuator, or an expression and its unit."""
    stiffness: Annotated[float | Formula, AMOUNTS["stiffness"], _Ruled("stiffness")] | None = None
    """As of an actuator, or an expression and its unit."""
    stroke: Annotated[float | Formula, AMOUNTS["stroke"], _Ruled("stroke")] | None = Field(
        default=None, examples=["5 um"]
    )
    """As of an actuator, or an expression and its unit."""
    frequency: Annotated[float | Formula, AMOUNTS["frequency"], _Ruled("frequency")] | None = None
    """As of an actuator, or an expression and its unit."""
    cycle: Cycle = "up-down"
    """As of an actuator, the same for all."""
    cycles: StrictInt | None = Field(default=None, ge=1, le=MAX_PASSES, examples=[5])
    """As of an actuator, the same for all."""
    dwell: Annotated[float | Formula, AMOUNTS["dwell"], _Ruled("dwell")] = 0.0
    """As of an actuator, or an expression and its unit."""
    phase: Annotated[float | Formula, AMOUNTS["phase"], _Ruled("phase")] = Field(
        default=0.0, examples=["60 * column deg"]
    )
    """As of an actuator, or an expression and its unit: a wave over the lattice."""
    ramp: Ramp = Field(default=0.0, examples=[3])
    """As of an actuator, the same for all."""
    table: Points | None = Field(default=None, examples=[[["0 ms", "0 um"], ["1 ms", "50 um"], ["3 ms", "20 um"]]])
    """As of an actuator, the same for all."""
    segments: tuple[SegmentCase, ...] | None = None
    """As of an actuator, the same for all."""
    repeats: Repeats = 1
    """As of an actuator, the same for all."""
    max_stroke: PositiveLength | None = Field(default=None, gt=0, examples=["150 um"])
    """As of an actuator, the same for all."""
    max_force: PositiveForce | None = Field(default=None, gt=0, examples=["100 mN"])
    """As of an actuator, the same for all."""
    delay: Annotated[float | Formula, AMOUNTS["delay"], _Ruled("delay")] = Field(
        default=0.0, examples=["0.05 * (row + column) ms"]
    )
    """As of an actuator, or an expression and its unit."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        yield from super().contradictions(given)
        if given.get("kind") == "hexagonal" and isinstance(given.get("pitch"), tuple):
            yield "pitch", 'must be one length with kind = "hexagonal", in which all neighbours are as far apart'
        counts = {key: count for key in ("rows", "columns") if (count := given.get(key, WRONG)) != WRONG}
        if counts and size(counts) > MAX_PLACES:
            key, *other = sorted(counts, key=counts.__getitem__, reverse=True)
            beside = f" with {other[0]} = {counts[other[0]]}" if other else ""
            yield key, f"must make at most {MAX_PLACES} actuators{beside}; got {counts[key]}"


def size(values: Mapping[str, Any]) -> int:
    """How many places a lattice has; rows or columns that are not known count as one."""
    rows, columns = (values.get(key, WRONG) for key in ("rows", "columns"))
    return (1 if rows is WRONG else rows) * (1 if columns is WRONG else columns)
