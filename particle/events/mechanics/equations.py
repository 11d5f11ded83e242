"""The equations of motion of a part on a moving surface z = w(x, y, t), and its energy.

(x, y) is the point of the mid-plane under the part: its contact is at the height z_k along the normal n above it, its
centre of mass at z_c. With v = (x', y'), a the base's acceleration in its plane less gravity's share there, everything
of w at that point and time, and S, n' and n'' (for x'' = y'' = 0) of `mechanics.parallel`:

    B = g + w_tt + 2 v.grad(w_t) + v.H.v - a.grad(w)        s^2 = 1 + |grad w|^2
    N = m (B / s - z_c |n'|^2) + squeeze                    normal force, from the constraint
    p = -a - B grad(w)/s^2 - z_c n''                        pull without friction, along the surface
    k = (I - z_k S) v,   u = |k|_M                          velocity and speed of the contact over the surface
    (I - z_c S) (x'', y'') = p - (Q(N) + c u)/m K k/u       while it slides,   K = (I - z_c S)^-1 (I - z_k S)

with the drag c of air, and it sticks while m |K^-1 p|_M at v = 0 is at most Q(N). K is d'Alembert's: in a displacement
dX the pressure does no work, friction Q.(I - z_k S) dX; so the pressure that bears its moment leans with the surface.
With z_k = z_c = 0 the part is a point on the mid-plane.

Where the mid-plane moves in its plane by u, (x, y) is a point of the material, F = I + grad u, and grad w the slope as
seen in space, F^-T grad w; the second derivatives of w are those of P times (-grad w, 1). Then a holds u_tt, the pull p
also holds -2 grad u_t v - v.grad grad u.v, and F takes the place of I in front of the curvature S: (3.8) to (3.11) in
docs/motion.md. So they do at u = 0, where F = I.

The surface does the work of the contact's whole force at its own velocity where the centre of mass is, about which
that force has no moment; friction and drag dissipate (Q + c u) u; the rest is kinetic and potential energy of the
part, both as seen by one at rest.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from particle.events.mechanics.motion import Motion
from particle.events.mechanics.parallel import (
    from_height,
    normal_bend,
    normal_rate,
    shape_operator,
    stretched,
    to_height,
    unstretched,
)
from particle.friction import FrictionLaw, Grip, grip
from particle.jit import device_no_arrays, spliced
from particle.surface import LocalSurface, SurfacePoint, surface_at


class Part(NamedTuple):
    """What the equations need to know of part and contact."""

    mass: float  # kg
    gravity: float  # m/s^2, towards the plate
    tilt_x: float  # m/s^2, gravity along x and y, on a tilted device
    tilt_y: float
    squeeze: float  # N, presses the part onto the surface along its normal
    law: FrictionLaw
    contact: float = 0.0  # m, heights over the mid-plane: of the contact, and of the centre of mass
    centre: float = 0.0
    drag: float = 0.0  # N s/m, of the air under it, against its slip


class Pull(NamedTuple):
    """The forces on the part per kg, in the plane's coordinates."""

    x: float  # m/s^2, acceleration without friction
    y: float
    normal: float  # N, net normal force N of the contact
    speed: float  # m/s, sliding speed u


@spliced
def pull(f: SurfacePoint, v_x: float, v_y: float, part: Part) -> Pull:
    """Acceleration without friction, normal force and sliding speed."""
    a_x, a_y = f.base_ax - part.tilt_x, f.base_ay - part.tilt_y
    c_x, c_y = carried(f, v_x, v_y)
    bend = v_x * (f.w_xx * v_x + 2 * f.w_xy * v_y) + v_y * f.w_yy * v_y
    b = part.gravity + f.w_tt + 2 * (v_x * f.w_xt + v_y * f.w_yt) + bend - a_x * f.w_x - a_y * f.w_y
    square = 1 + f.w_x * f.w_x + f.w_y * f.w_y
    p_x, p_y = -(a_x + c_x) - b * f.w_x / square, -(a_y + c_y) - b * f.w_y / square
    normal = part.mass * b / math.sqrt(square) + part.squeeze
    if part.centre > 0.0:
        n = normal_bend(f, v_x, v_y)
        p_x, p_y = p_x - part.centre * n.x, p_y - part.centre * n.y
        normal -= part.mass * part.centre * n.down
    return Pull(p_x, p_y, normal, slip_speed(f, part, v_x, v_y))


@device_no_arrays
def carried(f: SurfacePoint, v_x: float, v_y: float) -> tuple[float, float]:
    """2 grad u_t v + v.grad grad u v: what the mid-plane's motion in its plane adds to u_tt at a steady v [m/s^2]."""
    return (
        2 * (f.x_xt * v_x + f.x_yt * v_y) + v_x * (f.x_xx * v_x + 2 * f.x_xy * v_y) + v_y * f.x_yy * v_y,
        2 * (f.y_xt * v_x + f.y_yt * v_y) + v_x * (f.y_xx * v_x + 2 * f.y_xy * v_y) + v_y * f.y_yy * v_y,
    )


@device_no_arrays
def rising(f: SurfacePoint, v_x: float, v_y: float) -> float:
    """w_t + v.grad w: how fast [m/s] a point that moves over the mid-plane by v rises."""
    s_x, s_y = stretched(f, v_x, v_y)
    return f.w_t + s_x * f.w_x + s_y * f.w_y


@device_no_arrays
def slip_speed(f: SurfacePoint, part: Part, v_x: float, v_y: float) -> float:
    """The speed [m/s] of the contact over the surface."""
    k_x, k_y = slip(f, part, v_x, v_y)
    return length(f, k_x, k_y)


@device_no_arrays
def slip(f: SurfacePoint, part: Part, v_x: float, v_y: float) -> tuple[float, float]:
    """The velocity [m/s] of the contact over the surface."""
    return to_height(shape_operator(f), part.contact, v_x, v_y) if part.contact > 0.0 else stretched(f, v_x, v_y)


@device_no_arrays
def over_plane(f: SurfacePoint, part: Part, k_x: float, k_y: float) -> tuple[float, float]:
    """The velocity (x', y') [m/s] of a part from that of its contact."""
    return from_height(shape_operator(f), part.contact, k_x, k_y) if part.contact > 0.0 else unstretched(f, k_x, k_y)


@device_no_arrays
def by_centre(f: SurfacePoint, part: Part, x: float, y: float) -> tuple[float, float]:
    """(x', y') from the centre of mass's velocity [m/s] along the surface; also (x'', y'') from its acceleration."""
    return from_height(shape_operator(f), part.centre, x, y) if part.centre > 0.0 else unstretched(f, x, y)


@device_no_arrays
def of_centre(f: SurfacePoint, part: Part, x: float, y: float) -> tuple[float, float]:
    """The velocity [m/s] of the centre of mass along the surface from (x', y'): the inverse of `by_centre`."""
    return to_height(shape_operator(f), part.centre, x, y) if part.centre > 0.0 else stretched(f, x, y)


@device_no_arrays
def at_centre(f: SurfacePoint, part: Part, x: float, y: float) -> tuple[float, float]:
    """K a = F (F - z_c S)^-1 (F - z_k S) F^-1 a: the force along the surface on the centre of mass by friction a."""
    if part.centre == part.contact:
        return x, y
    shape = shape_operator(f)
    return stretched(f, *from_height(shape, part.centre, *to_height(shape, part.contact, *unstretched(f, x, y))))


@device_no_arrays
def at_contact(f: SurfacePoint, part: Part, x: float, y: float) -> tuple[float, float]:
    """K^-1 a: the friction that bears a force a along the surface on the centre of mass."""
    if part.centre == part.contact:
        return x, y
    shape = shape_operator(f)
    return stretched(f, *from_height(shape, part.contact, *to_height(shape, part.centre, *unstretched(f, x, y))))


@device_no_arrays
def length(f: SurfacePoint, x: float, y: float) -> float:
    """Length along the surface of a vector given in the plane's coordinates."""
    climb = x * f.w_x + y * f.w_y
    return math.sqrt(x * x + y * y + climb * climb)


@spliced
def slide_rate(f: SurfacePoint, part: Part, motion: Motion, rate: Motion) -> float:
    """The rate of a sliding part's motion into `rate`, with f at (x, y); returns the load [N] as on a flat surface."""
    v_x, v_y = motion.v_x, motion.v_y
    p = pull(f, v_x, v_y, part)
    limit, load = grip_at(f, part, p.normal)
    limit += part.drag * p.speed
    rate.x, rate.y = v_x, v_y
    slow = limit / part.mass / p.speed if p.speed > 0.0 else 0.0
    rate.v_x, rate.v_y, rate.work = braked(f, part, p, slow, v_x, v_y)
    rate.dissipated = limit * p.speed
    return load


@spliced
def braked(f: SurfacePoint, part: Part, p: Pull, slow: float, v_x: float, v_y: float) -> tuple[float, float, float]:
    """(x'', y'') [m/s^2] under a pull p and friction `slow` [1/s] times the slip, and the surface's power [W]."""
    k_x, k_y = slip(f, part, v_x, v_y)
    q_x, q_y = at_centre(f, part, slow * k_x, slow * k_y)
    a_x, a_y = by_centre(f, part, p.x - q_x, p.y - q_y)
    return a_x, a_y, push(f, part, p.normal) - part.mass * drag(f, part, q_x, q_y)


@spliced
def grip_at(f: SurfacePoint, part: Part, load: float) -> Grip:
    """What the contact bears under a normal force [N]."""
    return grip(part.law, load, f.w_xx, f.w_xy, f.w_yy)


@device_no_arrays
def push(f: SurfacePoint, part: Part, load: float) -> float:
    """The power [W] of the surface's normal force, net of the squeeze, at the surface's velocity."""
    s = math.sqrt(1 + f.w_x * f.w_x + f.w_y * f.w_y)
    return (load - part.squeeze) / s * (f.w_t - f.w_x * f.base_vx - f.w_y * f.base_vy)


@device_no_arrays
def drag(f: SurfacePoint, part: Part, x: float, y: float) -> float:
    """The velocity [m/s] of the place that the centre of mass has on the surface, times a vector along the surface."""
    along = x * f.base_vx + y * f.base_vy + (x * f.w_x + y * f.w_y) * f.w_t
    if part.centre > 0.0:
        n_x, n_y, n_z = normal_rate(f, 0.0, 0.0)
        along += part.centre * (x * n_x + y * n_y + (x * f.w_x + y * f.w_y) * n_z)
    return along


@device_no_arrays
def energy(
    f: SurfacePoint, x: float, y: float, v_x: float, v_y: float, z: float, v_z: float, part: Part
) -> tuple[float, float]:
    """Kinetic and potential energy [J] of a part on the surface, or over it, where z [m] is not w."""
    s_x, s_y = stretched(f, v_x, v_y)
    s_x, s_y, s_z = s_x + f.base_vx, s_y + f.base_vy, v_z
    height = part.gravity * z - part.tilt_x * (x + f.base_px) - part.tilt_y * (y + f.base_py)
    if part.centre > 0.0:
        n_x, n_y, n_z = normal_rate(f, v_x, v_y)
        s_x, s_y, s_z = s_x + part.centre * n_x, s_y + part.centre * n_y, s_z + part.centre * n_z
        s = math.sqrt(1 + f.w_x * f.w_x + f.w_y * f.w_y)
        height += part.centre * (part.gravity + part.tilt_x * f.w_x + part.tilt_y * f.w_y) / s
    return 0.5 * part.mass * (s_x * s_x + s_y * s_y + s_z * s_z), part.mass * height


@device_no_arrays
def energy_at_rest(local: LocalSurface, part: Part, time: float, motion: Motion) -> float:
    """The energy [J] of a part at rest on the surface at the place of `motion`."""
    f = surface_at(local, motion.x, motion.y, time)
    kinetic, potential = energy(f, motion.x, motion.y, 0.0, 0.0, f.w, f.w_t, part)
    return kinetic + potential


@device_no_arrays
def margin(local: LocalSurface, part: Part, load: float, gap: float) -> float:
    """How far the part is from the end of its contact: negative beyond the rim, below pull-off, above the largest load.

    load: N, as on a flat surface.  gap: m, the distance from the rim, or a positive lower bound of it.  The measure is
    dimensionless; the integrator follows its sign to locate such an end.
    """
    least = gap / local.frame[0].surface_size
    weight = part.mass * max(1.0, abs(part.gravity))
    if math.isfinite(part.law.pull_off):
        least = min(least, (load + part.law.pull_off) / weight)
    if math.isfinite(part.law.largest_load):
        least = min(least, (part.law.largest_load - load) / weight)
    return float(least)
