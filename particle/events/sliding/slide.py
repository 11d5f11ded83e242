"""One accepted step of a sliding part, or its stop, whichever comes first."""

from __future__ import annotations

import math

from particle.events.mechanics import Counts, Motion, Now, RestPull, rest_pull, slip_speed
from particle.events.memory import Memory
from particle.events.request import Request
from particle.events.sliding.contact_end import stays_in_contact
from particle.events.sliding.manifold import (
    AT_REST,
    GOOD,
    check_manifold,
    joins_manifold,
    leave_manifold,
    to_plane,
)
from particle.events.sliding.runge_kutta import attempt, motion_rate, step_error
from particle.events.sliding.stop import Stop, come_to_rest, frozen_stop, stop_ahead
from particle.events.tableau import Pairs
from particle.jit import device_no_arrays, inlined
from particle.modes import NO_EVENT, EventKind, Mode, Verdict
from particle.surface import (
    NOWHERE,
    ROUNDING,
    Frame,
    LocalSurface,
    Surface,
    SurfacePoint,
    allow_bridges,
    first_beyond,
    gap_at,
    rim_gap,
    surface_at,
)

MIN_STEP = 1e-13  # of a stroke
MAX_GROWTH, SAFETY = 5.0, 0.9
BEFORE_STOP = 0.6  # of the time to a stop, beyond which the velocity is a power of that time, not a polynomial of it
SHORT = 0.35  # of a step that the long pair would take: one that the short pair can take
IN_SIGHT = 5.0  # steps: how close a stop must be to be looked at
OFF_MANIFOLD = 0.4  # of the last step on the slow manifold: the first one off it
CLOSE, LATE = 0.1, 0.01  # of a step: how close and how late it must pass an actuator to end there


@device_no_arrays
def bridge(local: LocalSurface, request: Request, mode: int) -> None:
    """Bridge breakpoints under a sliding part only: when one slips, lands or comes off is located without."""
    frame: Frame = local.frame[0]
    sliding = mode == Mode.SLIDING or mode == Mode.MANIFOLD
    if not sliding and frame.min_jump > 0.0:
        frame.cell = NOWHERE  # what is prepared may have bridges in it
    allow_bridges(local, request.bridged[0] if sliding else 0.0, request.bridged[1] if sliding else 0.0)


@device_no_arrays
def slide(surface: Surface, request: Request, pairs: Pairs, memory: Memory) -> int:
    """Moves the part on by one step of about now.h [s], not beyond now.span_end, or to its stop.

    Returns STOPS, REVERSES where its slope pulls it on at once, or NO_EVENT.
    """
    now: Now = memory.now[0]
    counts: Counts = memory.counts[0]
    motion: Motion = memory.motion[0]
    local, step, part = memory.local, memory.step, request.part
    f = surface_at(local, motion.x, motion.y, now.time)
    counts.evaluations += 1
    a = rest_pull(f, part)
    step.loads[0] = motion_rate(f, now.mode, local, part, now.time, motion, step.rates[0])
    now.gap = gap_at(surface, local, motion.x, motion.y)
    if now.mode == Mode.SLIDING or (a.demand < a.limit and motion.v_x > 0.0):
        event = _stop(surface, request, memory, f, a)
        if event != NO_EVENT:
            return event
    if now.mode == Mode.SLIDING and joins_manifold(local, request, now.time, motion, f, a):
        motion.v_x, motion.v_y = slip_speed(f, part, motion.v_x, motion.v_y), 0.0
        now.mode = Mode.MANIFOLD
        step.loads[0] = motion_rate(f, now.mode, local, part, now.time, motion, step.rates[0])
    return _step(surface, request, pairs, memory, f, a)


@inlined
def _stop(surface: Surface, request: Request, memory: Memory, f: SurfacePoint, a: RestPull) -> int:
    """Moves the part to its stop if that is close; else shortens the step so that it ends before."""
    now: Now = memory.now[0]
    counts: Counts = memory.counts[0]
    local, step, part, time = memory.local, memory.step, request.part, now.time
    step.plane[0] = memory.motion[0]
    motion: Motion = step.plane[0]
    if now.mode == Mode.MANIFOLD:
        to_plane(local, part, time, motion, f, a)
    pace = 0.01 * surface.size / request.stroke_time
    small = 0.01 * request.tolerance
    stop, error = frozen_stop(f, part, a, motion.v_x, motion.v_y, small), math.inf
    if stop.time < min(IN_SIGHT * now.h, 0.5 * local.frame[0].unit):
        stop, error = stop_ahead(stop, local, part, time, motion, small, pace, request.force)
        counts.evaluations += 1
    close = time + stop.time <= now.span_end and error < 0.1 * request.tolerance
    close = close and _stops_on_plate(surface, now.gap, motion, stop)
    counts.evaluations += 5 * close
    if close and come_to_rest(local, part, time, motion, stop):
        memory.motion[0] = step.plane[0]
        a = rest_pull(surface_at(local, motion.x, motion.y, time + stop.time), part)
        now.time = time + stop.time
        if stop.reverses and a.demand > part.law.static_ratio * a.limit:
            now.mode = Mode.MANIFOLD
            return EventKind.REVERSES.value
        now.mode = Mode.RESTING
        return EventKind.STOPS.value
    # A step ends short of the stop, where the friction turns.
    now.h = min(now.h, BEFORE_STOP * stop.time)
    return NO_EVENT


@inlined
def _stops_on_plate(surface: Surface, gap: float, motion: Motion, stop: Stop) -> bool:
    """Whether the way to a stop lies on the plate; gap: m, from the rim at its start."""
    x, y = motion.x + stop.x, motion.y + stop.y
    velocity = (motion.v_x, motion.v_y)
    way = first_beyond(surface, gap, (motion.x, motion.y), (x, y), velocity, (0.0, 0.0), stop.time)
    return way == 1.0 and rim_gap(surface, x, y) >= -ROUNDING * surface.size


@inlined
def _step(surface: Surface, request: Request, pairs: Pairs, memory: Memory, f: SurfacePoint, a: RestPull) -> int:
    """Moves the part on by the first step tried that is good enough, to the end of contact, or to rest (STOPS)."""
    now: Now = memory.now[0]
    counts: Counts = memory.counts[0]
    remaining = now.span_end - now.time
    pair, reach = pairs.long, 1.0
    if pairs.short.order < pairs.long.order and remaining < SHORT * now.h:
        pair, reach = pairs.short, SHORT
    # Before the first attempt only: a step that is refused and tried a little shorter must not become as long again.
    now.h = remaining if now.h >= 0.9 * remaining else now.h
    while True:
        if now.mode == Mode.SLIDING:
            now.h = _to_passage(memory.local, memory.motion[0], now.h)
        if now.h < MIN_STEP * request.stroke_time and now.h < remaining:
            now.verdict = Verdict.WORK_LIMIT
            return NO_EVENT
        counts.evaluations += len(pair.c) - 1
        if not attempt(surface, request.part, pair, memory, now.h):
            now.h *= 0.5
            continue
        error = step_error(pair, memory.step, now.h, request.stroke_time, request.force) / request.tolerance
        if not error <= 1.0 and reach < 1.0:
            pair, reach = pairs.long, 1.0
        elif not error <= 1.0:
            now.h *= max(0.2, SAFETY * error ** (-1 / pair.order)) if error > 1.0 else 0.2
        else:
            found = check_manifold(request, memory, f, a) if now.mode == Mode.MANIFOLD else GOOD
            if found == AT_REST:
                return EventKind.STOPS.value
            if found == GOOD and stays_in_contact(surface, request, pair, memory):
                break
            if now.verdict != Verdict.GOES_ON:
                return NO_EVENT
    growth = min(MAX_GROWTH, SAFETY * max(error, 1e-12) ** (-1 / pair.order))
    _accept(request, memory, remaining, reach, growth)
    return NO_EVENT


@inlined
def _accept(request: Request, memory: Memory, remaining: float, reach: float, growth: float) -> None:
    """Goes on to the end of the step; reach: its share of one of the long pair."""
    now: Now = memory.now[0]
    h = now.h
    memory.motion[0] = memory.step.end[0]
    now.time = now.span_end if h == remaining else now.time + h
    now.h = h / reach * growth
    if now.mode == Mode.MANIFOLD:
        leave_manifold(request, memory)
        if now.mode == Mode.SLIDING:
            now.h = OFF_MANIFOLD * h


@inlined
def _to_passage(local: LocalSurface, motion: Motion, h: float) -> float:
    """The step [s], cut where the part passes closely over an actuator: at a step's end its logarithm does no harm."""
    x, y, v_x, v_y = motion.x, motion.y, motion.v_x, motion.v_y
    square = v_x * v_x + v_y * v_y
    for j in range(local.frame[0].logarithms):
        d_x, d_y = local.sources[j, 0] - x, local.sources[j, 1] - y
        passage = (d_x * v_x + d_y * v_y) / square if square > 0.0 else 0.0
        if LATE * h < passage < h and abs(d_x * v_y - d_y * v_x) < CLOSE * square * h:
            h = passage
    return h
