"""Edit: the text of a case file with other values in it, and all else as somebody wrote it."""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from coupling.case.actuators import ActuatorCase, LatticeCase, outside
from coupling.case.case import Case, read_case
from coupling.case.fields import lattice_of
from coupling.case.scaled import rounded
from coupling.case.table import Location, Table
from coupling.case.toml_file import CaseError
from coupling.case.toml_text import TomlText
from coupling.case.values import LONGEST
from coupling.case.writing.text import FILES, block, case_text, commented, items_of, write_case, written
from coupling.files import whole_file

Actuators = tuple[ActuatorCase, ...]


class _Rewritten(Exception):
    """The changes are no other values of what stands in a file."""


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
        for location, annotation, old, new in _changes(one, other, ()):
            _put(file, location, annotation, old, new)
        for location in FILES if here.resolve() != folder.resolve() else ():
            if isinstance(name := file.value(location), str):
                file.put(location, json.dumps(os.path.relpath(here / name, folder), ensure_ascii=False))
    except (_Rewritten, LookupError):
        return None
    return str(file)


def _is(case: Case, file: Path) -> bool:
    """Whether a file is that of a case."""
    try:
        found = read_case(file)
    except CaseError:
        return False
    pairs = [(getattr(found, key), getattr(case, key)) for key in _tables()]
    return all(_plain(one) == _plain(other) for one, other in pairs)


def _plain(table: Any) -> Any:
    """A table whose files are named in one way, or actuators in one order."""
    if isinstance(table, tuple):
        return sorted(map(_shortly, table), key=lambda one: one.position)
    names = {key: getattr(table, key, None) for _, key in FILES}
    update = {key: os.path.abspath(name) for key, name in names.items() if isinstance(name, str)}
    return table.model_copy(update=update) if update else table


def _shortly(actuator: ActuatorCase) -> ActuatorCase:
    """An actuator to 12 digits, as one of a lattice has places and drives that follow from others."""
    floats = {key: rounded(value) for key, value in actuator if isinstance(value, float)}
    return actuator.model_copy(update={**floats, "position": tuple(map(rounded, actuator.position))})


def _tables() -> list[str]:
    return [key for key in Case.model_fields if key not in ("name", "source", "lattice")]


def _changes(before: Any, after: Any, location: Location) -> Iterator[tuple[Location, Any, Any, Any]]:
    """Yield where a table differs from another: the place, the annotation of its field, and the two values."""
    if type(before) is not type(after):
        raise _Rewritten
    for key in _tables() if not location else type(after).model_fields:
        old, new, here = getattr(before, key), getattr(after, key), (*location, key)
        if old == new:
            continue
        if isinstance(new, Table):
            yield from _changes(old, new, here)
        elif isinstance(new, tuple) and new and isinstance(new[0], Table):
            if old is None or len(old) != len(new):
                raise _Rewritten
            for index, pair in enumerate(zip(old, new, strict=True)):
                yield from _changes(*pair, (*here, index))
        else:
            yield here, type(after).model_fields[key].rebuild_annotation(), old, new


def _put(file: TomlText, at: Location, annotation: Any, old: Any, new: Any, marks: Sequence[Any] = ()) -> None:
    """Give a key, or an item of a list, another value; of a list as long as it was only the items that differ.

    marks: as of `written`.
    """
    there = file.value(at)
    if new is None:
        file.remove(at)
    elif isinstance(there, list) and isinstance(new, tuple) and len(there) == len(new) == len(old):
        for index, (item, kind, shared) in enumerate(items_of(new, annotation)):
            if item != old[index]:
                _put(file, (*at, index), kind, old[index], item, shared)
    else:
        file.put(at, written(new, annotation, there, marks))


def _put_lattice(file: TomlText, before: Case, after: Case, folder: Path) -> tuple[Actuators, Actuators]:
    """Give a lattice what its actuators have now; returns those that are given one by one, before and after.

    What most of them have becomes the lattice's. Others are left out of it, and get tables of their own; where that is
    most of them, there is no lattice any more.
    """
    lattice, alone = lattice_of(before)
    one_by_one, made = before.actuators[:alone], before.actuators[alone:]
    if lattice is None or made == after.actuators[alone:]:
        return before.actuators, after.actuators
    usual = _usual(made, after.actuators[alone:])
    made = tuple(one.model_copy(update=usual) for one in made)
    kept = {*made} & {*after.actuators}
    where = outside(lattice, [one.position for one in made if one not in kept])
    whole = 2 * len(kept) < len(made) or len(where) > LONGEST
    others = tuple(one for one in after.actuators if whole or one not in kept)
    if len(others) < alone:
        raise _Rewritten
    units = {**lattice, "position": lattice["pitch"]}
    placed = [one.model_copy(update={"position": _shortly(one).position}) for one in others[alone:]]
    blocks = [block("actuators", one, folder, units) for one in placed]
    lines = [one for one in file.statements if one.location[0] == "lattice"]
    if whole:
        file.replace(lines[0].start, lines[-1].end, "\n\n".join(blocks))
        return one_by_one, others[:alone]
    for key, value in usual.items():
        _put(file, ("lattice", key), ActuatorCase.model_fields[key].rebuild_annotation(), None, value)
    if where != lattice.get("where", ""):
        file.put(("lattice", "where"), json.dumps(where))
    if blocks:
        singles = [one for one in file.statements if one.location[0] == "actuators"]
        file.insert((singles or lines)[-1].end, "\n" + "\n\n".join(blocks))
    return one_by_one, others[:alone]


def _usual(old: Actuators, new: Actuators) -> dict[str, Any]:
    """What more of some actuators have in common now than have what they had."""
    usual = {}
    for key in LatticeCase.model_fields.keys() & ActuatorCase.model_fields.keys() if len(old) == len(new) else ():
        value, count = Counter(getattr(one, key) for one in new).most_common(1)[0]
        if count > sum(getattr(one, key) == getattr(other, key) for one, other in zip(old, new, strict=True)):
            usual[key] = value
    return usual
