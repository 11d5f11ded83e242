"""The path in the picture of a run: a line with its two ends, or a mark where the part hardly moves."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from numpy.typing import NDArray

from common import NOTHING, Unit, quantity_text
from fem_plate import extent
from particle import PLACE, RING, Rows, draw_line

FloatArray = NDArray[np.float64]


def draw_path(axes: Axes, rows: Rows, line: FloatArray, unit: Unit, visible: bool) -> list[Artist]:
    """Draw the path through points (n, 2) [m], or its start where no more would be visible; return keys."""
    if visible:
        return draw_line(axes, rows, line, unit.per_si)
    return [*axes.plot(*(rows.position[:1] * unit.per_si).T, **RING, **PLACE, label=_staying(extent(line)))]


def _staying(length: float) -> str:
    """The label of a part whose path is no more than a point."""
    where = f"within {quantity_text(length, 'm', 2)}" if length > NOTHING else "where it is"
    return f"the part, which stays {where}"
