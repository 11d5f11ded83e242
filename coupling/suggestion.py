"""What somebody may have meant by a word that is not known."""

from __future__ import annotations

import difflib
import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final

from coupling.synonyms import choices, synonyms

LIKE: Final = 0.65  # share of letters; less is another word


def near(word: str, known: Iterable[str]) -> str | None:
    """The known word that another stands for, is the only one to begin with, or is most like; None: there is none."""
    there = list(known)
    meant = [synonym.keys[0] for synonym in synonyms(word, there)]
    return next(iter([*meant, *choices(word, there)]), None) or alike(word, there)


def alike(word: str, known: Iterable[str]) -> str | None:
    """The known word that another is the only one to begin with, or is most like; None: there is none."""
    there, given = list(known), word.strip().lower()
    begun = [choice for choice in there if len(given) > 2 and choice.lower().startswith(given)]
    likely = difflib.get_close_matches(given, there, 1, LIKE)
    return next(iter([*(begun if len(begun) == 1 else ()), *likely]), None)


def same_values(word: str, known: Iterable[str]) -> bool:
    """Whether the key that `near` finds for another has the same values, as a radius has not those of a diameter."""
    return all(synonym.conversion in ("same", "name") for synonym in synonyms(word, [*known])[:1])


def near_file(path: Path, ending: str = ".toml") -> Path | None:
    """The file that is meant by a path at which there is none; None where no file is like it.

    It lacks its ending, a part of it is misspelt, or its folder is left out, which is one or two below.
    """
    if path.suffix != ending and (whole := path.with_name(path.name + ending)).is_file():
        return whole
    try:
        meant = _spelt(path, ending)
        return meant or next(_below(path, ending), None)
    except OSError:  # a folder that may not be read
        return None


def _spelt(path: Path, ending: str) -> Path | None:
    """A path whose parts are the most like those of another, among the files and folders that there are."""
    meant = Path(path.anchor)
    *folders, name = path.parts[1 if path.anchor else 0 :]
    for folder in folders:
        names = (
            [entry.name for entry in meant.iterdir() if entry.is_dir()] if not (meant / folder).is_dir() else [folder]
        )
        likely = difflib.get_close_matches(folder, names, 1)
        if folder != ".." and not likely:
            return None
        meant = meant / (folder if folder == ".." else likely[0])
    if (meant / name).is_file():
        return meant / name
    files = [entry.name for entry in meant.iterdir() if entry.is_file()]
    if name + ending in files:
        return meant / (name + ending)
    known = [file for file in files if file.endswith(ending)]
    likely = [like for one in (name, name + ending) for like in difflib.get_close_matches(one, known, 1, 0.75)]
    return meant / likely[0] if likely else None


def _below(path: Path, ending: str) -> Iterator[Path]:
    """Yield the files of a name in folders below that of a path, hidden ones left out, the nearest first."""
    for pattern in ("*/", "*/*/"):
        for name in (path.name, path.name + ending):
            found = path.parent.glob(f"{pattern}{name.translate({ord(c): '?' for c in '[]*'})}")
            yield from (file for file in sorted(found) if file.is_file() and not _hidden(file))


def _hidden(file: Path) -> bool:
    return any(part.startswith(".") and part not in (os.curdir, os.pardir) for part in file.parts)
