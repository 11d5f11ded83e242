"""A step of part and film to where rest, contact or flight end; and a part at rest."""

from __future__ import annotations

import math

from particle.body import ORDER, STAGES, Face
from particle.events import Request
from particle.events.mechanics import Now
from particle.film.film import Layer
from particle.film.gap import Gap, stored
from particle.film.memory import PUMPED, STORED, WORK, Memory, Z
from particle.film.state import energy_now, fill_need, fill_rate, is_off, leaves, rim_of, settle
from particle.film.step import FOLD, attempt, begin_step, error_of, fill_within, take_step
from particle.jit import device_no_arrays, inlined
from particle.modes import NO_EVENT, EventKind, Mode, Verdict
from particle.surface import Surface

ACROSS = 1e-6  # of a stroke: the most over which a film stays as it is where the gap jumps
LOOKS = 6  # moments of a step at rest that are looked at
HELD = 1e-6  # of its limit, by which friction still holds where a step ends at a jump of the gap, not at a slip
MAX_GROWTH, SAFETY, MIN_STEP = 8.0, 0.9, 1e-12
FIRST_TRY = 1e-6  # of a stroke


@inlined
def rest(surface: Surface, request: Request, layer: Layer, face: Face | tuple[()], memory: Memory) -> int:
    """The part rests for a step, at most to where it leaves: SLIPS, DETACHES or NO_EVENT."""
    now: Now = memory.now[0]
    step, g = memory.step[0], memory.gap[0]
    fill_rate(request, layer, face, memory, step.state, now.time, now.mode, g, step.rate)
    fill_need(request, face, memory, g)
    if leaves(request, g) > 0.0:
        return _event(surface, request, face, memory, g)
    energy = energy_now(request, face, memory)
    event = advance(surface, request, layer, face, memory)
    # A part at rest dissipates nothing: all that its energy gains is the surface's work.
    step.state[WORK] += energy_now(request, face, memory) - energy
    return event


@device_no_arrays
def advance(surface: Surface, request: Request, layer: Layer, face: Face | tuple[()], memory: Memory) -> int:
    """One step of about now.h [s] from memory.step[0].state, the rate of which is known; the event at its end."""
    now: Now = memory.now[0]
    step, last = memory.step[0], memory.gap[STAGES]
    begin_step(surface, request, layer, face, memory)
    remaining = now.span_end - now.time
    now.h = max(now.h, FIRST_TRY * request.stroke_time)  # an event may have cut the last step to nothing
    now.h = remaining if now.h >= 0.9 * remaining else now.h
    while True:
        if now.h < MIN_STEP * request.stroke_time and now.h < remaining:
            return _cross_fold(surface, request, layer, face, memory)
        if not attempt(surface, request, layer, face, memory, now.h):
            now.h *= 0.4
            continue
        error = error_of(surface, request, layer, face, memory, now.h) / request.tolerance
        if not error <= 1.0:
            now.h *= max(0.2, SAFETY * error ** (-1 / ORDER)) if error > 1.0 else 0.2
            continue
        ends, early = False, False
        if now.mode == Mode.RESTING:
            share = _leaves_at(request, layer, face, memory, now.h)
            if share < 1.0:
                # Just beyond: rounding could put off the end of contact again and again.
                now.h = min(now.h * share + MIN_STEP * request.stroke_time, remaining)
                if not attempt(surface, request, layer, face, memory, now.h):
                    now.h *= 0.4
                    continue
            ends = share <= 1.0
        else:
            ends = _is_over(surface, face, memory, STAGES)
            for k in range(1, STAGES):
                early = early or _is_over(surface, face, memory, k)
            if early and not ends:
                now.h *= 0.5
                continue
            if ends:
                _locate_end(surface, request, layer, face, memory)
        break
    h = now.h
    take_step(face, memory, h)
    now.time = now.span_end if h == remaining else now.time + h
    now.h = h * min(MAX_GROWTH, SAFETY * max(error, 1e-12) ** (-1 / ORDER))
    step.state[STORED] = stored(layer, last)
    if not ends:
        return NO_EVENT
    event = _event(surface, request, face, memory, last)
    if event == EventKind.SLIPS:
        fill_need(request, face, memory, last)
        if leaves(request, last) < -HELD:
            return NO_EVENT
    return event


@inlined
def _cross_fold(surface: Surface, request: Request, layer: Layer, face: Face | tuple[()], memory: Memory) -> int:
    """Where the gap jumps, as the film is softer than the asperities pull: the part is beyond it; else work ends."""
    now: Now = memory.now[0]
    state, g, before = memory.step[0].state, memory.gap[STAGES], memory.gap[0].z
    settle(request, layer, face, memory, state, now.time + now.h, g)
    while abs(g.z - before) < FOLD[1]:
        now.h *= 4.0
        if now.h > ACROSS * request.stroke_time:
            now.verdict = Verdict.WORK_LIMIT
            return NO_EVENT
        settle(request, layer, face, memory, state, now.time + now.h, g)
    now.time += now.h
    state[Z] = g.z
    state[PUMPED] += stored(layer, g) - state[STORED]
    now.h, memory.step[0].before = 1e-4 * request.stroke_time, 0.0
    return _event(surface, request, face, memory, g) if is_off(g) != (now.mode == Mode.FLYING) else NO_EVENT


@device_no_arrays
def _is_over(surface: Surface, face: Face | tuple[()], memory: Memory, k: int) -> bool:
    """Whether contact, or flight, has ended at the k-th stage, from 1."""
    g, stage = memory.gap[k], memory.step[0].stages[k - 1]
    ended = g.verdict != Verdict.GOES_ON or is_off(g) != (memory.now[0].mode == Mode.FLYING)
    return ended or rim_of(surface, face, memory, stage) < 0.0


@inlined
def _locate_end(surface: Surface, request: Request, layer: Layer, face: Face | tuple[()], memory: Memory) -> None:
    """Shorten the step tried to where contact or flight ends, just beyond it."""
    now: Now = memory.now[0]
    low, high = 0.0, now.h
    while high - low > 1e-15 * (now.time + high) and high - low > 1e-13 * now.h:
        middle = 0.5 * (low + high)
        if attempt(surface, request, layer, face, memory, middle) and _is_over(surface, face, memory, STAGES):
            high = middle
        else:
            low = middle
    attempt(surface, request, layer, face, memory, high)
    now.h = high


@device_no_arrays
def _event(surface: Surface, request: Request, face: Face | tuple[()], memory: Memory, g: Gap) -> int:
    """What happens where rest, contact or flight end, with the gap there."""
    now: Now = memory.now[0]
    state = memory.step[0].state
    if rim_of(surface, face, memory, state) < 0.0:
        now.verdict = Verdict.LEFT_PLATE
    elif g.verdict != Verdict.GOES_ON:
        now.verdict = g.verdict
    elif now.mode == Mode.FLYING:
        now.mode = Mode.SLIDING if g.speed > 0.0 else Mode.RESTING
        return EventKind.LANDS.value
    elif is_off(g) and request.flies:
        now.mode = Mode.FLYING
        return EventKind.DETACHES.value
    elif is_off(g):
        now.verdict = Verdict.DETACHED
    else:
        return EventKind.SLIPS.value
    return NO_EVENT


@device_no_arrays
def _look(request: Request, layer: Layer, face: Face | tuple[()], memory: Memory, share: float, h: float) -> float:
    """`leaves` a share of the step tried after its begin."""
    fill_within(face, memory, share, h, memory.step[0].probe)
    settle(request, layer, face, memory, memory.step[0].probe, memory.now[0].time + share * h, memory.gap[STAGES + 1])
    return leaves(request, memory.gap[STAGES + 1])


@inlined
def _leaves_at(request: Request, layer: Layer, face: Face | tuple[()], memory: Memory, h: float) -> float:
    """The share of the step tried after which a part at rest leaves, just beyond it: secants (Illinois), halving."""
    low, below, high, above = 0.0, leaves(request, memory.gap[0]), 0.0, 0.0
    for k in range(1, LOOKS + 1):
        high = k / LOOKS
        above = _look(request, layer, face, memory, high, h)
        if above > 0.0:
            break
        low, below = high, above
    if not above > 0.0:
        return math.inf
    secant = True
    while high - low > 1e-14:
        middle = 0.5 * (low + high)
        if secant:
            share = -below / (above - below)
            middle = low + min(max(share, 1e-9), 1.0 - 1e-9) * (high - low)
        if middle <= low or middle >= high:
            break
        value, width = _look(request, layer, face, memory, middle, h), high - low
        if value > 0.0:
            high, above, below = middle, value, 0.5 * below
        else:
            low, below, above = middle, value, 0.5 * above
        secant = high - low < 0.5 * width
    return high
