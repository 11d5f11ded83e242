"""Studies from their files: every mistake in one at once; and from the files of their results."""

from __future__ import annotations

import csv
import os
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np
from pydantic import ConfigDict, Field, PlainValidator, StrictInt, StrictStr, ValidationError, WithJsonSchema

from active_surface.studies.axes import AxisTable, must, read_axes
from active_surface.studies.columns import Threshold, read_threshold
from active_surface.studies.points import DRAWN, Points, Sampling
from active_surface.studies.points_file import ENDINGS, read_points_file
from active_surface.studies.study import Study, is_deep
from active_surface.studies.sweep_file import differences, key_of, read_dataset, whole
from coupling.case import (
    UNITS_REQUIRED,
    Case,
    CaseError,
    Contradictions,
    Expected,
    Faults,
    Length,
    Mistake,
    Table,
    mistakes_of,
    parse,
    quoted,
    read_case,
)

if TYPE_CHECKING:
    import xarray

MAX_PATHS = 1_000_000_000
TRIED = 64  # points, before the work begins
EXPECTED = "Input path must be a result of `active-surface sweep`"

_POINTS = must(
    f'a whole number from 1 to {MAX_PATHS}, or a file of points such as "points.csv"',
    lambda value: (
        value.lower().endswith(ENDINGS)
        if isinstance(value, str)
        else isinstance(value, int) and not isinstance(value, bool) and 1 <= value <= MAX_PATHS
    ),
)
_POINTS_SCHEMA = WithJsonSchema(
    {"anyOf": [{"type": "integer", "minimum": 1, "maximum": MAX_PATHS}, {"type": "string"}]}
)


class StudyTable(Table):
    """What is swept, and how points are chosen; jitter in m."""

    case: Annotated[StrictStr, Expected('the name of a case file such as "two_actuators.toml"')] = Field(
        examples=["one_actuator.toml"]
    )
    """The base case, a file beside the study's."""
    sampling: Sampling = "grid"
    """How points are chosen: all of a grid, one for each entry of lists, or drawn."""
    points: (
        Annotated[
            int | str, _POINTS, Expected('a whole number, or a file of points such as "points.csv"'), _POINTS_SCHEMA
        ]
        | None
    ) = Field(default=None, examples=[1000])
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
        elif sampling in DRAWN and "points" not in given:
            yield "points", f'is missing; with sampling = "{sampling}" it must be a whole number'
        elif sampling not in DRAWN and "points" in given:
            yield "points", f'must not be given with sampling = "{sampling}", whose axes tell the points'
        if given.get("repeats", 1) != 1 and given.get("jitter", 0.0) == 0.0:
            yield "repeats", 'must not be given without a jitter such as "1 um": the paths would all be the same'


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
    """All that a study file has."""

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
                yield ("axes", k, "values"), "is missing; give a list of values, or a range and a count"
        if not file and not given["axes"]:
            yield "axes", "must be at least one table, written [[axes]]; got none"


def read_study(
    path: str | os.PathLike[str], case: Case | None = None, points: str | os.PathLike[str] | None = None
) -> Study:
    """Read a study file.

    Parameters
    ----------
    path : path
        The file.
    case : Case, optional
        Its base case; by default that of the file that it names.
    points : path, optional
        Another file of points in place of the one that it names.

    Returns
    -------
    study : Study
        The study.

    Raises
    ------
    CaseError
        The file cannot be read or has mistakes; has every one.
    ValueError
        The base case is no Case.
    """
    if not isinstance(case, Case | None):
        raise ValueError(f"Input case of read_study must be a Case, as read_case makes it; got {quoted(case)}")
    file = parse(path)
    study = file.tables.get("study")
    beside_a_file = isinstance(study, dict) and isinstance(study.get("points"), str)
    try:
        tables = StudyTables.model_validate(
            {"axes": [], **file.tables} if beside_a_file else file.tables, context=UNITS_REQUIRED
        )
        return _study(Path(path), file.text, tables, case, points)
    except (ValidationError, Faults) as error:
        mistakes = mistakes_of(error, StudyTables, file.tables)
        if isinstance(error, ValidationError):
            mistakes += _of_axes(Path(path), file.tables, case)
        raise file.error(mistakes) from None


def _of_axes(path: Path, tables: Mapping[str, Any], case: Case | None) -> Iterator[Mistake]:
    """What is wrong with fields and values of the axes that are right as tables, in a file that is not."""
    study, axes = tables.get("study"), tables.get("axes")
    name = study.get("case") if isinstance(study, dict) else None
    if not isinstance(axes, list) or not (case or isinstance(name, str)):
        return
    try:
        base = case or _case(path, str(name))
    except Faults as fault:
        yield from fault.mistakes
        return
    for k, axis in enumerate(axes):
        with suppress(ValidationError):
            table = AxisTable.model_validate(axis, context=UNITS_REQUIRED)
            found = read_axes(base, [table], "grid")[1] if table.values or table.range else ()
            yield from ((("axes", k, *at[2:]), message) for at, message in found if at[2] == "field" or at[3:])


def _study(
    path: Path, text: str, tables: StudyTables, case: Case | None, points_path: str | os.PathLike[str] | None
) -> Study:
    """The study; raises Faults with what is wrong with it beyond its tables by themselves."""
    own = tables.study
    base = _case(path, own.case) if case is None else case
    file, sampling = None, own.sampling
    if isinstance(own.points, str):
        file, sampling = read_points_file(Path(points_path or path.parent / own.points)), "list"
    axes, mistakes = read_axes(base, tables.axes, sampling, file)
    if not mistakes:
        count = own.points if isinstance(own.points, int) else 0
        # What the plate depends on varies slowest: points that follow each other share it.
        axes.sort(key=lambda axis: not is_deep(base, axis))
        points = Points(tuple(axes), sampling, count, own.repeats, own.jitter, own.seed)
        study = Study(base, points, path.stem, text, tables.map.threshold)
        mistakes = list(_mistakes(study))
    if mistakes:
        raise Faults(mistakes)
    return study


def _mistakes(study: Study) -> Iterator[Mistake]:
    """What is wrong with a study as a whole, the first of it."""
    points, last = study.points, study.points.longest[-1]
    if len(points) > MAX_PATHS:
        yield ("axes",), f"must make at most {MAX_PATHS} paths; got {len(points)}"
    elif study.threshold and (points.sampling != "grid" or len(points.axes) < 2):
        where = "a grid over two axes, between whose points a condition begins to hold"
        yield ("map", "threshold"), f"must not be given without {where}"
    elif study.threshold and last.field.kind == "text":
        yield ("map", "threshold"), f"must not be given with texts along the second axis, {last.name}"
    elif message := _all_refused(study):
        yield ("axes",), message


def _all_refused(study: Study) -> str:
    """What is wrong where every point of a study that is tried is refused; "" where one is not."""
    places = np.unique(np.linspace(0, len(study.points) - 1, TRIED).astype(np.int64)).tolist()
    first = ""
    for k in places:
        messages = study.refusals(k)
        if not messages:
            return ""
        first = first or "; ".join(messages)
    tried = "every point" if len(places) == len(study.points) else f"each of {len(places)} points that were tried"
    return f"lead to a case that cannot be run at {tried}: {first}"


def _case(path: Path, name: str) -> Case:
    """The base case; raises Faults where it cannot be swept."""
    try:
        case = read_case(path.parent / name)
    except CaseError as error:
        message = "must be the file of a case; " + str(error).replace("\n", "\n    ")
        raise Faults([(("study", "case"), message)]) from None
    if case.run.scheme != "events":
        message = f'must have run.scheme = "events", by which sweeps go; got "{case.run.scheme}"'
        raise Faults([(("study", "case"), message)])
    return case


def read_sweep(path: Path, study: Study | None = None) -> tuple[Study, xarray.Dataset]:
    """The study whose results a netCDF file has, and these, read on demand until closed.

    study: that study, if its file is at hand; None: it is read from the text in the results.
    Raises ValueError when there is no such file or it is something else or of another study, and when its case
    reads files that do not exist.
    """
    if not path.is_file():
        raise ValueError(f"{EXPECTED}; got {path}, and there is no such file")
    if key_of(path) is None:
        raise ValueError(f"{EXPECTED}; got {path}, which is something else")
    if study is not None:
        others = [name for name in differences(study, path) if name != "versions"]
        if others:
            raise ValueError(f"{EXPECTED} of {study.name}; got {path}, which is of other {' and '.join(others)}")
        return study, read_dataset(path, [axis.name for axis in study.points.axes])
    with whole(path):
        dataset = read_dataset(path)
    if not dataset.attrs["study"]:
        raise ValueError(f"{EXPECTED}; got {path}, whose study was made without a file")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        files = {kind: folder / kind / f"{path.stem}.toml" for kind in ("study", "case")}
        for kind, file in files.items():
            file.parent.mkdir()
            file.write_text(dataset.attrs[kind], encoding="utf-8")
        with whole(path), (folder / "points.csv").open("w", encoding="utf-8", newline="") as text:
            if dataset.attrs["sampling"] == "list":  # whose values may be in a file that is elsewhere
                names = dataset.attrs["axes"].split()
                rows = csv.writer(text)
                rows.writerow(dataset[name].attrs["field"] for name in names)
                rows.writerows(zip(*(dataset[name].values.tolist() for name in names), strict=True))
        try:
            return read_study(files["study"], read_case(files["case"]), folder / "points.csv"), dataset
        except CaseError as error:
            raise ValueError(
                f"{path}: the study in it cannot be read; give the study file in its place\n{error}"
            ) from error
