"""The path in the picture of a run: a line with its two ends, or a mark where the part hardly moves.

The part of the plate around a short path is drawn once more at a larger scale, in a window.
"""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from numpy.typing import NDArray

from common import NOTHING, Unit, quantity_text
from fem_plate import extent, pitch
from particle import PLACE, RING, Rows, draw_line

FloatArray = NDArray[np.float64]

SHORT = 1 / 6  # of the plate's longer side: a shorter path gets a window
VISIBLE = 1 / 1000  # of the plate's longer side: a shorter path is drawn as a point
MIN_LENGTHS, MAX_LENGTHS = 2.5, 4.0  # of the path's extent: the side of the window,
PITCHES = 2.2  # which shows so many pitches if it can


def draw_path(axes: Axes, rows: Rows, line: FloatArray, unit: Unit, visible: bool) -> list[Artist]:
    """Draw the path through points (n, 2) [m], or its start where no more would be visible; return keys."""
    if visible:
        return draw_line(axes, rows, line, unit.per_si)
    return [*axes.plot(*(rows.position[:1] * unit.per_si).T, **RING, **PLACE, label=_staying(extent(line)))]


def _staying(length: float) -> str:
    """The label of a part whose path is no more than a point."""
    where = f"within {quantity_text(length, 'm', 2)}" if length > NOTHING else "where it is"
    return f"the part, which stays {where}"


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
