"""Coming to rest, in closed form.

Close to rest pull and friction limit hardly change. With both frozen (A along d, p and r the velocity along d and
across it), |A| < Q stops the part after

    T = (u Q + A p)/(Q^2 - A^2)
    X = (A p^2 + 2 Q p u + A u^2)/(4 (Q^2 - A^2)) along d
    Y = r (2 Q u + A p)/(4 Q^2 - A^2) across it.

A pull A > Q instead turns a part that moves straight against it: T = u/(A + Q), X = p u/(2 (A + Q)).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.breakaway import Slope, slope
from particle.fields import Fields, fields
from particle.jit import jit
from particle.motion import Part

FloatArray = NDArray[np.float64]


class Stop(NamedTuple):
    """Where and when the sliding speed reaches 0: after `time` [s], (x, y) [m] away; time is inf when it does not."""

    time: float
    x: float
    y: float
    reverses: bool


@jit
def frozen_stop(f: Fields, a: Slope, v_x: float, v_y: float, straight: float) -> Stop:
    """The stop under frozen forces; `straight` [m/s] is the cross velocity below which a part counts as turned back."""
    climb = v_x * f.x + v_y * f.y
    climb_d, climb_n = a.d_x * f.x + a.d_y * f.y, a.n_x * f.x + a.n_y * f.y
    p = v_x * a.d_x + v_y * a.d_y + climb * climb_d
    r = v_x * a.n_x + v_y * a.n_y + climb * climb_n
    u = math.hypot(p, r)
    q, pull = a.limit, a.demand
    if pull < q:
        loss = q * q - pull * pull
        along = (pull * p * p + 2 * q * p * u + pull * u * u) / (4 * loss)
        across = r * (2 * q * u + pull * p) / (4 * q * q - pull * pull)
        time = (u * q + pull * p) / loss
        return Stop(time, along * a.d_x + across * a.n_x, along * a.d_y + across * a.n_y, False)
    if q > 0.0 and p < 0.0 and abs(r) <= straight:
        time = u / (pull + q)
        return Stop(time, 0.5 * p * time * a.d_x, 0.5 * p * time * a.d_y, True)
    return Stop(math.inf, 0.0, 0.0, False)


@jit
def stop_ahead(
    surface: Any, local: Any, part: Part, time: float, state: FloatArray, straight: float, pace: float
) -> tuple[Stop, float]:
    """The stop ahead of a sliding part, with an estimate of its error [m]; an error in time counts `pace` [m/s] times.

    The forces are frozen a third of the way, where a change that is linear in time has its mean effect; the error is
    taken as the difference from freezing them now.
    """
    x, y, v_x, v_y = state
    f = fields(surface, local, x, y, time)
    now = frozen_stop(f, slope(f, part), v_x, v_y, straight)
    if not now.time < 0.5 * local.frame[1]:
        return now, math.inf
    # After a third of the time a straight stop has covered five ninths of its way.
    g = fields(surface, local, x + 5 / 9 * now.x, y + 5 / 9 * now.y, time + now.time / 3)
    later = frozen_stop(g, slope(g, part), v_x, v_y, straight)
    if later.reverses != now.reverses or not math.isfinite(later.time):
        return now, math.inf
    return later, max(math.hypot(later.x - now.x, later.y - now.y), pace * abs(later.time - now.time))
