"""The files of numbers that an XDMF mesh names: whether meshio can read them without harm."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

from meshes.hdf5 import DEADLY, UNREADABLE, check_hdf5, survives


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
    for file in sorted({path.resolve().parent / text.split(":")[0] for form, text in named if form == "HDF"}):
        yield from _wrong_file(file, most, hdf5=True)
    for file in sorted({Path(text) for form, text in named if form == "Binary"}):
        yield from _wrong_file(file, most, hdf5=False)


def _wrong_file(path: Path, most: int, hdf5: bool) -> Iterator[str]:
    try:
        if not path.is_file():
            yield f"{path} is a folder, a pipe or a device, not a file" if path.exists() else f"{path} is missing"
        elif (size := path.stat().st_size) > most:
            yield f"{path} has {size} bytes; at most {most} are read"
        elif hdf5 and not survives(path):
            yield f"{path} is damaged: {DEADLY}"
        elif hdf5:
            check_hdf5(path)
    except ValueError as error:
        yield f"{path} is refused: {error}"
    except UNREADABLE:
        yield f"{path} is no HDF5 file, or is damaged"
