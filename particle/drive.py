"""Drives: how far an actuator is raised over time, as polynomials of degree five between kinks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from particle.jit import jit

FloatArray = NDArray[np.float64]

ORDER = 6  # coefficients of a quintic
QUINTIC = np.array([0.0, 0.0, 0.0, 10.0, -15.0, 6.0])  # from 0 to 1 with no velocity and acceleration at either end


class DriveTable(NamedTuple):
    """The drives of all actuators, as kernels read them.

    Drive i holds its first value until delay[i], then runs through its segments first[i] .. first[i+1]-1, repeats[i]
    times in all (inf: without end), each pass lasting span[i], then holds its last value.
    """

    first: NDArray[np.int64]  # (N+1,)
    start: FloatArray  # (S,) s, of a segment after the start of its pass
    scale: FloatArray  # (S,) s, what its polynomial's variable is divided by
    coefficients: FloatArray  # (S, 6) m, in (t - start) / scale
    delay: FloatArray  # (N,) s
    span: FloatArray  # (N,) s
    repeats: FloatArray  # (N,)


@dataclass(frozen=True)
class Drive:
    """The stroke h(t) of one actuator: quintic 10 s^3 - 15 s^4 + 6 s^5, at rest and unaccelerated at both ends.

    cycle "up-down": up in half of 1/frequency, down in the other half, repeated without end or `cycles` times.
    cycle "up": up once in 1/frequency, then held.
    Raises ValueError, naming every field that is wrong.
    """

    stroke: float  # m
    frequency: float  # Hz
    cycle: str = "up-down"
    cycles: int | None = None
    delay: float = 0.0  # s

    def __post_init__(self) -> None:
        wrong = []
        if not math.isfinite(self.stroke):
            wrong.append(f"Input stroke of Drive must be a finite length in m; got {self.stroke!r}")
        if not (math.isfinite(self.frequency) and self.frequency > 0):
            wrong.append(f"Input frequency of Drive must be positive, in Hz; got {self.frequency!r}")
        if self.cycle not in ("up-down", "up"):
            wrong.append(f"Input cycle of Drive must be 'up-down' or 'up'; got {self.cycle!r}")
        if self.cycles is not None and (self.cycle == "up" or self.cycles != int(self.cycles) or self.cycles < 1):
            wrong.append(f"Input cycles of Drive must be a whole number of up-down cycles or None; got {self.cycles!r}")
        if not (math.isfinite(self.delay) and self.delay >= 0):
            wrong.append(f"Input delay of Drive must be 0 or a positive time in s; got {self.delay!r}")
        if wrong:
            raise ValueError("; ".join(wrong))

    def segments(self) -> tuple[FloatArray, FloatArray, FloatArray, float]:
        """Start (S,) and scale (S,) [s] and coefficients (S, 6) [m] of one pass, and how often it repeats."""
        if self.cycle == "up":
            return np.zeros(1), np.array([1 / self.frequency]), self.stroke * QUINTIC[None], 1.0
        half = 0.5 / self.frequency
        rise = self.stroke * QUINTIC
        fall = -rise
        fall[0] = self.stroke
        return np.array([0, half]), np.array([half, half]), np.array([rise, fall]), float(self.cycles or math.inf)

    def evaluate(self, time: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """h [m], its velocity [m/s] and its acceleration [m/s^2] at times of any shape [s]."""
        time = np.asarray(time, dtype=float)
        table = drive_table([self])
        pieces = np.array([drive_piece(table, 0, float(t), 1.0) for t in time.ravel()]).reshape(-1, ORDER)
        return tuple(  # type: ignore[return-value]
            (math.factorial(k) * pieces[:, k]).reshape(time.shape) for k in range(3)
        )


def drive_table(drives: Sequence[Drive]) -> DriveTable:
    """The drives as kernels read them."""
    parts = [drive.segments() for drive in drives]
    return DriveTable(
        first=np.cumsum([0] + [len(start) for start, *_ in parts]),
        start=np.concatenate([np.zeros(0)] + [start for start, *_ in parts]),
        scale=np.concatenate([np.zeros(0)] + [scale for _, scale, *_ in parts]),
        coefficients=np.concatenate([np.zeros((0, ORDER))] + [rows for _, _, rows, _ in parts]),
        delay=np.array([drive.delay for drive in drives], dtype=float),
        span=np.array([start[-1] + scale[-1] for start, scale, *_ in parts], dtype=float),
        repeats=np.array([repeats for *_, repeats in parts], dtype=float),
    )


def monomial_table(count: int) -> DriveTable:
    """Drives that are the powers 1, t, t^2, ... of time [s], without kinks, for surfaces given as polynomials."""
    return DriveTable(
        first=np.arange(count + 1),
        start=np.zeros(count),
        scale=np.ones(count),
        coefficients=np.eye(ORDER)[:count],
        delay=np.full(count, -math.inf),
        span=np.full(count, math.inf),
        repeats=np.ones(count),
    )


@jit
def drive_piece(table: DriveTable, i: int, time: float, unit: float) -> FloatArray:
    """The quintic of drive i around `time` [s]: its coefficients (6,) [m] in (t - time) / unit.

    At a kink it is the piece that begins there.
    """
    piece = np.zeros(ORDER)
    since = time - table.delay[i] if math.isfinite(table.delay[i]) else time
    begin, end = table.first[i], table.first[i + 1]
    span = table.span[i]
    if since < 0.0:
        piece[0] = table.coefficients[begin, 0]
        return piece
    if since >= span * table.repeats[i]:
        for k in range(ORDER):
            piece[0] += table.coefficients[end - 1, k]
        return piece
    if math.isfinite(span):
        since -= span * math.floor(since / span)
    segment = begin
    while segment + 1 < end and since >= table.start[segment + 1]:
        segment += 1
    # Taylor's shift of the polynomial to `time`, by repeated Horner.
    shift = (since - table.start[segment]) / table.scale[segment]
    for k in range(ORDER):
        piece[k] = table.coefficients[segment, k]
    for k in range(ORDER - 1):
        for j in range(ORDER - 2, k - 1, -1):
            piece[j] += shift * piece[j + 1]
    factor = 1.0
    for k in range(ORDER):
        piece[k] *= factor
        factor *= unit / table.scale[segment]
    return piece


@jit
def next_kink(table: DriveTable, time: float) -> float:
    """The first time [s] after `time` at which any drive has a kink; inf when there is none.

    Kinks closer than 1e-12 of a stroke are taken as one.
    """
    nearest = math.inf
    for i in range(len(table.delay)):
        span = table.span[i]
        if not math.isfinite(span):
            continue
        after = time + 1e-12 * table.scale[table.first[i]]
        since = after - table.delay[i]
        if since < 0.0:
            nearest = min(nearest, table.delay[i])
            continue
        passes = math.floor(since / span)
        if table.delay[i] + span * (passes + 1) <= after:  # rounding at late times
            passes += 1
        if passes >= table.repeats[i]:
            continue
        kink = table.delay[i] + span * (passes + 1)
        for segment in range(table.first[i], table.first[i + 1]):
            edge = table.delay[i] + (span * passes + table.start[segment])
            if edge > after:
                kink = min(kink, edge)
        nearest = min(nearest, kink)
    return nearest
