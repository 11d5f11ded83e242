"""The drives of all actuators as kernels read them: pieces of degree five, and the breakpoints between them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from particle.jit import jit, jit_no_arrays

FloatArray = NDArray[np.float64]
Segments = tuple[FloatArray, FloatArray, FloatArray, float]
"""Start (S,) and scale (S,) [s] and coefficients (S, 6) [m] of one pass, and how often it repeats (inf: no end)."""

ORDER = 6  # coefficients of a quintic
MERGED = 1e-12  # of a stroke: breakpoints closer than that are taken as one
ROUNDING = 4 * np.finfo(float).eps  # of the time: nor are breakpoints told apart that are closer than that


# What a jump of the fourth and fifth derivative adds, over the time of a bridge, to one of the third (see `span`).
ROUGH_OVER, FOURTH, FIFTH = 0.25, 0.141, 0.036  # a stroke


# Derivatives 1 to 5 of a segment at its begin and end, times its scale to that power, from its coefficients: (6, 5).
_AT_END = np.array([[math.perm(k, order) for order in range(1, ORDER)] for k in range(ORDER)], dtype=float)
_AT_BEGIN = np.where(np.eye(ORDER, ORDER - 1, -1) > 0, _AT_END, 0.0)


class AnyDrive(Protocol):
    """What every drive has."""

    @property
    def delay(self) -> float:
        """The time [s] until which it holds its first height."""

    @property
    def stroke_time(self) -> float:
        """The shortest time [s] of one stroke, from rest to rest or from one turning point to the next."""

    @property
    def frequency(self) -> float:
        """The highest number of up-and-down strokes in a second [Hz]; 0 when nothing moves."""

    @property
    def error(self) -> float:
        """The largest difference of the pieces from the height they stand for, over the stroke; 0: they are exact."""

    def segments(self) -> Segments:
        """The pieces of one pass, and how often it repeats."""

    def evaluate(self, time: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """h [m], its velocity [m/s] and its acceleration [m/s^2] at times of any shape [s]."""


class DriveTable(NamedTuple):
    """The drives of all actuators, as kernels read them.

    Drive i holds its first value until delay[i], then runs through its segments first[i] .. first[i+1]-1, repeats[i]
    times in all (inf: without end), each pass lasting span[i], then holds its last value.
    """

    first: NDArray[np.int64]  # (N+1,)
    start: FloatArray  # (S,) s, of a segment after the start of its pass; a pass's first is 0
    scale: FloatArray  # (S,) s, what its polynomial's variable is divided by
    coefficients: FloatArray  # (S, 6) m, in (t - start) / scale
    delay: FloatArray  # (N,) s
    span: FloatArray  # (N,) s
    repeats: FloatArray  # (N,)
    stroke_time: FloatArray  # (N,) s, the shortest stroke of each; inf: it has none
    jump: FloatArray  # (N, 2) m/s, m/s^2, by how much its velocity and acceleration jump at breakpoints at most
    rough: FloatArray  # (N,) m/s^3, by how much its third derivative does, with the share of those above


class Evaluated:
    """A drive that is evaluated from its own pieces."""

    def evaluate(self: AnyDrive, time: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """h [m], its velocity [m/s] and its acceleration [m/s^2] at times of any shape [s]."""
        time = np.asarray(time, dtype=float)
        values = _values(drive_table([self]), np.ascontiguousarray(time.ravel()))
        return values[0].reshape(time.shape), values[1].reshape(time.shape), values[2].reshape(time.shape)


def accelerations(table: DriveTable, time: float) -> FloatArray:
    """d^2 h/dt^2 [m/s^2] of all drives (N,) at one time [s]."""
    found, piece = np.empty(len(table.delay)), np.empty(ORDER)
    for i in range(len(found)):
        drive_piece(table, i, float(time), 1.0, piece)
        found[i] = 2.0 * piece[2]
    return found


def drive_table(drives: Sequence[AnyDrive]) -> DriveTable:
    """The drives as kernels read them."""
    parts = [drive.segments() for drive in drives]
    none = np.zeros((len(drives), 2))
    table = DriveTable(
        first=np.cumsum([0] + [len(start) for start, *_ in parts]),
        start=np.concatenate([np.zeros(0)] + [start for start, *_ in parts]),
        scale=np.concatenate([np.zeros(0)] + [scale for _, scale, *_ in parts]),
        coefficients=np.concatenate([np.zeros((0, ORDER))] + [rows for _, _, rows, _ in parts]),
        delay=np.array([drive.delay for drive in drives], dtype=float),
        span=np.array([start[-1] + scale[-1] for start, scale, *_ in parts], dtype=float),
        repeats=np.array([repeats for *_, repeats in parts], dtype=float),
        stroke_time=np.array([drive.stroke_time for drive in drives], dtype=float),
        jump=none,
        rough=none[:, 0],
    )
    jump = _jumps(table)
    longest = ROUGH_OVER * np.where(np.isfinite(table.stroke_time), table.stroke_time, 0.0)
    rough = jump[:, 2] + FOURTH * longest * jump[:, 3] + FIFTH * longest**2 * jump[:, 4]
    return table._replace(jump=jump[:, :2].copy(), rough=rough)


def monomial_table(count: int) -> DriveTable:
    """Drives that are the powers 1, t, t^2, ... of time [s], without breakpoints, for surfaces given as polynomials."""
    return DriveTable(
        first=np.arange(count + 1),
        start=np.zeros(count),
        scale=np.ones(count),
        coefficients=np.eye(ORDER)[:count],
        delay=np.full(count, -math.inf),
        span=np.full(count, math.inf),
        repeats=np.ones(count),
        stroke_time=np.full(count, math.inf),
        jump=np.zeros((count, 2)),
        rough=np.zeros(count),
    )


@np.errstate(divide="ignore", invalid="ignore", over="ignore")  # strokes too fast for numbers fail where they are used
def _jumps(table: DriveTable) -> FloatArray:
    """The largest jumps of the first five derivatives at breakpoints (N, 5) [m/s, m/s^2, ...]; 0: by rounding.

    Breakpoints are from one segment to the next, at its start and at its end.
    """
    if len(table.span) == 0:
        return np.zeros((0, ORDER - 1))
    orders, first, last = np.arange(1, ORDER), table.first[:-1], table.first[1:] - 1
    per_order = table.scale[:, None] ** orders
    begins, ends = table.coefficients @ _AT_BEGIN / per_order, table.coefficients @ _AT_END / per_order
    step = np.zeros_like(begins)
    step[1:] = np.abs(begins[1:] - ends[:-1])
    # At rest before the start, and after the end if there is one; before that the last segment goes on into the first.
    again = np.where((table.repeats > 1)[:, None], np.abs(ends[last] - begins[first]), 0.0)
    end = np.where(np.isfinite(table.repeats)[:, None], np.abs(ends[last]), 0.0)
    step[first] = np.maximum(np.maximum(np.abs(begins[first]), end), again)
    jump = np.maximum.reduceat(step, first)
    most = np.maximum.reduceat(np.abs(table.coefficients).max(axis=1), first)
    rounding = 100 * ROUNDING * most[:, None] / np.minimum.reduceat(table.scale, first)[:, None] ** orders
    return np.where((jump > rounding) & np.isfinite(table.span)[:, None], jump, 0.0)


@jit_no_arrays
def drive_piece(table: DriveTable, i: int, time: float, unit: float, out: FloatArray) -> None:
    """The quintic of drive i around `time` [s]: its coefficients (6,) [m] in (t - time) / unit, into `out`.

    At a breakpoint it is the piece that begins there.
    """
    for k in range(ORDER):
        out[k] = 0.0
    if time < table.delay[i]:
        out[0] = table.coefficients[table.first[i], 0]
        return
    if time >= _edge(table, i, table.repeats[i], table.first[i]):
        for k in range(ORDER):
            out[0] += table.coefficients[table.first[i + 1] - 1, k]
        return
    passes, segment = _place(table, i, time)
    since = time
    if math.isfinite(table.span[i]):
        since = (time - table.delay[i]) - table.span[i] * passes
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
    if after >= _edge(table, i, table.repeats[i], table.first[i]):
        return math.inf
    passes, segment = _place(table, i, after)
    if segment + 1 < table.first[i + 1]:
        return _edge(table, i, passes, segment + 1)
    return _edge(table, i, passes + 1.0, table.first[i])


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
    return float(table.delay[i] + (table.span[i] * passes + table.start[segment]))


@jit_no_arrays
def _place(table: DriveTable, i: int, time: float) -> tuple[float, int]:
    """The passes that drive i has behind it at `time` [s], from its delay to before its end, and its segment then."""
    low, high = table.first[i], table.first[i + 1]
    if not math.isfinite(table.span[i]):
        return 0.0, low
    passes = float(np.floor((time - table.delay[i]) / table.span[i]))
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


@jit
def _values(table: DriveTable, times: FloatArray) -> FloatArray:
    """h [m], velocity [m/s] and acceleration [m/s^2] of the first drive at times (n,) [s]: (3, n)."""
    values, piece = np.empty((3, len(times))), np.empty(ORDER)
    for n in range(len(times)):
        drive_piece(table, 0, times[n], 1.0, piece)
        values[0, n], values[1, n], values[2, n] = piece[0], piece[1], 2.0 * piece[2]
    return values
