"""What a path that is no result of a run leads to, and what to name in its place."""

from __future__ import annotations

from pathlib import Path

from coupling.case import parse
from coupling.suggestion import near

MAX_NAMES = 3  # of results in a folder
SHOWN = "`active-surface view` and `active-surface plot` show"
KINDS = {
    ".toml": "a case file: name the result, such as results/{name} after `active-surface run`",
    "study": f"a study file: it is of a sweep, whose result {SHOWN}",
    "aim": "an aim file: name the result of the case file that `active-surface aim` writes",
    ".vtkhdf": "whose name is no result's: those end in .plate.vtkhdf and .part.vtkhdf",
    **dict.fromkeys((".msh", ".vtu", ".xdmf"), "which is a mesh: name the result of a case that has it"),
    ".nc": f"which is of a sweep: {SHOWN} it",
}


def described(path: Path, endings: tuple[str, ...]) -> str | None:
    """What a file or folder is that is no result of a run; None: there is nothing.

    endings: those of the files of runs.
    """
    if path.is_dir():
        names = _names(path, endings)
        some = ", ".join(str(path / name) for name in names[:MAX_NAMES]) + ", ..." * (len(names) > MAX_NAMES)
        return f"a folder: name a result in it: {some}" if names else "a folder, in which there is no result of a run"
    if not path.is_file():
        return None
    kind = _kind(path)
    if kind in KINDS:
        return KINDS[kind].format(name=path.stem)
    if path.stem in _names(path.parent, endings):
        return f"which is beside a result: name {path.with_suffix('')}"
    return "which is another file"


def meant(path: Path, endings: tuple[str, ...]) -> str:
    """The result that a mistyped name stands for, as a question to add; empty where there is none like it."""
    name = near(path.name, [name for name in _names(path.parent, endings) if name != path.name])
    return f"; did you mean {path.with_name(name)}?" if name else ""


def _names(folder: Path, endings: tuple[str, ...]) -> list[str]:
    """The names of the results in a folder."""
    files = [file.name for file in folder.iterdir()] if folder.is_dir() else []
    plain = sorted(endings, key=len, reverse=True)  # NAME.partial.part.vtkhdf is of NAME
    ended = ((file, next((ending for ending in plain if file.endswith(ending)), "")) for file in files)
    return sorted({file.removesuffix(ending) for file, ending in ended if ending})


def _kind(path: Path) -> str:
    try:
        tables = parse(path).tables if path.suffix == ".toml" else {}
    except ValueError:  # no TOML
        return path.suffix
    return next((table for table in ("study", "aim") if table in tables), path.suffix)
