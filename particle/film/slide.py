"""Sliding on a film of air: how a part begins to slide, its steps, and its stop."""

from __future__ import annotations

from particle.body import STAGES, Face
from particle.events import FIRST_STEP, Request
from particle.events.mechanics import Now, RestPull, at_contact, first_slip, mobility, over_plane, pull, rest_pull
from particle.events.sliding import Stop, frozen_stop
from particle.film.advance import MIN_STEP, advance
from particle.film.face import drag_of, face_lost, face_slip_rate
from particle.film.film import Layer
from particle.film.gap import Gap, stored
from particle.film.memory import CONTENTS, HEADING, HEAT, LOSS, PUMPED, SPIN, STORED, V_X, V_Y, WORK, Memory, X, Y
from particle.film.state import energy_now, fill_rate, leaves, settle
from particle.film.step import LONGER, attempt, begin_step, take_step
from particle.jit import device_no_arrays, inlined
from particle.modes import EventKind, Mode, Verdict
from particle.surface import Surface, surface_at

FIRST = 1e-3  # of a stroke: the first moment of a slip, over which its acceleration is linear in time
CLOSE = 1e-9  # of the limit: how close a slip that was located begins to it
BEFORE_STOP = 0.85  # of the time to a stop: the longest step
STOPPED = 2e-5, 1e-2  # of a stroke, of the tolerance: how close a stop's time and place must be
FACE_STOPPED = 1e-7, 1e-3  # the same of a face
PLACES, SPEEDS = (X, Y, HEADING), (V_X, V_Y, SPIN)


@inlined
def slide(surface: Surface, request: Request, layer: Layer, face: Face | tuple[()], memory: Memory) -> int:
    """The part slides or flies for a step, at most to its stop or to the end of contact or flight; the event there."""
    now: Now = memory.now[0]
    step, g = memory.step[0], memory.gap[0]
    fill_rate(request, layer, face, memory, step.state, now.time, now.mode, g, step.rate)
    if now.mode == Mode.SLIDING and g.slowing > 0.0:
        until = g.speed / g.slowing
        close = stopped_of(face)
        if until < close[0] * request.stroke_time and g.speed * until < close[1] * request.tolerance:
            stop = _stop_ahead(request, layer, face, memory)
            if stop.time <= min(now.span_end - now.time, STOPPED[0] * request.stroke_time):
                return _stop(request, layer, face, memory, stop)
        now.h = min(now.h, BEFORE_STOP * until)
    return advance(surface, request, layer, face, memory)


@device_no_arrays
def stopped_of(face: Face | tuple[()]) -> tuple[float, float]:
    """How close a stop must be."""
    if len(face) == 0:
        return STOPPED
    return FACE_STOPPED


@device_no_arrays
def _stop_ahead(request: Request, layer: Layer, face: Face | tuple[()], memory: Memory) -> Stop:
    """The stop of a sliding part with forces as they are."""
    if len(face) == 0:
        return _point_stop(request, layer, memory)
    state, g = memory.step[0].state, memory.gap[0]
    time = g.speed / g.slowing
    lost = 0.5 * time * memory.step[0].rate[LOSS] / request.part.mass
    return Stop(time, 0.5 * time * state[V_X], 0.5 * time * state[V_Y], False, 0.0, 0.0, lost, 0.0)


@device_no_arrays
def _point_stop(request: Request, layer: Layer, memory: Memory) -> Stop:
    """The same of a point."""
    part, state, g = request.part, memory.step[0].state, memory.gap[0]
    f = surface_at(memory.local, state[X], state[Y], memory.now[0].time)
    a = rest_pull(f, part)
    limit = (g.limit + 0.5 * drag_of(layer, g.width) * g.speed) / part.mass
    a = RestPull(a.demand, limit, a.d_x, a.d_y, a.n_x, a.n_y, a.load)
    return frozen_stop(f, part, a, state[V_X], state[V_Y], STOPPED[1] * request.tolerance)


@inlined
def _stop(request: Request, layer: Layer, face: Face | tuple[()], memory: Memory, stop: Stop) -> int:
    """Move a part to its stop."""
    now: Now = memory.now[0]
    step, state, g = memory.step[0], memory.step[0].state, memory.gap[0]
    before, lost = energy_now(request, face, memory), request.part.mass * stop.loss
    state[X], state[Y] = state[X] + stop.x, state[Y] + stop.y
    state[HEADING] += 0.5 * stop.time * state[SPIN]
    state[V_X] = state[V_Y] = state[SPIN] = 0.0
    for i in range(CONTENTS, HEADING):
        state[i] += stop.time * step.rate[i]
    state[HEAT] += stop.time * step.rate[HEAT]
    now.time += stop.time
    now.mode, now.h, step.before = Mode.RESTING, FIRST_STEP * request.stroke_time, 0.0
    state[LOSS] += lost
    state[WORK] += energy_now(request, face, memory) - before + lost
    settle(request, layer, face, memory, state, now.time, g)
    state[PUMPED] += stored(layer, g) - state[STORED] + stop.time * step.rate[HEAT]
    return EventKind.REVERSES.value if leaves(request, g) > CLOSE else EventKind.STOPS.value


@inlined
def begin_slip(surface: Surface, request: Request, layer: Layer, face: Face | tuple[()], memory: Memory) -> bool:
    """Move a resting part that friction no longer holds over the first moment of its slip; False: it stays after all.

    Over that moment d the slip's rate goes from r_0 to r_1 along nearly the same e: it comes to (r_0 + r_1) d/2.
    """
    now: Now = memory.now[0]
    step, state, g = memory.step[0], memory.step[0].state, memory.gap[0]
    before = energy_now(request, face, memory)
    first = max(_slip_rate(request, face, memory, g, True), 0.0)
    fill_rate(request, layer, face, memory, state, now.time, now.mode, g, step.rate)
    begin_step(surface, request, layer, face, memory)
    moment = min(FIRST * request.stroke_time, 0.1 * (now.span_end - now.time))
    while not attempt(surface, request, layer, face, memory, moment):
        moment *= 0.4
        if moment < MIN_STEP * request.stroke_time:
            now.verdict = Verdict.WORK_LIMIT
            return False
    take_step(face, memory, moment)
    now.time += moment
    settle(request, layer, face, memory, state, now.time, g)
    rate = _slip_rate(request, face, memory, g, False)
    speed, way = 0.5 * (first + rate) * moment, (2 * first + rate) * moment * moment / 6
    if not (rate > 0.0 and speed > 0.0):
        state[WORK] += energy_now(request, face, memory) - before
        return False
    for n in range(3):
        i, v, along = PLACES[n], SPEEDS[n], step.off[n]
        state[i], state[v] = state[i] + way * along, speed * along
        for k in range(STAGES):
            step.lead[k, i] = step.lead[k, v] = 0.0
        step.lead[0, i], step.lead[0, v] = speed * along, rate * along
        step.lead[1, i], step.lead[1, v] = rate * along, (rate - first) / moment * along
    lost = _lost(request, layer, face, memory, g, way)
    state[LOSS] += lost
    state[WORK] += energy_now(request, face, memory) - before + lost
    now.mode, now.h = Mode.SLIDING, LONGER * moment
    return True


@device_no_arrays
def _lost(request: Request, layer: Layer, face: Face | tuple[()], memory: Memory, g: Gap, way: float) -> float:
    """What friction dissipates [J] over the first `way` [m] of a slip."""
    if len(face) == 0:
        return g.limit * way
    return face_lost(request, layer, face, memory, g) * way


@device_no_arrays
def _slip_rate(request: Request, face: Face | tuple[()], memory: Memory, g: Gap, first: bool) -> float:
    """r [m/s^2] by which a part at rest begins to slip; the rates of (x, y, heading) over it into step.off (3,).

    first: whether this is where it leaves its rest.
    """
    if len(face) == 0:
        return _point_slip_rate(request, memory, g)
    return face_slip_rate(request, face, memory, first)


@device_no_arrays
def _point_slip_rate(request: Request, memory: Memory, g: Gap) -> float:
    """The same of a point, as in `mechanics.breakaway`."""
    part, step = request.part, memory.step[0]
    f = surface_at(memory.local, step.state[X], step.state[Y], memory.now[0].time)
    p = pull(f, 0.0, 0.0, part)
    a_x, a_y = at_contact(f, part, p.x, p.y)
    rate, e_x, e_y = first_slip(f, mobility(f, part), a_x, a_y, g.limit / part.mass)
    step.off[0], step.off[1] = over_plane(f, part, e_x, e_y)
    step.off[2] = 0.0
    return rate
