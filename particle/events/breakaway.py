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
from typing import NamedTuple

from particle.events.equations import Part, drag, length, pull, push
from particle.events.motion import Motion
from particle.friction import friction_limit
from particle.jit import jit_no_arrays
from particle.surface import LocalSurface, SurfacePoint, surface_at


class RestPull(NamedTuple):
    """The pull on a part at rest: its size A and Q/m [m/s^2], unit vectors along and across it, the load."""

    demand: float
    limit: float
    d_x: float
    d_y: float
    n_x: float
    n_y: float
    load: float  # N


@jit_no_arrays
def rest_pull(f: SurfacePoint, part: Part) -> RestPull:
    """The pull at rest in the frame that it and the surface define."""
    p = pull(f, 0.0, 0.0, part)
    demand = length(f, p.x, p.y)
    d_x, d_y = (p.x / demand, p.y / demand) if demand > 0.0 else (1.0 / length(f, 1.0, 0.0), 0.0)
    # n is at right angles to d along the surface: M n is d turned left, M = I + grad w grad w^T, det M = s^2.
    s = math.sqrt(1 + f.w_x * f.w_x + f.w_y * f.w_y)
    m_x, m_y = d_x + f.w_x * (f.w_x * d_x + f.w_y * d_y), d_y + f.w_y * (f.w_x * d_x + f.w_y * d_y)
    limit = friction_limit(part.law, p.normal) / part.mass
    return RestPull(demand, limit, d_x, d_y, -m_y / s, m_x / s, p.normal)


@jit_no_arrays
def lag(
    local: LocalSurface, part: Part, time: float, x: float, y: float, u: float, f: SurfacePoint, a: RestPull
) -> float:
    """kappa [s/m] at the sliding speed u [m/s]."""
    if a.demand == 0.0 or 2 * a.demand <= a.limit:
        return 0.0
    if local.frame[0].base_drives > 0 or part.tilt_x != 0.0 or part.tilt_y != 0.0:
        # The pull is not along grad w, and there is no closed form without the base's jerk: its turning is taken from
        # a small step along the path.
        step = 1e-6 * local.frame[0].unit
        g = surface_at(local, x + step * u * a.d_x, y + step * u * a.d_y, time + step)
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
        square = 1 + f.w_x * f.w_x + f.w_y * f.w_y
        turn_x = factor / square * (f.w_xt + u * (f.w_xx * a.d_x + f.w_xy * a.d_y))
        turn_y = factor / square * (f.w_yt + u * (f.w_xy * a.d_x + f.w_yy * a.d_y))
    climb_n = a.n_x * f.w_x + a.n_y * f.w_y
    across = turn_x * a.n_x + turn_y * a.n_y + (turn_x * f.w_x + turn_y * f.w_y) * climb_n
    return across / a.demand / (2 * a.demand - a.limit)


@jit_no_arrays
def velocity(u: float, kappa: float, a: RestPull) -> tuple[float, float]:
    """The velocity [m/s] on the manifold."""
    back = min(max(kappa * u, -1.0), 1.0)
    along = math.sqrt(max(0.0, 1 - back * back))
    return u * (along * a.d_x - back * a.n_x), u * (along * a.d_y - back * a.n_y)


@jit_no_arrays
def manifold_rate(f: SurfacePoint, local: LocalSurface, part: Part, time: float, motion: Motion, rate: Motion) -> float:
    """The rate of a motion on the manifold, v_x of which is u, into `rate`; returns the normal force [N].

    f: the surface at `motion` and `time`.
    """
    x, y, u = motion.x, motion.y, motion.v_x
    a = rest_pull(f, part)
    kappa = lag(local, part, time, x, y, u, f, a)
    d_x, d_y = velocity(1.0, kappa * u, a)
    v_x, v_y = u * d_x, u * d_y
    load = pull(f, v_x, v_y, part).normal
    limit = friction_limit(part.law, load)
    climb = d_x * f.w_x + d_y * f.w_y
    upright = part.gravity + f.w_tt + v_x * f.w_xt + v_y * f.w_yt
    along = d_x * (f.base_ax - part.tilt_x) + d_y * (f.base_ay - part.tilt_y)
    rate.x, rate.y = v_x, v_y
    rate.v_x = -along - climb * upright - limit / part.mass
    rate.v_y = 0.0
    rate.work = push(f, part, load) - limit * drag(f, d_x, d_y)
    rate.dissipated = limit * u
    return load
