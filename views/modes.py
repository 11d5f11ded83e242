"""A moving surface as the sum of a few modes, which takes far less room than its heights at every step."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

SEEN = 1e-3  # of the largest height: less is not seen


class Modes(NamedTuple):
    """A field that is `amplitudes @ shapes`, good to `error`."""

    shapes: FloatArray  # (r, n)
    amplitudes: FloatArray  # (k, r)
    error: float  # the largest, in the field's unit


def modes_of(field: NDArray) -> Modes:
    """As few modes as give a field (k, n) to `SEEN` of its largest number, at least one.

    The plate is the sum of its actuators' shapes, and drives of one frequency and form differ by their delays: so even
    thousands of actuators make a few tens of modes.
    """
    heights = field.astype(np.float64)
    turned = len(heights) > heights.shape[1]
    rows = heights.T if turned else heights
    found, vectors = np.linalg.eigh(rows @ rows.T)
    vectors = vectors[:, np.argsort(-found)]
    rest, allowed, rank = rows.copy(), SEEN * float(np.abs(rows).max()), 0
    while rank == 0 or (rank < len(rows) and float(np.abs(rest).max()) > allowed):
        vector = vectors[:, rank]
        rest -= np.outer(vector, vector @ rows)
        rank += 1
    left = vectors[:, :rank]
    right = left.T @ rows
    error = float(np.abs(rest).max())
    return Modes(left.T, right.T, error) if turned else Modes(right, left, error)
