"""The window of a picture: the part of a plate that is drawn once more, larger, where the path is short beside it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

FloatArray = NDArray[np.float64]

SHORT = 1 / 6  # of the plate's longer side: a shorter path has a window
VISIBLE = 1 / 1000  # of the plate's longer side: a shorter path is drawn as a point
LEAST, MOST = 2.5, 4.0  # times the path's extent is the window's side,
PITCHES = 2.2  # as many as it takes to show so many pitches


def extent(path: FloatArray) -> float:
    """The longer side [m] of the box around a path (n, 2) [m]."""
    return float(np.ptp(path, axis=0).max())


def is_visible(path: FloatArray, box: FloatArray) -> bool:
    """Whether a path (n, 2) [m] is more than a point on a plate with a box (2, 2) [m]."""
    return extent(path) > VISIBLE * extent(box)


def pitch(actuators: FloatArray) -> float:
    """The distance [m] from an actuator to the nearest other one, the median of (N, 2) [m]; 0 where there is one."""
    if len(actuators) < 2:
        return 0.0
    return float(np.median(cKDTree(actuators).query(actuators, k=2)[0][:, 1]))


def path_window(path: FloatArray, box: FloatArray, actuators: FloatArray) -> FloatArray | None:
    """The lower left and upper right corner (2, 2) [m] of the window around a path (n, 2) [m]; None: it needs none.

    box: of the plate, (2, 2) m.  actuators: (N, 2) m.
    """
    length = extent(path)
    if not is_visible(path, box) or length > SHORT * extent(box):
        return None
    side = float(np.clip(PITCHES * pitch(actuators), LEAST * length, min(MOST * length, LEAST * SHORT * extent(box))))
    middle = (path.min(axis=0) + path.max(axis=0)) / 2
    return np.stack([middle - side / 2, middle + side / 2])
