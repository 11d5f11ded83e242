"""The drives of all actuators as kernels read them: quintics, the piece around a time, and the breakpoint after it."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from particle.group import grouped
from particle.jit import device_no_arrays, inlined, jit_no_arrays, spliced
from particle.types import BoolArray, FloatArray, IntArray

ORDER = 6  # coefficients of a quintic
MERGED = 1e-12  # of a stroke: breakpoints closer than that are taken as one
ROUNDING = 4 * np.finfo(float).eps  # of the time: the same holds for breakpoints closer than that
NO_SEGMENT = -1  # of a drive that has not begun, or has ended


@grouped
class DriveTable(NamedTuple):
    """The drives of all actuators, as kernels read them.

    Drive i holds its first value until delay[i], then runs through its segments first[i] .. first[i+1]-1 and holds its
    last value. Those from loop[i, 0] to before loop[i, 1] are passed repeats[i] times (inf: without end), each pass
    lasting span[i]; those before, its lead, and those after, its tail, once.
    """

    first: IntArray  # (N+1,)
    loop: IntArray  # (N, 2)
    start: FloatArray  # (S,) s, after the start of the pass; of the lead negative, of the tail after the last pass
    scale: FloatArray  # (S,) s, what its polynomial's variable is divided by
    coefficients: FloatArray  # (S, 6) m, in (t - start) / scale
    delay: FloatArray  # (N,) s
    span: FloatArray  # (N,) s
    repeats: FloatArray  # (N,)
    stroke_time: FloatArray  # (N,) s, the shortest stroke of each; inf: it has none
    jump: FloatArray  # (N, 2) m/s, m/s^2, by how much its velocity and acceleration jump at breakpoints at most
    rough: FloatArray  # (N,) m/s^3, by how much its third derivative does, with the share of those above
    alike: BoolArray  # (N,) whether all its pieces begin and end when those of the drive before it do


def hermite_end(rise: Any, v_0: Any, v_1: Any, a_0: Any, a_1: Any) -> tuple[Any, Any, Any]:
    """The coefficients of s^3, s^4 and s^5 of a quintic on [0, 1] by its rise and its derivatives at both ends.

    c_3 = 10 r - 6 v_0 - 4 v_1 - 3/2 a_0 + 1/2 a_1, c_4 = -15 r + 8 v_0 + 7 v_1 + 3/2 a_0 - a_1,
    c_5 = 6 r - 3 v_0 - 3 v_1 - 1/2 a_0 + 1/2 a_1; c_0, c_1 and c_2 are the height, v_0 and a_0 / 2 at the start.
    """
    return (
        10 * rise - 6 * v_0 - 4 * v_1 - 1.5 * a_0 + 0.5 * a_1,
        -15 * rise + 8 * v_0 + 7 * v_1 + 1.5 * a_0 - a_1,
        6 * rise - 3 * v_0 - 3 * v_1 - 0.5 * a_0 + 0.5 * a_1,
    )


quintic_end = device_no_arrays(hermite_end)  # for kernels, of numbers


@spliced
def quintic_at(c_0: Any, c_1: Any, c_2: Any, c_3: Any, c_4: Any, c_5: Any, s: float) -> tuple[Any, Any, Any]:
    """c_0 + c_1 s + ... + c_5 s^5 and its two derivatives in s, by Horner; numbers or lanes."""
    value, first, second = c_5 * s + c_4, c_5, c_5  # the first derivative, and half the second
    first, value = first * s + value, value * s + c_3
    second, first, value = second * s + first, first * s + value, value * s + c_2
    second, first, value = second * s + first, first * s + value, value * s + c_1
    second, first, value = second * s + first, first * s + value, value * s + c_0
    return value, first, 2 * second


@device_no_arrays
def evaluate_piece(c: FloatArray, s: float, unit: float) -> tuple[float, float, float]:
    """A quintic c (6,) in s = t / unit, with its first and second derivative in t."""
    value, first, second = quintic_at(c[0], c[1], c[2], c[3], c[4], c[5], s)
    return value, first / unit, second / (unit * unit)


@jit_no_arrays
def drive_piece(table: DriveTable, i: int, time: float, unit: float, out: FloatArray) -> None:
    """The quintic of drive i around `time` [s]: its coefficients (6,) [m] in (t - time) / unit, into `out`.

    At a breakpoint it is the piece that begins there.
    """
    find_piece(table, i, time, time, unit, out)


@device_no_arrays
def find_piece(
    table: DriveTable, i: int, within: float, time: float, unit: float, out: FloatArray
) -> tuple[float, int]:
    """The same of the piece at `within` [s]; returns the passes behind it, and its segment or, at rest, NO_SEGMENT."""
    for k in range(ORDER):
        out[k] = 0.0
    if within < table.delay[i]:
        out[0] = table.coefficients[table.first[i], 0]
        return 0.0, NO_SEGMENT
    if within >= _end(table, i):
        for k in range(ORDER):
            out[0] += table.coefficients[table.first[i + 1] - 1, k]
        return 0.0, NO_SEGMENT
    passes, segment = _place(table, i, within)
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


@spliced
def expand_piece(
    table: DriveTable, i: int, passes: float, segment: int, time: float, unit: float, out: FloatArray
) -> None:
    """The quintic of a segment of drive i, as `drive_piece` has it."""
    since = time
    if math.isfinite(table.span[i]):
        since = (time - _origin(table, i)) - table.span[i] * passes
    shift = (since - table.start[segment]) / table.scale[segment]
    shift_quintic(table.coefficients[segment], shift, unit / table.scale[segment], out)


@spliced
def shift_quintic(c: FloatArray, shift: float, ratio: float, out: FloatArray) -> None:
    """A quintic c (6,) of s as one of (s - shift) / ratio, into `out`, which may be c: Taylor's shift, by Horner."""
    c_1, c_2, c_3, c_4, c_5, s, power = c[1], c[2], c[3], c[4], c[5], shift, ratio * ratio
    out[0] = ((((c_5 * s + c_4) * s + c_3) * s + c_2) * s + c_1) * s + c[0]
    out[1] = ((((5 * c_5 * s + 4 * c_4) * s + 3 * c_3) * s + 2 * c_2) * s + c_1) * ratio
    out[2] = (((10 * c_5 * s + 6 * c_4) * s + 3 * c_3) * s + c_2) * power
    out[3] = ((10 * c_5 * s + 4 * c_4) * s + c_3) * (power * ratio)
    out[4] = (5 * c_5 * s + c_4) * (power * power)
    out[5] = c_5 * (power * power * ratio)


@device_no_arrays
def copy_rows(c: FloatArray, out: FloatArray) -> None:
    """Polynomials (m, n) into others: numba's own copies compile messages about shapes."""
    for i in range(c.shape[0]):
        for k in range(c.shape[1]):
            out[i, k] = c[i, k]


@device_no_arrays
def breakpoint_slack(table: DriveTable, i: int, time: float) -> float:
    """How close [s] to `time` a breakpoint of drive i must be to count as one there: rounding, or 1e-12 of a stroke."""
    return MERGED * table.stroke_time[i] + ROUNDING * abs(time) if math.isfinite(table.span[i]) else 0.0


@device_no_arrays
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


@device_no_arrays
def _edge(table: DriveTable, i: int, passes: float, segment: int) -> float:
    """When [s] a segment of drive i begins after so many passes: the one expression that decides about pieces."""
    if not math.isfinite(table.span[i]):
        return math.inf
    return float(_origin(table, i) + (table.span[i] * passes + table.start[segment]))


@spliced
def _origin(table: DriveTable, i: int) -> float:
    """When [s] the first pass of drive i begins, after its lead."""
    return float(table.delay[i] - table.start[table.first[i]])


@device_no_arrays
def _end(table: DriveTable, i: int) -> float:
    """When [s] drive i has ended."""
    last = table.first[i + 1] - 1
    if last < table.loop[i, 1]:
        return _edge(table, i, table.repeats[i], table.loop[i, 0])
    length = table.start[last] + table.scale[last]
    return float(_origin(table, i) + (table.span[i] * table.repeats[i] + length))


@device_no_arrays
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
