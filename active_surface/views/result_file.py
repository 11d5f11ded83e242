"""What a file that a user names stands for: the result of a run or of a sweep."""

from __future__ import annotations

import json
from pathlib import Path
from typing import NamedTuple

from active_surface.studies import ENDING
from coupling.case import parse, read_parts
from coupling.results import ENDINGS, SavedRun, is_run, name_of, record_of


class ResultFile(NamedTuple):
    """A result: what its reader wants, and where its page goes."""

    path: Path  # of a run FOLDER/NAME or one of its files, of a sweep its file
    page: Path
    is_sweep: bool
    study: Path | None = None  # the study file that was named


def result_of(path: Path, folder: Path) -> ResultFile:
    """The result that a path stands for; that of a case or study file is in the folder or beside it.

    Raises ValueError when there is none.
    """
    if path.suffix == ".toml":
        return _of_file(path, folder)
    if path.suffix == ENDING:
        return ResultFile(path, path.with_suffix(".sweep.html"), True)
    sweep = path.with_name(path.name + ENDING)
    if sweep.is_file() and not (path.is_file() or is_run(path)):
        return ResultFile(sweep, sweep.with_suffix(".sweep.html"), True)
    return ResultFile(path, path.with_name(f"{name_of(path)}.html"), False)


def is_of(run: SavedRun, path: Path) -> bool:
    """Whether a run is of a case that a case file states now; raises ValueError or OSError where that is no case."""
    then = record_of(run.case)
    cases = [record_of(case) for case in read_parts(path)]
    return any(json.loads(now.text) == json.loads(then.text) and dict(now.files) == dict(then.files) for now in cases)


def part_of(run: SavedRun) -> str:
    """The name of the part of a run of many."""
    return run.name.removeprefix(f"{name_of(run.plate_path)}.")


def _of_file(path: Path, folder: Path) -> ResultFile:
    tables = parse(path).tables
    expected = f"a result, or a file whose result is in {folder} or beside it"
    if "aim" in tables:
        its = "whose table [aim] is for `active-surface aim`: name the result of the case file that this writes"
        raise ValueError(f"Input RESULT must be {expected}; got {path}, {its}")
    is_sweep = "study" in tables
    endings = (ENDING,) if is_sweep else ENDINGS
    for place in (folder, path.parent):
        for ending in endings:
            file = place / f"{path.stem}{ending}"
            if file.is_file():
                page = place / f"{path.stem}{'.sweep' if is_sweep else ''}.html"
                return ResultFile(file if is_sweep else place / path.stem, page, is_sweep, path if is_sweep else None)
    command = "sweep" if is_sweep else "run"
    raise ValueError(
        f"Input RESULT must be {expected}; got {path}, and no {path.stem}{endings[0]} is there: "
        f"`active-surface {command} {path}` makes it"
    )
