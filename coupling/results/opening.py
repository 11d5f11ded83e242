"""Opening: a result file of a run, one refusal for all that may be wrong with it, and what else a path may lead to."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from common import UNREADABLE
from coupling.environment import versions
from coupling.suggestion import near

EXPECTED = "Input path must be a result of `active-surface run`"
LACKS = re.compile(r"\bobject '([^']+)' doesn't exist|attribute: '([^']+)'")  # as h5py says it
SUFFIX, PARTIAL = ".vtkhdf", ".partial"
KINDS = {"plate": "UnstructuredGrid", "part": "PolyData"}  # and the type of their VTKHDF
ENDINGS = tuple(f"{part}.{kind}{SUFFIX}" for part in ("", PARTIAL) for kind in KINDS)
FINITE = ("points", "time", "position")
MAX_NAMES = 3  # of results in a folder


@contextmanager
def opened(path: Path) -> Iterator[h5py.File]:
    """A file of a run, open; raises ValueError where it is none."""
    try:
        file = h5py.File(path, "r")
    except BlockingIOError as error:  # its writer keeps others out
        raise ValueError(f"{EXPECTED}; got {path}, which is being written: its run has not ended") from error
    except UNREADABLE as error:
        what = f"which is damaged: {_message(error)}" if h5py.is_hdf5(path) else "which is no HDF5 file"
        raise ValueError(f"{EXPECTED}; got {path}, {what}") from error
    with file:
        with readable(path, path):
            ours = "VTKHDF" in file and "run" in getattr(file.get("active_surface"), "attrs", ())
        if not ours:
            raise ValueError(f"{EXPECTED}; got {path}, which is HDF5 but holds something else")
        yield file


@contextmanager
def readable(path: str | os.PathLike[str], part: Path, but: str = "which is damaged") -> Iterator[None]:
    """Raises ValueError, with the file and what is wrong with it, where what is read from it is not as it must be.

    part: the file of the run that names the version that wrote it.
    """
    try:
        yield
    except UNREADABLE as error:
        raise ValueError(f"{EXPECTED}; got {path}, {but}: {_message(error)}{_written(part)}") from error


def _message(error: Exception) -> str:
    """What is wrong, on one line."""
    text = str(error.args[0] if isinstance(error, KeyError) and error.args else error).replace("\n", " ")
    if missing := LACKS.search(text):
        return f"it has no {missing[1] or missing[2]}"
    plain = isinstance(error, ValueError) and not text.startswith(("Unable to", "Can't"))  # words of HDF5
    return text if plain else "it cannot be read to its end, or has another form than a run writes"


def _written(path: Path) -> str:
    """That another version of the program wrote a file, if so."""
    try:
        with h5py.File(path, "r") as file:
            then = json.loads(file["active_surface"].attrs["versions"])["active-surface"]
    except UNREADABLE:
        return ""
    now = versions()["active-surface"]
    return "" if then == now else f"; version {then} wrote it, and this is {now}: run its case again"


def checked_count(name: str, value: Any, most: int | None = None) -> int:
    """A count of the file; raises ValueError unless it is a whole number from 0 to the most that it can be."""
    number = np.asarray(value)
    if number.shape or number.dtype.kind not in "iu" or not 0 <= number <= (np.inf if most is None else most):
        wanted = "not negative" if most is None else f"from 0 to {most}"
        raise ValueError(f"{name} must be a whole number, {wanted}; got {number.tolist()!r}")
    return int(number)


def checked_cells(points: NDArray[Any], corners: NDArray[Any]) -> NDArray[np.int64]:
    """The triangles (m, 3) of corners (3 m,), rows of points; raises ValueError where these are no mesh."""
    check_numbers("the plate", {"Points": points}, {"Points": (len(points), 3)})
    if corners.dtype.kind not in "iu" or corners.ndim != 1 or not corners.size or corners.size % 3:
        raise ValueError("Connectivity must be whole numbers, three a triangle")
    if corners.min() < 0 or corners.max() >= len(points):
        raise ValueError(f"a triangle has a corner that is none of the {len(points)} points")
    return corners.reshape(-1, 3)


def check_numbers(owner: str, arrays: Mapping[str, Any], shapes: Mapping[str, tuple[int, ...]]) -> None:
    """Raise ValueError unless these arrays are real numbers of these shapes, and places and times are finite."""
    for name, shape in shapes.items():
        array = np.asarray(arrays[name])
        if array.shape != shape:
            raise ValueError(f"{owner} has {name} of the shape {array.shape}, not {shape}")
        if array.dtype.kind not in "iuf":
            raise ValueError(f"{name} must be real numbers")
        if name.lower() in FINITE and not np.isfinite(array).all():
            raise ValueError(f"{name} has a number that is not finite")


def described(path: Path) -> str | None:
    """What a file or folder is that is no result of a run; None: there is nothing."""
    if path.is_dir():
        names = _names(path)
        some = ", ".join(str(path / name) for name in names[:MAX_NAMES]) + ", ..." * (len(names) > MAX_NAMES)
        return f"a folder: name a result in it: {some}" if names else "a folder, in which there is no result of a run"
    if not path.is_file():
        return None
    if path.stem in _names(path.parent):
        return f"which is beside a result: name {path.with_suffix('')}"
    if path.suffix == ".toml":
        return f"which is input: name its result, such as results/{path.stem} after `active-surface run`"
    return f"which is another file: those of a run end in {ENDINGS[0]} and {ENDINGS[1]}"


def meant(path: Path) -> str:
    """The result that a mistyped name stands for, as a question to add; empty where there is none like it."""
    name = near(path.name, [name for name in _names(path.parent) if name != path.name])
    return f"; did you mean {path.with_name(name)}?" if name else ""


def _names(folder: Path) -> list[str]:
    """The names of the results in a folder."""
    files = folder.glob(f"*{SUFFIX}") if folder.is_dir() else ()
    return sorted({split(file)[0] for file in files if split(file)[1]})


def split(path: Path) -> tuple[str, str | None, bool]:
    """A file's NAME, its kind, None where the path is FOLDER/NAME, and whether it is a partial one."""
    for kind in KINDS:
        name = path.name.removesuffix(f".{kind}{SUFFIX}")
        if name != path.name:
            return name.removesuffix(PARTIAL), kind, name.endswith(PARTIAL)
    return path.name, None, False
