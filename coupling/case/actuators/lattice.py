"""The lattice of a case: many actuators in rows and columns, whose drives follow formulas."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal, NamedTuple

from pydantic import Field, StrictInt

from coupling.case.actuators.drive import ActuatorCase, DriveCase, Pushing, limit_faults
from coupling.case.table import Contradictions, Faults, Table
from coupling.case.values import (
    UNITS_REQUIRED,
    Amount,
    Condition,
    Expected,
    Formula,
    Length,
    Listed,
    OneOrList,
    Point,
    PositiveLength,
    Where,
    length_text,
    quoted,
)

if TYPE_CHECKING:
    from meshes import PlateMesh

Place = tuple[float, float]

SAME_PLACE: Final = 1e-9
"""Places closer than this fraction of half the plate's longer side count as one."""
MAX_PLACES: Final = 100_000  # actuators


_TWO: Final = 'a length such as "150 um", or two, along x and y'
Pitch = Annotated[
    OneOrList[PositiveLength, Annotated[tuple[PositiveLength, PositiveLength], Listed(_TWO, 2, 2)]], Expected(_TWO)
]


class _Places(Table):
    rows: StrictInt = Field(ge=1, examples=[3])
    """How many rows there are, along y."""
    columns: StrictInt = Field(ge=1, examples=[3])
    """How many columns there are, along x."""
    pitch: Pitch = Field(examples=["100 um"])
    """The distance of neighbours, or two: along x and along y; in a hexagonal lattice one."""
    centre: Point = (0.0, 0.0)
    """The lattice's middle."""
    kind: Literal["rectangular", "hexagonal"] = "rectangular"
    """Rows above each other, or every second row moved by half a pitch, so that all neighbours are one pitch apart."""
    margin: Length | None = Field(default=None, ge=0, examples=["20 um"])
    """Actuators nearer than this to the rim, or beyond it, are left out; without it they are a mistake."""
    where: Where | None = Field(default=None, examples=["not (row == 1 and column == 1)"])
    """An expression of row, column, x and y that is true where there is an actuator."""

    def spots(self) -> list[Spot]:
        """All its places, row by row from the lowest, each from the left."""
        hexagonal = self.kind == "hexagonal"
        pitch = self.pitch
        along = math.sqrt(0.75) if hexagonal else 1.0  # pitches
        across, along = pitch if isinstance(pitch, tuple) else (pitch, pitch * along)
        spots = []
        for row in range(self.rows):
            moved = 0.5 if hexagonal and (row - (self.rows - 1) // 2) % 2 else 0.0  # in pitches
            y = self.centre[1] + (row - (self.rows - 1) / 2) * along
            for column in range(self.columns):
                spots.append(Spot(row, column, self.centre[0] + (moved + column - (self.columns - 1) / 2) * across, y))
        return spots

    def names_at(self, spot: Spot) -> dict[str, float]:
        """The values that names in formulas have at a place."""
        row, column, x, y = spot
        whole = {"pi": math.pi, "rows": float(self.rows), "columns": float(self.columns)}
        return {**whole, "row": float(row), "column": float(column), "x": x, "y": y}


class LatticeCase(DriveCase, Pushing, _Places):
    """Actuators in `rows` along y and `columns` along x, `pitch` apart, around a `centre`, in m.

    In a hexagonal lattice rows are sqrt(3)/2 pitches apart, and every second one, counted from the middle one (of an
    even number the lower of the two), is half a pitch further to the right.

    Those nearer than `margin` in m to the rim, or beyond it, are left out, unless it is None, and those for which the
    `Condition` `where` is false. The other keys are those of an actuator; a `Formula` gives each its own value.
    """

    force: Annotated[float | Formula, Amount("N", "2 uN")] | None = Field(default=None, examples=["1 mN"])  # type: ignore[assignment]
    """As of an actuator, or an expression and its unit."""
    stiffness: Annotated[float | Formula, Amount("N/m", "1e4 N/m", positive=True)] | None = None  # type: ignore[assignment]
    """As of an actuator, or an expression and its unit."""
    stroke: Annotated[float | Formula, Amount("m", "150 um")] | None = Field(default=None, examples=["5 um"])  # type: ignore[assignment]
    """As of an actuator, or an expression and its unit."""
    frequency: Annotated[float | Formula, Amount("Hz", "300 Hz", positive=True)] | None = None  # type: ignore[assignment]
    """As of an actuator, or an expression and its unit."""
    dwell: Annotated[float | Formula, Amount("s", "50 ms", from_0=True)] = 0.0  # type: ignore[assignment]
    """As of an actuator, or an expression and its unit."""
    phase: Annotated[float | Formula, Amount("rad", "90 deg")] = Field(default=0.0, examples=["60 * column deg"])  # type: ignore[assignment]
    """As of an actuator, or an expression and its unit: a wave over the lattice."""
    delay: Annotated[float | Formula, Amount("s", "50 ms", from_0=True)] = Field(  # type: ignore[assignment]
        default=0.0, examples=["0.05 * (row + column) ms"]
    )
    """As of an actuator, or an expression and its unit."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        yield from super().contradictions(given)
        if given.get("kind") == "hexagonal" and isinstance(given["pitch"], tuple):
            yield "pitch", 'must be one length with kind = "hexagonal", in which all neighbours are as far apart'
        count = given["rows"] * given["columns"]
        if count > MAX_PLACES:
            shorter, longer = sorted(("rows", "columns"), key=given.__getitem__)
            yield longer, f"must make at most {MAX_PLACES} actuators with {shorter} = {given[shorter]}; got {count}"


FORMULAS: Final = ("stroke", "force", "stiffness", "frequency", "dwell", "delay", "phase")
"""The keys of an actuator that may be formulas."""


class Spot(NamedTuple):
    """A place in a lattice: row and column from 0, and x and y in m."""

    row: int
    column: int
    x: float
    y: float

    def __str__(self) -> str:
        return f"row {self.row}, column {self.column}"


def actuators_of(lattice: LatticeCase, mesh: PlateMesh) -> tuple[ActuatorCase, ...]:
    """The actuators of a lattice under a plate; raises Faults with what is wrong with them."""
    spots = _standing(lattice, mesh)
    columns: dict[str, list[Any]] = {}
    wrong = []
    for key in FORMULAS:
        try:
            columns[key] = _values(key, lattice, spots)
        except Faults as faults:
            wrong += faults.mistakes
    if wrong:
        raise Faults(wrong)
    same = {key: getattr(lattice, key) for key in ActuatorCase.model_fields if key not in ("position", *FORMULAS)}
    if same["max_stroke"] is not None or same["max_force"] is not None:
        for k, spot in enumerate(spots):
            for at, message in limit_faults({**same, "stroke": columns["stroke"][k], "force": columns["force"][k]}):
                raise Faults([(("lattice", str(at)), f"{message} at {spot}")])
    # All values are valid: to check them once more would take longer than the rest.
    return tuple(
        ActuatorCase.model_construct(position=(spot.x, spot.y), **same, **dict(zip(columns, column, strict=True)))
        for spot, column in zip(spots, zip(*columns.values(), strict=True), strict=True)
    )


def _standing(lattice: LatticeCase, mesh: PlateMesh) -> Sequence[Spot]:
    """The places that are not left out; raises Faults where one is not inside the rim, or none is left."""
    spots = lattice.spots()
    standing = list(zip(spots, gaps(mesh, [(spot.x, spot.y) for spot in spots]), strict=True))
    if lattice.margin is not None:
        needed = max(lattice.margin - SAME_PLACE * half_size(mesh), mesh.least_gap)
        standing = [(spot, gap) for spot, gap in standing if gap > needed]
        if not standing:
            raise Faults([(("lattice", "margin"), "leaves no actuator on the plate")])
    if lattice.where is not None:
        there = _values("where", lattice, [spot for spot, _ in standing])
        standing = [one for one, is_there in zip(standing, there, strict=True) if is_there]
        if not standing:
            must = f"must be true for one actuator or more; {quoted(lattice.where.text)} is true for none"
            raise Faults([(("lattice", "where"), must)])
    if beyond := [(spot, gap) for spot, gap in standing if gap <= mesh.least_gap]:
        (spot, gap), *more = beyond
        also = f", and {len(more)} more are not inside either" if more else ""
        inside, at = _inside(gap, mesh)
        message = f"must have all its actuators {inside}; {spot} is {at}{also}; a margin leaves them out"
        raise Faults([(("lattice",), message)])
    return [spot for spot, _ in standing]


def _values(key: str, lattice: LatticeCase, spots: Sequence[Spot]) -> list[Any]:
    """The values of a key at places; raises Faults, which name the first place where there is none."""
    formula = getattr(lattice, key)
    if not isinstance(formula, Formula | Condition):
        return [formula] * len(spots)
    found: list[Any] = []
    for spot in spots:
        try:
            found.append(formula.value(lattice.names_at(spot)))
        except ValueError as error:
            raise Faults([(("lattice", key), f"{error} at {spot}")]) from None
    return found


def outside(lattice: Mapping[str, Any], places: Sequence[Place]) -> str:
    """The condition of a lattice, as a file has it, that leaves some of its places out as well."""
    read = LatticeCase.model_validate(lattice, context=UNITS_REQUIRED)
    spots = {(spot.x, spot.y): spot for spot in read.spots()}
    several = [key for key in ("row", "column") if lattice[f"{key}s"] > 1]
    left = [" or ".join(f"{key} != {getattr(spots[place], key)}" for key in several) for place in places]
    parts = [*([lattice["where"]] if "where" in lattice else []), *left]
    return " and ".join(f"({part})" for part in parts) if len(parts) > 1 else "".join(parts)


def half_size(mesh: PlateMesh) -> float:
    """Half of the plate's longer side [m]."""
    return float((mesh.outline.box[1] - mesh.outline.box[0]).max()) / 2


def gaps(mesh: PlateMesh, places: Sequence[Place]) -> list[float]:
    """How far inside the rim places are [m], negative beyond it."""
    return mesh.outline.gap(places).tolist() if places else []


def must_be_inside(gap: float, mesh: PlateMesh) -> str:
    """What is wrong with a place so far inside the rim [m], where more is needed."""
    inside, at = _inside(gap, mesh)
    return f"must be {inside}; got a point {at}"


def _inside(gap: float, mesh: PlateMesh) -> tuple[str, str]:
    same = SAME_PLACE * half_size(mesh)
    if gap > same:
        return f"more than {length_text(mesh.least_gap)} inside the rim", f"{length_text(gap)} inside it"
    return "inside the rim", f"{length_text(-gap)} beyond it" if gap < -same else "on it"
