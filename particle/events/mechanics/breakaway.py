"""The first moments of sliding, on the slow manifold.

At a small sliding speed u friction turns the contact's velocity at the rate Q/u, so that explicit steps from rest fall
to first order. The slow solution is known. With K of `equations`, friction q per kg accelerates the contact by K^2 q,
and a pull p on the centre of mass does the same as K^-1 p = A d at the contact. The contact begins to slide along e,

    K^2 (A d - Q e) = r e,     |e| = 1,     r = u' at first;

where the contact is as high as the centre of mass, K = I, e = d and r = A - Q. From there the velocity lags by the
angle kappa u,

    k = u (sqrt(1 - kappa^2 u^2) e - kappa u n),     kappa = (turning rate of e) / (2 r + Q n.K^2 n),

with n at right angles to e (all of unit length along the surface). It is regular at u = 0.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from particle.events.mechanics.equations import (
    Part,
    Pull,
    at_centre,
    at_contact,
    drag,
    grip_at,
    length,
    over_plane,
    pull,
    push,
)
from particle.events.mechanics.motion import Motion
from particle.events.mechanics.parallel import (
    inner,
    normal_bend_along,
    stretch_rate,
)
from particle.jit import device_no_arrays, inlined
from particle.surface import LocalSurface, SurfacePoint, surface_at

TURNS, SETTLED = 50, 1e-15


class RestPull(NamedTuple):
    """The friction A that a part at rest needs, and Q/m [m/s^2], unit vectors along and across it, the load."""

    demand: float
    limit: float
    d_x: float
    d_y: float
    n_x: float
    n_y: float
    load: float  # N, as on a flat surface


class Heading(NamedTuple):
    """Where a part on the slow manifold slides: the directions e and n of its contact, and the lag."""

    e_x: float
    e_y: float
    n_x: float
    n_y: float
    kappa: float  # s/m


class Mobility(NamedTuple):
    """The matrix K^2, by rows: the contact's acceleration along the surface for friction per kg."""

    xx: float
    xy: float
    yx: float
    yy: float


@device_no_arrays
def rest_pull(f: SurfacePoint, part: Part) -> RestPull:
    """The pull at rest in the frame that it and the surface define."""
    p = pull(f, 0.0, 0.0, part)
    a_x, a_y = at_contact(f, part, p.x, p.y)
    demand = length(f, a_x, a_y)
    d_x, d_y = (a_x / demand, a_y / demand) if demand > 0.0 else (1.0 / length(f, 1.0, 0.0), 0.0)
    n_x, n_y = _turned_left(f, d_x, d_y)
    limit, load = grip_at(f, part, p.normal)
    return RestPull(demand, limit / part.mass, d_x, d_y, n_x, n_y, load)


@device_no_arrays
def _turned_left(f: SurfacePoint, d_x: float, d_y: float) -> tuple[float, float]:
    """n at right angles to d along the surface: M n is d turned left, M = I + grad w grad w^T, det M = s^2."""
    s = math.sqrt(1 + f.w_x * f.w_x + f.w_y * f.w_y)
    m_x, m_y = d_x + f.w_x * (f.w_x * d_x + f.w_y * d_y), d_y + f.w_y * (f.w_x * d_x + f.w_y * d_y)
    return -m_y / s, m_x / s


@device_no_arrays
def mobility(f: SurfacePoint, part: Part) -> Mobility:
    """K^2."""
    xx, yx = at_centre(f, part, *at_centre(f, part, 1.0, 0.0))
    xy, yy = at_centre(f, part, *at_centre(f, part, 0.0, 1.0))
    return Mobility(xx, xy, yx, yy)


@device_no_arrays
def moved(k: Mobility, x: float, y: float) -> tuple[float, float]:
    """K^2 times a vector."""
    return k.xx * x + k.xy * y, k.yx * x + k.yy * y


@device_no_arrays
def first_slip(f: SurfacePoint, k: Mobility, p_x: float, p_y: float, limit: float) -> tuple[float, float, float]:
    """r, e_x and e_y with K^2 (p - limit e) = r e, for a pull p [m/s^2] at the contact; exact where K = I."""
    size = length(f, p_x, p_y)
    e_x, e_y = p_x / size, p_y / size
    rate = size - limit
    for _ in range(TURNS):
        # (r K^-2 + limit) e = p with r from the e before, then as long as 1: K is nearly I, so ten turns settle it.
        a_x, a_y = moved(k, p_x - limit * e_x, p_y - limit * e_y)
        rate = inner(f, e_x, e_y, a_x, a_y)
        q_x, q_y = moved(k, p_x, p_y)
        xx, xy, yx, yy = rate + limit * k.xx, limit * k.xy, limit * k.yx, rate + limit * k.yy
        det = xx * yy - xy * yx
        t_x, t_y = (yy * q_x - xy * q_y) / det, (xx * q_y - yx * q_x) / det
        size = length(f, t_x, t_y)
        t_x, t_y = t_x / size, t_y / size
        off = abs(t_x - e_x) + abs(t_y - e_y)
        e_x, e_y = t_x, t_y
        if off < SETTLED:
            break
    return rate, e_x, e_y


@device_no_arrays
def after_friction(
    f: SurfacePoint, part: Part, c_x: float, c_y: float, largest: float, static: float
) -> tuple[float, float, bool]:
    """The centre's velocity along the surface after friction's impulse, of a part that would go on by c [m/s].

    static: m/s, the impulse per kg that may bring the part to rest; `largest` is what it is if not, against the
    contact's velocity after it, c - largest K e with K (c - largest K e) along e.  Also whether the part slides on.
    """
    k_x, k_y = at_contact(f, part, c_x, c_y)
    size = length(f, k_x, k_y)
    if size <= static:
        return 0.0, 0.0, False
    if part.centre == part.contact:
        kept = 1.0 - largest / size
        return kept * c_x, kept * c_y, True
    _, e_x, e_y = first_slip(f, mobility(f, part), k_x, k_y, largest)
    e_x, e_y = at_centre(f, part, e_x, e_y)
    return c_x - largest * e_x, c_y - largest * e_y, True


@device_no_arrays
def heading(
    local: LocalSurface, part: Part, time: float, x: float, y: float, u: float, f: SurfacePoint, a: RestPull
) -> Heading:
    """Where a part slides at the speed u [m/s] of its contact."""
    if part.centre > 0.0 or local.frame[0].in_plane > 0:
        return _raised_heading(local, part, time, x, y, u, f, a)
    return Heading(a.d_x, a.d_y, a.n_x, a.n_y, _lag(local, part, time, x, y, u, f, a))


@inlined
def _lag(
    local: LocalSurface, part: Part, time: float, x: float, y: float, u: float, f: SurfacePoint, a: RestPull
) -> float:
    """kappa [s/m] of a point part."""
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


@inlined
def _raised_heading(
    local: LocalSurface, part: Part, time: float, x: float, y: float, u: float, f: SurfacePoint, a: RestPull
) -> Heading:
    """Where a part slides whose contact or centre of mass is off the mid-plane, or on a mid-plane that stretches.

    How e turns, and how the pull on a moving part differs from that on one at rest, are taken from small steps.
    """
    if a.demand == 0.0 or 2 * a.demand <= a.limit:
        return Heading(a.d_x, a.d_y, a.n_x, a.n_y, 0.0)
    k = mobility(f, part)
    rate, e_x, e_y = first_slip(f, k, a.demand * a.d_x, a.demand * a.d_y, a.limit)
    n_x, n_y = _turned_left(f, e_x, e_y)
    v_x, v_y = over_plane(f, part, u * e_x, u * e_y)
    step = 1e-6 * local.frame[0].unit
    g = surface_at(local, x + step * v_x, y + step * v_y, time + step)
    ahead = pull(g, 0.0, 0.0, part)
    limit = grip_at(g, part, ahead.normal).limit / part.mass
    _, g_x, g_y = first_slip(g, mobility(g, part), *at_contact(g, part, ahead.x, ahead.y), limit)
    turning_rate = inner(f, n_x, n_y, (g_x - e_x) / step, (g_y - e_y) / step)
    if u > 0.0:
        fast = pull(f, v_x, v_y, part)
        limit = grip_at(f, part, fast.normal).limit / part.mass
        a_x, a_y = _contact_acceleration(f, part, k, fast, v_x, v_y, limit * e_x, limit * e_y)
        turning_rate -= inner(f, n_x, n_y, a_x, a_y) / u
    across_x, across_y = moved(k, n_x, n_y)
    damping = 2 * rate + a.limit * inner(f, n_x, n_y, across_x, across_y)
    return Heading(e_x, e_y, n_x, n_y, turning_rate / damping if damping > 0.0 else 0.0)


@inlined
def _contact_acceleration(
    f: SurfacePoint, part: Part, k: Mobility, p: Pull, v_x: float, v_y: float, q_x: float, q_y: float
) -> tuple[float, float]:
    """The rate [m/s^2], in x and y, of the contact's velocity over the surface under a pull p and friction q per kg."""
    a_x, a_y = at_contact(f, part, p.x, p.y)
    a_x, a_y = moved(k, a_x - q_x, a_y - q_y)
    n, s = normal_bend_along(f, v_x, v_y), math.sqrt(1 + f.w_x * f.w_x + f.w_y * f.w_y)
    z = part.contact
    c_x, c_y = stretch_rate(f, v_x, v_y, v_x, v_y)
    return a_x + z * (n.x + n.down * f.w_x / s) + c_x, a_y + z * (n.y + n.down * f.w_y / s) + c_y


@device_no_arrays
def velocity(f: SurfacePoint, part: Part, u: float, h: Heading) -> tuple[float, float]:
    """The velocity (x', y') [m/s] on the manifold at the contact's speed u [m/s]."""
    k_x, k_y = _direction(u, h)
    return over_plane(f, part, u * k_x, u * k_y)


@device_no_arrays
def _direction(u: float, h: Heading) -> tuple[float, float]:
    """The direction of the contact's velocity."""
    back = min(max(h.kappa * u, -1.0), 1.0)
    along = math.sqrt(max(0.0, 1 - back * back))
    return along * h.e_x - back * h.n_x, along * h.e_y - back * h.n_y


@device_no_arrays
def manifold_rate(f: SurfacePoint, local: LocalSurface, part: Part, time: float, motion: Motion, rate: Motion) -> float:
    """The rate of a motion on the manifold, v_x of which is u, into `rate`; returns the load [N] as on a flat surface.

    f: the surface at `motion` and `time`.
    """
    x, y, u = motion.x, motion.y, motion.v_x
    h = heading(local, part, time, x, y, u, f, rest_pull(f, part))
    d_x, d_y = _direction(u, h)
    v_x, v_y = over_plane(f, part, u * d_x, u * d_y)
    p = pull(f, v_x, v_y, part)
    limit, load = grip_at(f, part, p.normal)
    limit += part.drag * u
    climb = d_x * f.w_x + d_y * f.w_y
    rate.x, rate.y = v_x, v_y
    if part.centre > 0.0 or local.frame[0].in_plane > 0:
        q = limit / part.mass
        a_x, a_y = at_contact(f, part, p.x, p.y)
        a_x, a_y = moved(mobility(f, part), a_x - q * d_x, a_y - q * d_y)
        n = normal_bend_along(f, v_x, v_y)
        # With what the surface adds by its own height, w_pq along the motion.
        lift = v_x * f.w_xt + v_y * f.w_yt + v_x * (f.w_xx * v_x + 2 * f.w_xy * v_y) + v_y * f.w_yy * v_y
        c_x, c_y = stretch_rate(f, v_x, v_y, v_x, v_y)
        a_x, a_y = a_x + part.contact * n.x + c_x, a_y + part.contact * n.y + c_y
        rate.v_x = inner(f, d_x, d_y, a_x, a_y) + climb * lift
    else:
        upright = part.gravity + f.w_tt + v_x * f.w_xt + v_y * f.w_yt
        along = d_x * (f.base_ax - part.tilt_x) + d_y * (f.base_ay - part.tilt_y)
        rate.v_x = -along - climb * upright - limit / part.mass
    rate.v_y = 0.0
    rate.work = push(f, part, p.normal) - limit * drag(f, part, *at_centre(f, part, d_x, d_y))
    rate.dissipated = limit * u
    return load
