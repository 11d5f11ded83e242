"""The exact sum over all actuators, the right side and fixed steps, compiled by numba."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from particle.friction import friction_limit
from rivals.problem import GRAVITY, MASS, RADIUS

FloatArray = NDArray[np.float64]

SCALE = 1 / (16 * math.pi)

compiled = numba.njit(error_model="numpy", nogil=True)


@compiled
def quintics(coefficients: FloatArray, s: float, out: FloatArray) -> None:
    """Polynomials (N, 6), lowest power first, and their first two derivatives at s: into `out` (N, 3)."""
    for n in range(len(coefficients)):
        c = coefficients[n]
        out[n, 0] = ((((c[5] * s + c[4]) * s + c[3]) * s + c[2]) * s + c[1]) * s + c[0]
        out[n, 1] = (((5 * c[5] * s + 4 * c[4]) * s + 3 * c[3]) * s + 2 * c[2]) * s + c[1]
        out[n, 2] = ((20 * c[5] * s + 12 * c[4]) * s + 6 * c[3]) * s + 2 * c[2]


@compiled
def plate(x: float, y: float, points: FloatArray, forces: FloatArray) -> tuple:
    """w_tt, gradient (2), its rate (2), Hessian (xx, xy, yy): Boggio's function over all actuators (N, 2) [m]."""
    u, v = x / RADIUS, y / RADIUS
    w_tt = g_x = g_y = g_xt = g_yt = h_xx = h_xy = h_yy = 0.0
    for n in range(len(points)):
        p, q = points[n, 0] / RADIUS, points[n, 1] / RADIUS
        square = p * p + q * q
        d_x, d_y, e_x, e_y = u - p, v - q, square * u - p, square * v - q
        big_r = d_x * d_x + d_y * d_y
        big_s = (u * u + v * v) * square - 2 * (u * p + v * q) + 1
        ratio = big_r / big_s
        by_r, by_s = math.log(ratio), 1 - ratio
        f, f_t, f_tt = forces[n, 0], forces[n, 1], forces[n, 2]
        w_tt += f_tt * (big_r * by_r + big_s - big_r)
        slope_x, slope_y = by_r * d_x + by_s * e_x, by_r * d_y + by_s * e_y
        g_x += f * slope_x
        g_y += f * slope_y
        g_xt += f_t * slope_x
        g_yt += f_t * slope_y
        level = 0.5 * (by_r + square * by_s)
        h_xx += f * (d_x * d_x / big_r - (2 * d_x * e_x - e_x * e_x * ratio) / big_s + level)
        h_xy += f * (d_x * d_y / big_r - (d_x * e_y + d_y * e_x - e_x * e_y * ratio) / big_s)
        h_yy += f * (d_y * d_y / big_r - (2 * d_y * e_y - e_y * e_y * ratio) / big_s + level)
    a, b = 2 * SCALE / RADIUS, 4 * SCALE / RADIUS**2
    return SCALE * w_tt, a * g_x, a * g_y, a * g_xt, a * g_yt, b * h_xx, b * h_xy, b * h_yy


@compiled
def pull(f: tuple, v_x: float, v_y: float) -> tuple:
    """Acceleration without friction (x, y) [m/s^2], and the net load [N]."""
    w_tt, g_x, g_y, g_xt, g_yt, h_xx, h_xy, h_yy = f
    b = GRAVITY + w_tt + 2 * (v_x * g_xt + v_y * g_yt) + v_x * (h_xx * v_x + 2 * h_xy * v_y) + v_y * h_yy * v_y
    square = 1 + g_x * g_x + g_y * g_y
    return -b * g_x / square, -b * g_y / square, MASS * b / math.sqrt(square)


@compiled
def length(f: tuple, x: float, y: float) -> float:
    """Of a vector along the surface."""
    climb = x * f[1] + y * f[2]
    return math.sqrt(x * x + y * y + climb * climb)


@compiled
def right_side(
    time: float,
    state: FloatArray,
    points: FloatArray,
    breakpoints: FloatArray,
    forces: FloatArray,
    law: Any,
    scratch: FloatArray,
) -> FloatArray:
    """d/dt of (x, y, v_x, v_y) while the part slides; forces (S, N, 6), scratch (N, 3)."""
    x, y, v_x, v_y = state
    span = np.searchsorted(breakpoints[1:-1], time, side="right")
    quintics(forces[span], time - breakpoints[span], scratch)
    f = plate(x, y, points, scratch)
    a_x, a_y, load = pull(f, v_x, v_y)
    slow = friction_limit(law, load) / MASS / length(f, v_x, v_y)
    return np.array([v_x, v_y, a_x - slow * v_x, a_y - slow * v_y])


@compiled
def fixed_steps(
    x: float,
    y: float,
    points: FloatArray,
    breakpoints: FloatArray,
    forces: FloatArray,
    law: Any,
    step: float,
    count: int,
) -> tuple[float, float]:
    """The place [m] of a part that starts from rest, after so many steps [s] by Moreau's scheme."""
    v_x = v_y = 0.0
    span, at = 0, np.empty((len(points), 3))
    for k in range(count):
        x += 0.5 * step * v_x
        y += 0.5 * step * v_y
        time = (k + 0.5) * step
        while span + 2 < len(breakpoints) and time >= breakpoints[span + 1]:
            span += 1
        quintics(forces[span], time - breakpoints[span], at)
        f = plate(x, y, points, at)
        a_x, a_y, load = pull(f, v_x, v_y)
        free_x, free_y = v_x + step * a_x, v_y + step * a_y
        speed, most = length(f, free_x, free_y), step * friction_limit(law, load) / MASS
        kept = 1 - most / speed if speed > most else 0.0
        v_x, v_y = kept * free_x, kept * free_y
        x += 0.5 * step * v_x
        y += 0.5 * step * v_y
    return x, y
