"""A part that has come off: free flight to where it next meets the surface, and the impact there.

The flight is exact, seen from the base: gravity, and the squeeze straight down. Its height over the surface is followed
by quintics that meet it with two derivatives at both ends of a step; where the first of them becomes negative the part
lands. The impact takes away the normal velocity relative to the surface, and at most `impact_coefficient` times as much
of the tangential one. A surface whose velocity jumps under the part hits it, or leaves it behind, in the same way.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from particle.events.bernstein import first_negative
from particle.events.equations import Part
from particle.events.memory import Memory
from particle.events.motion import Counts, Motion, Now
from particle.events.request import Request
from particle.events.slide import MIN_STEP
from particle.jit import jit
from particle.modes import Mode, Verdict
from particle.surface import LocalSurface, Surface, SurfacePoint, first_beyond, rim_gap, surface_at, within_cell

FloatArray = NDArray[np.float64]

GRAZE = 1e-13  # of the surface's size: rounding of a height
MIN_JUMP = 1e-11  # of the surface's size in a stroke: smaller velocities after an impact, and jumps, are rounding


@jit
def take_off(local: LocalSurface, time: float, motion: Motion) -> None:
    """Completes `motion` by the height and the vertical velocity with which a part comes off."""
    f = surface_at(local, motion.x, motion.y, time)
    motion.z, motion.v_z = f.w, f.w_t + motion.v_x * f.w_x + motion.v_y * f.w_y


@jit
def fly(surface: Surface, request: Request, memory: Memory) -> None:
    """Moves the part on by one step of about now.h [s], at most to now.span_end, to the landing or to the rim."""
    now: Now = memory.now[0]
    motion: Motion = memory.motion[0]
    end: Motion = memory.step.end[0]
    local, part, time, remaining = memory.local, request.part, now.time, now.span_end - now.time
    here = surface_at(local, motion.x, motion.y, time)
    heights = _heights(request, memory, here, GRAZE * surface.size)
    if now.verdict != Verdict.GOES_ON:
        return
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
        _fly_ahead(local, part, here, time, motion, lands * h, end)
        memory.motion[0] = memory.step.end[0]
        now.time = now.span_end if lands == 1.0 and h == remaining else time + lands * h
        f = surface_at(local, motion.x, motion.y, now.time)
        if motion.v_z - f.w_t - motion.v_x * f.w_x - motion.v_y * f.w_y >= 0.0:
            motion.z = f.w  # on its way up: cells that differ by their error are no landing
        else:
            now.mode = land(f, part, MIN_JUMP * surface.size / request.stroke_time, motion)
    else:
        memory.motion[0] = memory.step.end[0]
        now.time = now.span_end if h == remaining else time + h
        now.h = 2 * h


@jit
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
        _fly_ahead(local, part, here, time, motion, h, end)
        good = within_cell(local, end.x, end.y)
        if good:
            b = _quintic(start, _height(surface_at(local, end.x, end.y, time + h), part, end), h)
            for share in (0.3, 0.6):
                _fly_ahead(local, part, here, time, motion, share * h, middle)
                if good and within_cell(local, middle.x, middle.y):
                    truth = surface_at(local, middle.x, middle.y, time + share * h)
                    miss = middle.z - truth.w - _at(b, share)
                    good = abs(miss) <= max(0.01 * request.tolerance, graze)
                else:
                    good = False
            if good:
                return b
        now.h = 0.5 * h


@jit
def _exit_share(surface: Surface, memory: Memory, part: Part, here: SurfacePoint, beyond: float) -> float:
    """The share of the step at which the part crosses the rim, located by halving; its motion there to step.end."""
    now: Now = memory.now[0]
    motion: Motion = memory.motion[0]
    end: Motion = memory.step.end[0]
    low, high = 0.0, beyond
    while high - low > 1e-15:
        share = 0.5 * (low + high)
        _fly_ahead(memory.local, part, here, now.time, motion, share * now.h, end)
        if rim_gap(surface, end.x, end.y) < 0.0:
            high = share
        else:
            low = share
    _fly_ahead(memory.local, part, here, now.time, motion, high * now.h, end)
    return high


@jit
def land(f: SurfacePoint, part: Part, slack: float, motion: Motion) -> int:
    """The impact of a part at `motion` on the surface, in place; what it does then, should the contact last.

    A velocity along the surface of up to `slack` [m/s] is none.
    """
    s = math.sqrt(1 + f.w_x * f.w_x + f.w_y * f.w_y)
    v_x, v_y, v_z = motion.v_x, motion.v_y, motion.v_z - f.w_t
    into = (v_z - v_x * f.w_x - v_y * f.w_y) / s
    # Velocity along the surface, before friction's impulse takes its share.
    t_x, t_y, t_z = v_x + into * f.w_x / s, v_y + into * f.w_y / s, v_z - into / s
    speed = math.sqrt(t_x * t_x + t_y * t_y + t_z * t_z)
    kept = max(0.0, 1.0 - part.law.impact_coefficient * abs(into) / speed) if speed > slack else 0.0
    after_x, after_y, after_z = kept * t_x, kept * t_y, kept * t_z
    p_x, p_y, p_z = after_x - v_x, after_y - v_y, after_z - v_z  # impulse per kg
    motion.work += part.mass * (p_x * f.base_vx + p_y * f.base_vy + p_z * f.w_t)
    motion.dissipated -= 0.5 * part.mass * (p_x * (v_x + after_x) + p_y * (v_y + after_y) + p_z * (v_z + after_z))
    motion.v_x, motion.v_y = after_x, after_y
    motion.z, motion.v_z = f.w, f.w_t + after_z
    return Mode.SLIDING if kept > 0.0 else Mode.RESTING


@jit
def velocity_jump(before: SurfacePoint, after: SurfacePoint) -> float:
    """By how much the surface's velocity [m/s] jumps."""
    x, y, z = after.base_vx - before.base_vx, after.base_vy - before.base_vy, after.w_t - before.w_t
    return math.sqrt(x * x + y * y + z * z)


@jit
def cross_jump(before: SurfacePoint, after: SurfacePoint, part: Part, mode: int, slack: float, motion: Motion) -> int:
    """What a part does when the surface's velocity jumps, which moves on `motion`.

    A surface that drops from under a part, by more than `slack` [m/s], lets go of it unless nothing can pull it off.
    """
    if mode != Mode.FLYING:
        motion.z, motion.v_z = before.w, before.w_t + motion.v_x * before.w_x + motion.v_y * before.w_y
    motion.v_x -= after.base_vx - before.base_vx
    motion.v_y -= after.base_vy - before.base_vy
    away = motion.v_z - after.w_t - motion.v_x * after.w_x - motion.v_y * after.w_y
    if mode == Mode.FLYING or (away > slack and math.isfinite(part.law.pull_off)):
        return Mode.FLYING
    return land(after, part, slack, motion)


@jit
def _fly_ahead(
    local: LocalSurface, part: Part, here: SurfacePoint, time: float, motion: Motion, h: float, out: Motion
) -> None:
    """The motion of a flying part h [s] later into `out`."""
    down = part.gravity + part.squeeze / part.mass
    out.x = motion.x + h * (motion.v_x + 0.5 * h * part.tilt_x)
    out.y = motion.y + h * (motion.v_y + 0.5 * h * part.tilt_y)
    out.v_x, out.v_y = motion.v_x + h * part.tilt_x, motion.v_y + h * part.tilt_y
    if local.frame[0].base_drives > 0:
        # x and y are counted from the base, which moves on under the part.
        later = surface_at(local, motion.x, motion.y, time + h)
        out.x -= later.base_px - here.base_px - h * here.base_vx
        out.y -= later.base_py - here.base_py - h * here.base_vy
        out.v_x -= later.base_vx - here.base_vx
        out.v_y -= later.base_vy - here.base_vy
    out.z, out.v_z = motion.z + h * (motion.v_z - 0.5 * h * down), motion.v_z - h * down
    out.work, out.dissipated = motion.work - part.squeeze * (out.z - motion.z), motion.dissipated


@jit
def _height(f: SurfacePoint, part: Part, motion: Motion) -> tuple[float, float, float]:
    """The height [m] over the surface of a flying part and its two derivatives in time."""
    v_x, v_y = motion.v_x, motion.v_y
    bend = v_x * (f.w_xx * v_x + 2 * f.w_xy * v_y) + v_y * f.w_yy * v_y
    turn = (part.tilt_x - f.base_ax) * f.w_x + (part.tilt_y - f.base_ay) * f.w_y
    falls = part.gravity + part.squeeze / part.mass + f.w_tt + 2 * (v_x * f.w_xt + v_y * f.w_yt) + bend + turn
    return motion.z - f.w, motion.v_z - f.w_t - v_x * f.w_x - v_y * f.w_y, -falls


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
