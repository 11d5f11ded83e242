"""Edit the text of a case file: put other values into it, and leave all else to the byte."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from coupling.case.actuators import ActuatorCase, LatticeCase
from coupling.case.case import Case, read_case
from coupling.case.fields import lattice_of
from coupling.case.table import Location, Table, value_at
from coupling.case.tables import CaseTables
from coupling.case.toml_file import CaseError
from coupling.case.toml_text import TomlText
from coupling.case.values import kinds_of_items
from coupling.case.writing.text import FILES, block, case_text, commented, write_case, written
from coupling.files import whole_file


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
        whole = case_text(case, path.parent)
        if _whole_text_of(partial) != whole:
            partial.write_text(commented(said) + whole, encoding="utf-8")
    return path


def edited_text(text: str, here: Path, before: Case, after: Case, folder: Path) -> str | None:
    """The text of a case with the values of another; None where that takes more than other values.

    text, here: the file of the first and its folder.  folder: of the file that it is to be.
    """
    try:
        file = TomlText(text)
        alone = _put_lattice(file, before, after, folder)
        one, other = (case.model_copy(update={"actuators": case.actuators[:alone]}) for case in (before, after))
        for key, field in CaseTables.model_fields.items():
            for change in _changes(getattr(one, key), getattr(other, key), field.rebuild_annotation(), (key,)):
                _put(file, *change)
        for location in FILES if here.resolve() != folder.resolve() else ():
            if isinstance(name := value_at(file.tables, location), str):
                file.put(location, json.dumps(os.path.relpath(here / name, folder), ensure_ascii=False))
    except (_Rewritten, LookupError):
        return None
    return str(file)


def _whole_text_of(file: Path) -> str | None:
    """The case in a file as `write_case` would write it; None: there is none."""
    try:
        return case_text(read_case(file), file.parent)
    except CaseError:
        return None


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


def _put_lattice(file: TomlText, before: Case, after: Case, folder: Path) -> int | None:
    """Give a lattice what all of its actuators have now; where they differ, tables of their own replace it.

    Returns how many actuators the file has one by one; None: all.
    """
    lattice, alone = lattice_of(before)
    if lattice is None:
        return None
    old, new = before.actuators[alone:], after.actuators[alone:]
    shared = ActuatorCase.model_fields.keys() & LatticeCase.model_fields.keys()
    same = {key: getattr(new[0], key) for key in shared if len({getattr(one, key) for one in new}) == 1}
    if tuple(one.model_copy(update=same) for one in old) == new:
        for key, value in same.items():
            if any(getattr(one, key) != value for one in old):
                _put(file, ("lattice", key), ActuatorCase.model_fields[key].rebuild_annotation(), None, value)
    else:
        units = {**lattice, "position": lattice["pitch"]}
        lines = [span for location, span in file.statements.items() if location[0] == "lattice"]
        tables = "\n\n".join(block("actuators", one, folder, units, brackets=2) for one in new)
        file.replace(lines[0][0], lines[-1][1], tables)
    return alone
