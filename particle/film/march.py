"""The integrator of a part on a film of air: rest, slips, stops and the end of contact, each located.

Part and film are one system, at rest as well, where the contents alone move. A step of `step` ends where a resting part
leaves: that is looked for at moments of the step's polynomial, so it is located, not proven.
"""

from __future__ import annotations

import math

import numpy as np

from particle.body.collocation import ORDER, STAGES
from particle.events import FIRST_STEP, PathRecord, Request, last_row, note, write
from particle.events.flight import MIN_JUMP, velocity_jump
from particle.events.mechanics import (
    Counts,
    Now,
    RestPull,
    at_contact,
    first_slip,
    mobility,
    over_plane,
    pull,
    rest_pull,
)
from particle.events.sliding import Stop, frozen_stop
from particle.film.film import Layer
from particle.film.gap import Gap, fill_gap_at_rest, stored
from particle.film.memory import CONTENTS, HEAT, LOSS, PUMPED, SOLVED, STATE, STORED, V_X, V_Y, WORK, Memory, X, Y, Z
from particle.film.state import drag_of, energy_now, fill_rate, fill_row, is_off, leaves, settle
from particle.film.step import FOLD, LONGER, attempt, begin_step, error_of, fill_within, take_step
from particle.jit import device, device_no_arrays, inlined, jit
from particle.modes import END_EVENTS, NO_EVENT, EventKind, Mode, Verdict
from particle.surface import UNBUILT, Surface, allow_bridges, enter, gap_at, surface_at
from particle.types import FloatArray

FIRST = 1e-3  # of a stroke: the first moment of a slip, over which its acceleration is linear in time
CLOSE = 1e-9  # of the limit: how close a slip that was located begins to it
BEFORE_STOP = 0.85  # of the time to a stop: the longest step
STOPPED = 2e-5, 1e-2  # of a stroke, of the tolerance: how close a stop's time and place must be
ACROSS = 1e-6  # of a stroke: the most over which a film stays as it is where the gap jumps
LOOKS = 6  # moments of a step at rest that are looked at
MAX_GROWTH, SAFETY, MIN_STEP = 8.0, 0.9, 1e-12
EVALUATIONS_PER_SPAN, MIN_EVALUATIONS = 50_000, 500_000


@jit
def march_film(
    surface: Surface, request: Request, layer: Layer, start: FloatArray, memory: Memory, record: PathRecord
) -> tuple[PathRecord, FloatArray]:
    """The path from one request, into `record`, and the state at its rows (rows, STATE) or more.

    start: (STATE,), with z = nan for a film at rest at the pressure around.  Where a cell is lacking the path ends, and
    must begin anew when there is one.
    """
    now: Now = memory.now[0]
    counts: Counts = memory.counts[0]
    step, local, g = memory.step[0], memory.local, memory.gap[0]
    states = np.zeros((len(record.rows), STATE))
    for k in range(STATE):
        step.state[k] = start[k]
    step.before = 0.0
    now.time = now.span_end = request.begin
    now.mode, now.h, now.verdict = request.mode, request.first_step, Verdict.GOES_ON
    # A part that is about to slip, as at a row of its path, slips without a further event; so does one that reverses.
    slips = now.mode == Mode.SLIDING and step.state[V_X] == 0.0 and step.state[V_Y] == 0.0
    if slips:
        now.mode = Mode.RESTING
    while now.verdict == Verdict.GOES_ON and now.time < request.until:
        if memory.stop[0] != 0:
            now.verdict = Verdict.INTERRUPTED
            break
        new_span = now.time >= now.span_end
        if request.jumps and new_span and counts.spans > 0 and _jumps(surface, request, memory):
            now.verdict = Verdict.JUMPS
            break
        allow_bridges(local, request.bridged[0], request.bridged[1])
        cell = enter(surface, local, step.state[X], step.state[Y], now.time, request.duration)
        if cell == UNBUILT:
            now.verdict = Verdict.LACKS_CELL
            break
        if cell < 0 or gap_at(surface, local, step.state[X], step.state[Y]) < 0.0:
            now.verdict = Verdict.LEFT_PLATE
            break
        now.span_end = min(local.frame[0].end, request.until)
        if now.span_end <= now.time:
            now.verdict = Verdict.WORK_LIMIT
            break
        if record.lengths[0].rows == 0:
            if math.isnan(step.state[Z]):
                _fill_film_at_rest(request, layer, memory)
            if now.verdict == Verdict.GOES_ON:
                fill_row(request, layer, memory, now.mode, memory.row[0])
                now.verdict = g.verdict
            record, states = _write(record, states, memory)
            if now.verdict != Verdict.GOES_ON:
                break
        elif new_span:
            # Where forces jump the gap does, with the film's contents as they are.
            settle(request, layer, memory, step.state, now.time, g)
            step.state[Z] = g.z
            step.state[PUMPED] += stored(layer, g) - step.state[STORED]
            step.state[STORED] = stored(layer, g)
        if new_span:
            counts.spans += 1
            now.h = max(now.h, 1e-4 * request.stroke_time)
        if now.mode == Mode.RESTING:
            event = _rest(surface, request, layer, memory)
            if event == EventKind.SLIPS:
                fill_row(request, layer, memory, Mode.SLIDING, memory.row[0])
                begins = _begin_slip(surface, request, layer, memory)
                if begins:
                    record, states = _write(record, states, memory)
                if begins and not slips:
                    record = note(record, event, memory.row[0])
                event = NO_EVENT
            slips = False
        else:
            event = _slide(surface, request, layer, memory)
            slips = event == EventKind.REVERSES
        fill_row(request, layer, memory, now.mode, memory.row[0])
        if event != NO_EVENT:
            record = note(record, event, memory.row[0])
        record, states = _write(record, states, memory)
        if counts.evaluations > MIN_EVALUATIONS + EVALUATIONS_PER_SPAN * counts.spans:
            now.verdict = Verdict.WORK_LIMIT
    verdict = now.verdict
    if verdict >= Verdict.DETACHED and verdict <= Verdict.OVERLOADED and record.lengths[0].rows > 0:
        memory.row[0] = last_row(record)
        record = note(record, END_EVENTS + verdict, memory.row[0])
    return record, states


@device
def _write(record: PathRecord, states: FloatArray, memory: Memory) -> tuple[PathRecord, FloatArray]:
    """The record with the row memory.row[0], and the state at its rows."""
    record = write(record, memory.row[0])
    if len(states) < len(record.rows):
        longer = np.zeros((len(record.rows), STATE))
        longer[: len(states)] = states
        states = longer
    place = record.lengths[0].rows - 1
    for k in range(STATE):
        states[place, k] = memory.step[0].state[k]
    return record, states


@inlined
def _jumps(surface: Surface, request: Request, memory: Memory) -> bool:
    """Whether the surface's velocity under the part jumps as a span begins."""
    local, state, time = memory.local, memory.step[0].state, memory.now[0].time
    old = surface_at(local, state[X], state[Y], time)
    enter(surface, local, local.frame[0].x, local.frame[0].y, time, request.duration)
    new = surface_at(local, state[X], state[Y], time)
    return velocity_jump(old, new, request.part) > MIN_JUMP * surface.size / request.stroke_time


@inlined
def _fill_film_at_rest(request: Request, layer: Layer, memory: Memory) -> None:
    """The film at the pressure around, in the gap in which the asperities bear the load, into the state."""
    state, time, g = memory.step[0].state, memory.now[0].time, memory.gap[0]
    f = surface_at(memory.local, state[X], state[Y], time)
    g.xx, g.xy, g.yy = f.w_xx, f.w_xy, f.w_yy
    fill_gap_at_rest(layer, pull(f, state[V_X], state[V_Y], request.part).normal, state[CONTENTS:SOLVED], g)
    state[Z], memory.now[0].verdict = g.z, g.verdict


@inlined
def _rest(surface: Surface, request: Request, layer: Layer, memory: Memory) -> int:
    """The part rests for a step, at most to where it leaves: SLIPS, DETACHES or NO_EVENT."""
    now: Now = memory.now[0]
    step, g = memory.step[0], memory.gap[0]
    fill_rate(request, layer, memory, step.state, now.time, now.mode, g, step.rate)
    if leaves(request, g) > 0.0:
        return _event(surface, request, memory, g)
    energy = energy_now(request, memory)
    event = _advance(surface, request, layer, memory)
    # A part at rest dissipates nothing: all that its energy gains is the surface's work.
    step.state[WORK] += energy_now(request, memory) - energy
    return event


@inlined
def _slide(surface: Surface, request: Request, layer: Layer, memory: Memory) -> int:
    """The part slides or flies for a step, at most to its stop or to the end of contact or flight; the event there."""
    now: Now = memory.now[0]
    step, g = memory.step[0], memory.gap[0]
    fill_rate(request, layer, memory, step.state, now.time, now.mode, g, step.rate)
    if now.mode == Mode.SLIDING and g.slowing > 0.0:
        until = g.speed / g.slowing
        if until < STOPPED[0] * request.stroke_time and g.speed * until < STOPPED[1] * request.tolerance:
            stop = _stop_ahead(request, layer, memory)
            if stop.time <= min(now.span_end - now.time, STOPPED[0] * request.stroke_time):
                return _stop(request, layer, memory, stop)
        now.h = min(now.h, BEFORE_STOP * until)
    return _advance(surface, request, layer, memory)


@inlined
def _stop_ahead(request: Request, layer: Layer, memory: Memory) -> Stop:
    """The stop of a sliding part with forces as they are."""
    part, state, g = request.part, memory.step[0].state, memory.gap[0]
    f = surface_at(memory.local, state[X], state[Y], memory.now[0].time)
    a = rest_pull(f, part)
    limit = (g.limit + 0.5 * drag_of(layer, g.width) * g.speed) / part.mass
    a = RestPull(a.demand, limit, a.d_x, a.d_y, a.n_x, a.n_y, a.load)
    return frozen_stop(f, part, a, state[V_X], state[V_Y], STOPPED[1] * request.tolerance)


@inlined
def _stop(request: Request, layer: Layer, memory: Memory, stop: Stop) -> int:
    """Move a part to its stop."""
    now: Now = memory.now[0]
    step, state, g = memory.step[0], memory.step[0].state, memory.gap[0]
    before, lost = energy_now(request, memory), request.part.mass * stop.loss
    state[X], state[Y] = state[X] + stop.x, state[Y] + stop.y
    state[V_X] = state[V_Y] = 0.0
    for i in range(CONTENTS, SOLVED):
        state[i] += stop.time * step.rate[i]
    state[HEAT] += stop.time * step.rate[HEAT]
    now.time += stop.time
    now.mode, now.h, step.before = Mode.RESTING, FIRST_STEP * request.stroke_time, 0.0
    state[LOSS] += lost
    state[WORK] += energy_now(request, memory) - before + lost
    settle(request, layer, memory, state, now.time, g)
    state[PUMPED] += stored(layer, g) - state[STORED] + stop.time * step.rate[HEAT]
    return EventKind.REVERSES.value if leaves(request, g) > CLOSE else EventKind.STOPS.value


@device_no_arrays
def _advance(surface: Surface, request: Request, layer: Layer, memory: Memory) -> int:
    """One step of about now.h [s] from memory.step[0].state, the rate of which is known; the event at its end."""
    now: Now = memory.now[0]
    step, last = memory.step[0], memory.gap[STAGES]
    begin_step(surface, request, layer, memory)
    remaining = now.span_end - now.time
    now.h = remaining if now.h >= 0.9 * remaining else now.h
    while True:
        if now.h < MIN_STEP * request.stroke_time and now.h < remaining:
            return _cross_fold(surface, request, layer, memory)
        if not attempt(surface, request, layer, memory, now.h):
            now.h *= 0.4
            continue
        error = error_of(surface, request, layer, memory, now.h) / request.tolerance
        if not error <= 1.0:
            now.h *= max(0.2, SAFETY * error ** (-1 / ORDER)) if error > 1.0 else 0.2
            continue
        ends, early = False, False
        if now.mode == Mode.RESTING:
            share = _leaves_at(request, layer, memory, now.h)
            if share < 1.0:
                now.h *= share
                if not attempt(surface, request, layer, memory, now.h):
                    now.h *= 0.4
                    continue
            ends = share <= 1.0
        else:
            ends = _is_over(surface, memory, STAGES)
            for k in range(1, STAGES):
                early = early or _is_over(surface, memory, k)
            if early and not ends:
                now.h *= 0.5
                continue
            if ends:
                _locate_end(surface, request, layer, memory)
        break
    h = now.h
    take_step(memory, h)
    now.time = now.span_end if h == remaining else now.time + h
    now.h = h * min(MAX_GROWTH, SAFETY * max(error, 1e-12) ** (-1 / ORDER))
    step.state[STORED] = stored(layer, last)
    return _event(surface, request, memory, last) if ends else NO_EVENT


@inlined
def _cross_fold(surface: Surface, request: Request, layer: Layer, memory: Memory) -> int:
    """Where the gap jumps, as the film is softer than the asperities pull: the part is beyond it; else work ends."""
    now: Now = memory.now[0]
    state, g, before = memory.step[0].state, memory.gap[STAGES], memory.gap[0].z
    settle(request, layer, memory, state, now.time + now.h, g)
    while abs(g.z - before) < FOLD[1]:
        now.h *= 4.0
        if now.h > ACROSS * request.stroke_time:
            now.verdict = Verdict.WORK_LIMIT
            return NO_EVENT
        settle(request, layer, memory, state, now.time + now.h, g)
    now.time += now.h
    state[Z] = g.z
    state[PUMPED] += stored(layer, g) - state[STORED]
    now.h, memory.step[0].before = 1e-4 * request.stroke_time, 0.0
    return _event(surface, request, memory, g) if is_off(g) != (now.mode == Mode.FLYING) else NO_EVENT


@device_no_arrays
def _is_over(surface: Surface, memory: Memory, k: int) -> bool:
    """Whether contact, or flight, has ended at the k-th stage, from 1."""
    g, stage = memory.gap[k], memory.step[0].stages[k - 1]
    ended = g.verdict != Verdict.GOES_ON or is_off(g) != (memory.now[0].mode == Mode.FLYING)
    return ended or gap_at(surface, memory.local, stage[X], stage[Y]) < 0.0


@inlined
def _locate_end(surface: Surface, request: Request, layer: Layer, memory: Memory) -> None:
    """Shorten the step tried to where contact or flight ends, just beyond it."""
    now: Now = memory.now[0]
    low, high = 0.0, now.h
    while high - low > 1e-15 * (now.time + high) and high - low > 1e-13 * now.h:
        middle = 0.5 * (low + high)
        if attempt(surface, request, layer, memory, middle) and _is_over(surface, memory, STAGES):
            high = middle
        else:
            low = middle
    attempt(surface, request, layer, memory, high)
    now.h = high


@device_no_arrays
def _event(surface: Surface, request: Request, memory: Memory, g: Gap) -> int:
    """What happens where rest, contact or flight end, with the gap there."""
    now: Now = memory.now[0]
    state = memory.step[0].state
    if gap_at(surface, memory.local, state[X], state[Y]) < 0.0:
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
def _look(request: Request, layer: Layer, memory: Memory, share: float, h: float) -> float:
    """`leaves` a share of the step tried after its begin."""
    fill_within(memory, share, h, memory.step[0].probe)
    settle(request, layer, memory, memory.step[0].probe, memory.now[0].time + share * h, memory.gap[STAGES + 1])
    return leaves(request, memory.gap[STAGES + 1])


@inlined
def _leaves_at(request: Request, layer: Layer, memory: Memory, h: float) -> float:
    """The share of the step tried after which a part at rest leaves, just beyond it: secants (Illinois), halving."""
    low, below, high, above = 0.0, leaves(request, memory.gap[0]), 0.0, 0.0
    for k in range(1, LOOKS + 1):
        high = k / LOOKS
        above = _look(request, layer, memory, high, h)
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
        value, width = _look(request, layer, memory, middle, h), high - low
        if value > 0.0:
            high, above, below = middle, value, 0.5 * below
        else:
            low, below, above = middle, value, 0.5 * above
        secant = high - low < 0.5 * width
    return high


@inlined
def _begin_slip(surface: Surface, request: Request, layer: Layer, memory: Memory) -> bool:
    """Move a resting part that friction no longer holds over the first moment of its slip; False: it stays after all.

    Over that moment d the slip's rate goes from r_0 to r_1 along nearly the same e: it comes to (r_0 + r_1) d/2.
    """
    now: Now = memory.now[0]
    step, state, g = memory.step[0], memory.step[0].state, memory.gap[0]
    before = energy_now(request, memory)
    first = max(_slip_rate(request, memory, g), 0.0)
    fill_rate(request, layer, memory, state, now.time, now.mode, g, step.rate)
    begin_step(surface, request, layer, memory)
    moment = min(FIRST * request.stroke_time, 0.1 * (now.span_end - now.time))
    while not attempt(surface, request, layer, memory, moment):
        moment *= 0.4
        if moment < MIN_STEP * request.stroke_time:
            now.verdict = Verdict.WORK_LIMIT
            return False
    take_step(memory, moment)
    now.time += moment
    settle(request, layer, memory, state, now.time, g)
    rate = _slip_rate(request, memory, g)
    speed, way = 0.5 * (first + rate) * moment, (2 * first + rate) * moment * moment / 6
    if not (rate > 0.0 and speed > 0.0):
        state[WORK] += energy_now(request, memory) - before
        return False
    e_x, e_y = step.off[X], step.off[Y]
    state[X], state[Y] = state[X] + way * e_x, state[Y] + way * e_y
    state[V_X], state[V_Y] = speed * e_x, speed * e_y
    for i, along in ((X, e_x), (Y, e_y)):
        for k in range(STAGES):
            step.lead[k, i] = step.lead[k, V_X + i] = 0.0
        step.lead[0, i], step.lead[0, V_X + i] = speed * along, rate * along
        step.lead[1, i], step.lead[1, V_X + i] = rate * along, (rate - first) / moment * along
    lost = g.limit * way
    state[LOSS] += lost
    state[WORK] += energy_now(request, memory) - before + lost
    now.mode, now.h = Mode.SLIDING, LONGER * moment
    return True


@device_no_arrays
def _slip_rate(request: Request, memory: Memory, g: Gap) -> float:
    """r [m/s^2] by which a part at rest begins to slip, as in `mechanics.breakaway`; (x, y) over it into step.off."""
    part, step = request.part, memory.step[0]
    f = surface_at(memory.local, step.state[X], step.state[Y], memory.now[0].time)
    p = pull(f, 0.0, 0.0, part)
    a_x, a_y = at_contact(f, part, p.x, p.y)
    rate, e_x, e_y = first_slip(f, mobility(f, part), a_x, a_y, g.limit / part.mass)
    step.off[X], step.off[Y] = over_plane(f, part, e_x, e_y)
    return rate
