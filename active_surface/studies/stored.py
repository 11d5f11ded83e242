"""What the file of a sweep's results holds, read back; and whether it is whole."""

from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final, NamedTuple

import h5netcdf
import h5py
import numpy as np
from numpy.typing import NDArray

from active_surface.studies.record import COLUMNS, KIND, OUTCOMES, Records
from active_surface.studies.study import Study
from common import UNREADABLE, check_hdf5, survives

KIND_ATTRIBUTE: Final = "active-surface sweep"
AT_ONCE: Final = 65536  # points whose coordinates or records are read or written together
TEXTS: Final = ("key", "study", "case", "sampling", "axes")
JSON_TEXTS: Final = {"traits": dict, "versions": dict, "stream": list}
LOST: Final = "it cannot be read to its end"
Slab = tuple[slice, ...]


class _DamageError(ValueError):
    """What is wrong with a file, in our words."""


def stored_records(path: Path) -> Iterator[tuple[int, Records]]:
    """Yield the number of the first path of each lot of records in a file, and the records."""
    with h5netcdf.File(path, "r") as file:
        shape = file["outcome"].shape
        if 0 in shape:
            raise _DamageError("it has no points")
        count = math.prod(shape)
        for start in range(0, count, AT_ONCE):
            stop = min(start + AT_ONCE, count)
            records, first = np.empty(stop - start, KIND), 0
            for slab, length in slabs(shape, start, stop):
                for name in COLUMNS:
                    records[name][first : first + length] = file[name][slab].ravel()
                first += length
            yield start, records


@contextmanager
def whole(path: Path) -> Iterator[None]:
    """Raise ValueError, which names the file, where what is read from it in the block is not as it must be."""
    try:
        yield
    except UNREADABLE as error:
        what = str(error) if isinstance(error, _DamageError) else LOST
        raise ValueError(f"{path}: is a sweep that is damaged: {what}; remove it and sweep again") from error


def key_of(path: Path) -> str | None:
    """The key of the study whose results a file holds; None: there is no such file.

    Raises ValueError when the results are damaged.
    """
    if not path.is_file() or not survives(path):
        return None
    try:
        with h5py.File(path, "r") as file:  # h5netcdf prints a traceback where it cannot open one
            if file.attrs.get("kind") != KIND_ATTRIBUTE:
                return None
    except UNREADABLE:
        return None
    with whole(path):
        return _checked_key(path)


def _checked_key(path: Path) -> str:
    """The key; raises _DamageError, or any of UNREADABLE, where the file is not as `write_dataset` makes it."""
    try:
        check_hdf5(path)
    except UnicodeError:
        raise
    except ValueError as error:
        raise _DamageError(str(error)) from None
    with h5netcdf.File(path, "r") as file:
        for name in TEXTS:
            if not isinstance(file.attrs.get(name), str):
                raise _DamageError(f"it has no text {name}")
        for name, kind in JSON_TEXTS.items():
            if name in file.attrs and not isinstance(json.loads(file.attrs[name]), kind):
                raise _DamageError(f"its {name} are no {kind.__name__}")
        tomllib.loads(file.attrs["study"])
        for name in ("rim", "actuators"):
            numbers = np.asarray(file.attrs.get(name, []))
            if numbers.ndim > 1 or (numbers.size and numbers.dtype.kind != "f") or numbers.size % 2:
                raise _DamageError(f"its {name} has no places")
        shape = file["outcome"].shape
        points = {"grid": shape[: len(file.attrs["axes"].split())]}.get(file.attrs["sampling"], shape[:1])
        for number, name in enumerate(file.attrs["axes"].split()):
            grid = file.attrs["sampling"] == "grid"
            values = file[name]
            if not isinstance(values.attrs["field"], str) or values.shape != points[number if grid else 0 :][:1]:
                raise _DamageError(f"its axis {name} does not fit its results")
            if values.dtype.kind == "f" and not np.isfinite(values[...]).all():
                raise _DamageError(f"its axis {name} has a number that is not finite")
        for name, column in COLUMNS.items():
            if file[name].shape != shape or np.dtype(file[name].dtype) != np.dtype(column.kind):
                raise _DamageError(f"its {name} does not fit its outcomes")
        key = str(file.attrs["key"])
    for _, records in stored_records(path):
        if not ((records["outcome"] >= 0) & (records["outcome"] < len(OUTCOMES))).all():
            raise _DamageError("it has an outcome that there is not")
    return key


def differences(study: Study, path: Path) -> list[str]:
    """In what a study differs from the one whose results a file holds."""
    with h5netcdf.File(path, "r") as file:
        known = json.loads(file.attrs.get("traits", "{}"))
    return [name for name, trait in study.traits.items() if known.get(name) != trait]


class Coordinates(NamedTuple):
    """The points whose results a file holds, as it has them."""

    axes: list[tuple[str, NDArray[Any]]]  # the field of each axis, and its values: of a grid each once
    sampling: str
    repeats: int
    stream: tuple[float, int | None]  # as of `Points`
    heights: str


def stored_coordinates(path: Path) -> Coordinates | None:
    """The points of the results in a file; None: it does not have all of them."""
    with h5netcdf.File(path, "r") as file:
        if not {"stream", "heights"} <= set(file.attrs):
            return None
        variables = [file[name] for name in str(file.attrs["axes"]).split()]
        jitter, seed = json.loads(str(file.attrs["stream"]))
        return Coordinates(
            [(str(variable.attrs["field"]), _plain(variable[...])) for variable in variables],
            str(file.attrs["sampling"]),
            file.dimensions["repeat"].size if "repeat" in file.dimensions else 1,
            (jitter, seed),
            str(file.attrs["heights"]),
        )


def _plain(values: NDArray[Any]) -> NDArray[Any]:
    """Values with texts as Python has them."""
    if values.dtype != object:
        return values
    return np.array([text.decode() if isinstance(text, bytes) else text for text in values], object)


def slabs(shape: Sequence[int], start: int, stop: int) -> Iterator[tuple[Slab, int]]:
    """Yield the boxes, in order, that elements start to stop - 1 of an array make up, each with its number of them."""
    if start >= stop:
        return
    if len(shape) == 1:
        yield (slice(start, stop),), stop - start
        return
    inner = math.prod(shape[1:])
    first, last = start // inner, (stop - 1) // inner
    if first == last:
        yield from _within(first, slabs(shape[1:], start - first * inner, stop - first * inner))
        return
    whole_from, whole_to = -(-start // inner), stop // inner
    if start % inner:
        yield from _within(first, slabs(shape[1:], start % inner, inner))
    if whole_to > whole_from:
        rest = tuple(slice(0, n) for n in shape[1:])
        yield (slice(whole_from, whole_to), *rest), (whole_to - whole_from) * inner
    if stop % inner:
        yield from _within(last, slabs(shape[1:], 0, stop % inner))


def _within(index: int, inner: Iterator[tuple[Slab, int]]) -> Iterator[tuple[Slab, int]]:
    for slab, count in inner:
        yield (slice(index, index + 1), *slab), count
