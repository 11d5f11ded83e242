"""The integrator of a part on a film of air: rest, slips, stops and the end of contact, each located.

Part and film are one system, at rest as well, where the contents alone move. A step of `step` ends where a resting part
leaves: that is looked for at moments of the step's polynomial, so it is located, not proven.
"""

from __future__ import annotations

import math

import numpy as np

from particle.body import Face, enter_all, jumps, keep_carried
from particle.events import PathRecord, Request, last_row, note, with_room, write
from particle.events.flight import MIN_JUMP, velocity_jump
from particle.events.mechanics import Counts, Now
from particle.film.advance import rest
from particle.film.film import Layer
from particle.film.gap import fill_gap_at_rest, stored
from particle.film.memory import CONTENTS, HEADING, PUMPED, SPIN, STATE, STORED, V_X, V_Y, Memory, X, Y, Z
from particle.film.slide import begin_slip, slide
from particle.film.state import fill_load, fill_row, rim_of, settle
from particle.jit import device_no_arrays, jit
from particle.modes import END_EVENTS, NO_EVENT, EventKind, Mode, Verdict
from particle.surface import UNBUILT, Surface, allow_bridges, enter, surface_at
from particle.types import FloatArray

EVALUATIONS_PER_SPAN, MIN_EVALUATIONS = 50_000, 500_000


@jit
def march_film(
    surface: Surface,
    request: Request,
    layer: Layer,
    face: Face | tuple[()],
    start: FloatArray,
    memory: Memory,
    record: PathRecord,
) -> tuple[PathRecord, FloatArray]:
    """The path from one request, into `record`, and the state at its rows (rows, STATE) or more.

    face: of a part that has one; of a point ().  start: (STATE,), with z = nan for a film at rest at the pressure
    around.  Where a cell is lacking the path ends, and must begin anew when there is one.
    """
    now: Now = memory.now[0]
    counts: Counts = memory.counts[0]
    step, g = memory.step[0], memory.gap[0]
    states = np.zeros((len(record.rows), STATE))
    for k in range(STATE):
        step.state[k] = start[k]
    step.before = 0.0
    now.time = now.span_end = request.begin
    now.mode, now.h, now.verdict = request.mode, request.first_step, Verdict.GOES_ON
    # A part that is about to slip, as at a row of its path, slips without a further event; so does one that reverses.
    slips = now.mode == Mode.SLIDING and step.state[V_X] == step.state[V_Y] == step.state[SPIN] == 0.0
    if slips:
        now.mode = Mode.RESTING
    while now.verdict == Verdict.GOES_ON and now.time < request.until:
        record = with_room(record)
        if len(states) < len(record.rows):
            longer = np.zeros((len(record.rows), STATE))
            longer[: len(states)] = states
            states = longer
        if memory.stop[0] != 0:
            now.verdict = Verdict.INTERRUPTED
            break
        new_span = now.time >= now.span_end
        if request.jumps and new_span and counts.spans > 0 and _jumps(surface, request, layer, face, memory):
            now.verdict = Verdict.JUMPS
            break
        cell, end = _enter(surface, request, face, memory)
        if cell == UNBUILT:
            now.verdict = Verdict.LACKS_CELL
            break
        if cell < 0 or rim_of(surface, face, memory, step.state) < 0.0:
            now.verdict = Verdict.LEFT_PLATE
            break
        now.span_end = min(end, request.until)
        if now.span_end <= now.time:
            now.verdict = Verdict.WORK_LIMIT
            break
        if record.lengths[0].rows == 0:
            if math.isnan(step.state[Z]):
                _fill_film_at_rest(request, layer, face, memory)
            if now.verdict == Verdict.GOES_ON:
                fill_row(request, layer, face, memory, now.mode, memory.row[0])
                now.verdict = g.verdict
            _write(record, states, memory, step.state)
            if now.verdict != Verdict.GOES_ON:
                break
        elif new_span:
            # Where forces jump the gap does, with the film's contents as they are.
            settle(request, layer, face, memory, step.state, now.time, g)
            step.state[Z] = g.z
            step.state[PUMPED] += stored(layer, g) - step.state[STORED]
            step.state[STORED] = stored(layer, g)
        if new_span:
            counts.spans += 1
            now.h = max(now.h, 1e-4 * request.stroke_time)
        if now.mode == Mode.RESTING:
            event = rest(surface, request, layer, face, memory)
            if event == EventKind.SLIPS:
                fill_row(request, layer, face, memory, Mode.SLIDING, memory.row[0])
                for k in range(STATE):
                    step.probe[k] = step.state[k]
                begins = begin_slip(surface, request, layer, face, memory)
                if begins:
                    _write(record, states, memory, step.probe)
                if begins and not slips:
                    note(record, event, memory.row[0])
                event = NO_EVENT
            slips = False
        else:
            event = slide(surface, request, layer, face, memory)
            slips = event == EventKind.REVERSES
        fill_row(request, layer, face, memory, now.mode, memory.row[0])
        if event != NO_EVENT:
            note(record, event, memory.row[0])
        _write(record, states, memory, step.state)
        if counts.evaluations > MIN_EVALUATIONS + EVALUATIONS_PER_SPAN * counts.spans:
            now.verdict = Verdict.WORK_LIMIT
    verdict = now.verdict
    if verdict >= Verdict.DETACHED and verdict <= Verdict.TIPPED and record.lengths[0].rows > 0:
        memory.row[0] = last_row(record)
        note(record, END_EVENTS + verdict, memory.row[0])
    return record, states


@device_no_arrays
def _write(record: PathRecord, states: FloatArray, memory: Memory, state: FloatArray) -> None:
    """Adds the row memory.row[0] to the record, and `state` to the states at its rows."""
    write(record, memory.row[0])
    place = record.lengths[0].rows - 1
    for k in range(STATE):
        states[place, k] = state[k]


@device_no_arrays
def _enter(surface: Surface, request: Request, face: Face | tuple[()], memory: Memory) -> tuple[int, float]:
    """Prepare for the part at the state's place from now on: a cell, NOWHERE or UNBUILT; when [s] the span ends."""
    state, time, local = memory.step[0].state, memory.now[0].time, memory.local
    if len(face) == 0:
        allow_bridges(local, request.bridged[0], request.bridged[1])
        cell = enter(surface, local, state[X], state[Y], time, request.duration)
        return cell, local.frame[0].end
    x, y, heading, under = state[X], state[Y], state[HEADING], memory.body.under
    return enter_all(surface, local, under, face, x, y, heading, time, request.duration, request.bridged)


@device_no_arrays
def _jumps(surface: Surface, request: Request, layer: Layer, face: Face | tuple[()], memory: Memory) -> bool:
    """Whether the surface's velocity under the part jumps as a span begins."""
    if len(face) == 0:
        return _jumps_under_point(surface, request, memory)
    settle(request, layer, face, memory, memory.step[0].state, memory.now[0].time, memory.gap[0])  # sets the pose
    keep_carried(request.part, face, memory.body, memory.now[0].time)
    _enter(surface, request, face, memory)
    return jumps(surface, request, face, memory.body)


@device_no_arrays
def _jumps_under_point(surface: Surface, request: Request, memory: Memory) -> bool:
    """The same of a point."""
    local, state, time = memory.local, memory.step[0].state, memory.now[0].time
    old = surface_at(local, state[X], state[Y], time)
    enter(surface, local, local.frame[0].x, local.frame[0].y, time, request.duration)
    new = surface_at(local, state[X], state[Y], time)
    return velocity_jump(old, new, request.part) > MIN_JUMP * surface.size / request.stroke_time


@device_no_arrays
def _fill_film_at_rest(request: Request, layer: Layer, face: Face | tuple[()], memory: Memory) -> None:
    """The film at the pressure around, in the gap in which the asperities bear the load, into the state."""
    state, time, g = memory.step[0].state, memory.now[0].time, memory.gap[0]
    fill_load(request, face, memory, state, time, g)
    fill_gap_at_rest(layer, g.normal, state[CONTENTS:HEADING], g)
    state[Z], memory.now[0].verdict = g.z, g.verdict
