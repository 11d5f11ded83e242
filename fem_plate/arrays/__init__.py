"""Influence shapes of large arrays, put together from patches of the plate."""

from fem_plate.arrays.cutting import CELL, FINER_CELL, Cutter
from fem_plate.arrays.patched import PatchedShapes
from fem_plate.arrays.patches import PITCH_DIGITS, ActuatorArray, ProgressCallback, spacing
