"""A quick bound of what friction must resist: it proves most rests, over long subintervals, at little cost.

No tangential part of a vector V is longer than V less any multiple of the normal. With G the slope as seen in space,
U = gravity + w_tt, a the acceleration in the plane less gravity's share in it, and z the height of the centre of mass,

    |p| <= |a + U G - z G''| + z (5/2 g^2 g'' + 4 g g'^2 + 6 g^3 g'^2)

for bounds g, g', g'' of |G|, |G'|, |G''|. As grad w = (I + grad u)^T G, the first term is within
U e g + z (e'' g + 2 e' g' + e g'') of |a + U grad w - z grad w''|, a vector of polynomials of degree 8; e, e' and e''
bound |grad u| and its rates. With K of `mechanics.equations`, a bound c of the curvatures and the contact's height z_k,
|K^-1 p| <= |p| (1 + (z - z_k) c / (1 - z_k c)).
"""

from __future__ import annotations

import math

import numpy as np

from particle.drives import ORDER
from particle.events.mechanics import Part
from particle.events.polynomials import quintic_to_bernstein
from particle.friction import friction_limit
from particle.jit import device_no_arrays
from particle.types import FloatArray

DEGREE = 8  # of the bound's polynomials
_TO_BERNSTEIN = np.array(
    [[math.comb(i, k) / math.comb(DEGREE, k) for k in range(DEGREE + 1)] for i in range(DEGREE + 1)]
)
MAX_STRETCH = 0.5  # of the gradient of u, up to which the bound is of use


@device_no_arrays
def _extremes(row: FloatArray, lasting: float, b: FloatArray) -> tuple[float, float, float]:
    """Bounds of the size of a quintic (6,) of the share of `lasting` [s] and of its two derivatives; b: scratch."""
    quintic_to_bernstein(row, b)
    largest = fastest = sharpest = 0.0
    for k in range(ORDER):
        largest = max(largest, abs(b[k]))
    for k in range(ORDER - 1):
        fastest = max(fastest, abs(b[k + 1] - b[k]))
    for k in range(ORDER - 2):
        sharpest = max(sharpest, abs(b[k] - 2 * b[k + 1] + b[k + 2]))
    return largest, 5 * fastest / lasting, 20 * sharpest / (lasting * lasting)


@device_no_arrays
def is_safe_by_bound(
    part: Part, motion: FloatArray, plane: FloatArray, lasting: float, b: FloatArray, force: FloatArray
) -> bool:
    """Whether the bound leaves the part at rest; b (6,), force (9,): scratch.

    With G the slope seen in space, |G| <= |grad w| / (1 - |grad u|), and so on for its derivatives.
    """
    e = e_t = e_tt = g = g_t = g_tt = 0.0
    for along in range(2):
        for row in (1, 2):
            size, rate, bend = _extremes(plane[along, row], lasting, b)
            e, e_t, e_tt = e + size * size, e_t + rate * rate, e_tt + bend * bend
    for row in (1, 2):
        size, rate, bend = _extremes(motion[row], lasting, b)
        g, g_t, g_tt = g + size * size, g_t + rate * rate, g_tt + bend * bend
    e, e_t, e_tt = math.sqrt(e), math.sqrt(e_t), math.sqrt(e_tt)
    g, g_t, g_tt = math.sqrt(g), math.sqrt(g_t), math.sqrt(g_tt)
    if e > MAX_STRETCH:
        return False
    kept = 1.0 - e
    g = g / kept
    g_t = (g_t + e_t * g) / kept
    g_tt = (g_tt + 2 * e_t * g_t + e_tt * g) / kept
    a_x = _extremes(plane[0, 0], lasting, b)[2] + abs(part.tilt_x)
    a_y = _extremes(plane[1, 0], lasting, b)[2] + abs(part.tilt_y)
    a = math.hypot(a_x, a_y)
    quintic_to_bernstein(motion[0], b)
    least, most = math.inf, -math.inf
    for k in range(ORDER - 2):
        upright = part.gravity + 20 * (b[k] - 2 * b[k + 1] + b[k + 2]) / (lasting * lasting)
        least, most = min(least, upright), max(most, upright)
    s = math.sqrt(1.0 + g * g)
    turn = part.centre * g_t * g_t
    load_low = part.mass * ((least / s if least > 0.0 else least) - a * g - turn) + part.squeeze
    load_high = part.mass * ((most if most > 0.0 else most / s) + a * g) + part.squeeze
    if load_low < -part.law.pull_off or load_high > part.law.largest_load:
        return False
    limit = part.law.static_ratio * friction_limit(part.law, load_low) / part.mass
    rest = max(abs(least), abs(most)) * e * g + part.centre * (e_tt * g + 2 * e_t * g_t + e * g_tt)
    rest += part.centre * (2.5 * g * g * g_tt + (4 + 6 * g * g) * g * g_t * g_t)
    needed = largest_force(part, motion, plane, lasting, force) + rest
    if part.centre != part.contact:
        curvature = (_largest_bend(motion, lasting, b) + g * _largest_bend(plane[0], lasting, b)) / (kept * kept)
        curvature += g * _largest_bend(plane[1], lasting, b) / (kept * kept)
        if part.contact * curvature >= 1.0:
            return False
        needed *= 1.0 + (part.centre - part.contact) * curvature / (1.0 - part.contact * curvature)
    return bool(needed <= limit)


@device_no_arrays
def _largest_bend(rows: FloatArray, lasting: float, b: FloatArray) -> float:
    """A bound [1/m] of the matrix of second derivatives by x and y of rows (6, 6); b: scratch."""
    xx, xy, yy = _extremes(rows[3], lasting, b)[0], _extremes(rows[4], lasting, b)[0], _extremes(rows[5], lasting, b)[0]
    return math.sqrt(xx * xx + 2 * xy * xy + yy * yy)


@device_no_arrays
def largest_force(part: Part, motion: FloatArray, plane: FloatArray, lasting: float, force: FloatArray) -> float:
    """What |a + U grad w - z grad w''| is at most [m/s^2]; force: scratch."""
    rate, square = 1.0 / (lasting * lasting), 0.0
    for row, along, tilt in ((1, 0, part.tilt_x), (2, 1, part.tilt_y)):
        for k in range(DEGREE + 1):
            force[k] = 0.0
        force[0] = -tilt
        for k in range(ORDER - 2):
            twice = (k + 2) * (k + 1) * rate
            force[k] += twice * (plane[along, 0, k + 2] - part.centre * motion[row, k + 2])
            upright = twice * motion[0, k + 2] + (part.gravity if k == 0 else 0.0)
            for j in range(ORDER):
                force[k + j] += upright * motion[row, j]
        most = 0.0
        for i in range(DEGREE + 1):
            coefficient = 0.0
            for k in range(i + 1):
                coefficient += _TO_BERNSTEIN[i, k] * force[k]
            most = max(most, abs(coefficient))
        square += most * most
    return math.sqrt(square)
