"""Slipping: at which of many places a part at rest would slip, and at which it would come off, at one moment."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from particle.events.equations import Part, length, pull
from particle.friction import friction_limit
from particle.jit import jit, jit_no_arrays
from particle.surface import SurfacePoint

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]


@jit_no_arrays
def load_and_demand(
    w_tt: float,
    slope: tuple[float, float],
    slope_t: tuple[float, float],
    slope_tt: tuple[float, float],
    base: tuple[float, float],
    part: Part,
) -> tuple[float, float]:
    """The net load [N] of a part at rest, and the pull [m/s^2] that friction must hold.

    slope_t, slope_tt: 1/s and 1/s^2, the rates of the slope.  base: m/s^2, the acceleration of the surface's base.
    """
    f = SurfacePoint(
        *(0.0, 0.0, w_tt, slope[0], slope[1], slope_t[0], slope_t[1], 0.0, 0.0, 0.0, slope_tt[0], slope_tt[1]),
        *(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, base[0], base[1]),
        *(1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    )
    p = pull(f, 0.0, 0.0, part)
    return p.normal, length(f, p.x, p.y)


@jit
def find_lost(
    w_tt: FloatArray,
    slopes: tuple[FloatArray, FloatArray, FloatArray],
    base: FloatArray,
    part: Part,
    factors: FloatArray,
    lost: BoolArray,
) -> None:
    """Mark in `lost` (F, n) the places where a part at rest is not held by its contact at this moment.

    slopes: (n, 2), the slope and its two rates.  base: (n, 2) m/s^2, the acceleration in the plane.  Rates grow
    with the factors (F,) of the drives' frequencies, accelerations with their squares.
    """
    for i in range(len(factors)):
        for n in range(len(w_tt)):
            load, _ = _at_factor(w_tt, slopes, base, part, factors[i], n)
            if not -part.law.pull_off <= load <= part.law.largest_load:
                lost[i, n] = True


@jit
def count_slips(
    w_tt: FloatArray,
    slopes: tuple[FloatArray, FloatArray, FloatArray],
    base: FloatArray,
    part: Part,
    factors: FloatArray,
    lost: BoolArray,
    counts: FloatArray,
    slips: FloatArray,
) -> None:
    """Count where a part at rest slips at this moment: into `counts` (2, F) and, at the last factor, `slips` (n,)."""
    law = part.law
    for i in range(len(factors)):
        for n in range(len(w_tt)):
            load, demand = _at_factor(w_tt, slopes, base, part, factors[i], n)
            if not -law.pull_off <= load <= law.largest_load:
                continue
            if part.mass * demand > law.static_ratio * friction_limit(law, load):
                counts[0, i] += 0.0 if lost[i, n] else 1.0
                counts[1, i] += 1.0
                slips[n] += 1.0 if i == len(factors) - 1 else 0.0


@jit_no_arrays
def _at_factor(
    w_tt: FloatArray,
    slopes: tuple[FloatArray, FloatArray, FloatArray],
    base: FloatArray,
    part: Part,
    factor: float,
    n: int,
) -> tuple[float, float]:
    """Load and demand at the n-th place with the drives' frequencies multiplied by a factor."""
    slope, slope_t, slope_tt = slopes
    k = factor**2
    return load_and_demand(
        k * w_tt[n],
        (slope[n, 0], slope[n, 1]),
        (factor * slope_t[n, 0], factor * slope_t[n, 1]),
        (k * slope_tt[n, 0], k * slope_tt[n, 1]),
        (k * base[n, 0], k * base[n, 1]),
        part,
    )
