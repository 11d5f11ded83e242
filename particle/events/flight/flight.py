"""A part that has come off: free flight to where it next meets the surface.

The centre of mass flies as in `ballistics`. The height over the surface, z - w, is followed by quintics that meet it
with two derivatives at both ends of a step; where the first of them becomes negative the part lands (`impact`).
"""

from __future__ import annotations

import math

import numpy as np

from particle.events.flight.ballistics import fly_ahead
from particle.events.flight.impact import MIN_JUMP, land
from particle.events.mechanics import (
    Counts,
    Motion,
    Now,
    Part,
    by_centre,
    carried,
    normal_bend,
    rising,
    shape_operator,
    stretched,
    to_height,
)
from particle.events.memory import Memory
from particle.events.polynomials import first_negative, quintic_between, quintic_value
from particle.events.request import Request
from particle.events.sliding import MIN_STEP
from particle.jit import device, device_no_arrays, inlined
from particle.modes import NO_EVENT, EventKind, Verdict
from particle.surface import LocalSurface, Surface, SurfacePoint, first_beyond, rim_gap, surface_at, within_cell
from particle.types import FloatArray

GRAZE = 1e-13  # of the surface's size: rounding of a height


@inlined
def take_off(local: LocalSurface, time: float, motion: Motion) -> None:
    """Completes `motion` by the height and the vertical velocity with which a part comes off."""
    f = surface_at(local, motion.x, motion.y, time)
    motion.z, motion.v_z = f.w, rising(f, motion.v_x, motion.v_y)


@inlined
def fly(surface: Surface, request: Request, memory: Memory) -> int:
    """Moves the part on by one step of about now.h [s], at most to now.span_end, to the landing or to the rim.

    Returns LANDS or NO_EVENT.
    """
    now: Now = memory.now[0]
    motion: Motion = memory.motion[0]
    end: Motion = memory.step.end[0]
    local, part, time, remaining = memory.local, request.part, now.time, now.span_end - now.time
    here = surface_at(local, motion.x, motion.y, time)
    heights = _heights(request, memory, here, GRAZE * surface.size)
    if now.verdict != Verdict.GOES_ON:
        return NO_EVENT
    h = now.h
    lands = first_negative(heights + GRAZE * surface.size)
    start_gap = rim_gap(surface, motion.x, motion.y)
    places = (motion.x, motion.y), (end.x, end.y)
    beyond = first_beyond(surface, start_gap, *places, (motion.v_x, motion.v_y), (end.v_x, end.v_y), h)
    out = rim_gap(surface, end.x, end.y) < 0.0
    if (beyond < 1.0 or out) and not lands <= beyond:
        share = _exit_share(surface, memory, part, here, beyond)
        memory.motion[0] = memory.step.end[0]
        now.time, now.verdict = time + share * h, Verdict.LEFT_PLATE
    elif lands <= 1.0:
        fly_ahead(local, part, here, time, motion, lands * h, end)
        memory.motion[0] = memory.step.end[0]
        now.time = now.span_end if lands == 1.0 and h == remaining else time + lands * h
        f = surface_at(local, motion.x, motion.y, now.time)
        if motion.v_z - rising(f, motion.v_x, motion.v_y) >= 0.0:
            motion.z = f.w  # on its way up: cells that differ by their error are no landing
        else:
            now.mode = land(f, part, MIN_JUMP * surface.size / request.stroke_time, motion)
            return EventKind.LANDS.value
    else:
        memory.motion[0] = memory.step.end[0]
        now.time = now.span_end if h == remaining else time + h
        now.h = 2 * h
    return NO_EVENT


@device
def _heights(request: Request, memory: Memory, here: SurfacePoint, graze: float) -> FloatArray:
    """The height over the surface in a step that is short enough for a quintic: its Bernstein coefficients (6,).

    The step goes to now.h, its end to step.end. Where no step is short enough the verdict says so.
    """
    now: Now = memory.now[0]
    counts: Counts = memory.counts[0]
    motion: Motion = memory.motion[0]
    end: Motion = memory.step.end[0]
    middle: Motion = memory.step.stage[0]
    local, part, time, remaining = memory.local, request.part, now.time, now.span_end - now.time
    start = _height(here, part, motion)
    while True:
        now.h = h = remaining if now.h >= 0.9 * remaining else now.h
        if h < MIN_STEP * request.stroke_time and h < remaining:
            now.verdict = Verdict.WORK_LIMIT
            return np.zeros(6)
        counts.evaluations += 3
        fly_ahead(local, part, here, time, motion, h, end)
        good = within_cell(local, end.x, end.y)
        if good:
            b = quintic_between(start, _height(surface_at(local, end.x, end.y, time + h), part, end), h)
            for share in (0.3, 0.6):
                fly_ahead(local, part, here, time, motion, share * h, middle)
                if good and within_cell(local, middle.x, middle.y):
                    truth = surface_at(local, middle.x, middle.y, time + share * h)
                    miss = middle.z - truth.w - quintic_value(b, share)
                    good = abs(miss) <= max(0.01 * request.tolerance, graze)
                else:
                    good = False
            if good:
                return b
        now.h = 0.5 * h


@inlined
def _exit_share(surface: Surface, memory: Memory, part: Part, here: SurfacePoint, beyond: float) -> float:
    """The share of the step at which the part crosses the rim, located by halving; its motion there to step.end."""
    now: Now = memory.now[0]
    motion: Motion = memory.motion[0]
    end: Motion = memory.step.end[0]
    low, high = 0.0, beyond
    while high - low > 1e-15:
        share = 0.5 * (low + high)
        fly_ahead(memory.local, part, here, now.time, motion, share * now.h, end)
        if rim_gap(surface, end.x, end.y) < 0.0:
            high = share
        else:
            low = share
    fly_ahead(memory.local, part, here, now.time, motion, high * now.h, end)
    return high


@device_no_arrays
def _height(f: SurfacePoint, part: Part, motion: Motion) -> tuple[float, float, float]:
    """The height [m] over the surface of a flying part and its two derivatives in time."""
    v_x, v_y = motion.v_x, motion.v_y
    u_x, u_y = carried(f, v_x, v_y)
    bend = v_x * (f.w_xx * v_x + 2 * f.w_xy * v_y) + v_y * f.w_yy * v_y
    a_x, a_y, a_z = part.tilt_x - f.base_ax, part.tilt_y - f.base_ay, part.gravity + part.squeeze / part.mass
    a_x, a_y, b_x, b_y = a_x - u_x, a_y - u_y, u_x, u_y
    if part.centre > 0.0:
        n, s = normal_bend(f, v_x, v_y), math.sqrt(1 + f.w_x * f.w_x + f.w_y * f.w_y)
        a_x -= part.centre * (n.x + n.down * f.w_x / s)
        a_y -= part.centre * (n.y + n.down * f.w_y / s)
        a_x, a_y = by_centre(f, part, a_x, a_y)
        c_x, c_y = to_height(shape_operator(f), part.centre, a_x, a_y)
        a_x, a_y = stretched(f, a_x, a_y)
        a_z += (c_x - a_x) * f.w_x + (c_y - a_y) * f.w_y
        a_z += part.centre * (n.x * f.w_x + n.y * f.w_y - n.down / s)
    turn = (a_x + b_x) * f.w_x + (a_y + b_y) * f.w_y
    falls = a_z + f.w_tt + 2 * (v_x * f.w_xt + v_y * f.w_yt) + bend + turn
    return motion.z - f.w, motion.v_z - rising(f, v_x, v_y), -falls
