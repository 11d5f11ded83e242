"""Quintics: the blend of a stroke, and pieces through given heights, velocities and accelerations."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

QUINTIC = np.array([0.0, 0.0, 0.0, 10.0, -15.0, 6.0])  # from 0 to 1 with no velocity and acceleration at either end


def hermite(times: FloatArray, h: FloatArray, v: FloatArray, a: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The quintics between times (n,) [s] with heights [m], velocities and accelerations (n,) given at each.

    Returns their scales (n-1,) [s] and coefficients (n-1, 6) [m] in (t - start) / scale.
    """
    scale = np.diff(times)
    rise = np.diff(h)
    v_0, v_1 = v[:-1] * scale, v[1:] * scale
    a_0, a_1 = a[:-1] * scale**2, a[1:] * scale**2
    rows = [
        h[:-1],
        v_0,
        0.5 * a_0,
        10 * rise - 6 * v_0 - 4 * v_1 - 1.5 * a_0 + 0.5 * a_1,
        -15 * rise + 8 * v_0 + 7 * v_1 + 1.5 * a_0 - a_1,
        6 * rise - 3 * v_0 - 3 * v_1 - 0.5 * a_0 + 0.5 * a_1,
    ]
    return scale, np.stack(rows, axis=1)
