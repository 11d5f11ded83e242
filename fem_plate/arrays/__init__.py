"""Influence shapes of large arrays, put together from patches of the plate."""

from fem_plate.arrays.patched import PatchedShapes, patched_shapes
from fem_plate.arrays.patches import PITCH_DIGITS, ProgressCallback, spacing
