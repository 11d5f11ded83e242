"""The integrator: sticks, slips, stops, flights and ends are located, never stepped over.

Between two kinks of the drives the surface is one polynomial in time. A resting part stays until `stick` finds that it
leaves; it starts on the slow manifold (`breakaway`), slides by adaptive Runge-Kutta steps and comes to rest in closed
form (`stop`). A step that ends beyond the rim, below pull-off or above the largest load is cut back to that moment. A
part that comes off may be followed (`flight`) to where it lands.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.events.breakaway import slope
from particle.events.equations import Part, energy_at_rest, margin, pull
from particle.events.flight import JUMP, fly, jolt, jump, take_off
from particle.events.record import (
    ENDS,
    FLYING,
    LANDS,
    MANIFOLD,
    RESTING,
    REVERSES,
    SLIDING,
    SLIPS,
    STOPS,
    TIME,
    V_X,
    V_Y,
    Record,
    new_record,
    note,
    row_of,
    write,
)
from particle.events.runge_kutta import Pairs, new_step
from particle.events.slide import (
    DETACHED,
    GOES_ON,
    INTERRUPTED,
    LACKS_CELL,
    LEFT_PLATE,
    OVERLOADED,
    TURNED,
    WORK_LIMIT,
    Request,
    bridge,
    slide,
)
from particle.events.stick import leaves_rest, new_rest
from particle.friction import friction_limit
from particle.jit import jit
from particle.surface import END, UNBUILT, enter, fields, gap_at, go_on, new_local, prepare

FloatArray = NDArray[np.float64]

START = 0.02  # of a stroke: the first step
ROUNDING = 1e-9  # of a path's typical force

EVALUATIONS_PER_SPAN, EVALUATIONS_AT_LEAST = 2_000, 20_000
LONG, EVALUATIONS_PER_STEP = 1e-5, 40  # of the run: steps that are no sign of trouble, however many there are


class Memory(NamedTuple):
    """Scratch memory of a path."""

    local: Any
    rest: Any
    step: Any
    stop: NDArray[np.int64]  # (1,) another thread sets it to 1 when nobody waits for the path any more


@jit
def new_memory(surface: Any, pairs: Pairs, stop: NDArray[np.int64]) -> Memory:
    """Scratch memory that fits the surface as far as its cells are built."""
    return Memory(new_local(surface), new_rest(), new_step(pairs), stop)


@jit
def forget(surface: Any, memory: Memory) -> None:
    """Make the scratch memory of another path, over a surface of the same measures, as good as new."""
    prepare(surface, memory.local)
    memory.step.seen[0] = math.nan


@jit
def march(surface: Any, request: Request, pairs: Pairs, memory: Memory) -> tuple[FloatArray, FloatArray, int, int]:
    """The path from one request: rows (n, COLUMNS), events (m, EVENT_COLUMNS), how it ended, evaluations.

    Where a cell is lacking, at memory.local.missing, it ends, and must begin anew when there is one.
    """
    part, end = request.part, request.duration
    local, rest, step, record = memory.local, memory.rest, memory.step, new_record()
    count = np.zeros(3, dtype=np.int64)  # evaluations, spans, long steps
    # x, y, v_x, v_y, work, dissipation, z, v_z; on the slow manifold u in place of v_x.
    state, time = np.zeros(8), 0.0
    state[:4] = request.start
    mode = RESTING if state[2] == 0.0 and state[3] == 0.0 else SLIDING
    span_end, h, verdict = 0.0, START * request.stroke_time, GOES_ON
    while verdict == GOES_ON:
        if memory.stop[0] != 0:
            verdict = INTERRUPTED
            break
        if time >= span_end:
            if time >= end:
                break
            h = max(h, 1e-4 * request.stroke_time)
            if request.bends or request.jumps:
                step.seen[0] = math.nan
            if request.jumps and count[1] > 0:
                before, row = mode, row_of(local, part, mode, time, state)
                mode, jolted = _cross_kink(surface, local, request, mode, time, row, state)
                if jolted:
                    row = row_of(local, part, mode, time, state)
                    if mode == FLYING and before != FLYING:
                        record = note(record, ENDS + DETACHED, row, _speed(row))
                    elif mode == RESTING and before != RESTING:
                        record = note(record, STOPS, row, _speed(row))
                    elif before == RESTING and mode != RESTING:
                        record = note(record, SLIPS, row, _speed(row))
                    record = write(record, row)
                    if mode == FLYING and not request.flies:
                        return _results(record, DETACHED, count)
            count[1] += 1
        bridge(local, request, mode)
        cell = enter(surface, local, state[0], state[1], time, end)
        if cell == UNBUILT:
            verdict = LACKS_CELL
            break
        if cell < 0 or gap_at(surface, local, state[0], state[1]) < 0.0:
            verdict = LEFT_PLATE
            break
        span_end = local.frame[END]
        if span_end <= time:
            verdict = WORK_LIMIT
            break
        if record.counts[0] == 0:
            record = write(record, row_of(local, part, mode, time, state))
        before, event = mode, -1
        if mode == RESTING:
            stood = energy_at_rest(local, part, time, state)
            leaves = leaves_rest(local, part, rest, state[0], state[1], time, span_end)
            time = min(leaves, span_end)
            # A part at rest dissipates nothing: all that its energy gains is the surface's work.
            state[4] += energy_at_rest(local, part, time, state) - stood
            count[0] += 3
            if leaves < math.inf:
                a = slope(fields(local, state[0], state[1], time), part)
                load, law = a.load, part.law
                # Rounding must not make a slip of what is the end of contact.
                ends = min(load + law.pull_off, law.largest_load - load) < ROUNDING * request.force
                if margin(local, part, load, 0.0) < 0.0 or (ends and a.demand <= law.static_ratio * a.limit):
                    verdict = DETACHED if load + law.pull_off < law.largest_load - load else OVERLOADED
                else:
                    mode, h, event = _start(part, load), START * request.stroke_time, SLIPS
        elif mode == FLYING:
            mode, time, h, verdict = fly(surface, local, request, count, time, h, span_end, state)
            if mode != FLYING:
                load = pull(fields(local, state[0], state[1], time), state[2], state[3], part).normal
                # A surface that falls away as it is met is not held on to.
                mode, event = (FLYING if load < -part.law.pull_off else mode), LANDS
        else:
            mode, time, h, verdict = slide(surface, local, request, pairs, step, count, mode, time, h, span_end, state)
            if mode == RESTING:
                event = STOPS
            elif mode == TURNED:
                mode, event = MANIFOLD, REVERSES
        if verdict == DETACHED and request.flies:
            verdict, event = GOES_ON, ENDS + DETACHED
        row = row_of(local, part, mode, time, state)
        if event == ENDS + DETACHED:
            state[2], state[3] = row[V_X], row[V_Y]
            take_off(local, time, state)
            mode, h = FLYING, START * request.stroke_time
        if event >= 0:
            record = note(record, event, row, _speed(row))
        if event == LANDS and mode == FLYING:
            record = note(record, ENDS + DETACHED, row, _speed(row))
        if mode != before:
            row = row_of(local, part, mode, time, state)
        count[2] += row[TIME] - record.rows[record.counts[0] - 1, TIME] > LONG * end
        record = write(record, row)
        allowed = EVALUATIONS_AT_LEAST + EVALUATIONS_PER_SPAN * count[1] + EVALUATIONS_PER_STEP * count[2]
        if count[0] > allowed:
            verdict = WORK_LIMIT
    if verdict in (DETACHED, LEFT_PLATE, OVERLOADED):
        row = record.rows[record.counts[0] - 1]
        record = note(record, ENDS + verdict, row, _speed(row))
    return _results(record, verdict, count)


@jit
def _results(record: Record, verdict: int, count: NDArray[np.int64]) -> tuple[FloatArray, FloatArray, int, int]:
    return record.rows[: record.counts[0]], record.events[: record.counts[1]], verdict, count[0]


@jit
def _cross_kink(
    surface: Any, local: Any, request: Request, mode: int, time: float, row: FloatArray, state: FloatArray
) -> tuple[int, bool]:
    """Goes on to the next span over a kink; what the part does then, and whether the surface's velocity jumped.

    It stays in its cell for that: from one cell to the next the velocity differs by what the fits are off by.
    """
    before = fields(local, state[0], state[1], time)
    go_on(surface, local, time, request.duration)
    after = fields(local, state[0], state[1], time)
    moved = state.copy()
    if mode == MANIFOLD:
        moved[2], moved[3] = row[V_X], row[V_Y]
    slack = JUMP * surface.size / request.stroke_time
    if jump(before, after) <= slack:
        return mode, False
    mode = jolt(before, after, request.part, mode, slack, moved)
    state[:] = moved
    return mode, True


@jit
def _start(part: Part, load: float) -> int:
    """How a part begins to slide: without friction there is no slow manifold, and no stiffness either."""
    return MANIFOLD if friction_limit(part.law, load) > 0.0 else SLIDING


@jit
def _speed(row: FloatArray) -> float:
    return math.hypot(row[V_X], row[V_Y])
