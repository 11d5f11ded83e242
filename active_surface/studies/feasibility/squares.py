"""Squares: what an outline encloses, cut into squares with their neighbours."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from active_surface.arrays import FloatArray
from meshes import Outline

IndexArray = NDArray[np.int64]


class Squares(NamedTuple):
    """Squares side by side."""

    centres: FloatArray  # (n, 2) m
    side: float  # m
    neighbours: IndexArray  # (n, 4) those at -x, +x, -y and +y; where there is none the square itself


def squares_within(outline: Outline, across: int) -> Squares:
    """Squares whose centres an outline encloses, so many along its longer side."""
    low, high = outline.box
    side = float((high - low).max()) / across
    counts = np.ceil((high - low) / side - 1e-9).astype(int)
    along = [middle + side * (np.arange(n) - (n - 1) / 2) for middle, n in zip((low + high) / 2, counts, strict=True)]
    grid = np.stack(np.meshgrid(*along, indexing="ij"), axis=-1)
    inside = outline.gap(grid.reshape(-1, 2)).reshape(counts) > 0
    numbers = np.full(counts + 2, -1)
    numbers[1:-1, 1:-1][inside] = np.arange(inside.sum())
    around = [numbers[:-2, 1:-1], numbers[2:, 1:-1], numbers[1:-1, :-2], numbers[1:-1, 2:]]
    neighbours = np.stack([one[inside] for one in around], axis=1)
    return Squares(grid[inside], side, np.where(neighbours < 0, np.arange(len(neighbours))[:, None], neighbours))
