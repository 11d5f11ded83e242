"""The scene of a platform: a flat rigid surface that moves as a whole."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from coupling.case import AXES, RATES, MotionCase, PlatformCase
from coupling.drives import build_drive, travel
from coupling.measured import MotionFit, fit_motion
from coupling.progress import Progress
from particle import AnyDrive, Drive, SurfaceMotion, platform_surface

FloatArray = NDArray[np.float64]

STILL = Drive(0.0, 1.0, "up")
STILL_SIZE = 1e-3  # m: the length that tolerances refer to where nothing moves


@dataclass(frozen=True, eq=False)
class PlatformScene:
    """A platform."""

    lifts: Sequence[AnyDrive]  # one, along z
    base: Sequence[AnyDrive]  # along x and y; of a turning platform a third one, its turn [rad]
    surface: SurfaceMotion
    fits: tuple[MotionFit, ...] = ()  # how closely the drives follow a measured motion, by axis
    shapes: None = field(default=None, init=False)
    origin: str = field(default="the platform", init=False)  # what positions are counted from


def platform_scene(platform: PlatformCase, progress: Progress) -> PlatformScene:
    """The scene of a case with a platform.

    Raises ValueError or OSError when the file of its motion can no longer be read.
    """
    with progress("Fitting the motion"):
        drives, fits = _drives(platform)
    with progress("Joining the surface"):
        x, y, z, turn = (drives.get(name) for name in (*AXES, "turn"))
        size = max((travel(drive) for drive in (x, y, z) if drive), default=0.0) or STILL_SIZE
        surface = platform_surface(x, y, z, size, turn)
    base = [x or STILL, y or STILL, *([turn] if turn else [])]
    return PlatformScene([z or STILL], base, surface, fits)


def _drives(platform: PlatformCase) -> tuple[dict[str, AnyDrive], tuple[MotionFit, ...]]:
    """The drive of each moving axis, and of a turn, and how closely it follows a measured motion."""
    if isinstance(platform.motion, MotionCase):
        return {name: build_drive(drive) for name, drive in platform.motion if drive is not None}, ()
    measured, mistakes = platform.read_motion
    if mistakes:
        raise ValueError(f"{Path(str(platform.motion))}: " + "; ".join(mistakes))
    if measured is None:
        return {}, ()
    columns = measured.columns
    fitted = [
        fit_motion(axis, measured.time, columns[axis], platform.smoothing, *(columns.get(name) for name in RATES[axis]))
        for axis in AXES
        if axis in columns
    ]
    fits = tuple(replace(fit, ignored=measured.ignored) for _, fit in fitted)
    return {fit.axis: drive for drive, fit in fitted}, fits
