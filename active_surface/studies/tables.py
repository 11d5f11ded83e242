"""The tables of a study file: [study], and [[axes]] once for each axis."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, ConfigDict, Field, PlainValidator, StrictInt, StrictStr, WithJsonSchema

from active_surface.studies.points import Sampling
from active_surface.studies.points_file import ENDINGS
from active_surface.studies.record import COLUMNS
from active_surface.studies.threshold import Threshold, read_threshold
from coupling.case import Contradictions, Expected, Length, Table, quoted

MAX_PATHS, MAX_VALUES = 1_000_000_000, 1_000_000


TAKEN = ("point", "repeat", *COLUMNS)
"""Names that the results have themselves."""


def _several(value: object) -> object:
    if not isinstance(value, list) or not value:
        raise ValueError(f'must be a list of values such as ["300 Hz", "400 Hz"]; got {quoted(value)}')
    return value


def _two(value: object) -> object:
    if not isinstance(value, list) or len(value) != 2:
        raise ValueError(f'must be the first and the last value, such as ["200 Hz", "600 Hz"]; got {quoted(value)}')
    return value


def _name(value: object) -> object:
    if not isinstance(value, str) or not re.fullmatch(r"[A-Za-z][\w.*-]*", value) or value in TAKEN:
        rule = "a letter, followed by letters, digits or any of _ . * -, and none of the results' own names"
        raise ValueError(f"must be {rule}; got {quoted(value)}")
    return value


def _points(value: object) -> object:
    if isinstance(value, int) and not isinstance(value, bool) and 1 <= value <= MAX_PATHS:
        return value
    if isinstance(value, str) and value.lower().endswith(ENDINGS):
        return value
    numbers = f"a whole number from 1 to {MAX_PATHS}"
    raise ValueError(f'must be {numbers}, or a file of points such as "points.csv"; got {quoted(value)}')


_CASE_FILE = Expected('the name of a case file such as "two_actuators.toml"')
_FIELD_PATH = Expected('the path of a field such as "actuators.0.frequency"')
_HOW_MANY = Expected('a whole number, or a file of points such as "points.csv"')
_POINTS_SCHEMA = {"anyOf": [{"type": "integer", "minimum": 1, "maximum": MAX_PATHS}, {"type": "string"}]}
PointsOrFile = Annotated[int | str, PlainValidator(_points), _HOW_MANY, WithJsonSchema(_POINTS_SCHEMA)]


class StudyTable(Table):
    """What is swept, and how points are chosen; jitter in m."""

    case: Annotated[StrictStr, _CASE_FILE] = Field(examples=["one_actuator.toml"])
    """The base case, a file beside the study's."""
    sampling: Sampling = "grid"
    """How points are chosen: all of a grid, one for each entry of lists, or drawn."""
    points: PointsOrFile | None = Field(default=None, examples=[1000])
    """How many, of random and Sobol ones; or the file that has them, beside the study's."""
    repeats: StrictInt = Field(default=1, ge=1, le=1_000_000, examples=[10])
    """How many paths there are of each point."""
    jitter: Length = Field(default=0.0, ge=0, examples=["1 um"])
    """How far the starts of repeats are displaced at most."""
    seed: StrictInt = Field(default=0, ge=0, lt=2**32)
    """From which random numbers follow."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        sampling = given.get("sampling", "grid")
        if isinstance(given.get("points"), str):
            if given.get("sampling", "list") != "list":
                yield "sampling", f'must be "list" or left out with a file of points; got "{sampling}"'
            sampling = "list"
        elif sampling in ("grid", "list") and "points" in given:
            yield "points", f'must not be given with sampling = "{sampling}", whose axes tell the points'
        if sampling in ("random", "sobol") and "points" not in given:
            yield "points", f'is missing; with sampling = "{sampling}" it must be a whole number'
        if given.get("repeats", 1) != 1 and given.get("jitter", 0.0) == 0.0:
            yield "repeats", 'must not be given without a jitter such as "1 um": the paths would all be the same'


class AxisTable(Table):
    """An axis: the path of a `field` of the case, and its `values`, or their `range` and `count`.

    Beside a file of points it has none of these.
    """

    in_template: ClassVar[tuple[str, ...]] = ("values",)

    field: Annotated[StrictStr, _FIELD_PATH] = Field(examples=["actuators.*.frequency"])
    """The field of the case that is varied; * stands for every actuator."""
    name: Annotated[str, BeforeValidator(_name)] | None = Field(default=None, examples=["frequency"])
    """The axis's name in the results; without it the field's."""
    values: Annotated[tuple[Any, ...], BeforeValidator(_several)] | None = Field(
        default=None, examples=[["300 Hz", "400 Hz"]]
    )
    """The values that it takes."""
    range: Annotated[tuple[Any, Any], BeforeValidator(_two)] | None = Field(
        default=None, examples=[["200 Hz", "600 Hz"]]
    )
    """In place of values: the first and the last."""
    count: StrictInt | None = Field(default=None, ge=1, le=MAX_VALUES, examples=[41])
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


class MapTable(Table):
    """What the picture shows: where the condition `threshold` begins to hold."""

    threshold: Annotated[Threshold, PlainValidator(read_threshold), WithJsonSchema({"type": "string"})] | None = Field(
        default=None, examples=["distance > 1 um"]
    )
    """A condition; the picture shows where it begins to hold."""


def _axes_or(schema: dict[str, Any]) -> None:
    """Has a JSON schema ask for axes or for a file of points."""
    schema["required"].remove("axes")
    file = {"properties": {"points": {"type": "string"}}, "required": ["points"]}
    schema["anyOf"] = [{"required": ["axes"]}, {"properties": {"study": file}}]


class StudyTables(Table):
    """All that a study file holds."""

    model_config = ConfigDict(json_schema_extra=_axes_or)

    whole_file: ClassVar[bool] = True

    study: StudyTable
    """What is swept, and how."""
    axes: tuple[AxisTable, ...]
    """The axes, one table each; none are needed beside a file of points."""
    map: MapTable = MapTable()
    """The picture."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        file = isinstance(given["study"].points, str)
        for k, axis in enumerate(given["axes"]):
            if file:
                for key in ("values", "range", "count"):
                    if getattr(axis, key) is not None:
                        yield ("axes", k, key), "must not be given with a file of points, which has the values"
            elif axis.values is None and axis.range is None:
                wanted = "a list of values, or have range and count in its place"
                yield ("axes", k, "values"), f"is missing; it must be {wanted}"
        if not file and not given["axes"]:
            yield "axes", "must be at least one table, written [[axes]]; got none"
