"""A case as results keep it: every number to the last bit, and the contents of the files that it reads."""

from __future__ import annotations

import atexit
import json
import re
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from coupling.case import Case
from coupling.plate_case import MeshCase
from coupling.platform_case import PlatformCase

PATHS = ("mesh", "motion")  # keys of a plate that may name a file
_HEAVY = re.compile(r">\s*([^<>:/\\]+):/")  # what an XDMF file names as holding its numbers


class CaseRecord(NamedTuple):
    """A case: `text` is JSON in SI units, `files` the contents of what it reads, by their names without a folder."""

    text: str
    files: Mapping[str, bytes]


def record_of(case: Case) -> CaseRecord:
    """The record of a case; raises OSError when a file that it reads is gone."""
    tables = case.model_dump(mode="json", exclude_none=True, exclude={"name", "source"})
    for key in PATHS:
        if isinstance(tables["plate"].get(key), str):
            tables["plate"][key] = Path(tables["plate"][key]).name
    return CaseRecord(json.dumps(tables), {file.name: file.read_bytes() for file in files_of(case)})


def case_of(record: CaseRecord, name: str, source: str | None = None) -> Case:
    """The case of a record, whose files are in a temporary folder until the interpreter ends.

    Raises ValueError when the record holds no case.
    """
    tables = json.loads(record.text)
    if record.files:
        folder = Path(_kept_folder())
        for file, content in record.files.items():
            (folder / Path(file).name).write_bytes(content)
        for key in PATHS:
            if isinstance(tables["plate"].get(key), str):
                tables["plate"][key] = str(folder / Path(tables["plate"][key]).name)
    return Case.model_validate(tables | {"name": name, "source": source})


def files_of(case: Case) -> list[Path]:
    """The files that a case reads when its scene is built."""
    plate = case.plate
    if isinstance(plate, MeshCase):
        path = Path(plate.mesh)
        return [path, *_beside(path)]
    return [Path(plate.motion)] if isinstance(plate, PlatformCase) and isinstance(plate.motion, str) else []


def _beside(path: Path) -> list[Path]:
    """The files beside an XDMF file that hold its numbers."""
    if path.suffix.lower() != ".xdmf":
        return []
    names = dict.fromkeys(match.strip() for match in _HEAVY.findall(path.read_text(encoding="utf-8", errors="replace")))
    return [path.with_name(name) for name in names if path.with_name(name).is_file()]


def _kept_folder() -> str:
    folder = tempfile.TemporaryDirectory(prefix="active-surface-")
    atexit.register(folder.cleanup)
    return folder.name
