"""HDF5 files that others may have made: whether they hold what they say, before any of it is read."""

from __future__ import annotations

import os
from collections.abc import Iterator

import h5py

UNREADABLE = (
    *(AttributeError, AssertionError, IndexError, KeyError, LookupError, MemoryError, OSError, OverflowError),
    *(RecursionError, RuntimeError, SyntaxError, TypeError, ValueError),
)
"""What reading raises where something is not there, or not as it was written."""
MAX_OBJECTS = 100_000
PACKED = 1100  # times: by how much gzip packs zeros, and a little more
UNSTORED = 2**16  # bytes that a dataset may have without any in the file
MAX_BYTES = 2**31  # of a dataset that is read at once


def check_hdf5(path: str | os.PathLike[str], by_steps: str = "") -> None:
    """Raise ValueError where a file leads to other files, or a dataset in it says that it is far larger than it is.

    by_steps: the group whose datasets are read piece by piece, however large they are.
    Raises any of UNREADABLE where the file cannot be read.
    """
    with h5py.File(path, "r") as file:
        for name, dataset in _datasets(file):
            if dataset.is_virtual or dataset.external:
                raise ValueError(f"its {name} is in another file")
            size, stored = dataset.size * dataset.dtype.itemsize, dataset.id.get_storage_size()
            if size > PACKED * stored + UNSTORED:
                raise ValueError(f"its {name} says that it has {size} bytes, of which {stored} are there")
            if size > MAX_BYTES and not (by_steps and name.startswith(f"{by_steps}/")):
                raise ValueError(f"its {name} has {size} bytes; at most {MAX_BYTES} are read")


def _datasets(file: h5py.File) -> Iterator[tuple[str, h5py.Dataset]]:
    """Yield the datasets of a file with their names, each once; ValueError where a link leads out of it."""
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
            if isinstance(one, h5py.Dataset):
                yield name, one
            elif isinstance(one, h5py.Group):
                groups.append((name, one))
