"""The drives of all actuators as kernels read them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

ORDER = 6  # coefficients of a quintic
MERGED = 1e-12  # of a stroke: breakpoints closer than that are taken as one
ROUNDING = 4 * np.finfo(float).eps  # of the time: the same holds for breakpoints closer than that


class DriveTable(NamedTuple):
    """The drives of all actuators, as kernels read them.

    Drive i holds its first value until delay[i], then runs through its segments first[i] .. first[i+1]-1 and holds its
    last value. Those from loop[i, 0] to before loop[i, 1] are passed repeats[i] times (inf: without end), each pass
    lasting span[i]; those before, its lead, and those after, its tail, once.
    """

    first: NDArray[np.int64]  # (N+1,)
    loop: NDArray[np.int64]  # (N, 2)
    start: FloatArray  # (S,) s, after the start of the pass; of the lead negative, of the tail after the last pass
    scale: FloatArray  # (S,) s, what its polynomial's variable is divided by
    coefficients: FloatArray  # (S, 6) m, in (t - start) / scale
    delay: FloatArray  # (N,) s
    span: FloatArray  # (N,) s
    repeats: FloatArray  # (N,)
    stroke_time: FloatArray  # (N,) s, the shortest stroke of each; inf: it has none
    jump: FloatArray  # (N, 2) m/s, m/s^2, by how much its velocity and acceleration jump at breakpoints at most
    rough: FloatArray  # (N,) m/s^3, by how much its third derivative does, with the share of those above
    alike: NDArray[np.bool_]  # (N,) whether all its pieces begin and end when those of the drive before it do
