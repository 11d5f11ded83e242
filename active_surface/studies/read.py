"""Reading a study file: every mistake in it at once, those of its axes against the base case among them."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from active_surface.studies.axes import Axes
from active_surface.studies.points import Points
from active_surface.studies.points_file import read_points_file
from active_surface.studies.refusal import all_refused
from active_surface.studies.study import Study
from active_surface.studies.tables import MAX_PATHS, StudyTables
from coupling.case import UNITS_REQUIRED, Case, CaseError, Faults, Mistake, mistakes_of, parse, read_case


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
    file = parse(path)
    try:
        tables = StudyTables.model_validate(_with_axes(file.tables), context=UNITS_REQUIRED)
        return _study(Path(path), file.text, tables, case, points)
    except (ValidationError, Faults) as error:
        raise file.error(mistakes_of(error, StudyTables, file.tables)) from None


def _study(
    path: Path, text: str, tables: StudyTables, case: Case | None, points_path: str | os.PathLike[str] | None
) -> Study:
    """The study; raises Faults with what is wrong with it beyond its tables by themselves."""
    own = tables.study
    if case is None:
        case = _case(path, own.case)
    file, sampling = None, own.sampling
    if isinstance(own.points, str):
        file, sampling = read_points_file(Path(points_path or path.parent / own.points)), "list"
    axes = Axes(case, [dict(axis) for axis in tables.axes], sampling, file)
    mistakes: list[Mistake] = axes.mistakes
    if not mistakes:
        count = own.points if isinstance(own.points, int) else 0
        points = Points(axes.axes, sampling, count, own.repeats, own.jitter, own.seed)
        study = Study(case, points, path.stem, text, threshold=tables.map.threshold)
        if len(points) > MAX_PATHS:
            mistakes.append((("axes",), f"must make at most {MAX_PATHS} paths; got {len(points)}"))
        elif tables.map.threshold and (message := _undrawn(points)):
            mistakes.append((("map", "threshold"), message))
        elif message := all_refused(study):
            mistakes.append((("axes",), message))
    if mistakes:
        raise Faults(mistakes)
    return study


def _with_axes(tables: Mapping[str, Any]) -> Mapping[str, Any]:
    """The tables of a study, which needs no axes beside a file of points."""
    study = tables.get("study")
    file = isinstance(study, dict) and isinstance(study.get("points"), str)
    return {"axes": [], **tables} if file else tables


def _undrawn(points: Points) -> str:
    """Why there is no place where a condition begins; "": there is."""
    if points.sampling != "grid" or len(points.axes) < 2:
        return "must not be given without a grid over two axes, between whose points a condition begins to hold"
    last = points.longest[-1]
    return f"must not be given with texts along the second axis, {last.name}" if last.field.kind == "text" else ""


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
