"""Slipping: what pulls and presses a part at rest, from its surface at one moment, or at many moments at one place."""

from __future__ import annotations

import math

import numpy as np

from particle.events.mechanics import Part, length, pull
from particle.jit import jit, jit_no_arrays
from particle.surface import LocalSurface, Surface, SurfacePoint, enter, surface_at
from particle.types import FloatArray


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
def rest_over_time(
    surface: Surface, local: LocalSurface, part: Part, x: float, y: float, times: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Net loads [N] and pulls [m/s^2] (n,) on a part that stays at (x, y) [m].

    times: (n,) s, ascending.  Where a cell is lacking, at `missing_place`, the rest is nan.
    """
    loads, demands = np.full(len(times), np.nan), np.full(len(times), np.nan)
    for n in range(len(times)):
        if enter(surface, local, x, y, times[n], math.inf) < 0:
            break
        f = surface_at(local, x, y, times[n])
        p = pull(f, 0.0, 0.0, part)
        loads[n], demands[n] = p.normal, length(f, p.x, p.y)
    return loads, demands
