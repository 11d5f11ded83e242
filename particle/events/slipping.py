"""Slipping: which of many places would let a part at rest slip, and which would lose it, at one moment."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from particle.friction import friction_limit
from particle.jit import bare, jit

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]


@bare
def rest_pull(w_tt: float, x: float, y: float, a_x: float, a_y: float, part: Any) -> tuple[float, float]:
    """The net load [N] of a part at rest, and the pull [m/s^2] that friction must hold.

    x, y: the slopes.  a_x, a_y: m/s^2, the acceleration of the surface's base.
    """
    a_x, a_y = a_x - part.tilt_x, a_y - part.tilt_y
    b = part.gravity + w_tt - a_x * x - a_y * y
    square = 1 + x * x + y * y
    p_x, p_y = -a_x - b * x / square, -a_y - b * y / square
    climb = p_x * x + p_y * y
    return part.mass * b / math.sqrt(square) + part.squeeze, math.sqrt(p_x * p_x + p_y * p_y + climb * climb)


@jit
def find_lost(
    w_tt: FloatArray, slope: FloatArray, base: FloatArray, part: Any, factors: FloatArray, lost: BoolArray
) -> None:
    """Mark in `lost` (F, n) the places where a part at rest is not held by its contact at this moment.

    base: (2,) m/s^2, the acceleration of the surface's base; it grows with the factors (F,) as `w_tt` (n,) does.
    """
    for i in range(len(factors)):
        k = factors[i] ** 2
        for n in range(len(w_tt)):
            load, _ = rest_pull(k * w_tt[n], slope[n, 0], slope[n, 1], k * base[0], k * base[1], part)
            if not -part.law.pull_off <= load <= part.law.largest_load:
                lost[i, n] = True


@jit
def count_slips(
    w_tt: FloatArray,
    slope: FloatArray,
    base: FloatArray,
    part: Any,
    factors: FloatArray,
    lost: BoolArray,
    counts: FloatArray,
    slips: FloatArray,
) -> None:
    """Count where a part at rest slips at this moment: into `counts` (2, F) and, at the last factor, `slips` (n,)."""
    law = part.law
    for i in range(len(factors)):
        k = factors[i] ** 2
        for n in range(len(w_tt)):
            load, demand = rest_pull(k * w_tt[n], slope[n, 0], slope[n, 1], k * base[0], k * base[1], part)
            if not -law.pull_off <= load <= law.largest_load:
                continue
            if part.mass * demand > law.static_ratio * friction_limit(law, load):
                counts[0, i] += 0.0 if lost[i, n] else 1.0
                counts[1, i] += 1.0
                slips[n] += 1.0 if i == len(factors) - 1 else 0.0
