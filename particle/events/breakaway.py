"""The first moments of sliding, on the slow manifold.

At a small sliding speed u friction turns the velocity towards the pull at the rate Q/u, so that explicit steps from
rest fall to first order. The slow solution is known: the velocity lags behind the pull's direction d by the angle
kappa u,

    v = u (sqrt(1 - kappa^2 u^2) d - kappa u n),     kappa = turning rate of d / (2 A - Q),     u' = A_d - Q,

with A the pull along the surface, n at right angles to d (both of unit length along the surface). It is regular at
u = 0.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.events.equations import Part, drag, length, pull, push
from particle.friction import friction_limit
from particle.jit import bare
from particle.surface import BASE, UNIT, Fields, fields

FloatArray = NDArray[np.float64]


class Slope(NamedTuple):
    """The pull on a part at rest: its size A and Q/m [m/s^2], unit vectors along and across it, the load."""

    demand: float
    limit: float
    d_x: float
    d_y: float
    n_x: float
    n_y: float
    load: float  # N


@bare
def slope(f: Fields, part: Part) -> Slope:
    """The pull at rest in the frame that it and the surface define."""
    p = pull(f, 0.0, 0.0, part)
    demand = length(f, p.x, p.y)
    d_x, d_y = (p.x / demand, p.y / demand) if demand > 0.0 else (1.0 / length(f, 1.0, 0.0), 0.0)
    # n is at right angles to d along the surface: M n is d turned left, M = I + grad w grad w^T, det M = s^2.
    s = math.sqrt(1 + f.x * f.x + f.y * f.y)
    m_x, m_y = d_x + f.x * (f.x * d_x + f.y * d_y), d_y + f.y * (f.x * d_x + f.y * d_y)
    limit = friction_limit(part.law, p.normal) / part.mass
    return Slope(demand, limit, d_x, d_y, -m_y / s, m_x / s, p.normal)


@bare
def lag(local: Any, part: Part, time: float, x: float, y: float, u: float, f: Fields, a: Slope) -> float:
    """kappa [s/m] at the sliding speed u [m/s]."""
    if a.demand == 0.0 or 2 * a.demand <= a.limit:
        return 0.0
    if local.counts[BASE] > 0 or part.tilt_x != 0.0 or part.tilt_y != 0.0:
        # The pull is not along grad w, and there is no closed form without the base's jerk: its turning is taken from
        # a small step along the path.
        step = 1e-6 * local.frame[UNIT]
        g = fields(local, x + step * u * a.d_x, y + step * u * a.d_y, time + step)
        ahead, here = pull(g, 0.0, 0.0, part), pull(f, 0.0, 0.0, part)
        turn_x, turn_y = (ahead.x - here.x) / step, (ahead.y - here.y) / step
        if u > 0.0:
            # The pull on a moving part is not along that on one at rest: what that adds grows with u as the lag does.
            fast = pull(f, u * a.d_x, u * a.d_y, part)
            turn_x -= a.demand * (fast.x - here.x) / u
            turn_y -= a.demand * (fast.y - here.y) / u
    else:
        # The pull is along grad w, which turns by grad w_t + H v; what changes its size has no part in it.
        factor = -part.gravity - f.w_tt
        square = 1 + f.x * f.x + f.y * f.y
        turn_x = factor / square * (f.xt + u * (f.xx * a.d_x + f.xy * a.d_y))
        turn_y = factor / square * (f.yt + u * (f.xy * a.d_x + f.yy * a.d_y))
    climb_n = a.n_x * f.x + a.n_y * f.y
    across = turn_x * a.n_x + turn_y * a.n_y + (turn_x * f.x + turn_y * f.y) * climb_n
    return across / a.demand / (2 * a.demand - a.limit)


@bare
def velocity(u: float, kappa: float, a: Slope) -> tuple[float, float]:
    """The velocity [m/s] on the manifold."""
    back = min(max(kappa * u, -1.0), 1.0)
    along = math.sqrt(max(0.0, 1 - back * back))
    return u * (along * a.d_x - back * a.n_x), u * (along * a.d_y - back * a.n_y)


@bare
def manifold_rate(f: Fields, local: Any, part: Part, time: float, state: FloatArray, out: FloatArray) -> float:
    """d/dt of (x, y, u, -, work, dissipation) into `out`, with f at (x, y); returns the normal force [N]."""
    x, y, u = state[0], state[1], state[2]
    a = slope(f, part)
    kappa = lag(local, part, time, x, y, u, f, a)
    d_x, d_y = velocity(1.0, kappa * u, a)
    v_x, v_y = u * d_x, u * d_y
    load = pull(f, v_x, v_y, part).normal
    limit = friction_limit(part.law, load)
    climb = d_x * f.x + d_y * f.y
    upright = part.gravity + f.w_tt + v_x * f.xt + v_y * f.yt
    along = d_x * (f.base_ax - part.tilt_x) + d_y * (f.base_ay - part.tilt_y)
    out[0], out[1] = v_x, v_y
    out[2] = -along - climb * upright - limit / part.mass
    out[3] = 0.0
    out[4] = push(f, part, load) - limit * drag(f, d_x, d_y)
    out[5] = limit * u
    return load
