"""Kernels of drives: the piece around a time, and the breakpoint after it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from particle.drives.record import MERGED, ORDER, ROUNDING, DriveTable
from particle.jit import inlined, jit_no_arrays

FloatArray = NDArray[np.float64]

NO_SEGMENT = -1  # of a drive that has not begun, or has ended


@jit_no_arrays
def evaluate_piece(c: FloatArray, s: float, unit: float) -> tuple[float, float, float]:
    """A quintic c (6,) in s = t / unit, with its first and second derivative in t."""
    value = ((((c[5] * s + c[4]) * s + c[3]) * s + c[2]) * s + c[1]) * s + c[0]
    first = (((5 * c[5] * s + 4 * c[4]) * s + 3 * c[3]) * s + 2 * c[2]) * s + c[1]
    second = ((20 * c[5] * s + 12 * c[4]) * s + 6 * c[3]) * s + 2 * c[2]
    return value, first / unit, second / (unit * unit)


@jit_no_arrays
def drive_piece(table: DriveTable, i: int, time: float, unit: float, out: FloatArray) -> None:
    """The quintic of drive i around `time` [s]: its coefficients (6,) [m] in (t - time) / unit, into `out`.

    At a breakpoint it is the piece that begins there.
    """
    find_piece(table, i, time, unit, out)


@jit_no_arrays
def find_piece(table: DriveTable, i: int, time: float, unit: float, out: FloatArray) -> tuple[float, int]:
    """The same; also returns the passes that drive i has behind it, and its segment, NO_SEGMENT: it holds."""
    for k in range(ORDER):
        out[k] = 0.0
    if time < table.delay[i]:
        out[0] = table.coefficients[table.first[i], 0]
        return 0.0, NO_SEGMENT
    if time >= _end(table, i):
        for k in range(ORDER):
            out[0] += table.coefficients[table.first[i + 1] - 1, k]
        return 0.0, NO_SEGMENT
    passes, segment = _place(table, i, time)
    expand_piece(table, i, passes, segment, time, unit, out)
    return passes, segment


@jit_no_arrays
def find_alike(table: DriveTable) -> None:
    """Fill `table.alike`."""
    for i in range(len(table.alike)):
        table.alike[i] = i > 0 and _is_alike(table, i, i - 1)


@inlined
def _is_alike(table: DriveTable, i: int, other: int) -> bool:
    first, first_other, count = table.first[i], table.first[other], table.first[i + 1] - table.first[i]
    if (
        table.first[other + 1] - first_other != count
        or table.loop[i, 0] - first != table.loop[other, 0] - first_other
        or table.loop[i, 1] - first != table.loop[other, 1] - first_other
        or table.delay[i] != table.delay[other]
        or table.span[i] != table.span[other]
        or table.repeats[i] != table.repeats[other]
        or table.stroke_time[i] != table.stroke_time[other]
    ):
        return False
    for k in range(count):
        if table.start[first + k] != table.start[first_other + k]:
            return False
        if table.scale[first + k] != table.scale[first_other + k]:
            return False
    return True


@jit_no_arrays
def expand_piece(
    table: DriveTable, i: int, passes: float, segment: int, time: float, unit: float, out: FloatArray
) -> None:
    """The quintic of a segment of drive i, as `drive_piece` has it."""
    since = time
    if math.isfinite(table.span[i]):
        since = (time - _origin(table, i)) - table.span[i] * passes
    # Taylor's shift of the polynomial to `time`, by repeated Horner.
    shift = (since - table.start[segment]) / table.scale[segment]
    for k in range(ORDER):
        out[k] = table.coefficients[segment, k]
    for k in range(ORDER - 1):
        for j in range(ORDER - 2, k - 1, -1):
            out[j] += shift * out[j + 1]
    factor = 1.0
    for k in range(ORDER):
        out[k] *= factor
        factor *= unit / table.scale[segment]


@jit_no_arrays
def breakpoint_slack(table: DriveTable, i: int, time: float) -> float:
    """How close [s] to `time` a breakpoint of drive i must be to count as one there: rounding, or 1e-12 of a stroke."""
    return MERGED * table.stroke_time[i] + ROUNDING * abs(time) if math.isfinite(table.span[i]) else 0.0


@jit_no_arrays
def drive_breakpoint(table: DriveTable, i: int, time: float) -> float:
    """The first time [s] after `time` at which drive i has a breakpoint; inf when there is none."""
    if not math.isfinite(table.span[i]):
        return math.inf
    after = time + breakpoint_slack(table, i, time)
    if after < table.delay[i]:
        return float(table.delay[i])
    if after >= _end(table, i):
        return math.inf
    passes, segment = _place(table, i, after)
    if segment + 1 == table.first[i + 1] and segment >= table.loop[i, 1]:
        return _end(table, i)
    if segment + 1 == table.loop[i, 1]:
        return _edge(table, i, passes + 1.0, table.loop[i, 0])
    return _edge(table, i, passes, segment + 1)


@jit_no_arrays
def next_breakpoint(table: DriveTable, time: float) -> float:
    """The first time [s] after `time` at which any drive has a breakpoint; inf when there is none.

    Breakpoints closer than 1e-12 of a stroke, or than rounding at that time, are taken as one.
    """
    nearest = math.inf
    for i in range(len(table.delay)):
        nearest = min(nearest, drive_breakpoint(table, i, time))
    return nearest


@jit_no_arrays
def _edge(table: DriveTable, i: int, passes: float, segment: int) -> float:
    """When [s] a segment of drive i begins after so many passes: the one expression that decides about pieces."""
    if not math.isfinite(table.span[i]):
        return math.inf
    return float(_origin(table, i) + (table.span[i] * passes + table.start[segment]))


@jit_no_arrays
def _origin(table: DriveTable, i: int) -> float:
    """When [s] the first pass of drive i begins, after its lead."""
    return float(table.delay[i] - table.start[table.first[i]])


@jit_no_arrays
def _end(table: DriveTable, i: int) -> float:
    """When [s] drive i has ended."""
    last = table.first[i + 1] - 1
    if last < table.loop[i, 1]:
        return _edge(table, i, table.repeats[i], table.loop[i, 0])
    length = table.start[last] + table.scale[last]
    return float(_origin(table, i) + (table.span[i] * table.repeats[i] + length))


@jit_no_arrays
def _place(table: DriveTable, i: int, time: float) -> tuple[float, int]:
    """The passes that drive i has behind it at `time` [s], from its delay to before its end, and its segment then."""
    low, high = table.loop[i, 0], table.loop[i, 1]
    if not math.isfinite(table.span[i]):
        return 0.0, low
    if time < _edge(table, i, 0.0, low):
        passes, low, high = 0.0, table.first[i], low
    elif time >= _edge(table, i, table.repeats[i], low):
        passes, low, high = table.repeats[i], high, table.first[i + 1]
    else:
        passes = float(np.floor((time - _origin(table, i)) / table.span[i]))
        # The quotient is rounded: at late times it may be one off.
        if _edge(table, i, passes + 1.0, low) <= time:
            passes += 1.0
        elif _edge(table, i, passes, low) > time:
            passes -= 1.0
    while high - low > 1:
        middle = (low + high) // 2
        if _edge(table, i, passes, middle) <= time:
            low = middle
        else:
            high = middle
    return passes, low
