"""Whether friction holds a resting part, and how it begins to slide.

At rest the contact needs the planar wrench W. Against a slip xi friction resists with the power D(xi) = -xi.W(xi), a
convex function whose gradient is -W(xi): the part rests while the gauge

    max over xi of -W.xi/D(xi)

is at most 1, and where it comes to 1 it begins to slip by the xi of the maximum. Beyond, its slip begins at the rate r
e with K u(e) = r e for u under friction against e. Slips are (v_1, v_2, c omega), c the mean of |rho|.
"""

from __future__ import annotations

import math
from typing import Annotated

from particle.body.balance import Balance, fill_friction, find_rates
from particle.body.face import Face
from particle.body.press import press
from particle.body.wrench import fill_wrenches
from particle.events.mechanics import Part
from particle.friction import LOCAL
from particle.jit import device_no_arrays
from particle.records import Record
from particle.types import FloatArray

TURNS, SETTLED = 60, 1e-12
SMALL = 1e-11  # of D, what is still gained: one more of Newton's steps, each of which squares it, and it is rounding
STEP = 1e-6  # of a slip, to see how friction turns with it


class Search(Record):
    """Scratch memory of the searches: slips and wrenches."""

    needed: Annotated[FloatArray, 3]
    e: Annotated[FloatArray, 3]
    normal: Annotated[FloatArray, 3]
    plane: Annotated[FloatArray, 2, 3]
    friction: Annotated[FloatArray, 3]


@device_no_arrays
def needed(b: Balance, out: FloatArray) -> None:
    """W at u = 0 into `out` (3,)."""
    for i in range(3):
        out[i] = b.forces[i, 0]
        for j in range(3):
            out[i] -= b.workless[i, j] * b.forces[3 + j, 0]


@device_no_arrays
def _directions(e: FloatArray, out: FloatArray) -> None:
    """Two unit vectors at right angles to e (3,) into the rows of `out` (2, 3)."""
    k = 0
    for i in range(3):
        if abs(e[i]) < abs(e[k]):
            k = i
    size = 0.0
    for i in range(3):
        out[0, i] = (1.0 if i == k else 0.0) - e[k] * e[i]
        size += out[0, i] * out[0, i]
    for i in range(3):
        out[0, i] /= math.sqrt(size)
    for i in range(3):
        j, m = (i + 1) % 3, (i + 2) % 3
        out[1, i] = e[j] * out[0, m] - e[m] * out[0, j]


@device_no_arrays
def gauge(part: Part, face: Face, b: Balance, s: Search) -> float:
    """The gauge of the wrench s.needed under the load b.load; the slip of the maximum, a unit vector, into s.e.

    Newton's method for the least D on the plane -W.xi = 1.
    """
    if part.law.kind == LOCAL:
        press(part.law, face, b.load, b, True)
    c = face.arm
    w_1, w_2, w_3 = s.needed[0], s.needed[1], s.needed[2] / c
    size = math.sqrt(w_1 * w_1 + w_2 * w_2 + w_3 * w_3)
    if size == 0.0:
        s.e[0], s.e[1], s.e[2] = 1.0, 0.0, 0.0
        return 0.0
    s.normal[0], s.normal[1], s.normal[2] = -w_1 / size, -w_2 / size, -w_3 / size
    _directions(s.normal, s.plane)
    # xi = normal + p_1 plane_1 + p_2 plane_2
    p_1 = p_2 = 0.0
    best = _resistance(part, face, p_1, p_2, b, s, s.friction)
    for _ in range(TURNS):
        if not best > 0.0:
            break
        for i in range(3):
            s.e[i] = s.friction[i]
        g_1, g_2 = _dot(s.plane[0], s.e), _dot(s.plane[1], s.e)  # minus the gradient
        step = STEP * math.sqrt(1.0 + p_1 * p_1 + p_2 * p_2)
        _resistance(part, face, p_1 + step, p_2, b, s, s.friction)
        h_11, h_12 = (g_1 - _dot(s.plane[0], s.friction)) / step, (g_2 - _dot(s.plane[1], s.friction)) / step
        _resistance(part, face, p_1, p_2 + step, b, s, s.friction)
        h_22 = (g_2 - _dot(s.plane[1], s.friction)) / step
        det = h_11 * h_22 - h_12 * h_12
        if det > 0.0 and h_11 > 0.0:
            d_1, d_2 = (h_22 * g_1 - h_12 * g_2) / det, (h_11 * g_2 - h_12 * g_1) / det
        else:
            length = math.hypot(g_1, g_2)
            d_1, d_2 = (g_1 / length, g_2 / length) if length > 0.0 else (0.0, 0.0)
        share, gain = 1.0, g_1 * d_1 + g_2 * d_2
        while True:
            found = _resistance(part, face, p_1 + share * d_1, p_2 + share * d_2, b, s, s.friction)
            if found <= best - 1e-4 * share * gain or share < 1e-9 or gain <= SMALL * best:
                break
            share *= 0.5
        p_1, p_2, best = p_1 + share * d_1, p_2 + share * d_2, found
        if share < 1e-9 or gain <= SMALL * best:
            break
    size_e = math.sqrt(1.0 + p_1 * p_1 + p_2 * p_2)
    for i in range(3):
        s.e[i] = (s.normal[i] + p_1 * s.plane[0, i] + p_2 * s.plane[1, i]) / size_e
    return size / best if best > 0.0 else math.inf


@device_no_arrays
def _dot(a: FloatArray, b: FloatArray) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@device_no_arrays
def _resistance(part: Part, face: Face, p_1: float, p_2: float, b: Balance, s: Search, out: FloatArray) -> float:
    """D [N] at normal + p_1 plane_1 + p_2 plane_2, and the wrench of friction, its torque over c, into `out`."""
    x = s.normal[0] + p_1 * s.plane[0, 0] + p_2 * s.plane[1, 0]
    y = s.normal[1] + p_1 * s.plane[0, 1] + p_2 * s.plane[1, 1]
    z = s.normal[2] + p_1 * s.plane[0, 2] + p_2 * s.plane[1, 2]
    if part.law.kind != LOCAL:
        fill_wrenches(face, x, y, z / face.arm, b.wrenches)
    fill_friction(part, face, x, y, z / face.arm, b)
    for i in range(3):
        out[i] = part.law.static_ratio * b.friction[i, 0] / (face.arm if i == 2 else 1.0)
    return -(x * out[0] + y * out[1] + z * out[2])


@device_no_arrays
def slip_rate(part: Part, face: Face, b: Balance, s: Search) -> float:
    """r [m/s^2] with K u(e) = r e at rest, and e into s.e, from the e there; 0 or less, or nan: there is none.

    Newton's method in r and the two directions across e.
    """
    e, p = s.e, s.plane
    if not _acceleration(part, face, e[0], e[1], e[2], b, s):
        return math.nan
    rate = _dot(s.friction, e)
    for _ in range(TURNS):
        _directions(e, p)
        for i in range(3):
            s.needed[i] = s.friction[i]
        along = _dot(s.needed, e)
        off_1, off_2 = _dot(s.needed, p[0]), _dot(s.needed, p[1])
        if not _acceleration(part, face, e[0] + STEP * p[0, 0], e[1] + STEP * p[0, 1], e[2] + STEP * p[0, 2], b, s):
            return math.nan
        a_11, a_21 = (_dot(s.friction, p[0]) - off_1) / STEP, (_dot(s.friction, p[1]) - off_2) / STEP
        if not _acceleration(part, face, e[0] + STEP * p[1, 0], e[1] + STEP * p[1, 1], e[2] + STEP * p[1, 2], b, s):
            return math.nan
        a_12, a_22 = (_dot(s.friction, p[0]) - off_1) / STEP, (_dot(s.friction, p[1]) - off_2) / STEP
        a_11, a_22 = a_11 - along, a_22 - along
        det = a_11 * a_22 - a_12 * a_21
        if det == 0.0 or not math.isfinite(det):
            return math.nan
        d_1, d_2 = -(a_22 * off_1 - a_12 * off_2) / det, -(a_11 * off_2 - a_21 * off_1) / det
        longest = max(abs(d_1), abs(d_2))
        share = min(1.0, 0.3 / longest) if longest > 0.0 else 1.0
        size = 0.0
        for i in range(3):
            e[i] += share * (d_1 * p[0, i] + d_2 * p[1, i])
            size += e[i] * e[i]
        for i in range(3):
            e[i] /= math.sqrt(size)
        if not _acceleration(part, face, e[0], e[1], e[2], b, s):
            return math.nan
        rate = _dot(s.friction, e)
        if longest < SETTLED:
            break
    return rate


@device_no_arrays
def _acceleration(part: Part, face: Face, x: float, y: float, z: float, b: Balance, s: Search) -> bool:
    """K u, its last over 1/c, under friction against the slip (x, y, z/c), into s.friction."""
    c = face.arm
    if not find_rates(part, face, x, y, z / c, b):
        return False
    for i in range(3):
        s.friction[i] = b.planar[i, 0] * b.rates[0] + b.planar[i, 1] * b.rates[1] + b.planar[i, 2] * b.rates[2]
    s.friction[2] *= c
    return True
