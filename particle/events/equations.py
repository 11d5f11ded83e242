"""The equations of motion of a point part on a moving surface z = w(x, y, t), and its energy.

With v = (x', y'), a the base's acceleration in its plane less gravity's share there, and everything of w at the part's
place and time:

    B = g + w_tt + 2 v.grad(w_t) + v.H.v - a.grad(w)        s^2 = 1 + |grad w|^2
    N = m B / s + squeeze                                   normal force, from the constraint z'' = d^2 w / dt^2
    u = sqrt(|v|^2 + (v.grad w)^2)                          sliding speed
    (x'', y'') = -a - B grad(w)/s^2 - (Q(N)/m) v/u          while it slides

and it sticks while the force without friction, m |-a - B grad(w)/s^2| measured along the surface, is at most Q(N).

The surface does the work of the contact's force (and the squeeze's) at its own velocity, (V, w_t) with V that of the
base; friction dissipates Q u; the rest is kinetic and potential energy of the part, both as seen by one at rest.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from particle.events.motion import Motion
from particle.friction import FrictionLaw, friction_limit
from particle.jit import jit_no_arrays
from particle.surface import LocalSurface, SurfacePoint, surface_at


class Part(NamedTuple):
    """What the equations need to know of part and contact."""

    mass: float  # kg
    gravity: float  # m/s^2, towards the plate
    tilt_x: float  # m/s^2, gravity along x and y, on a tilted device
    tilt_y: float
    squeeze: float  # N, presses the part onto the surface along its normal
    law: FrictionLaw


class Pull(NamedTuple):
    """The forces on the part per kg, in the plane's coordinates."""

    x: float  # m/s^2, acceleration without friction
    y: float
    normal: float  # N, net normal force N of the contact
    speed: float  # m/s, sliding speed u


@jit_no_arrays
def pull(f: SurfacePoint, v_x: float, v_y: float, part: Part) -> Pull:
    """Acceleration without friction, normal force and sliding speed."""
    a_x, a_y = f.base_ax - part.tilt_x, f.base_ay - part.tilt_y
    bend = v_x * (f.w_xx * v_x + 2 * f.w_xy * v_y) + v_y * f.w_yy * v_y
    b = part.gravity + f.w_tt + 2 * (v_x * f.w_xt + v_y * f.w_yt) + bend - a_x * f.w_x - a_y * f.w_y
    square = 1 + f.w_x * f.w_x + f.w_y * f.w_y
    climb = v_x * f.w_x + v_y * f.w_y
    return Pull(
        -a_x - b * f.w_x / square,
        -a_y - b * f.w_y / square,
        part.mass * b / math.sqrt(square) + part.squeeze,
        math.sqrt(v_x * v_x + v_y * v_y + climb * climb),
    )


@jit_no_arrays
def length(f: SurfacePoint, x: float, y: float) -> float:
    """Length along the surface of a vector given in the plane's coordinates."""
    climb = x * f.w_x + y * f.w_y
    return math.sqrt(x * x + y * y + climb * climb)


@jit_no_arrays
def slide_rate(f: SurfacePoint, part: Part, motion: Motion, rate: Motion) -> float:
    """The rate of a sliding part's motion into `rate`, with f at (x, y); returns the normal force [N]."""
    v_x, v_y = motion.v_x, motion.v_y
    p = pull(f, v_x, v_y, part)
    limit = friction_limit(part.law, p.normal)
    slow = limit / part.mass / p.speed if p.speed > 0.0 else 0.0
    rate.x, rate.y = v_x, v_y
    rate.v_x, rate.v_y = p.x - slow * v_x, p.y - slow * v_y
    rate.work = push(f, part, p.normal) - part.mass * slow * drag(f, v_x, v_y)
    rate.dissipated = limit * p.speed
    return p.normal


@jit_no_arrays
def push(f: SurfacePoint, part: Part, load: float) -> float:
    """The power [W] of the surface's normal force, net of the squeeze, at the surface's velocity."""
    s = math.sqrt(1 + f.w_x * f.w_x + f.w_y * f.w_y)
    return (load - part.squeeze) / s * (f.w_t - f.w_x * f.base_vx - f.w_y * f.base_vy)


@jit_no_arrays
def drag(f: SurfacePoint, x: float, y: float) -> float:
    """The surface's velocity [m/s] times a vector along it, given in the plane's coordinates."""
    return x * f.base_vx + y * f.base_vy + (x * f.w_x + y * f.w_y) * f.w_t


@jit_no_arrays
def energy(f: SurfacePoint, x: float, y: float, v_x: float, v_y: float, part: Part) -> tuple[float, float]:
    """Kinetic and potential energy [J] of a part on the surface."""
    s_x, s_y, s_z = v_x + f.base_vx, v_y + f.base_vy, f.w_t + v_x * f.w_x + v_y * f.w_y
    height = part.gravity * f.w - part.tilt_x * (x + f.base_px) - part.tilt_y * (y + f.base_py)
    return 0.5 * part.mass * (s_x * s_x + s_y * s_y + s_z * s_z), part.mass * height


@jit_no_arrays
def energy_at_rest(local: LocalSurface, part: Part, time: float, motion: Motion) -> float:
    """The energy [J] of a part at rest on the surface at the place of `motion`."""
    f = surface_at(local, motion.x, motion.y, time)
    kinetic, potential = energy(f, motion.x, motion.y, 0.0, 0.0, part)
    return kinetic + potential


@jit_no_arrays
def margin(local: LocalSurface, part: Part, load: float, gap: float) -> float:
    """How far the part is from the end of its contact: negative beyond the rim, below pull-off, above the largest load.

    gap: m, the distance from the rim, or a positive lower bound of it.  The measure is dimensionless; the integrator
    follows its sign to locate such an end.
    """
    least = gap / local.frame[0].surface_size
    weight = part.mass * max(1.0, abs(part.gravity))
    if math.isfinite(part.law.pull_off):
        least = min(least, (load + part.law.pull_off) / weight)
    if math.isfinite(part.law.largest_load):
        least = min(least, (part.law.largest_load - load) / weight)
    return float(least)
