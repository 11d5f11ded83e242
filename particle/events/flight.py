"""A part that has come off: free flight to where it next meets the surface, and the impact there.

The centre of mass flies exactly, seen from the base, and from the material where that moves in its plane: gravity, and
the squeeze straight down. The part's attitude stays that of the surface under it: (x, y) is the point of the mid-plane
whose normal goes through the centre of mass, and z the latter's height less its share of that normal, so that a part on
the surface has z = w. The height over the surface, z - w, is followed by quintics that meet it with two derivatives
at both ends of a step; where the first of them becomes negative the part lands. The impact takes away the centre's
normal velocity relative to the surface, and at most `impact_coefficient` times as much of the tangential one. A surface
whose velocity jumps under the part hits it, or leaves it behind, in the same way.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from particle.events.bernstein import first_negative
from particle.events.equations import Part, by_centre, carried, of_centre, rising
from particle.events.memory import Memory
from particle.events.motion import Counts, Motion, Now
from particle.events.parallel import normal_bend, normal_rate, shape_operator, stretched, to_height, unstretched
from particle.events.request import Request
from particle.events.slide import MIN_STEP
from particle.jit import jit
from particle.modes import Mode, Verdict
from particle.surface import LocalSurface, Surface, SurfacePoint, first_beyond, rim_gap, surface_at, within_cell

FloatArray = NDArray[np.float64]

GRAZE = 1e-13  # of the surface's size: rounding of a height
MIN_JUMP = 1e-11  # of the surface's size in a stroke: smaller velocities after an impact, and jumps, are rounding
MAX_NEWTON, PLACED = 20, 1e-15  # of the place and of the height of the centre of mass


@jit
def take_off(local: LocalSurface, time: float, motion: Motion) -> None:
    """Completes `motion` by the height and the vertical velocity with which a part comes off."""
    f = surface_at(local, motion.x, motion.y, time)
    motion.z, motion.v_z = f.w, rising(f, motion.v_x, motion.v_y)


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
        if motion.v_z - rising(f, motion.v_x, motion.v_y) >= 0.0:
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
    v_x, v_y = stretched(f, motion.v_x, motion.v_y)
    v_z = motion.v_z - f.w_t
    into = (v_z - v_x * f.w_x - v_y * f.w_y) / s
    # Velocity of the centre along the surface, before friction's impulse takes its share.
    t_x, t_y, t_z = v_x + into * f.w_x / s, v_y + into * f.w_y / s, v_z - into / s
    if part.centre > 0.0:
        c_x, c_y = of_centre(f, part, motion.v_x, motion.v_y)
        t_x, t_y = t_x + c_x - v_x, t_y + c_y - v_y
        t_z = t_x * f.w_x + t_y * f.w_y
    speed = math.sqrt(t_x * t_x + t_y * t_y + t_z * t_z)
    kept = max(0.0, 1.0 - part.law.impact_coefficient * abs(into) / speed) if speed > slack else 0.0
    after_x, after_y, after_z = kept * t_x, kept * t_y, kept * t_z
    if part.centre > 0.0:
        v_x, v_y, v_z = t_x - into * f.w_x / s, t_y - into * f.w_y / s, t_z + into / s
    p_x, p_y, p_z = after_x - v_x, after_y - v_y, after_z - v_z  # impulse per kg
    n_x, n_y, n_z = normal_rate(f, 0.0, 0.0)
    z = part.centre
    motion.work += part.mass * (p_x * (f.base_vx + z * n_x) + p_y * (f.base_vy + z * n_y) + p_z * (f.w_t + z * n_z))
    motion.dissipated -= 0.5 * part.mass * (p_x * (v_x + after_x) + p_y * (v_y + after_y) + p_z * (v_z + after_z))
    motion.v_x, motion.v_y = by_centre(f, part, after_x, after_y)
    motion.z, motion.v_z = f.w, rising(f, motion.v_x, motion.v_y) if z > 0.0 else f.w_t + after_z
    return Mode.SLIDING if kept > 0.0 else Mode.RESTING


@jit
def velocity_jump(before: SurfacePoint, after: SurfacePoint, part: Part) -> float:
    """By how much the velocity [m/s] of a part at rest on the surface jumps."""
    x, y, z = after.base_vx - before.base_vx, after.base_vy - before.base_vy, after.w_t - before.w_t
    turn = math.hypot(after.w_xt - before.w_xt, after.w_yt - before.w_yt)
    return math.sqrt(x * x + y * y + z * z) + part.centre * turn


@jit
def cross_jump(before: SurfacePoint, after: SurfacePoint, part: Part, mode: int, slack: float, motion: Motion) -> int:
    """What a part does when the surface's velocity jumps, which moves on `motion`.

    A surface that drops from under a part, by more than `slack` [m/s], lets go of it unless nothing can pull it off.
    """
    if mode != Mode.FLYING:
        motion.z, motion.v_z = before.w, rising(before, motion.v_x, motion.v_y)
    u_x, u_y, u_z = _centre_velocity(before, part, motion)
    u_x -= after.base_vx - before.base_vx
    u_y -= after.base_vy - before.base_vy
    _from_centre_velocity(after, part, u_x, u_y, u_z, motion)
    away = motion.v_z - rising(after, motion.v_x, motion.v_y)
    if mode == Mode.FLYING or (away > slack and math.isfinite(part.law.pull_off)):
        return Mode.FLYING
    return land(after, part, slack, motion)


@jit
def _fly_ahead(
    local: LocalSurface, part: Part, here: SurfacePoint, time: float, motion: Motion, h: float, out: Motion
) -> None:
    """The motion of a flying part h [s] later into `out`."""
    down = part.gravity + part.squeeze / part.mass
    n_x, n_y, n_z = _centre_height(here, part)
    u_x, u_y, u_z = _centre_velocity(here, part, motion)
    x, y = motion.x + n_x + h * (u_x + 0.5 * h * part.tilt_x), motion.y + n_y + h * (u_y + 0.5 * h * part.tilt_y)
    z = motion.z + n_z + h * (u_z - 0.5 * h * down)
    u_x, u_y, u_z = u_x + h * part.tilt_x, u_y + h * part.tilt_y, u_z - h * down
    later = here
    if local.frame[0].base_drives > 0 or local.frame[0].in_plane > 0:
        # x and y are counted from the base, which moves on under the part, or from where X is.
        later = surface_at(local, motion.x, motion.y, time + h)
        x -= later.base_px - here.base_px - h * here.base_vx
        y -= later.base_py - here.base_py - h * here.base_vy
        u_x -= later.base_vx - here.base_vx
        u_y -= later.base_vy - here.base_vy
    out.work, out.dissipated = motion.work - part.squeeze * (z - motion.z - n_z), motion.dissipated
    out.x, out.y, out.z = x, y, z
    if part.centre > 0.0 or local.frame[0].in_plane > 0:
        _put_place(local, part, time + h, (later.base_px, later.base_py), x, y, z, out)
        f = surface_at(local, out.x, out.y, time + h)
        if local.frame[0].in_plane > 0:
            u_x, u_y = u_x - (f.base_vx - later.base_vx), u_y - (f.base_vy - later.base_vy)
        _from_centre_velocity(f, part, u_x, u_y, u_z, out)
    else:
        out.v_x, out.v_y, out.v_z = u_x, u_y, u_z


@jit
def _put_place(
    local: LocalSurface,
    part: Part,
    time: float,
    base: tuple[float, float],
    x: float,
    y: float,
    z: float,
    out: Motion,
) -> None:
    """The place in `out` of a part whose centre of mass is at (x, y, z) [m], counted from `base` (x, y) [m].

    Newton's steps from straight below.
    """
    in_plane = local.frame[0].in_plane > 0
    for _ in range(MAX_NEWTON):
        f = surface_at(local, out.x, out.y, time)
        n_x, n_y, n_z = _centre_height(f, part)
        if in_plane:
            n_x, n_y = n_x + f.base_px - base[0], n_y + f.base_py - base[1]
        step_x, step_y = by_centre(f, part, x - n_x - out.x, y - n_y - out.y)
        out.x, out.y, out.z = out.x + step_x, out.y + step_y, z - n_z
        if abs(step_x) + abs(step_y) <= PLACED * (part.centre + abs(out.x) + abs(out.y)):
            return


@jit
def _centre_height(f: SurfacePoint, part: Part) -> tuple[float, float, float]:
    """From a part's place [m] to its centre of mass, in space."""
    s = math.sqrt(1 + f.w_x * f.w_x + f.w_y * f.w_y)
    return -part.centre * f.w_x / s, -part.centre * f.w_y / s, part.centre / s


@jit
def _centre_velocity(f: SurfacePoint, part: Part, motion: Motion) -> tuple[float, float, float]:
    """The velocity [m/s] of the centre of mass of a flying part, seen from the base."""
    s_x, s_y = stretched(f, motion.v_x, motion.v_y)
    if part.centre == 0.0:
        return s_x, s_y, motion.v_z
    n_x, n_y, n_z = normal_rate(f, motion.v_x, motion.v_y)
    return s_x + part.centre * n_x, s_y + part.centre * n_y, motion.v_z + part.centre * n_z


@jit
def _from_centre_velocity(f: SurfacePoint, part: Part, u_x: float, u_y: float, u_z: float, out: Motion) -> None:
    """The velocity of a flying part's place, from that [m/s] of its centre of mass, into `out`."""
    out.v_x, out.v_y = unstretched(f, u_x, u_y)
    out.v_z = u_z
    if part.centre > 0.0:
        n_x, n_y, _ = normal_rate(f, 0.0, 0.0)
        out.v_x, out.v_y = by_centre(f, part, u_x - part.centre * n_x, u_y - part.centre * n_y)
        _, _, n_z = normal_rate(f, out.v_x, out.v_y)
        out.v_z = u_z - part.centre * n_z


@jit
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
