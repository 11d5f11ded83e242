"""Reduced models kept on disk, each in a file named by a hash of all that it depends on."""

from __future__ import annotations

import hashlib
import os
import time
import zipfile
import zlib
from contextlib import suppress
from pathlib import Path

import numpy as np
from numba.misc.appdirs import AppDirs
from numpy.typing import NDArray

import fem_plate
import meshes
from coupling.files import whole_file
from fem_plate import LargeDeflection
from fem_plate.large_deflection import Columns, ReducedPlate, Reduction
from particle import source_digest

FloatArray = NDArray[np.float64]

FOLDER = "ACTIVE_SURFACE_CACHE"  # environment variable: the folder of models; empty: they are not kept
MAX_FILES = 40  # of the models used last
STALE = 3600.0  # s after which nobody writes to a partial file any more
SHAPES = ("linear", "corrections")
FIGURES = ("level", "halvings", "solutions", "error", "mesh_error")
BROKEN = (OSError, ValueError, TypeError, KeyError, EOFError, zipfile.BadZipFile, zlib.error, NotImplementedError)
"""What a file raises that is missing, cut off, or changed."""


def key_of(large: LargeDeflection, heights: FloatArray, tolerance: float, *more: FloatArray) -> str:
    """A hash of plate, actuators, what the model is for and the sources that make it.

    heights: (S, N), or what they follow from.
    """
    plate, mesh = large.plate, large.plate.mesh
    digest = hashlib.sha256()
    for folder in (Path(fem_plate.__path__[0]), Path(meshes.__path__[0]), Path(__file__).parent):
        digest.update(source_digest(folder).encode())
    text = (
        *(plate.section, plate.tension, sorted(plate.supports.items()), plate.tolerance),
        *(sorted(large.movable.items()), large.membrane, tolerance),
        *(sorted((name, repr(curve)) for name, curve in mesh.curves.items()), list(mesh.boundaries)),
    )
    digest.update(repr(text).encode())
    for array in (
        mesh.points,
        mesh.triangles,
        *mesh.boundaries.values(),
        large.points,
        large.stiffness,
        heights,
        *more,
    ):
        digest.update(repr(array.shape).encode() + np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()[:32]


def read_model(key: str, large: LargeDeflection) -> tuple[Reduction, FloatArray, float] | None:
    """The reduction kept under a key, the heights it is for and its mesh error; None where none can be read."""
    folder = _folder()
    if folder is None:
        return None
    path = folder / f"{key}.npz"
    try:
        with open(path, "rb") as raw, np.load(raw, allow_pickle=False) as file:
            arrays = dict(file)
        plate = ReducedPlate(arrays["stiffness"], arrays["membrane"], in_plane=arrays["in_plane"])
        level, halvings, solutions, error, mesh_error = (float(arrays[name]) for name in FIGURES)
        linear, corrections = (Columns(arrays[f"{name}_v"], arrays[f"{name}_extra"]) for name in SHAPES)
        motions, heights = arrays["motions"], arrays["heights"]
    except BROKEN:
        return None
    with suppress(OSError):
        os.utime(path)
    discrete = large.discrete(int(level), int(halvings))
    return Reduction(discrete, plate, linear, corrections, motions, int(solutions), error), heights, mesh_error


def keep_model(key: str, reduction: Reduction, heights: FloatArray, mesh_error: float) -> None:
    """Keep a reduction and the heights it is for, if there is a place that can be written to."""
    folder = _folder()
    if folder is None:
        return
    plate, discrete = reduction.plate, reduction.discrete
    figures = discrete.level, discrete.halvings, reduction.solutions, reduction.error, mesh_error
    arrays = {"stiffness": plate.stiffness, "membrane": plate.membrane, "in_plane": plate.in_plane}
    for name, shapes in zip(SHAPES, (reduction.linear, reduction.corrections), strict=True):
        arrays |= {f"{name}_v": shapes.v, f"{name}_extra": shapes.extra}
    arrays |= {"motions": reduction.motions, "heights": heights}
    arrays |= {n: np.array(f) for n, f in zip(FIGURES, figures, strict=True)}
    with suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
        with whole_file(folder / f"{key}.npz") as partial, open(partial, "wb") as file:
            np.savez(file, **arrays)  # type: ignore[arg-type]  # its stub takes the names for those of options
        _tidy(folder)


def _tidy(folder: Path) -> None:
    """Remove all but the models used last, and what processes left that were killed while they wrote."""
    files = {path: path.stat().st_mtime for path in folder.glob("*.npz")}
    partial = {path for path in files if path.stem.endswith(".partial")}
    old = sorted(files.keys() - partial, key=files.__getitem__)[:-MAX_FILES]
    for path in [*old, *(path for path in partial if files[path] < time.time() - STALE)]:
        path.unlink(missing_ok=True)


def _folder() -> Path | None:
    """Where models are kept."""
    chosen = os.environ.get(FOLDER)
    if chosen is not None:
        return Path(chosen) if chosen else None
    return Path(AppDirs(appname="active-surface", appauthor=False).user_cache_dir) / "plates"
