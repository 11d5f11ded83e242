"""A case as results keep it: every number to the last bit, and the contents of the files that it reads."""

from __future__ import annotations

import atexit
import json
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

from coupling.case import Case, MeshCase, PlatformCase

PATHS = ("mesh", "motion")  # keys of a plate that may name a file


class CaseRecord(NamedTuple):
    """A case: `text` is JSON in SI units, `files` the contents of what it reads, by their names without a folder."""

    text: str
    files: Mapping[str, bytes]


def record_of(case: Case) -> CaseRecord:
    """The record of a case; raises OSError when a file that it reads is gone.

    An XDMF file names those beside it, wherever they are, without a folder.
    """
    tables = case.model_dump(mode="json", exclude_none=True, exclude={"name", "source"})
    for key in PATHS:
        if isinstance(tables["plate"].get(key), str):
            tables["plate"][key] = Path(tables["plate"][key]).name
    return CaseRecord(json.dumps(tables), files_of(case))


def case_of(record: CaseRecord, name: str, source: str | None = None) -> Case:
    """The case of a record, whose files are in a temporary folder until the interpreter ends.

    Raises ValueError when the record holds no case.
    """
    tables, folder = json.loads(record.text), Path(_kept_folder())
    for file, content in record.files.items():
        if Path(file).name != file or (file.lower().endswith(".xdmf") and _leads_elsewhere(content, record.files)):
            raise ValueError(f"its file {file} leads elsewhere")
        (folder / file).write_bytes(content)
    for key in PATHS:
        if isinstance(tables["plate"].get(key), str):
            if tables["plate"][key] not in record.files:
                raise ValueError(f"it lacks the file that plate.{key} names, {tables['plate'][key]}")
            tables["plate"][key] = str(folder / tables["plate"][key])
    if "file" in tables["friction"]:
        raise ValueError("its friction names a file, in place of the points in it")
    return Case(**tables, name=name, source=source)


def _leads_elsewhere(xdmf: bytes, files: Mapping[str, bytes]) -> bool:
    """Whether an XDMF file names numbers that are in none of these files."""
    try:
        root = ElementTree.fromstring(xdmf)
    except (ElementTree.ParseError, LookupError, ValueError):
        return False  # which nobody reads
    binary = any(item.get("Format") == "Binary" for item in root.iter("DataItem"))
    return binary or any(name not in files for _, name in _heavy(root))


def _heavy(root: ElementTree.Element) -> Iterator[tuple[ElementTree.Element, str]]:
    """The items of an XDMF file whose numbers are in an HDF5 file, and the name of that."""
    items = (item for item in root.iter("DataItem") if item.get("Format") == "HDF")
    return ((item, (item.text or "").partition(":")[0].strip()) for item in items)


def files_of(case: Case) -> dict[str, bytes]:
    """The contents of the files that a case reads when its scene is built, by their names without a folder."""
    plate = case.plate
    if isinstance(plate, MeshCase):
        path = Path(plate.mesh)
        return _with_heavy(path) if path.suffix.lower() == ".xdmf" else {path.name: path.read_bytes()}
    if isinstance(plate, PlatformCase) and isinstance(plate.motion, str):
        return {Path(plate.motion).name: Path(plate.motion).read_bytes()}
    return {}


def _with_heavy(path: Path) -> dict[str, bytes]:
    """An XDMF file and those that hold its numbers, which it names by the names that they get."""
    root, kept, contents = ElementTree.fromstring(path.read_bytes()), dict[Path, str](), {path.name: b""}
    for item, name in _heavy(root):
        file = path.resolve().parent / name  # as meshio finds it
        if file not in kept:
            kept[file] = file.name if file.name not in contents else f"{len(kept)}.{file.name}"
            contents[kept[file]] = file.read_bytes()
        item.text = f"{kept[file]}:{(item.text or '').partition(':')[2]}"
    return contents | {path.name: ElementTree.tostring(root)}


def _kept_folder() -> str:
    folder = tempfile.TemporaryDirectory(prefix="active-surface-")
    atexit.register(folder.cleanup)
    return folder.name
