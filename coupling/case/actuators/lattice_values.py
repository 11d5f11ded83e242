"""The actuators of a lattice: the value that each key has at each of its places."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final, NamedTuple, Self

from coupling.case.actuators.drive import ActuatorCase
from coupling.case.actuators.heights import limit_faults
from coupling.case.actuators.lattice import AMOUNTS, MAX_PLACES, SHARED, broken_rule, size
from coupling.case.mistakes import Mistake
from coupling.case.table import WRONG
from coupling.case.values import DIMENSIONS, Condition, Formula, quoted


class Spot(NamedTuple):
    """A place in a lattice: row and column from 0, and x and y in m."""

    row: int
    column: int
    x: float
    y: float

    def __str__(self) -> str:
        return f"row {self.row}, column {self.column}"


_NEEDED: Final = {
    "rectangular": {"x": {"columns"}, "y": {"rows"}},
    "hexagonal": {"x": {"rows", "columns"}, "y": {"rows"}},
}
"""The counts that a coordinate depends on, by the lattice's kind."""


class Grid(NamedTuple):
    """All places of a lattice, as far as they can be told from those of its keys that are right."""

    spots: Sequence[Spot]  # row by row from the lowest, each from the left; the first where a count is not known
    shared: Mapping[str, float]  # the names of formulas that have the same value at all places
    known: frozenset[str]  # the names of formulas whose values are known

    @classmethod
    def of(cls, values: Mapping[str, Any]) -> Self:
        """The places of a lattice with these values of its keys, WRONG for those that are not right."""
        counted = values if size(values) <= MAX_PLACES else {}
        counts = {key: counted[key] for key in ("rows", "columns") if counted.get(key, WRONG) is not WRONG}
        rows, columns = (counts.get(key, 1) for key in ("rows", "columns"))
        known = {"pi", *counts} | {key[:-1] for key in counts}
        pitch, centre, kind = values["pitch"], values["centre"], values["kind"]
        hexagonal = kind == "hexagonal"
        if WRONG in (pitch, centre, kind) or (hexagonal and isinstance(pitch, tuple)):
            pitch, centre = math.nan, (math.nan, math.nan)
        else:
            known |= {axis for axis, keys in _NEEDED[kind].items() if keys <= counts.keys()}
        across, along = pitch if isinstance(pitch, tuple) else (pitch, pitch * math.sqrt(0.75) if hexagonal else pitch)
        moved = [0.5 if hexagonal and (row - (rows - 1) // 2) % 2 else 0.0 for row in range(rows)]  # in pitches
        x = {
            by: [centre[0] + (by + column - (columns - 1) / 2) * across for column in range(columns)]
            for by in set(moved)
        }
        y = [centre[1] + (row - (rows - 1) / 2) * along for row in range(rows)]
        spots = [Spot(row, column, x[moved[row]][column], y[row]) for row in range(rows) for column in range(columns)]
        return cls(spots, {"pi": math.pi, "rows": float(rows), "columns": float(columns)}, frozenset(known))

    @property
    def whole(self) -> bool:
        """Whether all its places are known."""
        return {"x", "y"} <= self.known

    def tells(self, formula: Formula | Condition) -> bool:
        """Whether it tells all that a formula asks for."""
        return formula.expression.names <= self.known

    def names(self, spot: Spot) -> dict[str, float]:
        """The values that names have at a place; nan for those that are not known."""
        return {**self.shared, "row": float(spot.row), "column": float(spot.column), "x": spot.x, "y": spot.y}


def actuators_at(
    spots: Sequence[Spot], grid: Grid, values: Mapping[str, Any]
) -> tuple[tuple[ActuatorCase, ...], list[Mistake]]:
    """The actuators at some places of a grid; none, but what is wrong, if any of the values is."""
    columns: dict[str, list[float | None]] = {}
    mistakes: list[Mistake] = []
    for key in AMOUNTS:
        try:
            columns[key] = _column(key, values[key], spots, grid)
        except ValueError as error:
            mistakes.append((("lattice", key), str(error)))
    if mistakes or WRONG in values.values():
        return (), mistakes
    same = {key: values[key] for key in SHARED}
    if beyond := _beyond_limits(spots, columns, same):
        return (), [beyond]
    # All values are valid: to check them once more would take longer than the rest.
    made = [
        ActuatorCase.model_construct(position=(spot.x, spot.y), **same, **dict(zip(columns, column, strict=True)))
        for spot, column in zip(spots, zip(*columns.values(), strict=True), strict=True)
    ]
    return tuple(made), []


def _beyond_limits(
    spots: Sequence[Spot], columns: Mapping[str, Sequence[float | None]], same: Mapping[str, Any]
) -> Mistake | None:
    """The first actuator whose drive asks for more than it can do; None: there is none."""
    if same["max_stroke"] is None and same["max_force"] is None:
        return None
    for k, spot in enumerate(spots):
        for key, message in limit_faults({**same, "stroke": columns["stroke"][k], "force": columns["force"][k]}):
            return ("lattice", key), f"{message} at {spot}"
    return None


def _column(key: str, amount: Any, spots: Sequence[Spot], grid: Grid) -> list[float | None]:
    """The values of a key at places; ValueError, which names the first place where there is none."""
    if not isinstance(amount, Formula):
        return [amount] * len(spots)
    found: list[float | None] = []
    for spot in spots if grid.tells(amount) else ():
        try:
            value = amount.value(grid.names(spot))
        except ValueError as error:
            rule = f"must be {DIMENSIONS[AMOUNTS[key].unit]} for each actuator"
            raise ValueError(f"{rule}; {quoted(amount.text)} {error} at {spot}") from None
        if rule := broken_rule(key, value):
            got = f"{quoted(amount.text)} is {amount.text_of(value)} at {spot}"
            raise ValueError(f"must be {rule} for each actuator; {got}")
        found.append(value)
    return found
