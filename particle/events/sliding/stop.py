"""Coming to rest, in closed form.

Close to rest pull and friction limit hardly change. With both frozen (A along d, p and r the velocity along d and
across it), |A| < Q stops the part after

    T = (u Q + A p)/(Q^2 - A^2)
    X = (A p^2 + 2 Q p u + A u^2)/(4 (Q^2 - A^2)) along d
    Y = r (2 Q u + A p)/(4 Q^2 - A^2) across it.

Here p, r, X and Y are the contact's, and A and Q are multiplied by d.K^2 d of `mechanics.breakaway`, which is 1
where the contact is as high as the centre of mass. What K^2 has across d is left to the error. The drag c u of air
counts by its mean, Q + c u/(2 m) in place of Q, which is right to (c T/m)^2/12 in T, and to c T/(6 m) in X.

A pull A > Q instead turns a part that moves nearly straight against it, after T = u/(A + Q), X = p u/(2 (A + Q)) and
Y = r u/(A + 2 Q), which is exact up to lengths of r^2/Q.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from particle.events.mechanics import (
    Motion,
    Part,
    RestPull,
    at_centre,
    drag,
    grip_at,
    inner,
    mobility,
    moved,
    of_centre,
    over_plane,
    pull,
    push,
    rest_pull,
    slip,
)
from particle.jit import device_no_arrays, inlined
from particle.surface import LocalSurface, SurfacePoint, surface_at

# Gauss's rule on [0, 1], and its end, at which only the load is of interest.
NODES = np.append(0.5 + 0.5 * np.polynomial.legendre.leggauss(4)[0], 1.0)
WEIGHTS = np.append(0.5 * np.polynomial.legendre.leggauss(4)[1], 0.0)


class Stop(NamedTuple):
    """Where and when the sliding speed reaches 0: after `time` [s], (x, y) [m] away; time is inf when it does not."""

    time: float
    x: float
    y: float
    reverses: bool
    impulse_x: float  # m/s, what friction takes from the part on the way, per kg
    impulse_y: float
    loss: float  # m^2/s^2, what friction dissipates on the way, per kg
    miss: float  # m, what K^2 has across the way


@device_no_arrays
def frozen_stop(f: SurfacePoint, part: Part, a: RestPull, v_x: float, v_y: float, small: float) -> Stop:
    """The stop under frozen forces; `small` [m] is a length that does not count, r^2/Q of a part that turns back."""
    k_x, k_y = slip(f, part, v_x, v_y)
    climb = k_x * f.w_x + k_y * f.w_y
    climb_d, climb_n = a.d_x * f.w_x + a.d_y * f.w_y, a.n_x * f.w_x + a.n_y * f.w_y
    p = k_x * a.d_x + k_y * a.d_y + climb * climb_d
    r = k_x * a.n_x + k_y * a.n_y + climb * climb_n
    u = math.hypot(p, r)
    straight, bent, wide = 1.0, 0.0, 0.0
    if part.centre != part.contact:
        k = mobility(f, part)
        m_x, m_y = moved(k, a.d_x, a.d_y)
        straight, bent = inner(f, a.d_x, a.d_y, m_x, m_y), abs(inner(f, a.n_x, a.n_y, m_x, m_y))
        wide = abs(k.xx + k.yy - 2 * straight)
    q, force = straight * (a.limit + 0.5 * part.drag / part.mass * u), straight * a.demand
    if force < q:
        loss = q * q - force * force
        along = (force * p * p + 2 * q * p * u + force * u * u) / (4 * loss)
        across = r * (2 * q * u + force * p) / (4 * q * q - force * force)
        time, reverses = (u * q + force * p) / loss, False
    elif q > 0.0 and p < 0.0 and r * r <= small * q:
        time, reverses = u / (force + q), True
        along, across = 0.5 * p * time, r * u / (force + 2 * q)
    else:
        return Stop(math.inf, 0.0, 0.0, False, 0.0, 0.0, 0.0, 0.0)
    x, y = over_plane(f, part, along * a.d_x + across * a.n_x, along * a.d_y + across * a.n_y)
    c_x, c_y = of_centre(f, part, v_x, v_y)
    p_x, p_y = at_centre(f, part, a.demand * a.d_x, a.demand * a.d_y)
    c_x, c_y = c_x + p_x * time, c_y + p_y * time
    loss = (0.5 * u * u + force * along) / straight
    miss = bent * abs(along) + (bent + wide) * abs(across) + part.drag / part.mass * time * math.hypot(along, across)
    return Stop(time, x, y, reverses, c_x, c_y, loss, miss)


@inlined
def stop_ahead(
    now: Stop, local: LocalSurface, part: Part, time: float, motion: Motion, small: float, pace: float, force: float
) -> tuple[Stop, float]:
    """The stop ahead of a sliding part, which would be `now` under forces that do not change; and its error [m].

    An error in time counts as the way at `pace` [m/s], one of the energy as that on which `force` [N] does such work.

    The forces are frozen a third of the way, where a change that is linear in time has its mean effect; the error is
    taken as the difference from freezing them now.
    """
    x, y, v_x, v_y = motion.x, motion.y, motion.v_x, motion.v_y
    # After a third of the time a straight stop has covered five ninths of its way.
    g = surface_at(local, x + 5 / 9 * now.x, y + 5 / 9 * now.y, time + now.time / 3)
    later = frozen_stop(g, part, rest_pull(g, part), v_x, v_y, small)
    if later.reverses != now.reverses or not math.isfinite(later.time):
        return now, math.inf
    slower = (part.drag / part.mass * later.time) ** 2 * later.time
    miss = max(math.hypot(later.x - now.x, later.y - now.y) + later.miss, pace * (abs(later.time - now.time) + slower))
    return later, max(miss, part.mass / force * abs(later.loss - now.loss))


@inlined
def come_to_rest(local: LocalSurface, part: Part, time: float, motion: Motion, stop: Stop) -> bool:
    """Moves `motion` (x, y, v_x, v_y, work, dissipation) to a stop; False, and no move, if contact ends on the way.

    Powers are integrated by Gauss's rule along the way of
    a straight stop, which is quadratic in time.
    """
    x, y, v_x, v_y = motion.x, motion.y, motion.v_x, motion.v_y
    work = 0.0
    for k in range(len(NODES)):
        to_go = 1.0 - NODES[k]
        way = 1.0 - to_go * to_go
        f = surface_at(local, x + way * stop.x, y + way * stop.y, time + NODES[k] * stop.time)
        load = pull(f, to_go * v_x, to_go * v_y, part).normal
        if not -part.law.pull_off <= grip_at(f, part, load).load <= part.law.largest_load:
            return False
        work += WEIGHTS[k] * (
            push(f, part, load) * stop.time - part.mass * drag(f, part, stop.impulse_x, stop.impulse_y)
        )
    motion.x, motion.y, motion.v_x, motion.v_y = x + stop.x, y + stop.y, 0.0, 0.0
    motion.work += work
    motion.dissipated += part.mass * stop.loss
    return True
