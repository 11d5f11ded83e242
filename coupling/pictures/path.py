"""The path in the picture of a run: a line with its two ends, or a mark where that would be no more than a point."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from numpy.typing import NDArray

from coupling.pictures.prefixes import Unit, readable
from coupling.pictures.window import extent
from particle import PATH_COLOUR as PATH_COLOUR
from particle import PLACE, RING, Rows, draw_line
from particle import STICK_COLOUR as STICK_COLOUR

FloatArray = NDArray[np.float64]


def draw_path(axes: Axes, rows: Rows, line: FloatArray, unit: Unit, visible: bool) -> list[Artist]:
    """Draw the path, points (n, 2) [m] along it, or a point where no more would be visible; return keys."""
    if visible:
        return draw_line(axes, rows, line, unit.per_si)
    return [*axes.plot(*(rows.position[:1] * unit.per_si).T, **RING, **PLACE, label=_staying(extent(line)))]


def _staying(length: float) -> str:
    """What is said of a part whose path is no more than a point."""
    unit = readable(np.array([length]), "m")
    moved = f"within {float(f'{length * unit.per_si:.2g}'):g} {unit.name}" if unit.name != "m" else "where it is"
    return f"the part, which stays {moved}"
