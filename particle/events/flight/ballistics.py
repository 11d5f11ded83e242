"""Ballistics: where a part in flight is a time later, by the exact flight of its centre of mass.

The centre of mass flies exactly, seen from the base, and from the material where that moves in its plane: gravity, and
the squeeze straight down. The part's attitude stays that of the surface under it: (x, y) is the point of the mid-plane
whose normal goes through the centre of mass, and z the latter's height less its share of that normal, so that a part on
the surface has z = w.
"""

from __future__ import annotations

import math

from particle.events.mechanics import Motion, Part, by_centre, normal_rate, stretched, unstretched
from particle.jit import device_no_arrays, inlined
from particle.surface import LocalSurface, SurfacePoint, surface_at

MAX_NEWTON, PLACED = 20, 1e-15  # of the place and of the height of the centre of mass


@device_no_arrays
def fly_ahead(
    local: LocalSurface, part: Part, here: SurfacePoint, time: float, motion: Motion, h: float, out: Motion
) -> None:
    """The motion of a flying part h [s] later into `out`."""
    down = part.gravity + part.squeeze / part.mass
    n_x, n_y, n_z = _centre_height(here, part)
    u_x, u_y, u_z = centre_velocity(here, part, motion)
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
        from_centre_velocity(f, part, u_x, u_y, u_z, out)
    else:
        out.v_x, out.v_y, out.v_z = u_x, u_y, u_z


@inlined
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


@device_no_arrays
def _centre_height(f: SurfacePoint, part: Part) -> tuple[float, float, float]:
    """From a part's place [m] to its centre of mass, in space."""
    s = math.sqrt(1 + f.w_x * f.w_x + f.w_y * f.w_y)
    return -part.centre * f.w_x / s, -part.centre * f.w_y / s, part.centre / s


@device_no_arrays
def centre_velocity(f: SurfacePoint, part: Part, motion: Motion) -> tuple[float, float, float]:
    """The velocity [m/s] of the centre of mass of a flying part, seen from the base."""
    s_x, s_y = stretched(f, motion.v_x, motion.v_y)
    if part.centre == 0.0:
        return s_x, s_y, motion.v_z
    n_x, n_y, n_z = normal_rate(f, motion.v_x, motion.v_y)
    return s_x + part.centre * n_x, s_y + part.centre * n_y, motion.v_z + part.centre * n_z


@device_no_arrays
def from_centre_velocity(f: SurfacePoint, part: Part, u_x: float, u_y: float, u_z: float, out: Motion) -> None:
    """The velocity of a flying part's place, from that [m/s] of its centre of mass, into `out`."""
    out.v_x, out.v_y = unstretched(f, u_x, u_y)
    out.v_z = u_z
    if part.centre > 0.0:
        n_x, n_y, _ = normal_rate(f, 0.0, 0.0)
        out.v_x, out.v_y = by_centre(f, part, u_x - part.centre * n_x, u_y - part.centre * n_y)
        _, _, n_z = normal_rate(f, out.v_x, out.v_y)
        out.v_z = u_z - part.centre * n_z
