"""What all drives have, their pieces of degree five, and the table of them that kernels read."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike

from particle.drives.pieces import ORDER, ROUNDING, DriveTable, drive_piece, find_alike
from particle.jit import device_no_arrays, jit
from particle.types import FloatArray

MAX_PASSES = 1000  # of any endless drive in the period that all have in common
SAME_PERIOD = 1e-12  # of a period


class Segments(NamedTuple):
    """The pieces of a drive: a lead that comes once, a pass that repeats, and a tail that comes once."""

    start: FloatArray  # (S,) s, after the start of the pass; of the lead negative, of the tail after the last pass
    scale: FloatArray  # (S,) s, what the polynomial's variable is divided by
    coefficients: FloatArray  # (S, 6) m, in (t - start) / scale
    repeats: float  # of the pass; inf: no end
    lead: int = 0  # how many segments come before the pass
    tail: int = 0  # how many come after the last pass

    @property
    def span(self) -> float:
        """The time [s] of one pass."""
        last = len(self.start) - self.tail - 1
        return float(self.start[last] + self.scale[last])

    @property
    def lead_time(self) -> float:
        """The time [s] before the first pass."""
        return -float(self.start[0])

    @property
    def tail_time(self) -> float:
        """The time [s] after the last pass."""
        return float(self.start[-1] + self.scale[-1]) if self.tail else 0.0

    @property
    def duration(self) -> float:
        """The time [s] from the delay to the end; inf: no end."""
        return self.lead_time + self.span * self.repeats + self.tail_time

    @property
    def since(self) -> FloatArray:
        """When [s] each segment begins for the first time, after the delay (S,); inf for a tail that never comes."""
        passed = np.zeros(len(self.start))
        passed[len(passed) - self.tail :] = self.span * self.repeats if self.tail else 0.0
        return self.lead_time + passed + self.start


# What a jump of the fourth and fifth derivative adds, over the time of a bridge, to one of the third (see `span`).
JUMP_OVER, FOURTH, FIFTH = 0.25, 0.141, 0.036  # JUMP_OVER: of a stroke

# Of powers k in derivatives 1 to 5, at 1: k (k - 1) ..., (5, 6).
_FACTORS = np.array([[math.perm(k, order) for k in range(ORDER)] for order in range(1, ORDER)], dtype=float)


def joined(
    lead: tuple[FloatArray, ...], cycle: tuple[FloatArray, ...], tail: tuple[FloatArray, ...] | None, repeats: float
) -> Segments:
    """Pieces that come once, those of a pass, and pieces that come once after the last pass, None: there are none.

    Each has starts (S,), of the lead below 0, scales (S,) and coefficients (S, 6). Where the pass does not come at all
    the others make one.
    """
    if repeats == 0 and tail is not None:
        whole = [np.concatenate(parts) for parts in zip(lead, tail, strict=True)]
        return Segments(whole[0] - whole[0][0], whole[1], whole[2], 1.0)
    rest = () if tail is None else (tail,)
    start, scale, rows = (np.concatenate(parts) for parts in zip(lead, cycle, *rest, strict=True))
    return Segments(start, scale, rows, float(repeats), len(lead[0]), 0 if tail is None else len(tail[0]))


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
        """The pieces, and how often their pass repeats."""

    def evaluate(self, time: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """h [m], its velocity [m/s] and its acceleration [m/s^2] at times of any shape [s]."""


class Evaluated:
    """A drive that is evaluated from its own pieces."""

    def evaluate(self: AnyDrive, time: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """h [m], its velocity [m/s] and its acceleration [m/s^2] at times of any shape [s]."""
        time = np.asarray(time, dtype=float)
        values = _values(_pieces_of([self]), np.ascontiguousarray(time.ravel()))
        return values[0].reshape(time.shape), values[1].reshape(time.shape), values[2].reshape(time.shape)


def accelerations(table: DriveTable, time: float) -> FloatArray:
    """d^2 h/dt^2 [m/s^2] of all drives (N,) at one time [s]."""
    values, piece = np.empty(len(table.delay)), np.empty(ORDER)
    for i in range(len(values)):
        drive_piece(table, i, float(time), 1.0, piece)
        values[i] = 2.0 * piece[2]
    return values


def drive_table(drives: Sequence[AnyDrive]) -> DriveTable:
    """The drives as kernels read them."""
    table = _pieces_of(drives)
    find_alike(table)
    jump = _jumps(table)
    longest = JUMP_OVER * np.where(np.isfinite(table.stroke_time), table.stroke_time, 0.0)
    rough = jump[:, 2] + FOURTH * longest * jump[:, 3] + FIFTH * longest**2 * jump[:, 4]
    return table._replace(jump=jump[:, :2].copy(), rough=rough)


def _pieces_of(drives: Sequence[AnyDrive]) -> DriveTable:
    """The same, with jumps, roughness and likeness left at 0."""
    parts = [Segments(*drive.segments()) for drive in drives]
    none = np.zeros((len(drives), 2))
    first = np.cumsum([0] + [len(part.start) for part in parts])
    beside = np.array([(part.lead, -part.tail) for part in parts], dtype=np.int64).reshape(-1, 2)
    return DriveTable(
        first=first,
        loop=np.stack([first[:-1], first[1:]], axis=1) + beside,
        start=np.concatenate([np.zeros(0)] + [part.start for part in parts]),
        scale=np.concatenate([np.zeros(0)] + [part.scale for part in parts]),
        coefficients=np.concatenate([np.zeros((0, ORDER))] + [part.coefficients for part in parts]),
        delay=np.array([drive.delay for drive in drives], dtype=float),
        span=np.array([part.span for part in parts], dtype=float),
        repeats=np.array([part.repeats for part in parts], dtype=float),
        stroke_time=np.array([drive.stroke_time for drive in drives], dtype=float),
        jump=none,
        rough=none[:, 0],
        alike=np.zeros(len(drives), dtype=np.bool_),
    )


def horizon(table: DriveTable, time: float) -> float | None:
    """When [s] the drives have done all that they will ever do, seen from `time` [s].

    None where that is not known: the endless drives have no common period of up to a thousand passes of each, or a
    drive is a polynomial without end.
    """
    bounded, endless = np.isfinite(table.span), ~np.isfinite(table.repeats)
    for i in np.flatnonzero(~bounded):
        if table.coefficients[table.first[i] : table.first[i + 1], 1:].any():
            return None
    passes = np.where(endless, 0.0, table.repeats)[bounded]
    lead, tail = -table.start[table.first[:-1]], table.first[1:] - 1
    tail_time = np.where(tail < table.loop[:, 1], 0.0, table.start[tail] + table.scale[tail])
    ends = table.delay + lead + tail_time
    last = float((ends[bounded] + table.span[bounded] * passes).max(initial=time))
    spans = table.span[endless]
    if len(spans) == 0:
        return last
    ratios = [Fraction(float(span / spans[0])).limit_denominator(MAX_PASSES) for span in spans]
    if any(abs(float(ratio) * spans[0] / span - 1) > SAME_PERIOD for ratio, span in zip(ratios, spans, strict=True)):
        return None
    # The least whole number of passes of the first in which all others make whole numbers of theirs.
    common = math.lcm(*(ratio.numerator for ratio in ratios)) / math.gcd(*(ratio.denominator for ratio in ratios))
    if common * spans[0] / spans.min() > MAX_PASSES:
        return None
    return last + float(common * spans[0])


def monomial_table(count: int) -> DriveTable:
    """Drives that are the powers 1, t, t^2, ... of time [s], without breakpoints, for surfaces given as polynomials."""
    return DriveTable(
        first=np.arange(count + 1),
        loop=np.stack([np.arange(count), np.arange(1, count + 1)], axis=1),
        start=np.zeros(count),
        scale=np.ones(count),
        coefficients=np.eye(ORDER)[:count],
        delay=np.full(count, -math.inf),
        span=np.full(count, math.inf),
        repeats=np.ones(count),
        stroke_time=np.full(count, math.inf),
        jump=np.zeros((count, 2)),
        rough=np.zeros(count),
        alike=np.zeros(count, dtype=np.bool_),
    )


@np.errstate(divide="ignore", invalid="ignore", over="ignore")  # strokes too fast for numbers fail where they are used
def scaled_table(table: DriveTable, factor: float, stroke: float) -> DriveTable:
    """Drives that do the same `factor` times as fast, delays included, over `stroke` times their heights."""
    times = {name: getattr(table, name) / factor for name in ("start", "scale", "delay", "span", "stroke_time")}
    jump = table.jump * abs(stroke) * [factor, factor**2]
    rough = table.rough * abs(stroke) * factor**3
    return table._replace(coefficients=stroke * table.coefficients, jump=jump, rough=rough, **times)


@np.errstate(divide="ignore", invalid="ignore", over="ignore")  # strokes too fast for numbers fail where they are used
def _jumps(table: DriveTable) -> FloatArray:
    """The largest jumps of the first five derivatives at breakpoints (N, 5) [m/s, m/s^2, ...]; 0: by rounding.

    Breakpoints are from one segment to the next, at its start and at its end. There is none at the start of a drive
    without delay: no run begins before it.
    """
    # At rest before the start, and after the end if there is one; before that the end of a pass goes on into the next.
    jump, most, shortest = _largest_jumps(table)
    rounding = 100 * ROUNDING * most[:, None] / shortest[:, None] ** np.arange(1, ORDER)
    return np.where((jump > rounding) & np.isfinite(table.span)[:, None], jump, 0.0)


@jit
def _largest_jumps(table: DriveTable) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The largest jump of each derivative (N, 5), coefficient (N,) and the least scale (N,) of each drive."""
    count = len(table.span)
    jump, most, shortest = np.zeros((count, ORDER - 1)), np.zeros(count), np.full(count, math.inf)
    for i in range(count):
        first, last = table.first[i], table.first[i + 1] - 1
        loop_first, loop_last = table.loop[i, 0], table.loop[i, 1] - 1
        for k in range(first, last + 1):
            shortest[i] = min(shortest[i], table.scale[k])
            for j in range(ORDER):
                most[i] = max(most[i], abs(table.coefficients[k, j]))
        for j in range(ORDER - 1):
            largest = 0.0
            if table.delay[i] > 0:
                largest = max(largest, abs(_derivative(table, first, j, False)))
            if math.isfinite(table.repeats[i]):
                largest = max(largest, abs(_derivative(table, last, j, True)))
            if table.repeats[i] > 1:
                jumped = _derivative(table, loop_last, j, True) - _derivative(table, loop_first, j, False)
                largest = max(largest, abs(jumped))
            for k in range(first + 1, last + 1):
                largest = max(largest, abs(_derivative(table, k, j, False) - _derivative(table, k - 1, j, True)))
            jump[i, j] = largest
    return jump, most, shortest


@device_no_arrays
def _derivative(table: DriveTable, segment: int, order: int, at_end: bool) -> float:
    """The derivative of an order, from 0 for the first, of a segment where it begins or ends."""
    total = 0.0
    for k in range(order + 1, ORDER if at_end else order + 2):
        total += _FACTORS[order, k] * table.coefficients[segment, k]
    return total / table.scale[segment] ** (order + 1)


@jit
def _values(table: DriveTable, times: FloatArray) -> FloatArray:
    """h [m], velocity [m/s] and acceleration [m/s^2] of the first drive at times (n,) [s]: (3, n)."""
    values, piece = np.empty((3, len(times))), np.empty(ORDER)
    for n in range(len(times)):
        drive_piece(table, 0, times[n], 1.0, piece)
        values[0, n], values[1, n], values[2, n] = piece[0], piece[1], 2.0 * piece[2]
    return values
