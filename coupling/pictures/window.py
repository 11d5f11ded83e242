"""The window of a picture: the part of the plate around a short path, drawn once more at a larger scale."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fem_plate import extent, pitch

FloatArray = NDArray[np.float64]

SHORT = 1 / 6  # of the plate's longer side: a shorter path gets a window
VISIBLE = 1 / 1000  # of the plate's longer side: a shorter path is drawn as a point
MIN_LENGTHS, MAX_LENGTHS = 2.5, 4.0  # of the path's extent: the side of the window,
PITCHES = 2.2  # which shows so many pitches if it can


def is_visible(path: FloatArray, box: FloatArray) -> bool:
    """Whether a path (n, 2) [m] is more than a point on a plate with a box (2, 2) [m]."""
    return extent(path) > VISIBLE * extent(box)


def path_window(path: FloatArray, box: FloatArray, actuators: FloatArray) -> FloatArray | None:
    """The lower left and upper right corner (2, 2) [m] of the window around a path (n, 2) [m]; None: not needed.

    box: of the plate, (2, 2) m.  actuators: (N, 2) m.
    """
    length = extent(path)
    if not is_visible(path, box) or length > SHORT * extent(box):
        return None
    longest = min(MAX_LENGTHS * length, MIN_LENGTHS * SHORT * extent(box))
    side = float(np.clip(PITCHES * pitch(actuators), MIN_LENGTHS * length, longest))
    middle = (path.min(axis=0) + path.max(axis=0)) / 2
    return np.stack([middle - side / 2, middle + side / 2])
