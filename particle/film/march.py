"""The integrator of a part on a film of air: rest, slips, stops and the end of contact, each located.

Part and film are one system, at rest as well, where the contents alone move. A step of `step` ends where a resting part
leaves: that is looked for at moments of the step's polynomial, so it is located, not proven.
"""

from __future__ import annotations

import math

import numpy as np

from particle.events import PathRecord, Request, last_row, note, write
from particle.events.flight import MIN_JUMP, velocity_jump
from particle.events.mechanics import Counts, Now, pull
from particle.film.advance import rest
from particle.film.film import Layer
from particle.film.gap import fill_gap_at_rest, stored
from particle.film.memory import CONTENTS, PUMPED, SOLVED, STATE, STORED, V_X, V_Y, Memory, X, Y, Z
from particle.film.slide import begin_slip, slide
from particle.film.state import fill_row, settle
from particle.jit import device, inlined, jit
from particle.modes import END_EVENTS, NO_EVENT, EventKind, Mode, Verdict
from particle.surface import UNBUILT, Surface, allow_bridges, enter, gap_at, surface_at
from particle.types import FloatArray

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
            event = rest(surface, request, layer, memory)
            if event == EventKind.SLIPS:
                fill_row(request, layer, memory, Mode.SLIDING, memory.row[0])
                begins = begin_slip(surface, request, layer, memory)
                if begins:
                    record, states = _write(record, states, memory)
                if begins and not slips:
                    record = note(record, event, memory.row[0])
                event = NO_EVENT
            slips = False
        else:
            event = slide(surface, request, layer, memory)
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
