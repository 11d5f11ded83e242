"""How long a resting part with a face stays: the first moment of a span at which friction or contact no longer holds.

At a fixed place all forces are smooth in time over a span. Moments that are dense against the shortest stroke bracket
the first crossing of the limit; a dip between two of them that nearly reaches it is looked for. So break-away is
located, not proven: a crossing shorter than a 24th of a stroke that begins and ends between two moments, far from the
limit at these, is missed.
"""

from __future__ import annotations

import math

import numpy as np

from particle.body.averages import TT, T, enter_all, forget
from particle.body.balance import Balance, Base, fill_forces, least_pressure, limits, set_load
from particle.body.face import Face
from particle.body.limit import Search, gauge, needed
from particle.body.memory import HEADING, Memory, X, Y
from particle.body.press import pull_to_end
from particle.body.state import base_at, contact_margin, settle
from particle.events import Request
from particle.events.mechanics import Part
from particle.friction import LOCAL
from particle.jit import device_no_arrays, inlined, jit
from particle.surface import Surface
from particle.types import FloatArray

PER_STROKE, LEAST, MOST = 24, 4, 400  # moments looked at in the shortest stroke, and in a span
SAFE = 0.85  # of the limit: how far below it a bound that is cheaper than the gauge may stand for it
INNER = 0.8  # of friction's limits: an ellipsoid as large lies within them, on rectangles to 4:1, L-shapes and discs
NEAR = 0.1  # of the limit: a dip as near is looked at
HALVINGS = 60


@device_no_arrays
def excess(part: Part, face: Face, memory: Memory, time: float) -> float:
    """Above 0 where a part at rest does not stay at a time [s]: the gauge less 1, or minus the contact's margin.

    Far below the limit an upper bound of the gauge takes its place.
    """
    b, s = memory.balance[0], memory.search[0]
    if not settle(part, face, memory, memory.step[0].state, time):
        return math.nan
    margin = contact_margin(part, face, memory, True)
    if margin < 0.0:
        return -margin
    needed(b, s.needed)
    return max(quick_gauge(part, face, b, s) - 1.0, -margin)


@device_no_arrays
def quick_gauge(part: Part, face: Face, b: Balance, s: Search) -> float:
    """The gauge of s.needed under b.load; far below the limit an upper bound takes its place."""
    if part.law.kind == LOCAL:
        return gauge(part, face, b, s)
    turn = s.needed[2] / face.arm
    force = math.sqrt(s.needed[0] * s.needed[0] + s.needed[1] * s.needed[1] + turn * turn)
    limit, _, slope = limits(part, b)
    least = limit + slope * (least_pressure(face, b) - b.load[0])
    if force < SAFE * INNER * part.law.static_ratio * least:
        return force / (INNER * part.law.static_ratio * least)
    return gauge(part, face, b, s)


@jit
def rest_margins(
    surface: Surface, part: Part, face: Face, memory: Memory, x: float, y: float, heading: float, times: FloatArray
) -> FloatArray:
    """Of a part that stays at (x, y) [m]: the gauge of what holds it, and the contact's margin; (n, 2), at times [s].

    The gauge is inf where contact has ended and anything pulls at the part; both are nan off the plate.
    """
    out = np.full((len(times), 2), np.nan)
    b, s, state, end = memory.balance[0], memory.search[0], memory.step[0].state, -math.inf
    state[:] = 0.0
    state[X], state[Y], state[HEADING] = x, y, heading
    for k in range(len(times)):
        time = times[k]
        if not time < end:
            cell, end = enter_all(surface, memory.local, memory.under, face, x, y, heading, time, math.inf, (0.0, 0.0))
            if cell < 0:
                return out
        if not settle(part, face, memory, state, time):
            continue
        margin = contact_margin(part, face, memory, True)
        if part.law.kind == LOCAL and margin >= 0.0:
            margin = pull_to_end(part.law, face, b.load, b) / (part.mass * max(1.0, abs(part.gravity)))
        needed(b, s.needed)
        pulled = abs(s.needed[0]) + abs(s.needed[1]) + abs(s.needed[2]) > 0.0
        if margin >= 0.0:
            out[k, 0] = gauge(part, face, b, s)
        else:
            out[k, 0] = math.inf if pulled else 0.0
        out[k, 1] = margin
    return out


@jit
def rest_responses(
    surface: Surface, part: Part, face: Face, memory: Memory, places: FloatArray, heading: float, times: FloatArray
) -> FloatArray:
    """What a part at rest bears under drives sqrt(q) times as fast: (k, n, 12), at places (n, 2) [m], times (k,) [s].

    a and b of the load a + b q [N], of its moments M_1 and M_2 likewise [N m], then c and d of the wrench W = c + d q.
    Rates of the surface and the base grow by sqrt(q), second rates by q; pose and gravity stay.
    """
    out = np.full((len(times), len(places), 12), np.nan)
    b, s, state = memory.balance[0], memory.search[0], memory.step[0].state
    for n in range(len(places)):
        x, y, end = places[n, 0], places[n, 1], -math.inf
        state[:] = 0.0
        state[X], state[Y], state[HEADING] = x, y, heading
        for k in range(len(times)):
            time, row = times[k], out[k, n]
            if not time < end:
                cell, end = enter_all(
                    surface, memory.local, memory.under, face, x, y, heading, time, math.inf, (0.0, 0.0)
                )
                if cell < 0:
                    break
            if not settle(part, face, memory, state, time):
                continue
            needed(b, s.needed)
            for i in range(3):
                row[2 * i + 1], row[9 + i] = b.load[i], s.needed[i]
            forget(memory.under)
            for i in range(len(b.averages[T])):
                b.averages[T, i] = b.averages[TT, i] = 0.0
            base = base_at(memory.local, time)
            still = Base(base.x, base.y, base.turn, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
            fill_forces(part, face, still, 0.0, 0.0, 0.0, b)
            set_load(part, 0.0, 0.0, 0.0, b)
            needed(b, s.needed)
            for i in range(3):
                row[2 * i], row[6 + i] = b.load[i], s.needed[i]
                row[2 * i + 1], row[9 + i] = row[2 * i + 1] - b.load[i], row[9 + i] - s.needed[i]
    return out


@inlined
def leaves_rest(request: Request, face: Face, memory: Memory, end: float) -> float:
    """When [s] a part at rest first leaves its rest, from now.time on and before `end` [s]; inf: it does not."""
    part, begin = request.part, memory.now[0].time
    if end - begin <= 0.0:
        return math.inf
    count = int(min(max(math.ceil(PER_STROKE * (end - begin) / request.stroke_time), LEAST), MOST))
    width = (end - begin) / count
    before, value = math.inf, excess(part, face, memory, begin)
    if value > 0.0:
        return begin
    low = high = math.inf
    for k in range(1, count + 1):
        at = end if k == count else begin + k * width
        after = excess(part, face, memory, at)
        if math.isnan(after):
            return at
        if k > 1 and value > before and value > after and value > -NEAR:
            low, high = at - 2 * width, _peak(part, face, memory, at - 2 * width, at)
        if high == math.inf and after > 0.0:
            low, high = at - width, at
        if high < math.inf:
            break
        before, value = value, after
    return _root(part, face, memory, low, high) if high < math.inf else math.inf


@inlined
def _peak(part: Part, face: Face, memory: Memory, low: float, high: float) -> float:
    """A moment above the limit around a maximum between two [s]; inf: there is none. By the golden section."""
    ratio = 0.5 * (math.sqrt(5.0) - 1.0)
    a, b = high - ratio * (high - low), low + ratio * (high - low)
    at_a, at_b = excess(part, face, memory, a), excess(part, face, memory, b)
    for _ in range(30):
        if at_a > 0.0:
            return a
        if at_b > 0.0:
            return b
        if at_a > at_b:
            high, b, at_b = b, a, at_a
            a = high - ratio * (high - low)
            at_a = excess(part, face, memory, a)
        else:
            low, a, at_a = a, b, at_b
            b = low + ratio * (high - low)
            at_b = excess(part, face, memory, b)
    return math.inf


@inlined
def _root(part: Part, face: Face, memory: Memory, low: float, high: float) -> float:
    """The moment [s] between two at which the excess first is above 0, just beyond it: secants (Illinois), halving."""
    below, above = excess(part, face, memory, low), excess(part, face, memory, high)
    secant = True
    for _ in range(2 * HALVINGS):
        if high - low <= 1e-15 * abs(high):
            break
        middle = 0.5 * (low + high)
        if secant and math.isfinite(above) and math.isfinite(below):
            share = -below / (above - below)
            middle = low + min(max(share, 1e-9), 1.0 - 1e-9) * (high - low)
        if middle <= low or middle >= high:
            break
        value, width = excess(part, face, memory, middle), high - low
        if value > 0.0:
            high, above, below = middle, value, 0.5 * below
        else:
            low, below, above = middle, value, 0.5 * above
        secant = high - low < 0.5 * width
    return high
