"""The files of numbers that an XDMF mesh names: whether meshio can read them without harm."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

from meshes.hdf5 import DEADLY, UNREADABLE, check_hdf5, lacking, survives


def wrong_numbers(path: Path, most: int) -> Iterator[str]:
    """Yield what is wrong with each file of numbers, of at most so many bytes, that the XDMF file at a path names.

    A file that is not XML names none; meshio reports it.
    """
    try:
        items = list(ElementTree.parse(path).iter("DataItem"))
    except (ElementTree.ParseError, LookupError, ValueError, OSError):
        return
    named = {(item.get("Format"), (item.text or "").strip()) for item in items if "Reference" not in item.attrib}
    # As meshio finds them: HDF5 beside the mesh, raw numbers from the folder in which the program runs.
    datasets: dict[Path, set[str]] = {}
    for form, text in named:
        if form == "HDF":
            file, _, name = text.partition(":")
            datasets.setdefault(path.resolve().parent / file, set()).add(name.removeprefix("/"))
    for hdf5, names in sorted(datasets.items()):
        yield from _wrong_file(hdf5, most, sorted(names))
    for raw in sorted({Path(text) for form, text in named if form == "Binary"}):
        yield from _wrong_file(raw, most, None)


def _wrong_file(path: Path, most: int, datasets: list[str] | None) -> Iterator[str]:
    """Yield what is wrong with a file of raw numbers, or one of HDF5 that shall have some datasets."""
    try:
        if not path.is_file():
            yield f"{path} is a folder, a pipe or a device, not a file" if path.exists() else f"{path} is missing"
        elif (size := path.stat().st_size) > most:
            yield f"{path} has {size} bytes; at most {most} are read"
        elif datasets is not None and not survives(path):
            yield f"{path} is damaged: {DEADLY}"
        elif datasets is not None:
            check_hdf5(path)
            for name in lacking(path, datasets):
                yield f"{path} has no data set {name}" if name else f"{path} is named without a data set after a colon"
    except ValueError as error:
        yield f"{path} is refused: {error}"
    except UNREADABLE:
        yield f"{path} is no HDF5 file, or is damaged"
