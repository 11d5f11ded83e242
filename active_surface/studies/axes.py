"""The axes of a study: the fields of a case that it varies, their values, and what is wrong with them in its file."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, StrictInt, StrictStr
from pydantic import Field as Key

from active_surface.arrays import FloatArray
from active_surface.parameter import Parameter
from active_surface.studies.columns import COLUMNS
from active_surface.studies.points_file import Column, PointsFile
from coupling import near
from coupling.case import (
    Case,
    Contradictions,
    Expected,
    Field,
    Location,
    Mistake,
    Table,
    Value,
    find_field,
    lattice_of,
    quoted,
)

MAX_VALUES = 1_000_000
TAKEN = ("point", "repeat", *COLUMNS)
"""Names that the results have themselves."""


@dataclass(frozen=True)
class Axis:
    """A field and its values in SI units: those that are listed, or all between two bounds."""

    name: str
    field: Field
    values: tuple[Any, ...]  # those of a grid or list; empty: any within the bounds
    low: float = 0.0
    high: float = 0.0
    logarithmic: bool = False

    @cached_property
    def array(self) -> NDArray[Any]:
        """Its values (n,)."""
        return np.array(self.values, self.kind)

    @property
    def kind(self) -> Any:
        """The type of its values in arrays."""
        return {"number": np.float64, "whole": np.int64, "text": object}[self.field.kind]

    def end(self, which: int) -> Any:
        """The lowest value (0) or the highest (-1), as a point has it; of texts the first or the last."""
        if not self.values:
            return (self.low, self.high)[which]
        return (self.values if self.kind is object else sorted(self.values))[which]

    def spread(self, units: FloatArray) -> NDArray[Any]:
        """Its values (n,) at places (n,) in [0, 1)."""
        if self.values:
            return self.array[(units * len(self.values)).astype(np.int64)]
        values: FloatArray = Parameter(self.field, self.low, self.high, self.logarithmic).value(units)
        return values


def spaced(parameter: Parameter, count: int) -> tuple[float, ...]:
    """So many values of a range, both ends among them; equal fractions of a range are equal to the last bit."""
    between = parameter.value(np.arange(1, count - 1) / (count - 1))
    return (parameter.low, *between.tolist(), parameter.high)


def counted(number: str, unit: str) -> str:
    """A number with its unit, if it has one."""
    return number if unit in ("", "1") else f"{number} {unit}"


def must(expected: str, right: Callable[[Any], bool]) -> BeforeValidator:
    """Marks a key whose value must be something, which is said in words."""

    def check(value: object) -> object:
        if not right(value):
            raise ValueError(f"must be {expected}; got {quoted(value)}")
        return value

    return BeforeValidator(check)


_NAME = must(
    "a letter, followed by letters, digits or any of _ . * -, and none of the results' own names",
    lambda value: isinstance(value, str) and bool(re.fullmatch(r"[A-Za-z][\w.*-]*", value)) and value not in TAKEN,
)
_LIST = must('a list of values such as ["300 Hz", "400 Hz"]', lambda value: isinstance(value, list) and len(value) > 0)
_ENDS = must(
    'the first and the last value, such as ["200 Hz", "600 Hz"]',
    lambda value: isinstance(value, list) and len(value) == 2,
)


class AxisTable(Table):
    """An axis: the path of a `field` of the case, and its `values`, or their `range` and `count`.

    Beside a file of points it has none of these.
    """

    in_template: ClassVar[tuple[str, ...]] = ("values",)

    field: Annotated[StrictStr, Expected('the path of a field such as "actuators.0.frequency"')] = Key(
        examples=["actuators.*.frequency"]
    )
    """The field of the case that is varied; * stands for every actuator."""
    name: Annotated[str, _NAME] | None = Key(default=None, examples=["frequency"])
    """The axis's name in the results; without it the field's."""
    values: Annotated[tuple[Any, ...], _LIST] | None = Key(default=None, examples=[["300 Hz", "400 Hz"]])
    """The values that it takes."""
    range: Annotated[tuple[Any, Any], _ENDS] | None = Key(default=None, examples=[["200 Hz", "600 Hz"]])
    """In place of values: the first and the last."""
    count: StrictInt | None = Key(default=None, ge=1, le=MAX_VALUES, examples=[41])
    """How many values a range has."""
    spacing: Literal["linear", "logarithmic"] = "linear"
    """How those of a range lie."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        if "values" in given and "range" in given:
            yield "range", "must not be given with values"
        for key in ("count", "spacing"):
            if key in given and "values" in given and "range" not in given:
                yield key, "must not be given with values; it belongs to a range"


def read_axes(
    case: Case, tables: Sequence[AxisTable], sampling: str, file: PointsFile | None = None
) -> tuple[list[Axis], list[Mistake]]:
    """The axes that tables describe, or that a file of points has, and what is wrong with them."""
    columns = dict(file.columns) if file else {}
    # Each table has the column of its name or field; each column that is left has a table of its own.
    pairs: list[tuple[AxisTable, Column | None]] = [
        (table, next((columns.pop(name) for name in (table.name, table.field) if name in columns), None))
        for table in tables
    ]
    pairs += [(AxisTable(field=name), column) for name, column in columns.items()]
    mistakes: list[Mistake] = []
    axes: list[tuple[int, Axis]] = []
    fields: list[tuple[int, str, Field]] = []
    cells: list[tuple[int, str]] = []
    lattice, alone = lattice_of(case)
    for k, (table, column) in enumerate(pairs):
        try:
            field = find_field(case, lattice, table.field)
        except ValueError as error:
            mistakes.append((("axes", k, "field"), str(error)))
            continue
        name = table.name or field.path
        fields.append((k, name, field))
        wrong: list[tuple[Location, str]] = []
        if file is None:
            axis, wrong = _axis(name, field, table, sampling)
        elif column is None:
            known = f"must be a column of {file.name}, which has {', '.join(file.columns)}"
            axis, wrong = None, [(("field",), known)] if file.columns else []
        else:
            values, unread = file.read(field, column)
            axis = None if unread else Axis(name, field, tuple(values))
            cells += unread
        mistakes += [(("axes", k, *at), message) for at, message in wrong]
        axes += [(k, axis)] if axis else []
    mistakes += _doubled(fields, alone)
    for k, axis in axes[1:] if sampling == "list" else ():
        if len(axis.values) != (count := len(axes[0][1].values)):
            rule = f'must be as many as those of the first axis with sampling = "list", {count}'
            mistakes.append((("axes", k, "values"), rule))
    if file:
        mistakes = [_of_column(mistake, pairs, len(tables), file) for mistake in mistakes]
        mistakes += [(("study", "points"), message) for message in (*file.mistakes, *file.by_line(cells))]
    return [axis for _, axis in axes], mistakes


def _axis(name: str, field: Field, table: AxisTable, sampling: str) -> tuple[Axis | None, list[tuple[Location, str]]]:
    """The axis of a table that has values or a range, and what is wrong with it by its keys."""
    key, written = ("values", table.values) if table.values is not None else ("range", table.range)
    values: list[Any] = []
    wrong: list[tuple[Location, str]] = []
    for place, value in enumerate(written or ()):
        try:
            values.append(field.read(value))
        except ValueError as error:
            wrong.append(((key, place), str(error)))
    if not wrong:
        misfits = _listed_misfits if key == "values" else _range_misfits
        wrong = [((at,), message) for at, message in misfits(field, values, table, sampling)]
    if wrong:
        return None, wrong
    if key == "values":
        return Axis(name, field, tuple(values)), []
    low, high = values
    parameter = Parameter(field, low, high, table.spacing == "logarithmic")
    if table.count is None:
        return Axis(name, field, (), low, high, parameter.logarithmic), []
    return Axis(name, field, spaced(parameter, table.count), logarithmic=parameter.logarithmic), []


def _listed_misfits(field: Field, values: list[Value], _: AxisTable, sampling: str) -> Iterator[tuple[str, str]]:
    doubled = next((value for value, count in Counter(values).items() if count > 1), None)
    if doubled is not None and sampling == "grid":
        yield "values", f"must differ from each other; got {counted(quoted(doubled), field.unit)} twice"


def _range_misfits(field: Field, ends: list[Any], table: AxisTable, sampling: str) -> Iterator[tuple[str, str]]:
    drawn = sampling in ("random", "sobol")
    if field.kind != "number":
        yield "range", f"must not be given for {field.path}, which has no values in between; list its values"
    elif ends[0] == ends[1]:
        yield "range", "must have a last value that differs from the first"
    elif table.spacing == "logarithmic" and not (ends[0] > 0 and ends[1] > 0):
        yield "range", 'must have values above 0 with spacing = "logarithmic"'
    if not drawn and table.count is None:
        yield "count", f'is missing; with sampling = "{sampling}" a range needs a count of values'
    if drawn and table.count is not None:
        yield "count", f'must not be given with sampling = "{sampling}", which draws from all of a range'
    if table.count == 1:
        yield "count", "must be at least 2 for a range; got 1"


def _doubled(fields: Sequence[tuple[int, str, Field]], alone: int) -> Iterator[Mistake]:
    """What two axes both have; alone: how many actuators are listed one by one beside a lattice."""
    makes = next((field.path for *_, field in fields if field.locations[0][0] == "lattice"), None)
    for n, (k, name, field) in enumerate(fields):
        numbers = [int(at[1]) for at in field.locations if at[0] == "actuators"]
        if makes and numbers and max(numbers) >= alone:
            yield ("axes", k, "field"), f"must not vary actuators from {alone} on: the axis over {makes} makes them"
        for _, other, varied in fields[:n]:
            if shared := _within(field, varied) | _within(varied, field):
                at = ".".join(map(str, min(shared, key=str)))
                same = f"{at} is varied by the axis {other} already"
                yield ("axes", k, "field"), f"must be varied by one axis only; {same}"
            elif name == other:
                yield ("axes", k, "name"), f"must differ from that of another axis; got {quoted(name)} twice"


def _within(field: Field, other: Field) -> set[Location]:
    """The locations of a field that another one has, or has as part of what it varies."""
    known = set(other.locations)
    return {at for at in field.locations if any(at[:n] in known for n in range(1, len(at) + 1))}


def _of_column(mistake: Mistake, pairs: Sequence[tuple[AxisTable, Any]], own: int, file: PointsFile) -> Mistake:
    """A mistake about an axis that only the file has, as one of the file."""
    (_, k, *_), message = mistake
    if not isinstance(k, int) or k < own:
        return mistake
    column = pairs[k][0].field
    like = near(column, [word for table, _ in pairs[:own] for word in (table.name, table.field) if word])
    wrong = f"is not known; did you mean {like}?" if like else message
    return ("study", "points"), f"in {file.name}: column {quoted(column)} {wrong}"
