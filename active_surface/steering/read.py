"""Reading an aim file, or a case file that is to be aimed as it is: every mistake in it at once."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from itertools import accumulate
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from active_surface.steering.settings import AimTable, AimTables, Settings
from active_surface.steering.task import Place, Route, Task, mistakes
from coupling.case import (
    UNITS_REQUIRED,
    Case,
    CaseError,
    Faults,
    Quantity,
    mistakes_of,
    parse,
    quoted,
    read_case,
    read_columns,
    unreadable,
)

LENGTH, ANGLE = Quantity("m", "150 um"), Quantity("rad", "30 deg")
MEASURED_HEADER = "x [um], y [um]"


def read_task(
    path: str | os.PathLike[str],
    target: Place | None = None,
    quantile: float | None = None,
    cvar: float | None = None,
    heading: float | None = None,
    by: Place | None = None,
    **changes: Any,
) -> Task:
    """Read an aim file or a case file as a task.

    Parameters
    ----------
    path : path
        The file.
    target : point, optional
        The target, m; replaces the file's.
    quantile : float, optional
        Share of disturbed runs that must end near; replaces the file's quantile or CVaR.
    cvar : float, optional
        The quantile beyond which their mean distance is made small; likewise.
    heading : float, optional
        The heading of a part with a footprint at the target, rad; replaces the file's.
    by : point, optional
        The target from the part's start, m; likewise.
    **changes
        Fields of `Settings` that replace the file's, if not None.

    Returns
    -------
    task : Task
        The task.

    Raises
    ------
    CaseError
        The file has mistakes; has every one.
    ValueError
        The target does not suit the case.
    """
    if target is not None and by is not None:
        raise ValueError("by must not be given with a target, whose place it takes")
    case, settings, own_targets, own_heading = read_settings(path, target is None and by is None)
    targets = [target] if target is not None else own_targets if by is None else _after(case, [by])
    if len(targets) > 1:
        raise ValueError(f"by in [aim] must be one step for an aim; got {len(targets)}, which `plan` takes")
    if not targets:
        raise ValueError(
            "the target is missing; it must be two lengths, as --target 100,-50 or in the file's [aim], "
            "or a step from the start, as --by 150,0"
        )
    if quantile is not None or cvar is not None:
        settings = Settings(**(dict(settings) | {"quantile": quantile, "cvar": cvar}))
    name, turned = Path(path).stem, own_heading if heading is None else heading
    return Task(case, targets[0], _changed(settings, changes), name, turned)


def read_route(
    path: str | os.PathLike[str], through: Sequence[Place] = (), by: Sequence[Place] = (), **changes: Any
) -> Route:
    """Read an aim file or a case file as a route.

    Parameters
    ----------
    path : path
        The file.
    through : sequence of points
        The way-points, m.
    by : sequence of points
        Steps in their place, m, the first from the part's start; without both those of the file.
    **changes
        Fields of `Settings` that replace the file's, if not None.

    Returns
    -------
    route : Route
        The route.

    Raises
    ------
    CaseError
        The file has mistakes; has every one.
    ValueError
        The way-points do not suit the case.
    """
    if through and by:
        raise ValueError("by must not be given with way-points, whose place it takes")
    case, settings, own, heading = read_settings(path, not through and not by)
    if heading is not None:
        raise ValueError("heading in [aim] must not be given for a plan, whose way-points have none")
    places = through or (_after(case, by) if by else own)
    return Route(case, tuple(places), _changed(settings, changes), Path(path).stem)


def _after(case: Case, steps: Iterable[Place]) -> list[Place]:
    """Places [m] after each of some steps [m] from where the part of a case starts."""
    return list(accumulate(steps, lambda at, step: (at[0] + step[0], at[1] + step[1]), initial=case.part.position))[1:]


def _changed(settings: Settings, changes: dict[str, Any]) -> Settings:
    given = {key: value for key, value in changes.items() if value is not None}
    return Settings(**(dict(settings) | given)) if given else settings


def read_settings(path: str | os.PathLike[str], aims: bool) -> tuple[Case, Settings, list[Place], float | None]:
    """The case, the settings, the targets [m] and the heading [rad], if any, in a file; CaseError with every mistake.

    aims: whether its targets count.
    """
    file = parse(path)
    if "aim" not in file.tables:
        return read_case(path), Settings(), [], None
    try:
        table = AimTables.model_validate(file.tables, context=UNITS_REQUIRED).aim
        case = _case(Path(path), table)
        targets = _after(case, table.by) if table.by else [table.target] if table.target else []
        wrong = list(mistakes(case, table, targets[0] if aims and targets else None, table.heading))
        if table.by and table.target:
            wrong.append(("by", "must not be given with target, whose place it takes"))
        if wrong:
            raise Faults((("aim", key), message) for key, message in wrong)
    except (ValidationError, Faults) as error:
        raise file.error(mistakes_of(error, AimTables, file.tables)) from None
    own = {key: getattr(table, key) for key in Settings.model_fields}
    return case, Settings.model_construct(**own), targets, table.heading


def _case(path: Path, table: AimTable) -> Case:
    """The case that an aim file names; raises Faults where it is wrong."""
    try:
        return read_case(path.parent / table.case)
    except CaseError as error:
        message = "must be the file of a case; " + str(error).replace("\n", "\n    ")
        raise Faults([(("aim", "case"), message)]) from None


def read_place(text: str, option: str) -> Place:
    """The place [m] in a text such as 100,-50: two lengths, in um or with their units; ValueError names the option."""
    try:
        x, y = (LENGTH.parse(part if part[-1:].isalpha() else f"{part} um") for part in map(str.strip, text.split(",")))
    except ValueError:
        expected = 'two lengths, x and y, such as 100,-50 (um) or "0.1 mm,-50 um"'
        raise ValueError(f"{option} must be {expected}; got {quoted(text)}") from None
    return x, y


def read_heading(text: str, option: str) -> float:
    """The angle [rad] in a text such as 30: in deg or with its unit; ValueError names the option."""
    try:
        return ANGLE.parse(text if text[-1:].isalpha() else f"{text} deg")
    except ValueError:
        raise ValueError(f'{option} must be an angle such as 30 (deg) or "0.5 rad"; got {quoted(text)}') from None


def read_measured(path: str | os.PathLike[str]) -> list[Place]:
    """The places [m] in a CSV file with columns x and y, one after each leg; ValueError with every mistake."""
    file = Path(path)
    try:
        read = read_columns(file, {"x": LENGTH, "y": LENGTH}, [["x"], ["y"]], MEASURED_HEADER)
    except (OSError, ValueError) as error:
        raise ValueError(f"--measured {unreadable(str(file), error)}") from None
    if read.mistakes:
        raise ValueError("\n".join(f"{file.name} {mistake}" for mistake in read.mistakes))
    if read.lost:
        raise ValueError(f"{file.name} must have a place in each row, one after each leg; got {read.lost} without")
    return list(zip(read.columns.get("x", ()), read.columns.get("y", ()), strict=True))
