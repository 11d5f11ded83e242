"""A drive's piece as an array, as tests like it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from particle.drives import ORDER, DriveTable, drive_piece


def piece_at(table: DriveTable, i: int, time: float, unit: float) -> NDArray[np.float64]:
    """The quintic (6,) of drive i around a time [s], in (t - time) / unit."""
    out = np.empty(ORDER)
    drive_piece(table, i, time, unit, out)
    return out
