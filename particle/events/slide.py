"""One accepted step of a sliding part, or its stop, whichever comes first."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.events.breakaway import Slope, lag, slope, velocity
from particle.events.equations import Part, energy_at_rest, length, margin
from particle.events.record import MANIFOLD, RESTING, SLIDING
from particle.events.runge_kutta import Pairs, Step, Tableau, attempt, error, fields_at_start, first_excursion, rate
from particle.events.stop import Stop, come_to_rest, frozen_stop, stop_ahead
from particle.jit import bare
from particle.surface import (
    CELL,
    LANDED,
    NEAR,
    NOWHERE,
    ROUNDING,
    UNIT,
    Fields,
    allow,
    fields,
    first_beyond,
    gap_at,
    rim_gap,
)

FloatArray = NDArray[np.float64]

TURNED = -1  # what a part does that came to rest on a slope which at once pulls it back
# How a path ends; the last two only for now: until there is a cell, and when nobody waits for it any more.
GOES_ON, DETACHED, LEFT_PLATE, OVERLOADED, WORK_LIMIT, LACKS_CELL, INTERRUPTED = range(7)

WEAKEST = 0.75  # of the friction limit: the slow manifold draws parts to it down to a pull of half of it
SHORTEST = 1e-13  # of a stroke: no step is shorter
TOUCH = 1e-6  # of a stroke: a break-away that has not come off by then was only a touch
GROWTH, SAFETY = 5.0, 0.9
SHORT_OF_STOP = 0.6  # of the time to a stop, beyond which the velocity is a power of that time, not a polynomial of it
SHORT = 0.35  # of a step that the long pair would take: one that the short pair can take
IN_SIGHT = 5.0  # steps: how near a stop must be to be looked at
OFF_MANIFOLD = 0.4  # of the last step on the slow manifold: the first one off it
CLOSE, LATE = 0.1, 0.01  # of a step: how near and how late it must pass an actuator to end there


class Request(NamedTuple):
    """One path to find."""

    part: Part
    start: FloatArray  # (4,) m, m, m/s, m/s
    duration: float  # s
    tolerance: float  # m, error of one step
    stroke_time: float  # s, the shortest stroke
    force: float  # N, that of gravity and of crossing the surface in a stroke
    flies: bool  # whether a part that comes off is followed to where it lands
    jumps: bool  # whether the surface's velocity jumps at kinks
    bends: bool  # whether its acceleration does
    bridged: tuple[float, float]  # m/s, m/s^2, how far the surface may be off over kinks on which no step ends


@bare
def bridge(local: Any, request: Request, mode: int) -> None:
    """Let kinks be bridged under a sliding part; when one slips, lands or comes off is found without."""
    sliding = mode in (SLIDING, MANIFOLD)
    if not sliding and local.frame[LANDED] > 0.0:
        local.counts[CELL] = NOWHERE  # what is prepared may have bridges in it
    allow(local, request.bridged[0] if sliding else 0.0, request.bridged[1] if sliding else 0.0)


@bare
def slide(
    surface: Any,
    local: Any,
    request: Request,
    pairs: Pairs,
    step: Step,
    count: NDArray[np.int64],
    mode: int,
    time: float,
    h: float,
    span_end: float,
    state: FloatArray,
) -> tuple[int, float, float, int]:
    """Moves `state` on by one step of about h [s], not beyond `span_end`; count[0] counts evaluations.

    Returns what the part does then, the time, the next h and how the path ended (GOES_ON: it did not).
    """
    part, tolerance = request.part, request.tolerance
    f = fields_at_start(local, step, count, time, state)
    a = slope(f, part)
    step.loads[0] = rate(f, mode, local, part, time, state, step.rates[0])
    step.start_gap[0] = gap_at(surface, local, state[0], state[1])
    if mode == SLIDING or (a.demand < a.limit and state[2] > 0.0):
        moving = step.moving
        put(state, 8, moving)
        if mode == MANIFOLD:
            kappa = lag(local, part, time, state[0], state[1], state[2], f, a)
            moving[2], moving[3] = velocity(state[2], kappa, a)
        pace = 0.01 * surface.size / request.stroke_time
        small = 0.01 * tolerance
        stop, miss = frozen_stop(f, a, moving[2], moving[3], small), math.inf
        if stop.time < min(IN_SIGHT * h, 0.5 * local.frame[UNIT]):
            stop, miss = stop_ahead(stop, local, part, time, moving, small, pace, request.force)
            count[0] += 1
        near = time + stop.time <= span_end and miss < 0.1 * tolerance
        near = near and _stops_on_plate(surface, local, step, moving, stop)
        count[0] += 5 * near
        if near and come_to_rest(local, part, time, moving, stop):
            put(moving, 8, state)
            a = slope(fields(local, state[0], state[1], time + stop.time), part)
            back = stop.reverses and a.demand > part.law.static_ratio * a.limit
            return (TURNED if back else RESTING), time + stop.time, h, GOES_ON
        # A step ends short of the stop, where the friction turns.
        h = min(h, SHORT_OF_STOP * stop.time)
    if mode == SLIDING and _joins_manifold(local, request, time, state, f, a):
        state[2], state[3] = length(f, state[2], state[3]), 0.0
        mode = MANIFOLD
        step.loads[0] = rate(f, mode, local, part, time, state, step.rates[0])
    remaining = span_end - time
    shortest = SHORTEST * request.stroke_time
    pair, reach = pairs.long, 1.0
    if pairs.short.order < pairs.long.order and remaining < SHORT * h:
        pair, reach = pairs.short, SHORT
    # Before the first attempt only: a step that is refused and tried a little shorter must not become as long again.
    h = remaining if h >= 0.9 * remaining else h
    while True:
        if mode == SLIDING:
            h = _to_passage(local, state, h)
        if h < shortest and h < remaining:
            return mode, time, h, WORK_LIMIT
        count[0] += len(pair.c) - 1
        if not attempt(mode, surface, local, part, pair, step, time, state, h):
            h *= 0.5
            continue
        wrong = error(pair, step, h, request.stroke_time, request.force) / tolerance
        if not wrong <= 1.0 and reach < 1.0:
            pair, reach = pairs.long, 1.0
            continue
        if not wrong <= 1.0:
            h *= max(0.2, SAFETY * wrong ** (-1 / pair.order)) if wrong > 1.0 else 0.2
            continue
        if mode == MANIFOLD and step.end[2] <= 0.0:
            if h > TOUCH * request.stroke_time:
                h *= 0.5
                continue
            state[2] = state[3] = 0.0
            state[4] += energy_at_rest(local, part, time + h, state)
            state[4] -= energy_at_rest(local, part, time, state)
            return RESTING, time + h, h, GOES_ON
        beyond = _manifold_error(local, part, time + h, step.end) / tolerance if mode == MANIFOLD else 0.0
        if beyond > 1.0:
            if h > TOUCH * request.stroke_time:
                # It grows with the speed's third power, and that with the time.
                h *= max(0.05, SAFETY * beyond ** (-1 / 3))
                continue
            # Friction is about to vanish, and the manifold with it.
            kappa = lag(local, part, time, state[0], state[1], state[2], f, a)
            state[2], state[3] = velocity(state[2], kappa, a)
            mode = SLIDING
            step.loads[0] = rate(f, mode, local, part, time, state, step.rates[0])
            continue
        last = len(pair.c) - 1
        on_plate = first_beyond(surface, step.start_gap[0], state, step.end, step.rates[0], step.rates[last], h)
        # A path that leaves and comes back ends where it first leaves; where it ends beyond, the end is located below.
        if on_plate < (0.9 if step.margins[last] < 0.0 else 1.0):
            h *= on_plate
            continue
        if step.margins[last] < 0.0:
            h = _locate_end(surface, local, part, pair, step, count, mode, time, state, h)
            put(step.end, 6, state)
            return mode, time + h, h, reason(surface, part, step.loads[last], state)
        if step.margins[1 : last + 1].min() < 0.0:
            h *= 0.5
            continue
        within = first_excursion(part, pair, step)
        if within < 1.0 and h > TOUCH * request.stroke_time:
            h *= within
            continue
        break
    put(step.end, 6, state)
    time = span_end if h == remaining else time + h
    step.seen[0] = time
    if mode == MANIFOLD:
        mode = _leave_manifold(local, request, time, state)
        if mode == SLIDING:
            return mode, time, OFF_MANIFOLD * h, GOES_ON
    return mode, time, h / reach * min(GROWTH, SAFETY * max(wrong, 1e-12) ** (-1 / pair.order)), GOES_ON


@bare
def put(source: FloatArray, count: int, into: FloatArray) -> None:
    """Copy the first few numbers of an array; a slice would make an array on the way."""
    for i in range(count):
        into[i] = source[i]


@bare
def _to_passage(local: Any, state: FloatArray, h: float) -> float:
    """The step [s], cut where the part passes closely over an actuator: at a step's end its logarithm does no harm."""
    x, y, v_x, v_y = state[0], state[1], state[2], state[3]
    square = v_x * v_x + v_y * v_y
    for j in range(local.counts[NEAR]):
        d_x, d_y = local.near[j, 0] - x, local.near[j, 1] - y
        passage = (d_x * v_x + d_y * v_y) / square if square > 0.0 else 0.0
        if LATE * h < passage < h and abs(d_x * v_y - d_y * v_x) < CLOSE * square * h:
            h = passage
    return h


@bare
def _stops_on_plate(surface: Any, local: Any, step: Step, state: FloatArray, stop: Stop) -> bool:
    """Whether the way to a stop lies on the plate."""
    step.end[0], step.end[1] = state[0] + stop.x, state[1] + stop.y
    way = first_beyond(surface, step.start_gap[0], state, step.end, state[2:], step.still, stop.time)
    return way == 1.0 and rim_gap(surface, step.end[0], step.end[1]) >= -ROUNDING * surface.size


@bare
def _manifold_error(local: Any, part: Part, time: float, state: FloatArray) -> float:
    """What the slow manifold's next term would move the part by [m]."""
    f = fields(local, state[0], state[1], time)
    a = slope(f, part)
    kappa = lag(local, part, time, state[0], state[1], state[2], f, a)
    return 3 * abs(kappa) * state[2] ** 3 / a.limit if a.limit > 0.0 else math.inf


@bare
def _joins_manifold(local: Any, request: Request, time: float, state: FloatArray, f: Fields, a: Slope) -> bool:
    """Whether a slow part's velocity (v_x, v_y) has become that of the slow manifold, on which steps may be longer."""
    u, tolerance = length(f, state[2], state[3]), request.tolerance
    if a.limit <= 0.0 or a.demand < 1.1 * WEAKEST * a.limit or u > 0.01 * a.limit * request.stroke_time:
        return False
    kappa = lag(local, request.part, time, state[0], state[1], u, f, a)
    v_x, v_y = velocity(u, kappa, a)
    # What is off the manifold turns into it within u / Q.
    off = length(f, state[2] - v_x, state[3] - v_y) * u / a.limit
    return bool(off <= 0.01 * tolerance and 3 * abs(kappa) * u**3 / a.limit <= 0.01 * tolerance)


@bare
def _leave_manifold(local: Any, request: Request, time: float, state: FloatArray) -> int:
    """Turns (x, y, u) into (x, y, v_x, v_y) once the part is fast enough for plain steps, or slows down again."""
    part, u = request.part, state[2]
    f = fields(local, state[0], state[1], time)
    a = slope(f, part)
    fast = u > 0.03 * a.limit * request.stroke_time
    near = _manifold_error(local, part, time, state) <= 0.1 * request.tolerance
    if near and not fast and a.demand >= WEAKEST * a.limit:
        return MANIFOLD
    state[2], state[3] = velocity(u, lag(local, part, time, state[0], state[1], u, f, a), a)
    return SLIDING


@bare
def _locate_end(
    surface: Any,
    local: Any,
    part: Part,
    pair: Tableau,
    step: Step,
    count: NDArray[np.int64],
    mode: int,
    time: float,
    state: FloatArray,
    h: float,
) -> float:
    """The step that ends where contact does, just beyond it: a bracket that secants (Illinois) and halving close."""
    last = len(pair.c) - 1
    low, high = 0.0, h
    below, above = step.margins[last], margin(local, part, step.loads[0], step.start_gap[0])
    secant = True
    while high - low > 1e-15 * (time + high) and high - low > 1e-14 * h:
        middle = 0.5 * (low + high)
        if secant and above > 0.0:
            share = above / (above - below)
            # Never quite at an end, lest the other one stay for ever.
            middle = low + min(max(share, 1e-6), 1.0 - 1e-6) * (high - low)
        count[0] += len(pair.c)
        good = attempt(mode, surface, local, part, pair, step, time, state, middle)
        width = high - low
        if good and step.margins[last] < 0.0:
            high, below, above = middle, step.margins[last], 0.5 * above
        else:
            low, above, below = middle, (step.margins[last] if good else 0.0), 0.5 * below
        secant = high - low < 0.5 * width
    count[0] += len(pair.c)
    attempt(mode, surface, local, part, pair, step, time, state, high)
    return high


@bare
def reason(surface: Any, part: Part, load: float, state: FloatArray) -> int:
    """Why contact ends where the margin is negative."""
    if rim_gap(surface, state[0], state[1]) < 0.0:
        return LEFT_PLATE
    if load < -part.law.pull_off:
        return DETACHED
    return OVERLOADED
