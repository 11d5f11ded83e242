"""Fine enough: the largest cells on which a stretching plate meets its tolerance."""

from __future__ import annotations

import numpy as np

from fem_plate.estimated import MAX_UNKNOWNS
from fem_plate.large_deflection.large_deflection import LargeDeflection
from fem_plate.large_deflection.solution import DiscretePlate, level_of
from fem_plate.large_deflection.state import DeflectedPlate
from fem_plate.types import FloatArray


def fine_enough(large: LargeDeflection, heights: FloatArray) -> tuple[DiscretePlate, float]:
    """The plate on the largest cells that meet its tolerance at heights (N,) [m, or N], and the error that they leave.

    The error is that of w, over the largest: the difference from cells of half the size. Without a tolerance cells stay
    as they are, but those around actuators and at the rim.
    """
    coarse, tolerance = _on_own_cells(large, heights), large.plate.tolerance
    while True:
        fine = large.solved(heights, 0.0, coarse.discrete.level, coarse.discrete.halvings + 1)
        error = fine.difference(coarse)
        if tolerance is None or error <= tolerance or 4 * fine.unknowns > MAX_UNKNOWNS:
            return coarse.discrete, error
        coarse = fine


def _on_own_cells(large: LargeDeflection, heights: FloatArray) -> DeflectedPlate:
    """The plate at some heights on its own cells, but those around actuators and at the rim."""
    thickness = large.plate.section.thickness
    level = level_of(float(np.abs(heights[np.isinf(large.stiffness)]).max(initial=0.0)) / thickness)
    while True:
        state = large.solved(heights, 0.0, level, 0)
        needed = level_of(state.largest / thickness)
        if needed <= level:
            return state
        level = needed
