"""Damage: HDF5 files with other contents than their readers expect, which bytes alone rarely make."""

from __future__ import annotations

import io
import random
from typing import Any, Final

import h5py
import numpy as np

VALUES: Final[tuple[Any, ...]] = (
    *(0, -1, 2**62, 5.5, float("nan"), float("inf"), "", "x", "{}", "[]", "null", "a b c", b"\xff\xfe"),
    *([], [1, 2, 3], [0.5] * 7, np.empty((0, 3)), np.ones((3, 3)), ["a", "b"], h5py.Empty("f8")),
)


def damaged_hdf5(data: bytes, chance: random.Random) -> bytes:
    """An HDF5 file with one to three objects or attributes removed or replaced."""
    memory = io.BytesIO(data)
    with h5py.File(memory, "r+") as file:
        for _ in range(chance.choice((1, 1, 2, 3))):
            names: list[str] = []
            file.visit(names.append)
            try:
                name = chance.choice(names)
                _damage(file, name, chance)
            except (AttributeError, LookupError, MemoryError, OSError, RuntimeError, TypeError, ValueError):
                continue
    return memory.getvalue()


def _damage(file: h5py.File, name: str, chance: random.Random) -> None:
    holder = chance.choice([file, file[name]])
    match chance.randrange(8):
        case 0:
            del file[name]
        case 1 if len(holder.attrs):
            del holder.attrs[chance.choice(list(holder.attrs))]
        case 2 | 3 if len(holder.attrs):
            holder.attrs[chance.choice(list(holder.attrs))] = chance.choice(VALUES)
        case 4:
            del file[name]
            file[name] = chance.choice(VALUES)
        case 5:
            del file[name]
            shape = (chance.choice((10**6, 10**9, 10**12)),)
            file.create_dataset(name, shape, "f8", chunks=(1000,))
        case 6:
            del file[name]
            file[name] = chance.choice(
                (h5py.ExternalLink("/etc/passwd", "/"), h5py.SoftLink("/nowhere"), h5py.SoftLink("/"))
            )
        case _ if isinstance(file[name], h5py.Dataset) and file[name].ndim:
            values = file[name][...]
            if values.dtype.kind == "f" and chance.random() < 0.5:
                values.flat[chance.randrange(max(1, values.size))] = chance.choice((np.nan, np.inf, -1e300, 1e300))
            elif values.dtype.kind in "iu" and chance.random() < 0.5:
                values.flat[chance.randrange(max(1, values.size))] = chance.choice((-1, 10**6, 127))
            else:
                values = values[: len(values) // 2]
            attributes = dict(file[name].attrs)
            del file[name]
            file[name] = values
            file[name].attrs.update({key: value for key, value in attributes.items() if key.isidentifier()})
        case _:
            pass
