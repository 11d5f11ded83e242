"""The rim as a run needs it: as points, and to put a part back on that has just slid over it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from meshes import Outline
from meshes import rim_curves as rim_curves

FloatArray = NDArray[np.float64]


def onto_plate(outline: Outline, xy: FloatArray) -> FloatArray:
    """Points (n, 2) [m] themselves, or the nearest of the rim where they are just past it."""
    off = outline.gap(xy) < 0
    xy = xy.copy()
    if off.any():
        xy[off] = outline.project(xy[off])
    return xy
