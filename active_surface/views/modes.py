"""A moving surface as the sum of a few modes, which takes far less room than its heights at every step."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from active_surface.arrays import BoolArray, FloatArray

SEEN = 1e-3  # of the largest height in view: less is not seen


class Modes(NamedTuple):
    """A field that is `amplitudes @ shapes`, good to `error`."""

    shapes: FloatArray  # (r, n)
    amplitudes: FloatArray  # (k, r)
    error: float  # the largest, in the field's unit


def modes_of(field: NDArray, close: BoolArray | None = None) -> Modes:
    """As few modes as give a field (k, n) to `SEEN` of its largest number, at least one.

    close: which of the n are looked at closely (n,), and so are good to `SEEN` of the largest number of these.

    The plate is the sum of its actuators' shapes, and drives of one frequency and form differ by their delays: so even
    thousands of actuators make a few tens of modes.
    """
    sizes = np.full(field.shape[1], np.abs(field).max(), np.float64)
    if close is not None and close.any():
        sizes[close] = np.abs(field[:, close]).max()
    sizes[sizes == 0] = 1.0
    heights = field / sizes  # so that all are wanted to the same error
    turned = len(heights) > heights.shape[1]
    rows = heights.T if turned else heights
    eigenvalues, vectors = np.linalg.eigh(rows @ rows.T)
    vectors = vectors[:, np.argsort(-eigenvalues)]
    rest, rank = rows.copy(), 0
    while rank == 0 or (rank < len(rows) and float(np.abs(rest).max()) > SEEN):
        vector = vectors[:, rank]
        rest -= np.outer(vector, vector @ rows)
        rank += 1
    left = vectors[:, :rank]
    right = left.T @ rows
    shapes, amplitudes, errors = (left.T, right.T, rest.T) if turned else (right, left, rest)
    return Modes(shapes * sizes, amplitudes, float(np.abs(errors * sizes).max()))
