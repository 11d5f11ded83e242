"""What is recorded of a path: rows and events, as arrays that grow."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.events.mechanics import Motion, Part, energy, grip_at, heading, pull, rest_pull, rising, velocity
from particle.jit import device
from particle.modes import Mode
from particle.records import Record, new_records, record_type
from particle.surface import LocalSurface, surface_at


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


class PathRecord(NamedTuple):
    """Rows and events so far."""

    rows: NDArray[Row]
    events: NDArray[EventRow]
    lengths: NDArray[Lengths]  # (1,)


def new_record() -> PathRecord:
    return PathRecord(new_records(Row, 1024), new_records(EventRow, 256), new_records(Lengths))


@device
def fill_row(local: LocalSurface, part: Part, mode: int, time: float, motion: Motion, row: Row) -> None:
    """The row of a part's motion into `row`."""
    x, y, v_x, v_y = motion.x, motion.y, motion.v_x, motion.v_y
    row.time, row.x, row.y, row.mode = time, x, y, mode
    row.work, row.dissipated = motion.work, motion.dissipated
    f = surface_at(local, x, y, time)
    if mode == Mode.FLYING:
        row.v_x, row.v_y, row.z, row.v_z, row.load, row.friction = v_x, v_y, motion.z, motion.v_z, 0.0, 0.0
        row.kinetic, row.potential = energy(f, x, y, v_x, v_y, motion.z, motion.v_z, part)
        return
    a = rest_pull(f, part)
    if mode == Mode.MANIFOLD:
        v_x, v_y = velocity(f, part, motion.v_x, heading(local, part, time, x, y, motion.v_x, f, a))
    elif mode == Mode.RESTING:
        v_x = v_y = 0.0
    row.v_x, row.v_y, row.z, row.v_z = v_x, v_y, f.w, rising(f, v_x, v_y)
    row.load = pull(f, v_x, v_y, part).normal
    row.friction = part.mass * a.demand if mode == Mode.RESTING else grip_at(f, part, row.load).limit
    row.kinetic, row.potential = energy(f, x, y, v_x, v_y, row.z, row.v_z, part)


@device
def write(record: PathRecord, row: Row) -> PathRecord:
    """The record with one more row, or with its last row replaced when no time has passed."""
    rows, lengths = record.rows, record.lengths[0]
    place = lengths.rows
    if place > 0 and rows[place - 1].time == row.time:
        place -= 1
    if place == len(rows):
        longer = np.zeros(2 * len(rows), ROW)
        longer[: len(rows)] = rows
        rows = longer
    rows[place] = row
    lengths.rows = place + 1
    return PathRecord(rows, record.events, record.lengths)


@device
def note(record: PathRecord, kind: int, row: Row) -> PathRecord:
    """The record with one more event, at the place, time and speed of a row."""
    events, lengths = record.events, record.lengths[0]
    place = lengths.events
    if place == len(events):
        longer = np.zeros(2 * len(events), EVENT)
        longer[: len(events)] = events
        events = longer
    event = events[place]
    event.kind, event.time, event.x, event.y = kind, row.time, row.x, row.y
    event.speed, event.load, event.heading = math.hypot(row.v_x, row.v_y), row.load, row.heading
    lengths.events = place + 1
    return PathRecord(record.rows, events, record.lengths)


@device
def last_row(record: PathRecord) -> Row:
    return record.rows[record.lengths[0].rows - 1]
