"""Examples: case, study and aim files that come with the program, each with the files that it reads."""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

HERE: Final = Path(__file__).resolve().parent
NAMED: Final = (("study", "case"), ("study", "points"), ("aim", "case"), ("plate", "mesh"), ("plate", "motion"))
"""Tables and keys that name other files."""
COMMANDS: Final = {"study": "sweep", "aim": "aim", "parts": "run", "case": "run"}
"""The command for a kind of file."""


def examples_folder() -> Path:
    """Where the examples are: in the installed package, or beside it where that is a working copy."""
    inside = HERE / "examples"
    return inside if inside.is_dir() else HERE.parent / "examples"


def example_names() -> dict[str, str]:
    """What each example is about, the first sentence of its comment, by its name: studies/starts."""
    folder = examples_folder()
    files = sorted(folder.rglob("*.toml"), key=lambda file: (len(file.relative_to(folder).parts), file.as_posix()))
    return {file.relative_to(folder).with_suffix("").as_posix(): _about(file) for file in files}


def example_files(name: str) -> list[Path]:
    """The files of an example, from the folder of all: its own and those that it reads; ValueError for no example."""
    from coupling import near

    names = example_names()
    if name not in names:
        meant = near(name.removesuffix(".toml"), names)
        hint = f"did you mean {meant}?" if meant else f"there are {', '.join(names)}"
        raise ValueError(f"Input name of example must be one of the examples; got {name}; {hint}")
    folder = examples_folder()
    files = dict.fromkeys(_read(folder / f"{name}.toml"))
    return [file.resolve().relative_to(folder.resolve()) for file in files]


def write_example(name: str, folder: Path) -> dict[Path, bool]:
    """Write the files of an example into a folder, as they lie beside each other.

    Returns whether each was written, or was there already with the same content. Raises ValueError where there is no
    such example, or something else is in the place of a file.
    """
    contents = {folder / file: (examples_folder() / file).read_bytes() for file in example_files(name)}
    written = {path: not _has(path, content) for path, content in contents.items()}
    files = [place for path in contents for place in path.parents if os.path.lexists(place) and not place.is_dir()]
    files += [path for path, new in written.items() if new and os.path.lexists(path)]
    if taken := [str(path) for path in dict.fromkeys(files)]:
        are = "are" if len(taken) > 1 else "is"
        raise ValueError(
            f"Input name of example must be one whose files are free; {', '.join(taken)} {are} something else already"
        )
    for path, new in written.items():
        if new:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(contents[path])
    return written


def command_of(name: str) -> str:
    """The command that an example is for, with its words: the one in its comment, else by its kind."""
    text = (examples_folder() / f"{name}.toml").read_text(encoding="utf-8")
    if found := re.search(r"^# +active-surface (\w+) \S+(.*)$", text, re.MULTILINE):
        return f"{found[1]} {name}.toml{found[2]}"
    return f"{COMMANDS[kind_of(name)]} {name}.toml"


def kind_of(name: str) -> str:
    """What an example is: a "study", an "aim", a "case", or one of many "parts"."""
    tables = tomllib.loads((examples_folder() / f"{name}.toml").read_text(encoding="utf-8"))
    return next((kind for kind in ("study", "aim", "parts") if kind in tables), "case")


def _has(path: Path, content: bytes) -> bool:
    return path.is_file() and path.read_bytes() == content


def _read(file: Path) -> Iterator[Path]:
    """Yield a file and those that it names."""
    yield file
    tables: dict[str, Any] = tomllib.loads(file.read_text(encoding="utf-8"))
    for table, key in NAMED:
        name = tables.get(table, {}).get(key)
        if isinstance(name, str):
            other = file.parent / name
            yield from _read(other) if other.suffix == ".toml" else [other]


def _about(file: Path) -> str:
    comments: list[str] = []
    for line in file.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            break
        comments.append(line.strip("# "))
    return re.split(r"(?<=[.?]) ", " ".join(comments))[0].rstrip(".")
