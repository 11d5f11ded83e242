"""What is recorded of a path: rows and events, as arrays that grow."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.events.mechanics import Motion, Part, energy, grip_at, heading, pull, rest_pull, rising, velocity
from particle.jit import device, device_no_arrays
from particle.modes import Mode
from particle.records import Record, new_records, record_type
from particle.surface import LocalSurface, surface_here


class Row(Record):
    """The part at one moment."""

    time: float  # s
    x: float  # m
    y: float
    v_x: float  # m/s, in the plane
    v_y: float
    load: float  # N, the contact's net normal force
    friction: float  # N
    mode: int  # Mode
    z: float  # m
    v_z: float  # m/s
    kinetic: float  # J, of the part
    potential: float
    work: float  # J, done by the surface since the start
    dissipated: float  # J, by friction and impacts since the start
    heading: float  # rad, of a part with a face; else these three are 0
    spin: float  # rad/s
    pressure: float  # the least on the face over the mean
    gap: float  # m, the mean under a part with a film of air; else these two are 0
    air: float  # N, what the film bears of the load


class EventRow(Record):
    """What happened at one moment."""

    kind: int  # EventKind
    time: float  # s
    x: float  # m
    y: float
    speed: float  # m/s
    load: float  # N
    heading: float  # rad


class Lengths(Record):
    """How many rows and events there are."""

    rows: int
    events: int


ROW, EVENT = record_type(Row), record_type(EventRow)
ROOM = 4  # rows and events that one turn of a march adds at most, with the event of the end


class PathRecord(NamedTuple):
    """Rows and events so far."""

    rows: NDArray[Row]
    events: NDArray[EventRow]
    lengths: NDArray[Lengths]  # (1,)


def new_record() -> PathRecord:
    return PathRecord(new_records(Row, 1024), new_records(EventRow, 256), new_records(Lengths))


@device_no_arrays
def fill_row(local: LocalSurface, part: Part, mode: int, time: float, motion: Motion, row: Row) -> None:
    """The row of a part's motion into `row`."""
    x, y, v_x, v_y = motion.x, motion.y, motion.v_x, motion.v_y
    row.time, row.x, row.y, row.mode = time, x, y, mode
    row.work, row.dissipated = motion.work, motion.dissipated
    f = surface_here(local, x, y, time)
    if mode == Mode.FLYING:
        row.v_x, row.v_y, row.z, row.v_z, row.load, row.friction = v_x, v_y, motion.z, motion.v_z, 0.0, 0.0
        row.kinetic, row.potential = energy(f, x, y, v_x, v_y, motion.z, motion.v_z, part)
        return
    if mode == Mode.MANIFOLD:
        v_x, v_y = velocity(f, part, motion.v_x, heading(local, part, time, x, y, motion.v_x, f, rest_pull(f, part)))
    elif mode == Mode.RESTING:
        v_x = v_y = 0.0
    row.v_x, row.v_y, row.z, row.v_z = v_x, v_y, f.w, rising(f, v_x, v_y)
    row.load = pull(f, v_x, v_y, part).normal
    if mode == Mode.RESTING:
        row.friction = part.mass * rest_pull(f, part).demand
    else:
        row.friction = grip_at(f, part, row.load).limit
    row.kinetic, row.potential = energy(f, x, y, v_x, v_y, row.z, row.v_z, part)


@device_no_arrays
def has_room(record: PathRecord) -> bool:
    """Whether the record has room for what one turn of a march adds."""
    lengths = record.lengths[0]
    return bool(lengths.rows + ROOM <= len(record.rows) and lengths.events + ROOM <= len(record.events))


@device
def with_room(record: PathRecord) -> PathRecord:
    """The record with room for what one turn of a march adds."""
    if has_room(record):
        return record
    rows, events, lengths = record.rows, record.events, record.lengths[0]
    if lengths.rows + ROOM > len(rows):
        rows = np.zeros(2 * len(rows), ROW)
        for k in range(lengths.rows):
            rows[k] = record.rows[k]
    if lengths.events + ROOM > len(events):
        events = np.zeros(2 * len(events), EVENT)
        for k in range(lengths.events):
            events[k] = record.events[k]
    return PathRecord(rows, events, record.lengths)


@device_no_arrays
def write(record: PathRecord, row: Row) -> None:
    """Adds a row, or replaces the last one when no time has passed."""
    lengths = record.lengths[0]
    place = lengths.rows
    if place > 0 and record.rows[place - 1].time == row.time:
        place -= 1
    record.rows[place] = row
    lengths.rows = place + 1


@device_no_arrays
def note(record: PathRecord, kind: int, row: Row) -> None:
    """Adds an event at the place, time and speed of a row."""
    lengths = record.lengths[0]
    event = record.events[lengths.events]
    event.kind, event.time, event.x, event.y = kind, row.time, row.x, row.y
    event.speed, event.load, event.heading = math.hypot(row.v_x, row.v_y), row.load, row.heading
    lengths.events += 1


@device_no_arrays
def last_row(record: PathRecord) -> Row:
    return record.rows[record.lengths[0].rows - 1]
