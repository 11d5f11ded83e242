"""Edit the text of a case file: put other values into it, and leave all else to the byte."""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from coupling.case.actuators import ActuatorCase, LatticeCase, outside
from coupling.case.case import Case, read_case
from coupling.case.fields import lattice_of
from coupling.case.scaled import rounded
from coupling.case.table import Location, Table, value_at
from coupling.case.tables import CaseTables
from coupling.case.toml_file import CaseError
from coupling.case.toml_text import TomlText
from coupling.case.values import LONGEST, kinds_of_items
from coupling.case.writing.text import FILES, block, case_text, commented, write_case, written
from coupling.files import whole_file

Actuators = tuple[ActuatorCase, ...]


class _Rewritten(Exception):
    """The file cannot be edited: it lacks a table, or has another."""


def write_edited(case: Case, like: Case, folder: Path, path: Path, said: str = "") -> Path:
    """Writes a case as `write_case` does, with the comments, order and words of a file where it has other values only.

    like, folder: the case that was read from that file, and the folder that it is in.
    """
    text = None if like.source is None else edited_text(like.source, folder, like, case, path.parent)
    if text is None:
        return write_case(case, path, said)
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole_file(path) as partial:
        partial.write_text(commented(said) + text, encoding="utf-8", newline="")
        if not _is(case, partial):
            partial.write_text(commented(said) + case_text(case, path.parent), encoding="utf-8")
    return path


def edited_text(text: str, here: Path, before: Case, after: Case, folder: Path) -> str | None:
    """The text of a case with the values of another; None where that takes more than other values.

    text, here: the file of the first and its folder.  folder: of the file that it is to be.
    """
    try:
        file = TomlText(text)
        alone = _put_lattice(file, before, after, folder)
        one, other = (
            case.model_copy(update={"actuators": some}) for case, some in zip((before, after), alone, strict=True)
        )
        for key, field in CaseTables.model_fields.items():
            for change in _changes(getattr(one, key), getattr(other, key), field.rebuild_annotation(), (key,)):
                _put(file, *change)
        for location in FILES if here.resolve() != folder.resolve() else ():
            if isinstance(name := value_at(file.tables, location), str):
                file.put(location, json.dumps(os.path.relpath(here / name, folder), ensure_ascii=False))
    except (_Rewritten, LookupError):
        return None
    return str(file)


def _is(case: Case, file: Path) -> bool:
    """Whether a file has a case, with its actuators in any order."""
    try:
        found = read_case(file)
    except CaseError:
        return False
    return _in_order(found, file.parent) == _in_order(case, file.parent)


def _in_order(case: Case, folder: Path) -> str:
    """The text of a case whose actuators stand in the order of their places."""
    actuators = sorted(map(_shortly, case.actuators), key=lambda one: one.position)
    return case_text(case.model_copy(update={"actuators": tuple(actuators)}), folder)


def _shortly(actuator: ActuatorCase) -> ActuatorCase:
    """An actuator to 12 digits, as one of a lattice has places and drives that follow from others."""
    floats = {key: rounded(value) for key, value in actuator if isinstance(value, float)}
    return actuator.model_copy(update={**floats, "position": tuple(map(rounded, actuator.position))})


def _changes(old: Any, new: Any, annotation: Any, location: Location) -> Iterator[tuple[Location, Any, Any, Any]]:
    """Yield where a value differs from another in it: the place, the annotation of its field, and the two values."""
    if old == new:
        return
    if isinstance(new, Table):
        if type(old) is not type(new):
            raise _Rewritten
        for key, field in type(new).model_fields.items():
            yield from _changes(getattr(old, key), getattr(new, key), field.rebuild_annotation(), (*location, key))
    elif isinstance(new, tuple) and new and isinstance(new[0], Table):
        if old is None or len(old) != len(new):
            raise _Rewritten
        for index, pair in enumerate(zip(old, new, strict=True)):
            yield from _changes(*pair, None, (*location, index))
    else:
        yield location, annotation, old, new


def _put(file: TomlText, at: Location, annotation: Any, old: Any, new: Any) -> None:
    """Give a key, or an item of a list, another value; of a list as long as it was only the items that differ."""
    there = value_at(file.tables, at)
    if new is None:
        file.remove(at)
    elif isinstance(there, list) and isinstance(new, tuple) and len(there) == len(new) == len(old):
        for index, kind in enumerate(kinds_of_items(annotation, len(new))):
            if new[index] != old[index]:
                _put(file, (*at, index), kind, old[index], new[index])
    else:
        file.put(at, written(new, annotation, there))


def _put_lattice(file: TomlText, before: Case, after: Case, folder: Path) -> tuple[Actuators, Actuators]:
    """Give a lattice what its actuators have now; returns those that are given one by one, before and after.

    What most of them have becomes the lattice's. Others are left out of it, and get tables of their own; where that is
    most of them, there is no lattice any more.
    """
    lattice, alone = lattice_of(before)
    old, new = before.actuators[alone:], after.actuators[alone:]
    if lattice is None or old == new:
        return before.actuators, after.actuators
    usual = _usual(old, new)
    made = tuple(one.model_copy(update=usual) for one in old)
    kept = {*made} & {*after.actuators}
    where = outside(lattice, [one.position for one in made if one not in kept])
    whole = 2 * len(kept) < len(made) or len(where) > LONGEST
    others = tuple(one for one in after.actuators if whole or one not in kept)
    if len(others) < alone:
        raise _Rewritten
    units = {**lattice, "position": lattice["pitch"]}
    placed = [one.model_copy(update={"position": _shortly(one).position}) for one in others[alone:]]
    tables = "\n\n".join(block("actuators", one, folder, units, brackets=2) for one in placed)
    lines = [span for location, span in file.statements.items() if location[0] == "lattice"]
    if whole:
        file.replace(lines[0][0], lines[-1][1], tables)
        return before.actuators[:alone], others[:alone]
    for key, value in usual.items():
        _put(file, ("lattice", key), ActuatorCase.model_fields[key].rebuild_annotation(), getattr(old[0], key), value)
    if where != lattice.get("where", ""):
        file.put(("lattice", "where"), json.dumps(where))
    if tables:
        singles = [span for location, span in file.statements.items() if location[0] == "actuators"]
        file.insert((singles or lines)[-1][1], "\n" + tables)
    return before.actuators[:alone], others[:alone]


def _usual(old: Actuators, new: Actuators) -> dict[str, Any]:
    """What more of some actuators have in common now than have what they had."""
    usual = {}
    for key in LatticeCase.model_fields.keys() & ActuatorCase.model_fields.keys() if len(old) == len(new) else ():
        value, count = Counter(getattr(one, key) for one in new).most_common(1)[0]
        if count > sum(getattr(one, key) == getattr(other, key) for one, other in zip(old, new, strict=True)):
            usual[key] = value
    return usual
