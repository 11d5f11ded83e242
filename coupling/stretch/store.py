"""Reduced models kept on disk, each in a file named by a hash of all that it depends on."""

from __future__ import annotations

import hashlib
import os
import tempfile
import zipfile
from contextlib import suppress
from pathlib import Path

import numpy as np
from numba.misc.appdirs import AppDirs
from numpy.typing import NDArray

import fem_plate
import meshes
from fem_plate import LargeDeflection
from fem_plate.large_deflection import Columns, DiscretePlate, ReducedPlate, Reduction
from particle import source_digest

FloatArray = NDArray[np.float64]

FOLDER = "ACTIVE_SURFACE_CACHE"  # environment variable: the folder of models; empty: they are not kept
MAX_FILES = 40  # of the models used last


def key_of(large: LargeDeflection, heights: FloatArray, level: int, tolerance: float) -> str:
    """A hash of plate, actuators, the heights that the model is for, and the sources that make it."""
    plate, mesh = large.plate, large.plate.mesh
    digest = hashlib.sha256()
    for package in (fem_plate, meshes):
        digest.update(source_digest(Path(package.__path__[0])).encode())
    text = (
        *(plate.section, plate.tension, sorted(plate.supports.items()), plate.tolerance),
        *(sorted(large.movable.items()), large.membrane, level, tolerance),
        *(sorted((name, repr(curve)) for name, curve in mesh.curves.items()), list(mesh.boundaries)),
    )
    digest.update(repr(text).encode())
    for array in (mesh.points, mesh.triangles, *mesh.boundaries.values(), large.points, large.stiffness, heights):
        digest.update(repr(array.shape).encode() + np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()[:32]


def read_model(key: str, discrete: DiscretePlate) -> tuple[Reduction, float] | None:
    """The reduction kept under a key and its mesh error; None where there is none."""
    folder = _folder()
    if folder is None:
        return None
    try:
        with open(folder / f"{key}.npz", "rb") as raw, np.load(raw, allow_pickle=False) as file:
            arrays = dict(file)
        os.utime(folder / f"{key}.npz")
    except (OSError, ValueError, EOFError, zipfile.BadZipFile):
        return None
    plate = ReducedPlate(arrays["stiffness"], arrays["membrane"], in_plane=arrays["in_plane"])
    linear, corrections = (Columns(arrays[f"{name}_v"], arrays[f"{name}_extra"]) for name in ("linear", "corrections"))
    figures = int(arrays["solutions"]), float(arrays["error"])
    return Reduction(discrete, plate, linear, corrections, arrays["motions"], *figures), float(arrays["mesh_error"])


def keep_model(key: str, reduction: Reduction, mesh_error: float) -> None:
    """Keep a reduction, if there is a place that can be written to."""
    folder = _folder()
    if folder is None:
        return
    with suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=folder, suffix=".part", delete=False) as file:
            np.savez(
                file,
                stiffness=reduction.plate.stiffness,
                membrane=reduction.plate.membrane,
                in_plane=reduction.plate.in_plane,
                linear_v=reduction.linear.v,
                linear_extra=reduction.linear.extra,
                corrections_v=reduction.corrections.v,
                corrections_extra=reduction.corrections.extra,
                motions=reduction.motions,
                solutions=reduction.solutions,
                error=reduction.error,
                mesh_error=mesh_error,
            )
        os.replace(file.name, folder / f"{key}.npz")
        for old in sorted(folder.glob("*.npz"), key=lambda path: path.stat().st_mtime)[:-MAX_FILES]:
            old.unlink()


def _folder() -> Path | None:
    """Where models are kept."""
    chosen = os.environ.get(FOLDER)
    if chosen is not None:
        return Path(chosen) if chosen else None
    return Path(AppDirs(appname="active-surface", appauthor=False).user_cache_dir) / "plates"
