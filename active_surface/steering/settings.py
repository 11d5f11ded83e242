"""The table [aim] of an aim file: what may be varied, between which bounds, and how long to search."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Final, Literal

from pydantic import BeforeValidator, Field, GetCoreSchemaHandler, StrictFloat, StrictInt, StrictStr
from pydantic_core import CoreSchema, core_schema

from coupling.case import Angle, Expected, Frequency, Length, Point, Table, Time, quoted


@dataclass(frozen=True)
class _Bounds:
    """Marks two values as the least and the largest that are tried."""

    example: str

    @property
    def expected(self) -> str:
        return f"the least and the largest value, such as {self.example}"

    def validate(self, value: object, handler: Any) -> object:
        if not isinstance(value, (list, tuple)) or len(value) != 2:
            raise ValueError(f"must be {self.expected}; got {quoted(value)}")
        low, high = handler(value)
        if low > high:
            raise ValueError(f"must be {self.expected}, in that order; got {quoted(value)}")
        return low, high

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_wrap_validator_function(self.validate, handler(source))


_NUMBERS: Final = "a list of numbers of actuators, counted from 0, such as [0, 4]"


def _each_once(value: object) -> tuple[int, ...]:
    items = value if isinstance(value, (list, tuple)) else ()
    numbers = [k for k in items if type(k) is int and k >= 0]
    if not numbers or len(set(numbers)) < len(items):
        raise ValueError(f"must be {_NUMBERS}, each once; got {quoted(value)}")
    return tuple(numbers)


def _flat(value: object) -> object:
    """A table of tables as one: part.mass and "part.mass" are the same."""
    return dict(_flattened(value)) if isinstance(value, dict) else value


def _flattened(tables: Mapping[str, object], path: str = "") -> Iterator[tuple[str, object]]:
    """Yield each path in nested tables with its value."""
    for key, value in tables.items():
        if isinstance(value, Mapping):
            yield from _flattened(value, f"{path}{key}.")
        else:
            yield f"{path}{key}", value


MAX_PATHS, MAX_PATHS_DISTURBED = 10_000, 40_000

Positive = Annotated[Frequency, Field(gt=0)]
Waiting = Annotated[Time, Field(ge=0)]
Count = Annotated[StrictInt, Field(ge=1, le=1_000_000)]
Whole = Annotated[StrictInt, Field(ge=0)]
Numbers = Annotated[tuple[Whole, ...], Field(min_length=1, json_schema_extra={"uniqueItems": True})]


class Settings(Table):
    """How drives are searched for. Bounds hold for each actuator that takes part; None: they follow from its drive."""

    actuators: Annotated[Numbers, BeforeValidator(_each_once), Expected(_NUMBERS)] | None = Field(
        default=None, examples=[[0, 4]]
    )
    """Those that take part, by their numbers from 0; without it the nearest to the way to the target."""
    nearest: Count | None = Field(default=None, examples=[4])
    """How many these are; without it 9 at one frequency, 4 with a frequency each."""
    groups: Literal["each", "columns", "rows", "all"] = "each"
    """Which of them move alike: those of a column or row, all, or none."""
    frequency: Annotated[tuple[Positive, Positive], _Bounds('["100 Hz", "600 Hz"]')] | None = None
    """Bounds; without them from 0.2 times to twice its own."""
    stroke: Annotated[tuple[Length, Length], _Bounds('["0 um", "60 um"]')] | None = None
    """Bounds; without them from 0 to its own."""
    delay: Annotated[tuple[Waiting, Waiting], _Bounds('["0 ms", "2 ms"]')] | None = None
    """Bounds; without them from 0 to twice its own, where it has one."""
    cycles: Annotated[tuple[Count, Count], _Bounds("[1, 5]")] | None = Field(default=None, examples=[[1, 5]])
    """Bounds of how many cycles each drive has; without them from 1 to 3, at last to its own."""
    seed: StrictInt = Field(default=0, ge=0, lt=2**32)
    """From which random numbers follow."""
    paths: Count | None = Field(default=None, examples=[10000])
    """How many are followed at most; without it 10 000, fewer where runs are long, with a quantile or CVaR 40 000."""
    tolerance: Length = Field(default=5e-7, gt=0)
    """The distance from the target at which a search ends."""
    quantile: StrictFloat | None = Field(default=None, gt=0, le=1, examples=[0.9])
    """This quantile of the distances of disturbed runs is made small in place of the distance."""
    cvar: StrictFloat | None = Field(default=None, gt=0, lt=1, examples=[0.9])
    """The mean distance of disturbed runs beyond this quantile is made small in place of the distance."""
    disturbances: Annotated[dict[str, Any] | None, BeforeValidator(_flat)] = Field(
        default=None, examples=[{"friction": "1 %", "part.position": "1 um", "actuators.*.stroke": "1 %"}]
    )
    """How far disturbed runs deviate at most, by field; without it friction and strokes by 1 %, the start by 1 um."""
    scatter: Count | None = Field(default=None, examples=[100])
    """How many disturbed runs measure how robust the drives are; without it 100, or fewer where runs are long."""

    @property
    def is_robust(self) -> bool:
        """Whether disturbed runs count in place of the undisturbed one."""
        return self.quantile is not None or self.cvar is not None

    @property
    def max_paths(self) -> int:
        """How many paths are followed at most."""
        return self.paths or (MAX_PATHS_DISTURBED if self.is_robust else MAX_PATHS)


class AimTable(Settings):
    """The file of the `case`, beside this one; where the part is to go and how turned, if stated here; `Settings`."""

    case: Annotated[StrictStr, Expected('the name of a case file such as "array_3x3.toml"')] = Field(
        examples=["array_3x3.toml"]
    )
    """The case whose part is to be moved, a file beside this one."""
    target: Point | None = Field(default=None, examples=[["100 um", "-50 um"]])
    """Where the part is to go, unless the command states it."""
    by: Annotated[tuple[Point, ...], Field(min_length=1)] | None = Field(
        default=None, examples=[[["80 um", "0 um"], ["0 um", "80 um"]]]
    )
    """In place of a target the step from the start; for a plan steps, each from the way-point before."""
    heading: Angle | None = Field(default=None, examples=["30 deg"])
    """The heading that a part with a footprint is to have there; without it any will do."""


class AimTables(Table):
    """All that an aim file holds."""

    whole_file: ClassVar[bool] = True

    aim: AimTable
    """What may be varied, and how long to search."""
