"""The integrator: sticks, slips, stops, flights and ends are located, never stepped over.

Between two breakpoints of the drives the surface is one polynomial in time. A resting part stays until `stick` locates
when it leaves; it starts on the slow manifold (`breakaway`), slides by adaptive Runge-Kutta steps and comes to rest in
closed form (`stop`). A step that ends beyond the rim, below pull-off or above the largest load is cut back to that
moment. A part that comes off may be followed (`flight`) to where it lands.
"""

from __future__ import annotations

import math

from particle.events.flight import MIN_JUMP, cross_jump, fly, take_off, velocity_jump
from particle.events.mechanics import Counts, Motion, Now, energy_at_rest, grip_at, margin, pull, rest_pull, slip_speed
from particle.events.memory import Memory
from particle.events.record import PathRecord, Row, fill_row, has_room, last_row, note, with_room, write
from particle.events.request import Request
from particle.events.rest import leaves_rest
from particle.events.sliding import bridge, first_mode, slide
from particle.events.tableau import Pairs
from particle.jit import device, device_no_arrays, inlined, jit
from particle.modes import END_EVENTS, NO_EVENT, EventKind, Mode, Verdict
from particle.surface import UNBUILT, Surface, enter, gap_at, surface_at

FIRST_STEP = 0.02  # of a stroke
MIN_SPAN_STEP = 1e-4  # of a stroke: the first step of a span
ROUNDING = 1e-9  # of a path's typical force

EVALUATIONS_PER_SPAN, MIN_EVALUATIONS = 2_000, 20_000
LONG, EVALUATIONS_PER_STEP = 1e-5, 40  # of the run: steps that are no sign of trouble, however many there are


@jit
def march(surface: Surface, request: Request, pairs: Pairs, memory: Memory, record: PathRecord) -> PathRecord:
    """The path from one request, into `record`; memory.now says how it ended, memory.counts what it took.

    Where a cell is lacking, at `missing_place`, it ends, and must begin anew when there is one.
    """
    now: Now = memory.now[0]
    _begin(request, memory)
    while now.verdict == Verdict.GOES_ON and now.time < request.until:
        if request.only_rests and now.mode != Mode.RESTING:
            break
        record = with_room(record)
        if _slides(now.mode):
            _slide_on(surface, request, pairs, memory, record)
            continue
        _enter(surface, request, memory, record)
        before = now.mode
        if now.verdict != Verdict.GOES_ON or _slides(before):  # a jump made it slide
            continue
        event = _rest(request, memory) if before == Mode.RESTING else _fly(surface, request, memory)
        _note(request, memory, record, before, event)
    _note_end(memory, record)
    return record


@inlined
def _begin(request: Request, memory: Memory) -> None:
    """The part at its start."""
    now: Now = memory.now[0]
    for k in range(len(request.start)):
        memory.motion_numbers[0, k] = request.start[k]
    now.time = now.span_end = request.begin
    now.mode, now.h, now.verdict = request.mode, request.first_step, Verdict.GOES_ON


@device_no_arrays
def _slides(mode: int) -> bool:
    """Whether a part slides, on the slow manifold or off it."""
    return mode == Mode.SLIDING or mode == Mode.MANIFOLD


@device_no_arrays
def _slide_on(surface: Surface, request: Request, pairs: Pairs, memory: Memory, record: PathRecord) -> None:
    """Slides on while there is room for a row. `march`, which makes arrays, counts references to all it touches."""
    now: Now = memory.now[0]
    while has_room(record) and now.verdict == Verdict.GOES_ON and now.time < request.until and _slides(now.mode):
        _enter(surface, request, memory, record)
        before = now.mode
        if now.verdict == Verdict.GOES_ON and _slides(before):
            _note(request, memory, record, before, slide(surface, request, pairs, memory))


@device_no_arrays
def _enter(surface: Surface, request: Request, memory: Memory, record: PathRecord) -> None:
    """Prepares the surface around the part, in the next span where one has ended."""
    now: Now = memory.now[0]
    counts: Counts = memory.counts[0]
    motion: Motion = memory.motion[0]
    local, row = memory.local, memory.row[0]
    if memory.stop[0] != 0:
        now.verdict = Verdict.INTERRUPTED
        return
    if now.time >= now.span_end:
        now.h = max(now.h, MIN_SPAN_STEP * request.stroke_time)
        if request.jumps and counts.spans > 0:
            _cross_breakpoint(surface, request, memory, record)
            if now.verdict != Verdict.GOES_ON:
                return
        counts.spans += 1
    bridge(local, request, now.mode)
    cell = enter(surface, local, motion.x, motion.y, now.time, request.duration)
    if cell == UNBUILT:
        now.verdict = Verdict.LACKS_CELL
    elif cell < 0 or gap_at(surface, local, motion.x, motion.y) < 0.0:
        now.verdict = Verdict.LEFT_PLATE
    else:
        now.span_end = min(local.frame[0].end, request.until)
        if now.span_end <= now.time:
            now.verdict = Verdict.WORK_LIMIT
        elif record.lengths[0].rows == 0:
            if now.mode == Mode.MANIFOLD:
                f = surface_at(local, motion.x, motion.y, now.time)
                motion.v_x, motion.v_y = slip_speed(f, request.part, motion.v_x, motion.v_y), 0.0
            fill_row(local, request.part, now.mode, now.time, motion, row)
            write(record, row)


@inlined
def _cross_breakpoint(surface: Surface, request: Request, memory: Memory, record: PathRecord) -> None:
    """Goes on to the next span, where the surface's velocity may jump.

    It stays in its cell for that, entered by its centre: from one cell to the next the velocity differs by the error of
    the fits.
    """
    now: Now = memory.now[0]
    motion: Motion = memory.motion[0]
    row: Row = memory.row[0]
    local, before = memory.local, now.mode
    fill_row(local, request.part, before, now.time, motion, row)
    old = surface_at(local, motion.x, motion.y, now.time)
    enter(surface, local, local.frame[0].x, local.frame[0].y, now.time, request.duration)
    new = surface_at(local, motion.x, motion.y, now.time)
    slack = MIN_JUMP * surface.size / request.stroke_time
    if velocity_jump(old, new, request.part) <= slack:
        return
    if before == Mode.MANIFOLD:
        motion.v_x, motion.v_y = row.v_x, row.v_y
    now.mode = cross_jump(old, new, request.part, before, slack, motion)
    fill_row(local, request.part, now.mode, now.time, motion, row)
    if now.mode == Mode.FLYING and not request.flies:
        now.verdict = Verdict.DETACHED
    elif now.mode == Mode.FLYING and before != Mode.FLYING:
        note(record, EventKind.DETACHES, row)
    elif now.mode == Mode.RESTING and before != Mode.RESTING:
        note(record, EventKind.STOPS, row)
    elif before == Mode.RESTING and now.mode != Mode.RESTING:
        note(record, EventKind.SLIPS, row)
    write(record, row)


@device
def _rest(request: Request, memory: Memory) -> int:
    """The part stays until it leaves or the span ends; SLIPS or NO_EVENT."""
    now: Now = memory.now[0]
    counts: Counts = memory.counts[0]
    motion: Motion = memory.motion[0]
    local, part, law = memory.local, request.part, request.part.law
    energy = energy_at_rest(local, part, now.time, motion)
    leaves = leaves_rest(local, part, memory.rest, motion.x, motion.y, now.time, now.span_end)
    now.time = min(leaves, now.span_end)
    # A part at rest dissipates nothing: all that its energy gains is the surface's work.
    motion.work += energy_at_rest(local, part, now.time, motion) - energy
    counts.evaluations += 3
    if leaves == math.inf:
        return NO_EVENT
    a = rest_pull(surface_at(local, motion.x, motion.y, now.time), part)
    above, below = a.load + law.pull_off, law.largest_load - a.load
    # Rounding must not make a slip of what is the end of contact.
    ends = min(above, below) < ROUNDING * request.force
    if margin(local, part, a.load, 0.0) < 0.0 or (ends and a.demand <= law.static_ratio * a.limit):
        now.verdict = Verdict.DETACHED if above < below else Verdict.OVERLOADED
        return NO_EVENT
    now.mode, now.h = first_mode(part, a.load), FIRST_STEP * request.stroke_time
    return EventKind.SLIPS.value


@device
def _fly(surface: Surface, request: Request, memory: Memory) -> int:
    """The part flies one step, at most to where it lands; LANDS or NO_EVENT."""
    now: Now = memory.now[0]
    motion: Motion = memory.motion[0]
    event = fly(surface, request, memory)
    if event != NO_EVENT:
        f = surface_at(memory.local, motion.x, motion.y, now.time)
        # A surface that falls away as it is met is not held on to.
        load = pull(f, motion.v_x, motion.v_y, request.part).normal
        if grip_at(f, request.part, load).load < -request.part.law.pull_off:
            now.mode = Mode.FLYING
    return event


@device_no_arrays
def _note(request: Request, memory: Memory, record: PathRecord, before: int, event: int) -> None:
    """Records what has happened, and where the part is; `before`: the mode that it was in."""
    now: Now = memory.now[0]
    counts: Counts = memory.counts[0]
    motion: Motion = memory.motion[0]
    row: Row = memory.row[0]
    fill_row(memory.local, request.part, now.mode, now.time, motion, row)
    if now.verdict == Verdict.DETACHED and request.flies:
        now.verdict, event = Verdict.GOES_ON, EventKind.DETACHES.value
        motion.v_x, motion.v_y = row.v_x, row.v_y
        take_off(memory.local, now.time, motion)
        now.mode, now.h = Mode.FLYING, FIRST_STEP * request.stroke_time
    if event != NO_EVENT:
        note(record, event, row)
    if event == EventKind.LANDS and now.mode == Mode.FLYING:
        note(record, EventKind.DETACHES, row)
    if now.mode != before:
        fill_row(memory.local, request.part, now.mode, now.time, motion, row)
    counts.long_steps += row.time - last_row(record).time > LONG * request.duration
    write(record, row)
    allowed = MIN_EVALUATIONS + EVALUATIONS_PER_SPAN * counts.spans + EVALUATIONS_PER_STEP * counts.long_steps
    if counts.evaluations > allowed:
        now.verdict = Verdict.WORK_LIMIT


@inlined
def _note_end(memory: Memory, record: PathRecord) -> None:
    """Records why the path ended, where that is an event."""
    verdict = memory.now[0].verdict
    if verdict == Verdict.DETACHED or verdict == Verdict.LEFT_PLATE or verdict == Verdict.OVERLOADED:
        memory.row[0] = last_row(record)
        note(record, END_EVENTS + verdict, memory.row[0])
