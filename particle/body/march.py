"""The integrator of a part with a face: rest, slips, stops and the end of contact, each located.

Between two breakpoints of the drives the surface is one polynomial in time in each cell under the face. A resting part
stays until `rest` locates when it leaves; it starts by `begin_slip`, slides by steps of `collocation`, and stops with
forces as they are once its stop is close.
"""

from __future__ import annotations

import math

from particle.body.averages import enter_all
from particle.body.balance import energy_of
from particle.body.face import Face
from particle.body.memory import HEADING, SPIN, STATE, V_X, V_Y, WORK, Memory, X, Y
from particle.body.rest import leaves_rest
from particle.body.slide import begin_slip, slide
from particle.body.state import base_at, contact_margin, end_reason, fill_row, rim_margin, settle
from particle.events import PathRecord, Request, last_row, note, with_room, write
from particle.events.mechanics import Counts, Now, Part
from particle.jit import device_no_arrays, inlined, jit
from particle.modes import END_EVENTS, NO_EVENT, EventKind, Mode, Verdict
from particle.surface import UNBUILT, Surface

MIN_JUMP = 1e-6  # of the surface's size in a stroke: a jump of its velocity
EVALUATIONS_PER_SPAN, MIN_EVALUATIONS = 20_000, 200_000


@jit
def march_body(surface: Surface, request: Request, face: Face, memory: Memory, record: PathRecord) -> PathRecord:
    """The path from one request, into `record`; memory.now says how it ended, memory.counts what it took.

    Where a cell is lacking, at `missing_place`, it ends, and must begin anew when there is one.
    """
    now: Now = memory.now[0]
    counts: Counts = memory.counts[0]
    state, part = memory.step[0].state, request.part
    for k in range(STATE):
        state[k] = request.start[k]
    memory.step[0].lead[:] = 0.0
    memory.step[0].error = math.inf
    memory.balance[0].stands = 0
    now.time = now.span_end = request.begin
    now.mode, now.h, now.verdict = request.mode, request.first_step, Verdict.GOES_ON
    # A part that is about to slip, as at a row of its path, slips without a further event; so does one that reverses.
    slips = now.mode == Mode.SLIDING and state[V_X] == 0.0 and state[V_Y] == 0.0 and state[SPIN] == 0.0
    if slips:
        now.mode = Mode.RESTING
    while now.verdict == Verdict.GOES_ON and now.time < request.until:
        record = with_room(record)
        if memory.stop[0] != 0:
            now.verdict = Verdict.INTERRUPTED
            break
        new_span = now.time >= now.span_end
        crosses = request.jumps and new_span and counts.spans > 0
        if crosses:
            keep_carried(part, face, memory, now.time)
        bridged = request.bridged if now.mode == Mode.SLIDING else (0.0, 0.0)
        x, y, heading = state[X], state[Y], state[HEADING]
        cell, end = enter_all(
            surface, memory.local, memory.under, face, x, y, heading, now.time, request.duration, bridged
        )
        if cell < 0:
            now.verdict = Verdict.LACKS_CELL if cell == UNBUILT else Verdict.LEFT_PLATE
            break
        if rim_margin(surface, face, state) < -1e-12 * surface.size:
            now.verdict = Verdict.LEFT_PLATE
            break
        now.span_end = min(end, request.until)
        if now.span_end <= now.time:
            now.verdict = Verdict.WORK_LIMIT
            break
        if crosses and jumps(surface, request, face, memory):
            now.verdict = Verdict.JUMPS
            break
        if new_span:
            counts.spans += 1
            now.h = max(now.h, 1e-4 * request.stroke_time)
        if record.lengths[0].rows == 0:
            fill_row(part, face, memory, now.mode, memory.row[0])
            write(record, memory.row[0])
        event = NO_EVENT
        if now.mode == Mode.RESTING:
            if _rest(surface, request, face, memory) == EventKind.SLIPS:
                fill_row(part, face, memory, Mode.SLIDING, memory.row[0])
                if begin_slip(request, face, memory):
                    write(record, memory.row[0])
                    if not slips:
                        note(record, EventKind.SLIPS, memory.row[0])
            slips = False
        else:
            event = slide(surface, request, face, memory)
            slips = event == EventKind.REVERSES
        fill_row(part, face, memory, now.mode, memory.row[0])
        if event != NO_EVENT:
            note(record, event, memory.row[0])
        write(record, memory.row[0])
        if counts.evaluations > MIN_EVALUATIONS + EVALUATIONS_PER_SPAN * counts.spans:
            now.verdict = Verdict.WORK_LIMIT
    verdict = now.verdict
    if verdict >= Verdict.DETACHED and verdict <= Verdict.TIPPED:
        memory.row[0] = last_row(record)
        note(record, END_EVENTS + verdict, memory.row[0])
    return record


@device_no_arrays
def keep_carried(part: Part, face: Face, memory: Memory, time: float) -> None:
    """The twist by which the surface carries a face as a span ends into memory.step[0].carried."""
    settle(part, face, memory, memory.step[0].state, time)
    for k in range(6):
        memory.step[0].carried[k] = memory.balance[0].carried[k]


@device_no_arrays
def jumps(surface: Surface, request: Request, face: Face, memory: Memory) -> bool:
    """Whether the surface's velocity under the face jumps from memory.step[0].carried as a span begins."""
    settle(request.part, face, memory, memory.step[0].state, memory.now[0].time)
    largest = 0.0
    for k in range(6):
        unit = face.reach if k == 2 or k > 3 else 1.0
        largest = max(largest, unit * abs(memory.balance[0].carried[k] - memory.step[0].carried[k]))
    return largest > MIN_JUMP * surface.size / request.stroke_time


@inlined
def _rest(surface: Surface, request: Request, face: Face, memory: Memory) -> int:
    """The part stays until it leaves or the span ends; SLIPS or NO_EVENT."""
    now: Now = memory.now[0]
    part, state = request.part, memory.step[0].state
    settle(part, face, memory, state, now.time)
    kinetic, potential = energy_of(part, face, base_at(memory.local, now.time), 0.0, 0.0, 0.0, memory.balance[0])
    leaves = leaves_rest(request, face, memory, now.span_end)
    now.time = min(leaves, now.span_end)
    settle(part, face, memory, state, now.time)
    # A part at rest dissipates nothing: all that its energy gains is the surface's work.
    state[WORK] -= kinetic + potential
    kinetic, potential = energy_of(part, face, base_at(memory.local, now.time), 0.0, 0.0, 0.0, memory.balance[0])
    state[WORK] += kinetic + potential
    if leaves > now.span_end:
        return NO_EVENT
    if contact_margin(part, face, memory, True) < 0.0:
        now.verdict = end_reason(surface, part, face, memory, state)
        return NO_EVENT
    return EventKind.SLIPS.value
