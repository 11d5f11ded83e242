"""The lattice of a case: many actuators in rows and columns, whose drives follow formulas."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from typing import Annotated, Any, ClassVar, Final, NamedTuple

from pydantic import Field, StrictInt, ValidationError, ValidationInfo, field_validator

from coupling.case_lines import RULES
from coupling.drive_case import ActuatorCase, Cycle, Driven, Points, Repeats, SegmentCase
from coupling.formula import Amount, Formula
from coupling.keyed_table import adapter
from coupling.units import DIMENSIONS, Directed, Length, Point, Quantity, shown, shown_length

MOST: Final = 100_000  # actuators
AMOUNTS: Final = {
    "stroke": Amount("m", "150 um"),
    "force": Amount("N", "2 uN"),
    "stiffness": Amount("N/m", "1e4 N/m"),
    "frequency": Amount("Hz", "300 Hz"),
    "dwell": Amount("s", "50 ms"),
    "delay": Amount("s", "50 ms"),
}
"""The keys of an actuator that may be formulas."""
SHARED: Final = ("cycle", "cycles", "table", "segments", "repeats")
"""Its keys that are the same for all."""


class Spot(NamedTuple):
    """A place in a lattice: row and column from 0, and x and y in m."""

    row: int
    column: int
    x: float
    y: float

    def __str__(self) -> str:
        return f"row {self.row}, column {self.column}"


class LatticeCase(Driven):
    """Actuators in `rows` along y and `columns` along x, `pitch` apart, around a `centre`, in m.

    Those nearer than `margin` in m to the rim, or beyond it, are left out; None: none is. The other keys are those of
    an actuator; `Formula`s among them give each its own value.
    """

    owner: ClassVar[str] = ActuatorCase.owner
    drivers: ClassVar[tuple[str, ...]] = ActuatorCase.drivers
    in_place: ClassVar[str] = ActuatorCase.in_place
    segments_table: ClassVar[str] = "[[lattice.segments]]"

    rows: StrictInt = Field(ge=1)
    columns: StrictInt = Field(ge=1)
    pitch: Annotated[float | tuple[float, float], Directed(Quantity("m", "150 um"), "xy")]
    centre: Point = (0.0, 0.0)
    margin: Length | None = Field(default=None, ge=0)
    force: Annotated[float | Formula, AMOUNTS["force"]] | None = None
    stiffness: Annotated[float | Formula, AMOUNTS["stiffness"]] | None = None
    stroke: Annotated[float | Formula, AMOUNTS["stroke"]] | None = None
    frequency: Annotated[float | Formula, AMOUNTS["frequency"]] | None = None
    cycle: Cycle = "up-down"
    cycles: StrictInt | None = Field(default=None, ge=1)
    dwell: Annotated[float | Formula, AMOUNTS["dwell"]] = 0.0
    table: Points | None = None
    segments: tuple[SegmentCase, ...] | None = None
    repeats: Repeats = 1
    delay: Annotated[float | Formula, AMOUNTS["delay"]] = 0.0

    @field_validator("columns")
    @classmethod
    def _not_too_many(cls, columns: int, info: ValidationInfo) -> int:
        rows = info.data.get("rows", 1)
        if rows * columns > MOST:
            raise ValueError(f"must make at most {MOST} actuators with the rows; got {rows} x {columns}")
        return columns

    @field_validator("pitch")
    @classmethod
    def _apart(cls, pitch: float | tuple[float, float]) -> float | tuple[float, float]:
        wrong = [length for length in (pitch if isinstance(pitch, tuple) else (pitch,)) if length <= 0]
        if wrong:
            raise ValueError(f"must be greater than 0; got {shown_length(wrong[0])}")
        return pitch

    @cached_property
    def spots(self) -> list[Spot]:
        """All places, row by row from the lowest, each from the left."""
        across, along = self.pitch if isinstance(self.pitch, tuple) else (self.pitch, self.pitch)
        x = [self.centre[0] + (column - (self.columns - 1) / 2) * across for column in range(self.columns)]
        y = [self.centre[1] + (row - (self.rows - 1) / 2) * along for row in range(self.rows)]
        return [Spot(row, column, x[column], y[row]) for row in range(self.rows) for column in range(self.columns)]

    def actuators(self, spots: Sequence[Spot]) -> tuple[tuple[ActuatorCase, ...], list[tuple[str, str]]]:
        """The actuators at some of the places; none, but each key that is wrong, and why, if one is."""
        columns, mistakes = {}, []
        for key in AMOUNTS:
            try:
                columns[key] = self._values(key, spots)
            except ValueError as error:
                mistakes.append((key, str(error)))
        if mistakes:
            return (), mistakes
        shared = {key: getattr(self, key) for key in SHARED}
        # All values are valid: to check them once more would take longer than the rest.
        made = [
            ActuatorCase.model_construct(position=(spot.x, spot.y), **shared, **dict(zip(columns, values, strict=True)))
            for spot, values in zip(spots, zip(*columns.values(), strict=True), strict=True)
        ]
        return tuple(made), []

    def _values(self, key: str, spots: Sequence[Spot]) -> list[float | None]:
        """The values of a key at places; ValueError, which names the first place where there is none."""
        amount, valid = getattr(self, key), adapter(ActuatorCase, key).validate_python
        if not isinstance(amount, Formula):
            try:
                return [valid(amount)] * len(spots)
            except ValidationError as error:
                raise ValueError(f"must be {_rule(error)}; got {_shown(key, amount)}") from None
        values = []
        names = {"pi": math.pi, "rows": float(self.rows), "columns": float(self.columns)}
        for spot in spots:
            names |= {"row": float(spot.row), "column": float(spot.column), "x": spot.x, "y": spot.y}
            try:
                value = amount.value(names)
            except ValueError as error:
                rule = f"must be {DIMENSIONS[AMOUNTS[key].unit]} for each actuator"
                raise ValueError(f"{rule}; {shown(amount.text)} {error} at {spot}") from None
            try:
                values.append(valid(value))
            except ValidationError as error:
                got = f"{shown(amount.text)} is {_shown(key, value)} at {spot}"
                raise ValueError(f"must be {_rule(error)} for each actuator; {got}") from None
        return values


def _rule(error: ValidationError) -> str:
    """What a value must be for which a validation failed."""
    detail: Any = error.errors()[0]
    return RULES[detail["type"]].format(**detail.get("ctx", {}))


def _shown(key: str, value: float) -> str:
    return f"{value:g} {AMOUNTS[key].unit}"
