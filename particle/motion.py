"""The equations of motion of a point part on a moving surface z = w(x, y, t).

With v = (x', y'), the base's acceleration b in its plane and everything of w at the part's place and time:

    B = g + w_tt + 2 v.grad(w_t) + v.H.v - b.grad(w)        s^2 = 1 + |grad w|^2
    N = m B / s                                             normal force, from the constraint z'' = d^2 w / dt^2
    u = sqrt(|v|^2 + (v.grad w)^2)                          sliding speed
    (x'', y'') = -b - B grad(w)/s^2 - (Q(N)/m) v/u          while it slides

and it sticks while the force without friction, m |-b - B grad(w)/s^2| measured along the surface, is at most Q(N).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.fields import Fields, fields
from particle.friction import friction_limit
from particle.jit import jit

FloatArray = NDArray[np.float64]


class Part(NamedTuple):
    """What the equations need to know of part and contact."""

    mass: float  # kg
    gravity: float  # m/s^2
    law: Any  # particle.friction.FrictionLaw


class Pull(NamedTuple):
    """The forces on the part per kg, in the plane's coordinates."""

    x: float  # m/s^2, acceleration without friction
    y: float
    normal: float  # N, normal force
    speed: float  # m/s, sliding speed u


@jit
def pull(f: Fields, v_x: float, v_y: float, part: Part) -> Pull:
    """Acceleration without friction, normal force and sliding speed."""
    bend = v_x * (f.xx * v_x + 2 * f.xy * v_y) + v_y * f.yy * v_y
    b = part.gravity + f.w_tt + 2 * (v_x * f.xt + v_y * f.yt) + bend - f.base_x * f.x - f.base_y * f.y
    square = 1 + f.x * f.x + f.y * f.y
    climb = v_x * f.x + v_y * f.y
    return Pull(
        -f.base_x - b * f.x / square,
        -f.base_y - b * f.y / square,
        part.mass * b / math.sqrt(square),
        math.sqrt(v_x * v_x + v_y * v_y + climb * climb),
    )


@jit
def length(f: Fields, x: float, y: float) -> float:
    """Length along the surface of a vector given in the plane's coordinates."""
    climb = x * f.x + y * f.y
    return math.sqrt(x * x + y * y + climb * climb)


@jit
def slide_rate(surface: Any, local: Any, part: Part, time: float, state: FloatArray, out: FloatArray) -> float:
    """d/dt of (x, y, v_x, v_y) into `out`; returns the normal force [N]."""
    x, y, v_x, v_y = state
    f = fields(surface, local, x, y, time)
    p = pull(f, v_x, v_y, part)
    slow = friction_limit(part.law, p.normal) / part.mass / p.speed if p.speed > 0.0 else 0.0
    out[0], out[1] = v_x, v_y
    out[2], out[3] = p.x - slow * v_x, p.y - slow * v_y
    return p.normal


@jit
def margin(surface: Any, part: Part, load: float, gap: float) -> float:
    """How far the part is from the end of its contact: negative beyond the rim, below pull-off, above the largest load.

    gap: m, the distance from the rim, or a positive lower bound of it.  A dimensionless measure, whose sign the
    integrator follows to locate such an end.
    """
    least = gap / surface.size
    weight = part.mass * max(1.0, abs(part.gravity))
    if math.isfinite(part.law.pull_off):
        least = min(least, (load + part.law.pull_off) / weight)
    if math.isfinite(part.law.largest_load):
        least = min(least, (part.law.largest_load - load) / weight)
    return float(least)
