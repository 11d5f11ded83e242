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
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.friction import friction_limit
from particle.jit import bare
from particle.surface import SIZE, Fields, fields

FloatArray = NDArray[np.float64]


class Part(NamedTuple):
    """What the equations need to know of part and contact."""

    mass: float  # kg
    gravity: float  # m/s^2, towards the plate
    tilt_x: float  # m/s^2, gravity along x and y, on a tilted device
    tilt_y: float
    squeeze: float  # N, presses the part onto the surface along its normal
    law: Any  # particle.friction.contact.FrictionLaw


class Pull(NamedTuple):
    """The forces on the part per kg, in the plane's coordinates."""

    x: float  # m/s^2, acceleration without friction
    y: float
    normal: float  # N, net normal force N of the contact
    speed: float  # m/s, sliding speed u


@bare
def pull(f: Fields, v_x: float, v_y: float, part: Part) -> Pull:
    """Acceleration without friction, normal force and sliding speed."""
    a_x, a_y = f.base_ax - part.tilt_x, f.base_ay - part.tilt_y
    bend = v_x * (f.xx * v_x + 2 * f.xy * v_y) + v_y * f.yy * v_y
    b = part.gravity + f.w_tt + 2 * (v_x * f.xt + v_y * f.yt) + bend - a_x * f.x - a_y * f.y
    square = 1 + f.x * f.x + f.y * f.y
    climb = v_x * f.x + v_y * f.y
    return Pull(
        -a_x - b * f.x / square,
        -a_y - b * f.y / square,
        part.mass * b / math.sqrt(square) + part.squeeze,
        math.sqrt(v_x * v_x + v_y * v_y + climb * climb),
    )


@bare
def length(f: Fields, x: float, y: float) -> float:
    """Length along the surface of a vector given in the plane's coordinates."""
    climb = x * f.x + y * f.y
    return math.sqrt(x * x + y * y + climb * climb)


@bare
def slide_rate(f: Fields, part: Part, state: FloatArray, out: FloatArray) -> float:
    """d/dt of (x, y, v_x, v_y, work, dissipation) into `out`, with f at (x, y); returns the normal force [N]."""
    v_x, v_y = state[2], state[3]
    p = pull(f, v_x, v_y, part)
    limit = friction_limit(part.law, p.normal)
    slow = limit / part.mass / p.speed if p.speed > 0.0 else 0.0
    out[0], out[1] = v_x, v_y
    out[2], out[3] = p.x - slow * v_x, p.y - slow * v_y
    out[4] = push(f, part, p.normal) - part.mass * slow * drag(f, v_x, v_y)
    out[5] = limit * p.speed
    return p.normal


@bare
def push(f: Fields, part: Part, load: float) -> float:
    """The power [W] of the surface's normal force, net of the squeeze, at the surface's velocity."""
    s = math.sqrt(1 + f.x * f.x + f.y * f.y)
    return (load - part.squeeze) / s * (f.w_t - f.x * f.base_vx - f.y * f.base_vy)


@bare
def drag(f: Fields, x: float, y: float) -> float:
    """The surface's velocity [m/s] times a vector along it, given in the plane's coordinates."""
    return x * f.base_vx + y * f.base_vy + (x * f.x + y * f.y) * f.w_t


@bare
def energy(f: Fields, x: float, y: float, v_x: float, v_y: float, part: Part) -> tuple[float, float]:
    """Kinetic and potential energy [J] of a part on the surface."""
    s_x, s_y, s_z = v_x + f.base_vx, v_y + f.base_vy, f.w_t + v_x * f.x + v_y * f.y
    height = part.gravity * f.w - part.tilt_x * (x + f.base_px) - part.tilt_y * (y + f.base_py)
    return 0.5 * part.mass * (s_x * s_x + s_y * s_y + s_z * s_z), part.mass * height


@bare
def energy_at_rest(local: Any, part: Part, time: float, state: FloatArray) -> float:
    """The energy [J] of a part at rest on the surface at the place (x, y, ...)."""
    kinetic, potential = energy(fields(local, state[0], state[1], time), state[0], state[1], 0.0, 0.0, part)
    return kinetic + potential


@bare
def margin(local: Any, part: Part, load: float, gap: float) -> float:
    """How far the part is from the end of its contact: negative beyond the rim, below pull-off, above the largest load.

    gap: m, the distance from the rim, or a positive lower bound of it.  A dimensionless measure, whose sign the
    integrator follows to locate such an end.
    """
    least = gap / local.frame[SIZE]
    weight = part.mass * max(1.0, abs(part.gravity))
    if math.isfinite(part.law.pull_off):
        least = min(least, (load + part.law.pull_off) / weight)
    if math.isfinite(part.law.largest_load):
        least = min(least, (part.law.largest_load - load) / weight)
    return float(least)
