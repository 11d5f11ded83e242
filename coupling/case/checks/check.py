"""Checking: every mistake in the tables of a case at once, each file that they name read once."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from coupling.case.actuators import ActuatorCase
from coupling.case.checks.cycles import check_cycles
from coupling.case.checks.kinds import with_meant_kinds
from coupling.case.checks.parts import Parts
from coupling.case.checks.places import check_places, mesh_of, stand_of
from coupling.case.friction import Points, TableCase, read_points
from coupling.case.mistakes import Mistake
from coupling.case.plates import PLATFORM, PlatformCase, kind, outline_of, platform_of
from coupling.case.table import errors_of, right_value, validate
from coupling.case.tables import CaseTables, RunCase


class Checked(NamedTuple):
    """What the tables of a case are."""

    tables: CaseTables | None  # None where a field is wrong
    points: Points | None  # of a measured friction law, from its file
    lattice: tuple[ActuatorCase, ...]  # what the lattice stands for
    errors: list[Any]  # all mistakes, in the form of pydantic's errors


def check(written: Mapping[str, Any], context: Any = None) -> Checked:
    """Check the tables of a case, in plain values or as models.

    context: UNITS_REQUIRED for those of a file, with its `folder`, where other files are.
    """
    written, in_kinds = with_meant_kinds(written)
    if kind(written.get("plate")) == PLATFORM or written.get("lattice") is not None:
        written = {"actuators": ()} | written
    tables, errors = validate(CaseTables, dict(written), context)
    parts = Parts(dict(tables) if tables else written, written, context)
    points, in_points = _friction_points(parts)
    lattice, misplaced = _places(parts, errors)
    misplaced += check_cycles(parts, lattice)
    reported = {error["loc"] for error in errors}
    errors += errors_of(mistake for mistake in (*in_kinds, *in_points, *misplaced) if mistake[0] not in reported)
    return Checked(tables, points, lattice, errors)


def _friction_points(parts: Parts) -> tuple[Points | None, list[Mistake]]:
    """The points in the file of a measured friction law, if it has one, and what is wrong with that."""
    law = parts.tables.get("friction")
    if not isinstance(law, TableCase) and not (isinstance(law, dict) and law.get("model") == "table"):
        return None, []
    file = right_value(TableCase, "file", law, parts.context)
    if file is None:
        return None, []
    points, wrong = read_points(Path(file))
    return points, [(("friction", "table", "file"), message) for message in wrong]


def _places(parts: Parts, errors: list[Any]) -> tuple[tuple[ActuatorCase, ...], list[Mistake]]:
    """The actuators of the lattice, none where it is wrong, and what does not fit the plate or platform."""
    plate = parts.tables.get("plate")
    platform = platform_of(plate, parts.context)
    if platform:
        return (), _on_platform(parts, platform)
    mistakes: list[Mistake] = []
    if parts.tables.get("actuators") in ((), []) and parts.tables.get("lattice") is None:
        mistakes.append((("actuators",), "must be at least one table, written [[actuators]]; got none"))
    in_plate = [error["loc"] for error in errors if error["loc"][0] == "plate"]  # then the kind of plate, and the key
    outline = outline_of(plate, {location[2] for location in in_plate if len(location) > 2}, parts.context)
    mesh, wrong = mesh_of(outline) if outline else (None, [])
    mistakes += wrong
    stand = stand_of(parts, mesh)
    mistakes += stand.mistakes if stand else []
    if outline and mesh:
        mistakes += check_places(parts, outline, mesh, stand)
    return (stand.actuators if stand else ()), mistakes


def _on_platform(parts: Parts, platform: PlatformCase) -> list[Mistake]:
    mistakes: list[Mistake] = [
        ((key,), f"must not be given with {PLATFORM}, which moves as a whole")
        for key, absent in (("actuators", ((), [])), ("lattice", (None,)))
        if parts.tables.get(key) not in absent
    ]
    run = parts.tables.get("run")
    if right_value(RunCase, "start", run, parts.context) == "steady":
        mistakes.append((("run", "start"), f'must be "rest" with {PLATFORM}, which does not vibrate; got "steady"'))
    return mistakes + list(platform.mistakes(right_value(RunCase, "duration", run, parts.context)))
