"""A moving surface as a file: its cells and drives, to follow parts over it again without its plate."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from common import UNREADABLE, check_hdf5, survives
from coupling.files import check_room, whole_file
from particle import SurfaceMotion
from particle.drives import DriveTable
from particle.surface import BuiltCells, cells_of, columns_of

KIND, VERSION = "active-surface surface motion", 4

LENGTHS = ("size", "floor", "overhang", "half_thickness")


def write_surface(surface: SurfaceMotion, path: str | os.PathLike[str]) -> Path:
    """Write a surface, with the cells built so far, to an HDF5 file.

    To have cells everywhere, call `surface.evaluate` at points all over the plate first.

    Parameters
    ----------
    surface : SurfaceMotion
        The surface.
    path : path
        The file.

    Returns
    -------
    path : path
        The file.

    Raises
    ------
    ValueError
        The file holds something else.
    OSError
        The file cannot be written.
    """
    path = Path(path)
    check_surface(path)
    tables = {"drives": surface.drives._asdict(), "cells": columns_of(surface.store.cells)}
    check_room(path.parent, sum(np.asarray(value).nbytes for table in tables.values() for value in table.values()))
    with whole_file(path) as partial, h5py.File(partial, "w") as file:
        file.attrs.update(kind=KIND, version=VERSION, error=surface.error, moving_base=surface.moving_base)
        file.attrs["turning_base"] = surface.turning_base
        file.attrs["in_plane_count"] = surface.in_plane_count
        file.attrs.update({name: getattr(surface, name) for name in LENGTHS})
        for name in ("sources", "conics", "edges"):
            file[name] = getattr(surface, name)
        for group, table in tables.items():
            for name, value in table.items():
                file[f"{group}/{name}"] = value
    return path


def check_surface(path: Path) -> None:
    """Raises ValueError when there is a file at `path` that is no surface."""
    if path.exists() and not is_surface(path):
        raise ValueError(f"Input path of write_surface must be free or a surface; got {path}, which is neither")


def read_surface(path: str | os.PathLike[str]) -> SurfaceMotion:
    """Read the surface that `write_surface` wrote: the same bits, with the cells built then and no others.

    A path that comes to a place without a cell raises ValueError.

    Parameters
    ----------
    path : path
        The file.

    Returns
    -------
    surface : SurfaceMotion
        The surface.

    Raises
    ------
    ValueError
        The file holds something else.
    OSError
        The file cannot be read.
    """
    path = Path(path)
    if path.exists() and not is_surface(path):
        raise ValueError(f"Input path of read_surface must be a file that write_surface wrote; got {path}")
    try:
        check_hdf5(path)
        return _read(path)
    except UNREADABLE as error:
        if isinstance(error, OSError) and not path.is_file():
            raise
        why = "is damaged, or of another version"
        raise ValueError(f"Input path of read_surface must be whole; got {path}, which {why}") from error


def _read(path: Path) -> SurfaceMotion:
    with h5py.File(path, "r") as file:
        tables = {
            group: {name: value[()] if value.shape else value[()].item() for name, value in file[group].items()}
            for group in ("drives", "cells")
        }
        rest: dict[str, Any] = {name: float(file.attrs[name]) for name in LENGTHS}
        rest |= {name: np.ascontiguousarray(file[name][()]) for name in ("sources", "conics", "edges")}
        return SurfaceMotion(
            drives=DriveTable(**tables["drives"]),
            store=BuiltCells(cells_of(tables["cells"]), float(file.attrs["error"])),
            moving_base=bool(file.attrs["moving_base"]),
            turning_base=bool(file.attrs["turning_base"]),
            in_plane_count=int(file.attrs["in_plane_count"]),
            **rest,
        )


def is_surface(path: Path) -> bool:
    """Whether `write_surface` wrote a file."""
    if not h5py.is_hdf5(path) or not survives(path):
        return False
    with h5py.File(path, "r") as file:
        return bool(file.attrs.get("kind") == KIND and file.attrs.get("version") == VERSION)
