"""Reading a study file: every mistake in it at once, those of its axes against the base case among them."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from active_surface.studies.axes import Axes
from active_surface.studies.points import Points
from active_surface.studies.points_file import read_points_file
from active_surface.studies.refusal import all_refused
from active_surface.studies.study import Study
from active_surface.studies.tables import MAX_PATHS, AxisTable, StudyTable, StudyTables
from coupling.case import (
    UNITS_REQUIRED,
    WRONG,
    Case,
    CaseError,
    Location,
    Mistake,
    errors_of,
    parse,
    read_case,
    validate,
)


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
    """
    file = parse(path, lenient=True).as_meant(StudyTables)
    tables, errors = validate(StudyTables, _with_axes(file.tables), UNITS_REQUIRED)
    threshold = tables.map.threshold if tables else None
    study, mistakes = _study(Path(path), file.text, file.tables, case, points)
    if study and threshold and (message := _undrawn(study.points)):
        mistakes.append((("map", "threshold"), message))
    if study and not errors and not mistakes and not file.misread and (message := all_refused(study)):
        mistakes = [(("axes",), message)]
    errors += errors_of(mistakes)
    if errors or file.misread:
        raise file.error(errors, StudyTables)
    assert study
    return replace(study, threshold=threshold)


def _study(
    path: Path, text: str, data: Mapping[str, Any], case: Case | None, points_path: str | os.PathLike[str] | None
) -> tuple[Study | None, list[Mistake]]:
    """The study, None where it is not known, and what is wrong with it beyond each table by itself."""
    table = data.get("study")
    entries = StudyTable.values_of(table if isinstance(table, dict) else {}, UNITS_REQUIRED)
    mistakes: list[Mistake] = []
    if case is None:
        case, mistakes = _case(path, entries["case"])
    written = data.get("axes")
    tables = [table for table in written if isinstance(table, dict)] if isinstance(written, list) else []
    keyed = [AxisTable.values_of(table, UNITS_REQUIRED) for table in tables]
    file = None
    if isinstance(entries["points"], str):
        file = read_points_file(Path(points_path or path.parent / entries["points"]))
        entries = {**entries, "sampling": "list"}
    if file:
        mistakes += _with_file(tables)
    elif written == []:
        mistakes.append((("axes",), "must be at least one table, written [[axes]]; got none"))
    axes = Axes(case, keyed, entries["sampling"], file)
    mistakes += axes.mistakes
    if case is None or not axes.whole or WRONG in entries.values():
        return None, mistakes
    points = Points(
        axes.axes,
        entries["sampling"],
        0 if file else entries["points"] or 0,
        entries["repeats"],
        entries["jitter"],
        entries["seed"],
    )
    if len(points) > MAX_PATHS:
        mistakes.append((("axes",), f"must make at most {MAX_PATHS} paths; got {len(points)}"))
    return Study(case, points, path.stem, text), mistakes


def _with_file(tables: Sequence[Mapping[str, Any]]) -> Iterator[Mistake]:
    """What axes must not have beside a file of points."""
    for k, table in enumerate(tables):
        for key in ("values", "range", "count", "spacing"):
            if key in table:
                yield ("axes", k, key), "must not be given with a file of points, which has the values"


def _with_axes(tables: Mapping[str, Any]) -> Mapping[str, Any]:
    """The tables of a study, whose axes have something as values where a file of points has these."""
    study, axes = tables.get("study"), tables.get("axes", [])
    if not isinstance(study, dict) or not isinstance(study.get("points"), str) or not isinstance(axes, list):
        return tables
    filled = [
        {"values": [study["points"]], **axis} if isinstance(axis, dict) and "range" not in axis else axis
        for axis in axes
    ]
    return {**tables, "axes": filled}


def _undrawn(points: Points) -> str:
    """Why there is no place where a condition begins; "": there is."""
    if points.sampling != "grid" or len(points.axes) < 2:
        return "must not be given without a grid over two axes, between whose points a condition begins to hold"
    last = points.longest[-1]
    return f"must not be given with texts along the second axis, {last.name}" if last.field.kind == "text" else ""


def _case(path: Path, name: Any) -> tuple[Case | None, list[Mistake]]:
    """The base case, and what is wrong with it."""
    where: Location = ("study", "case")
    if name is WRONG:
        return None, []
    try:
        case = read_case(path.parent / name)
    except CaseError as error:
        return None, [(where, "must be the file of a case; " + str(error).replace("\n", "\n    "))]
    if case.run.scheme != "events":
        return case, [(where, f'must have run.scheme = "events", by which sweeps go; got "{case.run.scheme}"')]
    return case, []
