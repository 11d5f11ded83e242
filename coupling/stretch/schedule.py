"""Schedule: the breakpoints that drives have together, and the period after which all of them repeat."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coupling.case import common_period
from particle import AnyDrive, kernel
from particle.drives import DriveTable, drive_table, next_breakpoint

FloatArray = NDArray[np.float64]

CLOSEST = 1e-9  # of the shortest stroke: breakpoints of the loop's ends


class Schedule(NamedTuple):
    """When the drives have breakpoints."""

    edges: FloatArray  # (I+1,) s, breakpoints from 0 to the end of what is needed
    loop: int  # the interval with which a pass begins that repeats without end; -1: there is none
    table: DriveTable


def schedule_of(drives: Sequence[AnyDrive], end: float) -> Schedule:
    """The breakpoints from 0 to `end` [s], to the first end of a common period, or until all drives have ended."""
    moving = [drive for drive in drives if drive.segments().coefficients[:, 1:].any()]
    table, marks = drive_table(drives), drive_table(moving)
    begin, period = _period(moving)
    if not moving:
        return Schedule(np.array([0.0, end]), -1, table)
    if math.isinf(min(end, begin)):  # there is no end to them
        return Schedule(np.zeros(1), -1, table)
    if period is None:
        return Schedule(_edges(marks, min(end, begin)), -1, table)
    if not begin + period < end:
        return Schedule(_edges(marks, end), -1, table)
    lead = _edges(marks, begin) if begin > 0 else np.zeros(1)
    cycle = _edges(marks, begin + period, begin)
    return Schedule(np.concatenate([lead, cycle[1:]]), len(lead) - 1, table)


def _edges(table: DriveTable, end: float, begin: float = 0.0) -> FloatArray:
    """Begin, end and all breakpoints between them [s]."""
    times = breakpoints(table, begin, end)
    near = CLOSEST * min(float(table.stroke_time.min(initial=math.inf)), end - begin)
    return np.concatenate([[begin], times[(times > begin + near) & (times < end - near)], [end]])


@kernel
def breakpoints(table: DriveTable, begin: float, end: float) -> FloatArray:
    """The breakpoints after `begin` and before `end` [s]."""
    times, count = np.empty(64), 0
    time = next_breakpoint(table, begin)
    while time < end:
        if count == len(times):
            times = np.concatenate((times, np.empty(len(times))))
        times[count] = time
        count += 1
        time = next_breakpoint(table, time)
    return times[:count].copy()


def _period(moving: Sequence[AnyDrive]) -> tuple[float, float | None]:
    """From which time [s] on drives only repeat or rest, and the common period [s]; None: they rest, or there is none.

    Without a common period, but with drives that repeat, that time is inf.
    """
    begin, period = 0.0, None
    for drive in moving:
        pieces = drive.segments()
        if math.isfinite(pieces.duration):
            begin = max(begin, drive.delay + pieces.duration)
            continue
        begin = max(begin, drive.delay + pieces.lead_time)
        period = common_period(period, pieces.span)
        if math.isinf(period):
            return math.inf, None
    return begin, period
