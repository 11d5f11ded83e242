"""Opening: a result file of a run, and one refusal for all that may be wrong with it."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import h5py
from pydantic import ValidationError

from common import UNREADABLE
from coupling.environment import versions

EXPECTED = "Input path must be a result of `active-surface run`"
LACKS = re.compile(r"\bobject '([^']+)' doesn't exist|attribute: '([^']+)'")
OF_HDF5 = re.compile(r"(?:Unable to|Can't) (?:synchronously )?[\w ]+ \((.*)\)")
NO_NUMBER = re.compile(r"invalid literal for|could not convert")
FIELDS = re.compile(r"(\w+)\.(?:__init__|__new__)\(\) missing [^:]+: (.+)")
"""How h5py says that something is missing, how it wraps what HDF5 says; what Python says of numbers and records."""


@contextmanager
def opened(path: Path) -> Iterator[h5py.File]:
    try:
        is_hdf5 = bool(h5py.is_hdf5(path))
    except UNREADABLE:
        is_hdf5 = False
    if not is_hdf5:
        raise ValueError(f"{EXPECTED}; got {path}, which is no HDF5 file")
    try:
        file = h5py.File(path, "r")
    except BlockingIOError as error:  # its writer keeps others out
        raise ValueError(f"{EXPECTED}; got {path}, which is being written: its run has not ended") from error
    except UNREADABLE as error:
        raise ValueError(f"{EXPECTED}; got {path}, which is damaged: {_message(error)}") from error
    with file:
        try:
            ours = "VTKHDF" in file and "run" in getattr(file.get("active_surface"), "attrs", ())
        except UNREADABLE as error:
            raise ValueError(f"{EXPECTED}; got {path}, which is damaged: {_message(error)}") from error
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
    if isinstance(error, ValidationError):
        return ", ".join(f"{'.'.join(map(str, one['loc']))}: {one['msg']}" for one in error.errors())
    text = str(error.args[0] if isinstance(error, KeyError) else error).replace("\n", " ")
    if missing := LACKS.search(text):
        return f"it has no {missing[1] or missing[2]}"
    if lacking := FIELDS.search(text):
        return f"its {lacking[1].lower()} lacks {lacking[2].replace(chr(39), '')}"
    if isinstance(error, (ArithmeticError, AssertionError, AttributeError, IndexError, TypeError, UnicodeError)):
        return "something in it has another form than a run writes"
    if NO_NUMBER.match(text):
        return "something in it that should be a number is none"
    if isinstance(error, (MemoryError, OSError, RuntimeError)) or OF_HDF5.search(text):
        return "it cannot be read to its end"
    return text


def _written(path: Path) -> str:
    """That another version of the program wrote a file, if so."""
    try:
        with h5py.File(path, "r") as file:
            then = json.loads(file["active_surface"].attrs["versions"])["active-surface"]
    except UNREADABLE:
        return ""
    now = versions()["active-surface"]
    return "" if then == now else f"; version {then} wrote it, and this is {now}: run its case again"
