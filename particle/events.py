"""The integrator: sticks, slips, stops and ends are located, never stepped over.

Between two kinks of the drives the surface is one polynomial in time. A resting part stays until `stick` finds that it
leaves; it starts on the slow manifold (`breakaway`), slides by adaptive Runge-Kutta steps and comes to rest in closed
form (`stop`). A step that ends beyond the rim, below pull-off or above the largest load is cut back to that moment.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.breakaway import lag, slope, velocity
from particle.drive import next_kink
from particle.fields import fields, new_local, pin_cell, pin_time
from particle.friction import friction_limit
from particle.jit import jit
from particle.motion import Part, margin, pull
from particle.rim import rim_gap
from particle.runge_kutta import MANIFOLD, SLIDING, Tableau, new_step
from particle.slide import (
    DETACHED,
    GOES_ON,
    LEFT_PLATE,
    OVERLOADED,
    RESTING,
    TURNED,
    WORK_LIMIT,
    Request,
    reason,
    slide,
)
from particle.stick import leaves_rest, new_rest

FloatArray = NDArray[np.float64]

SLIPS, STOPS, REVERSES = range(3)  # as EventKind; the ends follow as 2 + their number

COLUMNS = 8  # of a record's rows: t, x, y, v_x, v_y, load, friction, state
EVALUATIONS_PER_SPAN, EVALUATIONS_AT_LEAST = 2_000, 20_000


class Record(NamedTuple):
    """What is written down on the way; `counts` are of rows, events, evaluations and spans."""

    rows: FloatArray  # (n, COLUMNS)
    events: FloatArray  # (m, 5): kind, t, x, y, load
    counts: NDArray[np.int64]  # (4,)


@jit
def march(surface: Any, request: Request, pair: Tableau) -> tuple[FloatArray, FloatArray, int, int]:
    """The path from one request: rows (n, COLUMNS), events (m, 5), how it ended, evaluations of the surface."""
    part, end = request.part, request.duration
    local, rest, step = new_local(surface), new_rest(), new_step(pair)
    record = Record(np.zeros((1024, COLUMNS)), np.zeros((256, 5)), np.zeros(4, dtype=np.int64))
    # x, y, v_x, v_y; on the slow manifold x, y, u.
    state, time = request.start.copy(), 0.0
    mode = RESTING if state[2] == 0.0 and state[3] == 0.0 else SLIDING
    span_end, h, verdict = 0.0, 0.02 * request.stroke_time, GOES_ON
    while verdict == GOES_ON:
        if time >= span_end:
            if time >= end:
                break
            span_end = min(next_kink(surface.drives, time), end)
            if span_end <= time:
                verdict = WORK_LIMIT
                break
            pin_time(surface, local, time, span_end)
            h = max(h, 1e-4 * request.stroke_time)
            record.counts[3] += 1
        if rim_gap(surface, state[0], state[1]) < 0.0 or not pin_cell(surface, local, state[0], state[1]):
            verdict = LEFT_PLATE
            break
        if record.counts[0] == 0:
            record = _write(surface, local, request, record, mode, time, state)
        if mode == RESTING:
            begin = (time - local.frame[0]) / local.frame[1]
            leaves = leaves_rest(surface, local, part, rest, state[0], state[1], begin)
            record.counts[2] += 1
            time = local.frame[0] + leaves * local.frame[1] if leaves < 1.0 else span_end
            if leaves < 1.0:
                load = pull(fields(surface, local, state[0], state[1], time), 0.0, 0.0, part).normal
                if margin(surface, part, load, 0.0) < 0.0:
                    verdict = reason(surface, part, load, state)
                else:
                    mode, h = _start(part, load), 0.02 * request.stroke_time
                    record = _note(surface, local, request, record, SLIPS, mode, time, state)
        else:
            mode, time, h, verdict = slide(
                surface, local, request, pair, step, record.counts, mode, time, h, span_end, state
            )
            if mode == RESTING:
                record = _note(surface, local, request, record, STOPS, mode, time, state)
            elif mode == TURNED:
                mode = MANIFOLD
                record = _note(surface, local, request, record, REVERSES, mode, time, state)
        record = _write(surface, local, request, record, mode, time, state)
        if record.counts[2] > EVALUATIONS_AT_LEAST + EVALUATIONS_PER_SPAN * record.counts[3]:
            verdict = WORK_LIMIT
    if verdict in (DETACHED, LEFT_PLATE, OVERLOADED):
        record = _note(surface, local, request, record, 2 + verdict, mode, time, state)
    return record.rows[: record.counts[0]], record.events[: record.counts[1]], verdict, record.counts[2]


@jit
def _start(part: Part, load: float) -> int:
    """How a part begins to slide: without friction there is no slow manifold, and no stiffness either."""
    return MANIFOLD if friction_limit(part.law, load) > 0.0 else SLIDING


@jit
def _now(surface: Any, local: Any, part: Part, mode: int, time: float, state: FloatArray) -> FloatArray:
    """A row: t, x, y, v_x, v_y, load, friction, state (stick 0, slip 1)."""
    x, y = state[0], state[1]
    f = fields(surface, local, x, y, time)
    v_x, v_y = state[2], state[3]
    a = slope(f, part)
    if mode == MANIFOLD:
        v_x, v_y = velocity(state[2], lag(surface, local, part, time, x, y, state[2], f, a), a)
    if mode == RESTING:
        return np.array([time, x, y, 0.0, 0.0, a.load, part.mass * a.demand, 0.0])
    load = pull(f, v_x, v_y, part).normal
    return np.array([time, x, y, v_x, v_y, load, friction_limit(part.law, load), 1.0])


@jit
def _write(
    surface: Any, local: Any, request: Request, record: Record, mode: int, time: float, state: FloatArray
) -> Record:
    """The record with one more row, or with its last row replaced when no time has passed."""
    row, rows = record.counts[0], record.rows
    if row > 0 and rows[row - 1, 0] == time:
        row -= 1
    if row == len(rows):
        rows = np.concatenate((rows, np.zeros_like(rows)))
    rows[row] = _now(surface, local, request.part, mode, time, state)
    record.counts[0] = row + 1
    return Record(rows, record.events, record.counts)


@jit
def _note(
    surface: Any, local: Any, request: Request, record: Record, kind: int, mode: int, time: float, state: FloatArray
) -> Record:
    """The record with one more event."""
    row, events = record.counts[1], record.events
    if row == len(events):
        events = np.concatenate((events, np.zeros_like(events)))
    load = _now(surface, local, request.part, mode, time, state)[5]
    events[row] = np.array([float(kind), time, state[0], state[1], load])
    record.counts[1] = row + 1
    return Record(record.rows, events, record.counts)
