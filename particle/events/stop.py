"""Coming to rest, in closed form.

Close to rest pull and friction limit hardly change. With both frozen (A along d, p and r the velocity along d and
across it), |A| < Q stops the part after

    T = (u Q + A p)/(Q^2 - A^2)
    X = (A p^2 + 2 Q p u + A u^2)/(4 (Q^2 - A^2)) along d
    Y = r (2 Q u + A p)/(4 Q^2 - A^2) across it.

A pull A > Q instead turns a part that moves nearly straight against it, after T = u/(A + Q), X = p u/(2 (A + Q)) and
Y = r u/(A + 2 Q), which is exact up to lengths of r^2/Q.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from particle.events.breakaway import RestPull, rest_pull
from particle.events.equations import Part, drag, pull, push
from particle.events.motion import Motion
from particle.jit import jit_no_arrays
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
    pull_x: float  # m/s^2, the frozen pull A d
    pull_y: float
    loss: float  # m^2/s^2, what friction dissipates on the way, per kg


@jit_no_arrays
def frozen_stop(f: SurfacePoint, a: RestPull, v_x: float, v_y: float, small: float) -> Stop:
    """The stop under frozen forces; `small` [m] is a length that does not count, r^2/Q of a part that turns back."""
    climb = v_x * f.w_x + v_y * f.w_y
    climb_d, climb_n = a.d_x * f.w_x + a.d_y * f.w_y, a.n_x * f.w_x + a.n_y * f.w_y
    p = v_x * a.d_x + v_y * a.d_y + climb * climb_d
    r = v_x * a.n_x + v_y * a.n_y + climb * climb_n
    u = math.hypot(p, r)
    q, force = a.limit, a.demand
    if force < q:
        loss = q * q - force * force
        along = (force * p * p + 2 * q * p * u + force * u * u) / (4 * loss)
        across = r * (2 * q * u + force * p) / (4 * q * q - force * force)
        time = (u * q + force * p) / loss
        x, y = along * a.d_x + across * a.n_x, along * a.d_y + across * a.n_y
        return Stop(time, x, y, False, force * a.d_x, force * a.d_y, 0.5 * u * u + force * along)
    if q > 0.0 and p < 0.0 and r * r <= small * q:
        time = u / (force + q)
        along, across = 0.5 * p * time, r * u / (force + 2 * q)
        x, y = along * a.d_x + across * a.n_x, along * a.d_y + across * a.n_y
        return Stop(time, x, y, True, force * a.d_x, force * a.d_y, 0.5 * u * u + force * along)
    return Stop(math.inf, 0.0, 0.0, False, 0.0, 0.0, 0.0)


@jit_no_arrays
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
    later = frozen_stop(g, rest_pull(g, part), v_x, v_y, small)
    if later.reverses != now.reverses or not math.isfinite(later.time):
        return now, math.inf
    miss = max(math.hypot(later.x - now.x, later.y - now.y), pace * abs(later.time - now.time))
    return later, max(miss, part.mass / force * abs(later.loss - now.loss))


@jit_no_arrays
def come_to_rest(local: LocalSurface, part: Part, time: float, motion: Motion, stop: Stop) -> bool:
    """Moves `motion` (x, y, v_x, v_y, work, dissipation) to a stop; False, and no move, if contact ends on the way.

    The friction's impulse on the way is known, v + A d T per kg. Powers are integrated by Gauss's rule along the way of
    a straight stop, which is quadratic in time.
    """
    x, y, v_x, v_y = motion.x, motion.y, motion.v_x, motion.v_y
    slow_x, slow_y = v_x + stop.pull_x * stop.time, v_y + stop.pull_y * stop.time
    work = 0.0
    for k in range(len(NODES)):
        to_go = 1.0 - NODES[k]
        way = 1.0 - to_go * to_go
        f = surface_at(local, x + way * stop.x, y + way * stop.y, time + NODES[k] * stop.time)
        load = pull(f, to_go * v_x, to_go * v_y, part).normal
        if not -part.law.pull_off <= load <= part.law.largest_load:
            return False
        work += WEIGHTS[k] * (push(f, part, load) * stop.time - part.mass * drag(f, slow_x, slow_y))
    motion.x, motion.y, motion.v_x, motion.v_y = x + stop.x, y + stop.y, 0.0, 0.0
    motion.work += work
    motion.dissipated += part.mass * stop.loss
    return True
