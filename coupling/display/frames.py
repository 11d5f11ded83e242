"""Frames: the times of the steps in result files, enough to show the fastest drive as long as the files stay small."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from coupling.case import Case
from coupling.display.mesh import display_points
from coupling.drives import fastest
from coupling.scene import PlateScene, Scene

FloatArray = NDArray[np.float64]

PER_CYCLE = 20
FRAMES = (100, 1000)  # the fewest, and the most of a measured motion, whose cycles are no drive's
MAX_BYTES = 300e6  # of the result files
STEP = 450.0  # bytes of a step besides the plate, as written
POINT = {False: 10.5, True: 27.0}  # bytes of a step at a point of the plate, compressed; whether it stretches


def frame_times(case: Case, scene: Scene, end: float) -> FloatArray:
    """The times [s] of the result files' steps, from 0 to the end of the path."""
    return np.unique(np.linspace(0, end, case.run.frames or _enough(scene, end)))  # one where the path ends at once


def _enough(scene: Scene, end: float) -> int:
    """So many that they resolve the fastest drive, or as many as the files may hold."""
    most = FRAMES[1] if scene.fits else int(MAX_BYTES / _bytes(scene))
    wanted = math.ceil(end * fastest([*scene.lifts, *scene.base]) * PER_CYCLE) + 1
    return max(min(wanted, most), FRAMES[0])


def _bytes(scene: Scene) -> float:
    """How much a step takes in the files, about."""
    if not isinstance(scene, PlateScene):
        return STEP
    return STEP + POINT[scene.stretch is not None] * display_points(scene.plate.mesh, scene.shapes.points)
