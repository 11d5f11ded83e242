"""A part that has come off: free flight to where it next meets the surface, and the impact there.

The flight is exact, seen from the base: gravity, and the squeeze straight down. Its height over the surface is followed
by quintics that meet it with two derivatives at both ends of a step; where the first of them becomes negative the part
lands. The impact takes away the normal velocity relative to the surface, and at most `impact_coefficient` times as much
of the tangential one. A surface whose velocity jumps under the part hits it, or leaves it behind, in the same way.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from particle.events.bernstein import first_negative
from particle.events.equations import Part
from particle.events.record import FLYING, RESTING, SLIDING
from particle.events.slide import GOES_ON, LEFT_PLATE, SHORTEST, WORK_LIMIT, Request
from particle.jit import jit
from particle.surface import BASE, Fields, fields, first_beyond, rim_gap, within_cell

FloatArray = NDArray[np.float64]

GRAZE = 1e-13  # of the surface's size: rounding of a height
JUMP = 1e-11  # of the surface's size in a stroke: smaller velocities after an impact, and jumps of them, are rounding


@jit
def take_off(local: Any, time: float, state: FloatArray) -> None:
    """Completes `state` (x, y, v_x, v_y, ...) by the height and the vertical velocity with which a part comes off."""
    f = fields(local, state[0], state[1], time)
    state[6], state[7] = f.w, f.w_t + state[2] * f.x + state[3] * f.y


@jit
def fly(
    surface: Any,
    local: Any,
    request: Request,
    count: NDArray[np.int64],
    time: float,
    h: float,
    span_end: float,
    state: FloatArray,
) -> tuple[int, float, float, int]:
    """Moves `state` on by one step of about h [s], at most to `span_end`, to the landing or to the rim.

    Returns what the part does then, the time, the next h and how the path ended (GOES_ON: it did not).
    """
    part, graze = request.part, GRAZE * surface.size
    end, middle = state.copy(), state.copy()
    here = fields(local, state[0], state[1], time)
    start = _height(here, part, state)
    remaining = span_end - time
    while True:
        h = remaining if h >= 0.9 * remaining else h
        if h < SHORTEST * request.stroke_time and h < remaining:
            return FLYING, time, h, WORK_LIMIT
        count[0] += 3
        _ahead(local, part, here, time, state, h, end)
        if not within_cell(local, end[0], end[1]):
            h *= 0.5
            continue
        stop = _height(fields(local, end[0], end[1], time + h), part, end)
        b = _quintic(start, stop, h)
        good = True
        for share in (0.3, 0.6):
            _ahead(local, part, here, time, state, share * h, middle)
            if good and within_cell(local, middle[0], middle[1]):
                truth = fields(local, middle[0], middle[1], time + share * h)
                miss = middle[6] - truth.w - _at(b, share)
                good = abs(miss) <= max(0.01 * request.tolerance, graze)
            else:
                good = False
        if not good:
            h *= 0.5
            continue
        break
    lands = first_negative(b + graze)
    rates = np.zeros((2, 2))
    rates[0], rates[1] = state[2:4], end[2:4]
    beyond = first_beyond(surface, rim_gap(surface, state[0], state[1]), state, end, rates[0], rates[1], h)
    out = rim_gap(surface, end[0], end[1]) < 0.0
    if (beyond < 1.0 or out) and not lands <= beyond:
        low, high = 0.0, beyond
        while high - low > 1e-15:
            share = 0.5 * (low + high)
            _ahead(local, part, here, time, state, share * h, end)
            if rim_gap(surface, end[0], end[1]) < 0.0:
                high = share
            else:
                low = share
        _ahead(local, part, here, time, state, high * h, end)
        state[:] = end
        return FLYING, time + high * h, h, LEFT_PLATE
    if lands <= 1.0:
        _ahead(local, part, here, time, state, lands * h, end)
        state[:] = end
        at = span_end if lands == 1.0 and h == remaining else time + lands * h
        f = fields(local, state[0], state[1], at)
        if state[7] - f.w_t - state[2] * f.x - state[3] * f.y >= 0.0:
            state[6] = f.w  # on its way up: cells that differ by their error are no landing
            return FLYING, at, h, GOES_ON
        slack = JUMP * surface.size / request.stroke_time
        return land(f, part, slack, state), at, h, GOES_ON
    state[:] = end
    return FLYING, (span_end if h == remaining else time + h), 2 * h, GOES_ON


@jit
def land(f: Fields, part: Part, slack: float, state: FloatArray) -> int:
    """The impact of a part at `state` on the surface, in place; what it does then, should the contact last.

    A velocity along the surface of up to `slack` [m/s] is none.
    """
    s = math.sqrt(1 + f.x * f.x + f.y * f.y)
    v_x, v_y, v_z = state[2], state[3], state[7] - f.w_t
    into = (v_z - v_x * f.x - v_y * f.y) / s
    # Velocity along the surface, before friction's impulse takes its share.
    t_x, t_y, t_z = v_x + into * f.x / s, v_y + into * f.y / s, v_z - into / s
    speed = math.sqrt(t_x * t_x + t_y * t_y + t_z * t_z)
    kept = max(0.0, 1.0 - part.law.impact_coefficient * abs(into) / speed) if speed > slack else 0.0
    after_x, after_y, after_z = kept * t_x, kept * t_y, kept * t_z
    p_x, p_y, p_z = after_x - v_x, after_y - v_y, after_z - v_z  # impulse per kg
    state[4] += part.mass * (p_x * f.base_vx + p_y * f.base_vy + p_z * f.w_t)
    state[5] -= 0.5 * part.mass * (p_x * (v_x + after_x) + p_y * (v_y + after_y) + p_z * (v_z + after_z))
    state[2], state[3] = after_x, after_y
    state[6], state[7] = f.w, f.w_t + after_z
    return SLIDING if kept > 0.0 else RESTING


@jit
def jump(before: Fields, after: Fields) -> float:
    """By how much the surface's velocity [m/s] jumps."""
    x, y, z = after.base_vx - before.base_vx, after.base_vy - before.base_vy, after.w_t - before.w_t
    return math.sqrt(x * x + y * y + z * z)


@jit
def jolt(before: Fields, after: Fields, part: Part, mode: int, slack: float, state: FloatArray) -> int:
    """What a part does when the surface's velocity jumps, which moves on `state`.

    A surface that drops from under a part, by more than `slack` [m/s], lets go of it unless nothing can pull it off.
    """
    if mode != FLYING:
        state[6], state[7] = before.w, before.w_t + state[2] * before.x + state[3] * before.y
    state[2] -= after.base_vx - before.base_vx
    state[3] -= after.base_vy - before.base_vy
    away = state[7] - after.w_t - state[2] * after.x - state[3] * after.y
    if mode == FLYING or (away > slack and math.isfinite(part.law.pull_off)):
        return FLYING
    return land(after, part, slack, state)


@jit
def _ahead(local: Any, part: Part, here: Fields, time: float, state: FloatArray, h: float, out: FloatArray) -> None:
    """The state of a flying part h [s] later."""
    down = part.gravity + part.squeeze / part.mass
    out[0] = state[0] + h * (state[2] + 0.5 * h * part.tilt_x)
    out[1] = state[1] + h * (state[3] + 0.5 * h * part.tilt_y)
    out[2], out[3] = state[2] + h * part.tilt_x, state[3] + h * part.tilt_y
    if local.counts[BASE] > 0:
        # x and y are counted from the base, which moves on under the part.
        later = fields(local, state[0], state[1], time + h)
        out[0] -= later.base_px - here.base_px - h * here.base_vx
        out[1] -= later.base_py - here.base_py - h * here.base_vy
        out[2] -= later.base_vx - here.base_vx
        out[3] -= later.base_vy - here.base_vy
    out[6], out[7] = state[6] + h * (state[7] - 0.5 * h * down), state[7] - h * down
    out[4], out[5] = state[4] - part.squeeze * (out[6] - state[6]), state[5]


@jit
def _height(f: Fields, part: Part, state: FloatArray) -> tuple[float, float, float]:
    """The height [m] over the surface of a flying part and its two derivatives in time."""
    v_x, v_y = state[2], state[3]
    bend = v_x * (f.xx * v_x + 2 * f.xy * v_y) + v_y * f.yy * v_y
    turn = (part.tilt_x - f.base_ax) * f.x + (part.tilt_y - f.base_ay) * f.y
    falls = part.gravity + part.squeeze / part.mass + f.w_tt + 2 * (v_x * f.xt + v_y * f.yt) + bend + turn
    return state[6] - f.w, state[7] - f.w_t - v_x * f.x - v_y * f.y, -falls


@jit
def _at(b: FloatArray, s: float) -> float:
    """A quintic of Bernstein coefficients b at s."""
    r = 1.0 - s
    outer = b[0] * r**5 + 5 * b[1] * r**4 * s + 5 * b[4] * r * s**4 + b[5] * s**5
    return float(outer + 10 * r * r * s * s * (b[2] * r + b[3] * s))


@jit
def _quintic(start: tuple[float, float, float], end: tuple[float, float, float], h: float) -> FloatArray:
    """Bernstein coefficients (6,) of the quintic over h [s] with these values and derivatives at its ends."""
    return np.array(
        [
            start[0],
            start[0] + h * start[1] / 5,
            start[0] + 2 * h * start[1] / 5 + h * h * start[2] / 20,
            end[0] - 2 * h * end[1] / 5 + h * h * end[2] / 20,
            end[0] - h * end[1] / 5,
            end[0],
        ]
    )
