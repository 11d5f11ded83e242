"""What is written down on the way of a part: rows and events, as arrays that grow."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.events.breakaway import lag, slope, velocity
from particle.events.equations import Part, energy, pull
from particle.friction import friction_limit
from particle.jit import jit
from particle.surface import fields

FloatArray = NDArray[np.float64]

# Columns of a row. The velocity is that in the plane; the load is the contact's net normal force; the energies are
# those of the part, the work is the surface's on it, and the last what friction and impacts took.
TIME, X, Y, V_X, V_Y, LOAD, FRICTION, MODE, Z, V_Z, KINETIC, POTENTIAL, WORK, DISSIPATED = range(14)
COLUMNS = 14
# Columns of an event.
KIND, EVENT_TIME, EVENT_X, EVENT_Y, EVENT_SPEED, EVENT_LOAD = range(6)
EVENT_COLUMNS = 6
# Kinds of events, as EventKind; the ends of a path follow as ENDS + their number.
SLIPS, STOPS, REVERSES, ENDS, LANDS = 0, 1, 2, 2, 6
# What a part does, in the column MODE; MANIFOLD: it slides, in its first moments (`breakaway`).
RESTING, SLIDING, FLYING, MANIFOLD = range(4)


class Record(NamedTuple):
    """Rows and events so far; `counts` says how many of each there are."""

    rows: FloatArray  # (n, COLUMNS)
    events: FloatArray  # (m, EVENT_COLUMNS)
    counts: NDArray[np.int64]  # (2,)


@jit
def new_record() -> Record:
    return Record(np.zeros((1024, COLUMNS)), np.zeros((256, EVENT_COLUMNS)), np.zeros(2, dtype=np.int64))


@jit
def row_of(local: Any, part: Part, mode: int, time: float, state: FloatArray) -> FloatArray:
    """The row (COLUMNS,) of a part's state (x, y, v_x, v_y or u, work, dissipation, z, v_z)."""
    row = np.zeros(COLUMNS)
    x, y, v_x, v_y = state[0], state[1], state[2], state[3]
    row[TIME], row[X], row[Y], row[MODE], row[WORK], row[DISSIPATED] = time, x, y, mode, state[4], state[5]
    f = fields(local, x, y, time)
    if mode == FLYING:
        row[V_X], row[V_Y], row[Z], row[V_Z] = v_x, v_y, state[6], state[7]
        s_x, s_y = v_x + f.base_vx, v_y + f.base_vy
        row[KINETIC] = 0.5 * part.mass * (s_x * s_x + s_y * s_y + state[7] * state[7])
        height = part.gravity * state[6] - part.tilt_x * (x + f.base_px) - part.tilt_y * (y + f.base_py)
        row[POTENTIAL] = part.mass * height
        return row
    a = slope(f, part)
    if mode == MANIFOLD:
        v_x, v_y = velocity(state[2], lag(local, part, time, x, y, state[2], f, a), a)
    elif mode == RESTING:
        v_x = v_y = 0.0
    row[V_X], row[V_Y], row[Z], row[V_Z] = v_x, v_y, f.w, f.w_t + v_x * f.x + v_y * f.y
    row[LOAD] = pull(f, v_x, v_y, part).normal
    row[FRICTION] = part.mass * a.demand if mode == RESTING else friction_limit(part.law, row[LOAD])
    row[KINETIC], row[POTENTIAL] = energy(f, x, y, v_x, v_y, part)
    return row


@jit
def write(record: Record, row: FloatArray) -> Record:
    """The record with one more row, or with its last row replaced when no time has passed."""
    place, rows = record.counts[0], record.rows
    if place > 0 and rows[place - 1, TIME] == row[TIME]:
        place -= 1
    if place == len(rows):
        rows = np.concatenate((rows, np.zeros_like(rows)))
    rows[place] = row
    record.counts[0] = place + 1
    return Record(rows, record.events, record.counts)


@jit
def note(record: Record, kind: int, row: FloatArray, speed: float) -> Record:
    """The record with one more event, at the place and time of a row, at a speed [m/s]."""
    place, events = record.counts[1], record.events
    if place == len(events):
        events = np.concatenate((events, np.zeros_like(events)))
    event = events[place]
    event[KIND], event[EVENT_TIME], event[EVENT_X], event[EVENT_Y] = kind, row[TIME], row[X], row[Y]
    event[EVENT_SPEED], event[EVENT_LOAD] = speed, row[LOAD]
    record.counts[1] = place + 1
    return Record(record.rows, events, record.counts)
