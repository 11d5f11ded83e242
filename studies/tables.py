"""The tables of a study file: [study], and [[axes]] once for each axis."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, Field, PlainValidator, StrictInt, StrictStr

from coupling.keyed_table import WRONG, Contradictions, KeyedTable
from coupling.table import Table
from coupling.units import Length, shown
from studies.points import Sampling
from studies.record import COLUMNS
from studies.threshold import Threshold, read_threshold

MOST_PATHS, MOST_VALUES = 1_000_000_000, 1_000_000


TAKEN = ("point", "repeat", *COLUMNS)
"""Names that the results have themselves."""


def _several(value: object) -> object:
    if not isinstance(value, list) or not value:
        raise ValueError(f'must be a list of values such as ["300 Hz", "400 Hz"]; got {shown(value)}')
    return value


def _two(value: object) -> object:
    if not isinstance(value, list) or len(value) != 2:
        raise ValueError(f'must be the first and the last value, such as ["200 Hz", "600 Hz"]; got {shown(value)}')
    return value


class _File:
    wanted = 'the name of a case file such as "two_actuators.toml"'


class _Path:
    wanted = 'the path of a field such as "actuators.0.frequency"'


def _name(value: object) -> object:
    if not isinstance(value, str) or not re.fullmatch(r"[A-Za-z][\w.*-]*", value) or value in TAKEN:
        rule = "a letter, followed by letters, digits or any of _ . * -, and none of the results' own names"
        raise ValueError(f"must be {rule}; got {shown(value)}")
    return value


class StudyTable(KeyedTable):
    """What is swept: the file of the base `case`, beside the study's, and how points are chosen.

    points: how many, of random and Sobol ones.  repeats: of each point.  jitter: how far in m starts are displaced.
    """

    case: Annotated[StrictStr, _File()]
    sampling: Sampling = "grid"
    points: StrictInt | None = Field(default=None, ge=1, le=MOST_PATHS)
    repeats: StrictInt = Field(default=1, ge=1, le=1_000_000)
    jitter: Length = Field(default=0.0, ge=0)
    seed: StrictInt = Field(default=0, ge=0, lt=2**32)

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        sampling = given.get("sampling", "grid")
        if sampling in ("random", "sobol") and "points" not in given:
            yield "points", f'is missing; with sampling = "{sampling}" it must be a whole number'
        if sampling in ("grid", "list") and "points" in given:
            yield "points", f'must not be given with sampling = "{sampling}", whose axes tell the points'
        if given.get("repeats", 1) not in (1, WRONG) and given.get("jitter", 0.0) == 0.0:
            yield "repeats", 'must not be given without a jitter such as "1 um": the paths would all be the same'


class AxisTable(KeyedTable):
    """An axis: the path of a `field` of the case, and its `values`, or their `range` and `count`."""

    field: Annotated[StrictStr, _Path()]
    name: Annotated[str, BeforeValidator(_name)] | None = None
    values: Annotated[tuple[Any, ...], BeforeValidator(_several)] | None = None
    range: Annotated[tuple[Any, Any], BeforeValidator(_two)] | None = None
    count: StrictInt | None = Field(default=None, ge=1, le=MOST_VALUES)
    spacing: Literal["linear", "logarithmic"] = "linear"

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        if "values" in given and "range" in given:
            yield "range", "must not be given with values"
        elif "values" not in given and "range" not in given:
            yield "values", "is missing; it must be a list of values, or have range and count in its place"
        for key in ("count", "spacing"):
            if key in given and "values" in given and "range" not in given:
                yield key, "must not be given with values; it belongs to a range"


class MapTable(Table):
    """What the picture shows: where the condition `threshold` begins to hold."""

    threshold: Annotated[Threshold, PlainValidator(read_threshold)] | None = None


class StudyTables(Table):
    """All that a study file holds."""

    study: StudyTable
    axes: tuple[AxisTable, ...]
    map: MapTable = MapTable()


TABLES: dict[str, type[BaseModel]] = {"": StudyTables, "study": StudyTable, "axes": AxisTable, "map": MapTable}
"""The models by the names of their tables."""
