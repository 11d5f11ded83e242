"""Impacts: a part that lands, and one whose surface jumps in velocity under it.

An impact takes away the centre's normal velocity relative to the surface, and at most `impact_coefficient` times as
much of the tangential one. A surface whose velocity jumps hits the part, or leaves it behind, in the same way.
"""

from __future__ import annotations

import math

from particle.events.flight.ballistics import centre_velocity, from_centre_velocity
from particle.events.mechanics import Motion, Part, after_friction, by_centre, normal_rate, of_centre, rising, stretched
from particle.jit import device_no_arrays, inlined
from particle.modes import Mode
from particle.surface import SurfacePoint

MIN_JUMP = 1e-11  # of the surface's size in a stroke: smaller velocities after an impact, and jumps, are rounding


@device_no_arrays
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
    most = part.law.impact_coefficient * abs(into)
    after_x, after_y, slides = after_friction(f, part, t_x, t_y, most, max(most, slack))
    after_z = after_x * f.w_x + after_y * f.w_y
    if part.centre > 0.0:
        v_x, v_y, v_z = t_x - into * f.w_x / s, t_y - into * f.w_y / s, t_z + into / s
    p_x, p_y, p_z = after_x - v_x, after_y - v_y, after_z - v_z  # impulse per kg
    n_x, n_y, n_z = normal_rate(f, 0.0, 0.0)
    z = part.centre
    motion.work += part.mass * (p_x * (f.base_vx + z * n_x) + p_y * (f.base_vy + z * n_y) + p_z * (f.w_t + z * n_z))
    motion.dissipated -= 0.5 * part.mass * (p_x * (v_x + after_x) + p_y * (v_y + after_y) + p_z * (v_z + after_z))
    motion.v_x, motion.v_y = by_centre(f, part, after_x, after_y)
    motion.z, motion.v_z = f.w, rising(f, motion.v_x, motion.v_y) if z > 0.0 else f.w_t + after_z
    return Mode.SLIDING if slides else Mode.RESTING


@device_no_arrays
def velocity_jump(before: SurfacePoint, after: SurfacePoint, part: Part) -> float:
    """By how much the velocity [m/s] of a part at rest on the surface jumps."""
    x, y, z = after.base_vx - before.base_vx, after.base_vy - before.base_vy, after.w_t - before.w_t
    turn = math.hypot(after.w_xt - before.w_xt, after.w_yt - before.w_yt)
    return math.sqrt(x * x + y * y + z * z) + part.centre * turn


@inlined
def cross_jump(before: SurfacePoint, after: SurfacePoint, part: Part, mode: int, slack: float, motion: Motion) -> int:
    """What a part does when the surface's velocity jumps, which moves on `motion`.

    A surface that drops from under a part, by more than `slack` [m/s], lets go of it unless nothing can pull it off.
    """
    if mode != Mode.FLYING:
        motion.z, motion.v_z = before.w, rising(before, motion.v_x, motion.v_y)
    u_x, u_y, u_z = centre_velocity(before, part, motion)
    u_x -= after.base_vx - before.base_vx
    u_y -= after.base_vy - before.base_vy
    from_centre_velocity(after, part, u_x, u_y, u_z, motion)
    away = motion.v_z - rising(after, motion.v_x, motion.v_y)
    if mode == Mode.FLYING or (away > slack and math.isfinite(part.law.pull_off)):
        return Mode.FLYING
    return land(after, part, slack, motion)
