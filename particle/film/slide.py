"""Sliding on a film of air: how a part begins to slide, its steps, and its stop."""

from __future__ import annotations

from particle.body import STAGES
from particle.events import FIRST_STEP, Request
from particle.events.mechanics import Now, RestPull, at_contact, first_slip, mobility, over_plane, pull, rest_pull
from particle.events.sliding import Stop, frozen_stop
from particle.film.advance import MIN_STEP, advance
from particle.film.film import Layer
from particle.film.gap import Gap, stored
from particle.film.memory import CONTENTS, HEAT, LOSS, PUMPED, SOLVED, STORED, V_X, V_Y, WORK, Memory, X, Y
from particle.film.state import drag_of, energy_now, fill_rate, leaves, settle
from particle.film.step import LONGER, attempt, begin_step, take_step
from particle.jit import device_no_arrays, inlined
from particle.modes import EventKind, Mode, Verdict
from particle.surface import Surface, surface_at

FIRST = 1e-3  # of a stroke: the first moment of a slip, over which its acceleration is linear in time
CLOSE = 1e-9  # of the limit: how close a slip that was located begins to it
BEFORE_STOP = 0.85  # of the time to a stop: the longest step
STOPPED = 2e-5, 1e-2  # of a stroke, of the tolerance: how close a stop's time and place must be


@inlined
def slide(surface: Surface, request: Request, layer: Layer, memory: Memory) -> int:
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
    return advance(surface, request, layer, memory)


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


@inlined
def begin_slip(surface: Surface, request: Request, layer: Layer, memory: Memory) -> bool:
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
