"""HDF5 files that others may have made: whether they hold what they say, before any of it is read."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
import warnings
from collections.abc import Iterable, Iterator
from contextlib import suppress
from itertools import chain

import h5py
import numpy as np
from h5py._objects import phil

UNREADABLE = (
    *(AttributeError, AssertionError, IndexError, KeyError, LookupError, MemoryError, OSError, OverflowError),
    *(RecursionError, RuntimeError, SyntaxError, TypeError, ValueError),
)
"""What reading raises where something is not there, or not as it was written."""
DEADLY = "HDF5 does not come to the end of it"
PATIENCE = 10.0  # s, for a file that takes a fraction of one
MAX_TRIED = 2**26  # bytes of its numbers that are tried
MEMORY = 2**31  # bytes that reading may take: a length that is wrong can have HDF5 ask for any
MAX_OBJECTS = 100_000
PACKED = 1100  # times: by how much gzip packs zeros, and a little more
UNSTORED = 2**16  # bytes that a dataset may have without any in the file
MAX_BYTES = 2**30  # of a dataset that is read at once
AXES, AXIS_OF, AXIS_COLUMNS = "DIMENSION_LIST", "REFERENCE_LIST", ("dataset", "dimension")
"""The attributes by which netCDF files say which datasets are the axes of others, as HDF5 defines them."""


def survives(path: str | os.PathLike[str]) -> bool:
    """Whether HDF5 reads a file without crashing, going round in circles or taking all memory, as one that is damaged.

    A child process tries, where there is fork and on the main thread; elsewhere nobody does, and it is taken to be so.
    """
    if not hasattr(os, "fork") or threading.current_thread() is not threading.main_thread():
        return True
    child = _forked()
    if child == 0:
        try:
            null = os.open(os.devnull, os.O_RDWR)
            for stream in (0, 1, 2):  # where a library that fails would print
                os.dup2(null, stream)
            before = _most_memory()
            with suppress(Exception):  # which the reader will see for itself
                _read_all(path)
            os._exit(0 if _most_memory() - before <= MEMORY else 1)
        finally:
            os._exit(0)
    end = time.monotonic() + PATIENCE
    try:
        while time.monotonic() < end:
            ended, status = os.waitpid(child, os.WNOHANG)
            if ended:
                child = 0
                return os.waitstatus_to_exitcode(status) == 0
            time.sleep(0.001)
        return False
    finally:
        if child:  # it takes too long, or Ctrl-C came
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)


def _forked() -> int:
    """As os.fork, without a word of other threads: of those the child, which needs none, has no more."""
    parent, said = os.getpid(), sys.unraisablehook
    with warnings.catch_warnings(), phil:  # held, so that no other thread is at HDF5 when only this one lives on
        warnings.simplefilter("ignore")
        sys.unraisablehook = lambda _: None  # scipy raises an error in the child for factors that another thread had
        try:
            return os.fork()
        except SystemError:
            if os.getpid() == parent:
                raise
            return 0
        finally:
            sys.unraisablehook = said


def _most_memory() -> int:
    """Bytes that this process has had at most."""
    import resource  # here, because Windows has none

    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return most if sys.platform == "darwin" else 1024 * most


def _read_all(path: str | os.PathLike[str]) -> None:
    """Read all attributes of an HDF5 file, and its datasets as far as there is time."""
    with h5py.File(path, "r") as file:
        left = MAX_TRIED
        for one in chain([file], (one for _, one in _objects(file))):
            with suppress(*UNREADABLE):
                for name in one.attrs:
                    with suppress(*UNREADABLE):
                        one.attrs[name]
                if isinstance(one, h5py.Dataset) and one.size * one.dtype.itemsize <= left:
                    left -= one.size * one.dtype.itemsize
                    one[...]


def check_hdf5(path: str | os.PathLike[str], by_steps: str = "") -> None:
    """Raise ValueError where a file leads to other files, or a dataset in it says that it is far larger than it is.

    by_steps: the group whose datasets are read piece by piece, however large they are.
    Raises any of UNREADABLE where the file cannot be read.
    """
    with h5py.File(path, "r") as file:
        for name, dataset in _datasets(file):
            if dataset.is_virtual or dataset.external:
                raise ValueError(f"its {name} is in another file")
            if dataset.shape is None:
                raise ValueError(f"its {name} is empty")
            size, stored = dataset.size * dataset.dtype.itemsize, dataset.id.get_storage_size()
            if size > PACKED * stored + UNSTORED:
                raise ValueError(f"its {name} says that it has {size} bytes, of which {stored} are there")
            if size > MAX_BYTES and not (by_steps and name.startswith(f"{by_steps}/")):
                raise ValueError(f"its {name} has {size} bytes; at most {MAX_BYTES} are read")
            if not _has_right_axes(dataset):
                raise ValueError(f"its {name} names its axes in another form than netCDF")


def lacking(path: str | os.PathLike[str], names: Iterable[str]) -> list[str]:
    """Those of some names that no dataset of a file has."""
    with h5py.File(path, "r") as file:
        return [name for name in names if not isinstance(file.get(name or "/"), h5py.Dataset)]


def _has_right_axes(dataset: h5py.Dataset) -> bool:
    """Whether the attributes of axes, if there are any, are references: with others HDF5 spoils its memory."""
    if AXES in dataset.attrs:
        attribute = dataset.attrs.get_id(AXES)
        if attribute.shape != (dataset.ndim,) or not _refers(h5py.check_vlen_dtype(attribute.dtype)):
            return False
    if AXIS_OF in dataset.attrs:
        kind = dataset.attrs.get_id(AXIS_OF).dtype
        return kind.names == AXIS_COLUMNS and _refers(kind[0])
    return True


def _refers(kind: np.dtype | None) -> bool:
    return kind is not None and h5py.check_ref_dtype(kind) is h5py.Reference


def _datasets(file: h5py.File) -> Iterator[tuple[str, h5py.Dataset]]:
    """Yield the datasets of a file with their names, each once; ValueError where a link leads out of it."""
    yield from ((name, one) for name, one in _objects(file) if isinstance(one, h5py.Dataset))


def _objects(file: h5py.File) -> Iterator[tuple[str, h5py.Dataset | h5py.Group]]:
    """Yield the datasets and groups of a file with their names, each once; ValueError where a link leads out of it."""
    groups, seen, count = [("", file)], set(), 0
    while groups:
        above, group = groups.pop()
        for key in group:
            name = f"{above}/{key}".lstrip("/")
            count += 1
            if count > MAX_OBJECTS:
                raise ValueError(f"it has more than {MAX_OBJECTS} objects")
            if not isinstance(group.get(key, getlink=True), h5py.HardLink):
                raise ValueError(f"its {name} is a link")
            one = group[key]
            info = h5py.h5o.get_info(one.id)
            if (info.fileno, info.addr) in seen:
                continue
            seen.add((info.fileno, info.addr))
            if isinstance(one, (h5py.Dataset, h5py.Group)):
                yield name, one
            if isinstance(one, h5py.Group):
                groups.append((name, one))
