"""Edit: the text of a case file with other values in it, and all else as somebody wrote it."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

from coupling.case.case import Case, read_case
from coupling.case.parsing import CaseError
from coupling.case.table import Table
from coupling.case.writing.text import case_text, commented, write_case, written
from coupling.files import whole_file

Place = tuple[str | int, ...]
FILES: Final = (("plate", "mesh"), ("plate", "motion"), ("friction", "file"))
"""Fields that may name a file, which is counted from the case file's folder."""


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
        partial.write_text(commented(said) + text, encoding="utf-8")
        if not _is(case, partial):
            partial.write_text(commented(said) + case_text(case, path.parent), encoding="utf-8")
    return path


def edited_text(text: str, here: Path, before: Case, after: Case, folder: Path) -> str | None:
    """The text of a case with the values of another; None where that takes more than other values.

    text, here: the file of the first and its folder.  folder: of the file that it is to be.
    """
    import tomlkit  # here, because few commands edit

    file: Any = tomlkit.parse(text)
    try:
        for location, annotation, value in _changes(before, after, ()):
            _put(file, location, None if value is None else written(value, annotation))
    except (_Rewritten, LookupError):  # LookupError: of a lattice
        return None
    for table, key in FILES:
        if isinstance(name := file.get(table, {}).get(key), str):
            file[table][key] = os.path.relpath(here / name, folder)
    return tomlkit.dumps(file)


def _is(case: Case, file: Path) -> bool:
    """Whether a file is that of a case."""
    try:
        found = read_case(file)
    except CaseError:
        return False
    pairs = [(getattr(found, key), getattr(case, key)) for key in _tables()]
    return all(_plain(one) == _plain(other) for one, other in pairs)


def _plain(table: Any) -> Any:
    """A table whose files are named in one way."""
    names = {key: getattr(table, key, None) for _, key in FILES}
    update = {key: os.path.abspath(name) for key, name in names.items() if isinstance(name, str)}
    return table.model_copy(update=update) if update else table


def _tables() -> list[str]:
    return [key for key in Case.model_fields if key not in ("name", "source", "lattice")]


def _changes(before: Any, after: Any, location: Place) -> Iterator[tuple[Place, Any, Any]]:
    """Yield where a table differs from another: the place, the annotation of its field, and the value."""
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
            yield here, type(after).model_fields[key].rebuild_annotation(), new


def _put(file: Any, location: Place, value: str | None) -> None:
    """Give a key a value, as TOML; None: take it away."""
    import tomlkit
    from tomlkit.items import AbstractTable, AoT, InlineTable

    table, key = file, str(location[-1])
    for step in location[:-1]:
        table = table[step]
    if value is None:
        table.pop(key, None)
    elif key in table or isinstance(table, InlineTable):
        table[key] = tomlkit.value(value)
    else:
        # tomlkit puts a new key below the comments that precede the next table.
        lines = [item for name, item in table.value.body if name and not isinstance(item, AbstractTable | AoT)]
        if not lines:
            raise _Rewritten
        lines[-1].trivia.trail += f"{key} = {value}\n"
