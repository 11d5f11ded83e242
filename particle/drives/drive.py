"""Drive and SegmentDrive: strokes that repeat, and schedules of strokes whose frequency, stroke and cycle change."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from particle.checks import finite, not_negative, positive, refuse, whole
from particle.drives.pieces import ORDER
from particle.drives.quintics import QUINTIC, RAMPS, SINE_ERROR, WAVES, begun_at, up_down, wave
from particle.drives.table import Evaluated, Segments
from particle.types import FloatArray

CYCLES = ("up-down", "up", *WAVES)
MAX_STROKES = 1_000_000


@dataclass(frozen=True)
class Drive(Evaluated):
    """The stroke h(t) of one actuator, repeated or once.

    Strokes follow the quintic 10 s^3 - 15 s^4 + 6 s^5, at rest and unaccelerated at both ends. Sines and cosines are
    quintics through 128 points a period, more while they grow, C2 between them; `error` states how far off they are.

    A sine or cosine begins, and after a number of cycles ends, with a jump: a sine of velocity (with a phase also of
    acceleration), a cosine of acceleration (with a phase also of velocity), an up-down drive with a phase of both. One
    without delay does not begin with a jump: it has been running all the time. With a ramp there is none at all.

    Parameters
    ----------
    cycle : str
        `"up-down"`: up in half of 1/frequency, down in the other half, each followed by `dwell` at rest. `"up"`: up
        once in 1/frequency, then held. `"sine"`: stroke sin(2 pi f t + phase). `"cosine"`:
        stroke (1 - cos(2 pi f t + phase)) / 2, from 0 up and back.
    cycles : int, optional
        Number of periods, by default without end; not for `"up"`. Afterwards the drive rests where it began.
    phase : float
        Where in its cycle the drive begins; a whole cycle, dwells included, is 2 pi. Not for `"up"`. During the delay
        the drive rests at the height of its phase, with a ramp at 0.
    ramp : float
        Number of cycles, from 0.01 to 1000, over which a sine or cosine grows from rest, by the factor
        10 s^3 - 15 s^4 + 6 s^5 with s from 0 to 1; 0: none. With `cycles` it likewise decays over the last `ramp`
        of them, so `ramp` is at most half of `cycles`.

    Raises
    ------
    ValueError
        A field is wrong; names each.
    """

    stroke: float  # m
    frequency: float  # Hz
    cycle: str = "up-down"
    cycles: int | None = None
    delay: float = 0.0  # s
    dwell: float = 0.0  # s, makes the period of an up-down drive 1/frequency + 2 dwell
    phase: float = 0.0  # rad
    ramp: float = 0.0  # cycles

    def __post_init__(self) -> None:
        counts = self.cycles is None or (self.cycle != "up" and whole(self.cycles))
        waits = not_negative(self.dwell) and (self.dwell == 0 or self.cycle == "up-down")
        begins = finite(self.phase) and (self.phase == 0 or self.cycle != "up")
        grows = finite(self.ramp) and (self.ramp == 0 or (self.cycle in WAVES and RAMPS[0] <= self.ramp <= RAMPS[1]))
        grows = grows and not (counts and self.cycles is not None and 2 * self.ramp > self.cycles)
        ramps = f"0, or for 'sine' and 'cosine' from {RAMPS[0]} to {RAMPS[1]} cycles, at most half of cycles"
        refuse(
            "Drive",
            [
                (finite(self.stroke), "stroke", "a finite length in m", self.stroke),
                (positive(self.frequency), "frequency", "positive, in Hz", self.frequency),
                (self.cycle in CYCLES, "cycle", "'up-down', 'up', 'sine' or 'cosine'", self.cycle),
                (counts, "cycles", "a whole number of cycles, of any but 'up', or None", self.cycles),
                (not_negative(self.delay), "delay", "0 or a positive time in s", self.delay),
                (waits, "dwell", "0 or a positive time in s, the latter for 'up-down' only", self.dwell),
                (begins, "phase", "a finite angle in rad, 0 for 'up'", self.phase),
                (grows, "ramp", ramps, self.ramp),
            ],
        )

    @property
    def stroke_time(self) -> float:
        """The time [s] of one stroke: half a cycle, the whole of an up drive, or the ramp if that is shorter."""
        return (1.0 if self.cycle == "up" else min(0.5, self.ramp or 0.5)) / self.frequency

    @property
    def error(self) -> float:
        """Of the quintics that stand for a sine, over the stroke; 0 for the other cycles, which are quintics."""
        return {"sine": SINE_ERROR, "cosine": SINE_ERROR / 2}.get(self.cycle, 0.0)

    def segments(self) -> Segments:
        """The pieces, and how often their pass repeats."""
        if self.cycle == "up":
            return Segments(np.zeros(1), np.array([1 / self.frequency]), self.stroke * QUINTIC[None], 1.0)
        turns = self.phase / (2 * math.pi) % 1.0
        if self.cycle == "up-down":
            return begun_at(turns, up_down(self.stroke, self.frequency, self.dwell), float(self.cycles or math.inf))
        pieces = wave(self.cycle, turns, float(self.ramp), self.cycles)
        return pieces._replace(
            start=pieces.start / self.frequency,
            scale=pieces.scale / self.frequency,
            coefficients=self.stroke * pieces.coefficients,
        )


@dataclass(frozen=True)
class Segment:
    """One part of a schedule, from the height where the previous one ended.

    Parameters
    ----------
    cycle : str
        `"up-down"`: up by the stroke in half of 1/frequency, down in the other half. `"up"`: up by the stroke in
        1/frequency; a negative stroke goes down. `"hold"`: stay for the time `dwell`, without stroke, frequency and
        cycles.
    cycles : int
        Number of strokes up and down, or up, each followed by `dwell` at rest.

    Raises
    ------
    ValueError
        A field is wrong; names each.
    """

    stroke: float | None = None  # m, needed except for "hold"
    frequency: float | None = None  # Hz, likewise
    cycle: str = "up-down"
    cycles: int = 1
    dwell: float = 0.0  # s

    def __post_init__(self) -> None:
        hold, only = self.cycle == "hold", "None with 'hold'"
        waits = not_negative(self.dwell) and not (hold and self.dwell == 0)
        refuse(
            "Segment",
            [
                (
                    self.stroke is None if hold else finite(self.stroke),
                    "stroke",
                    only if hold else "a finite length in m",
                    self.stroke,
                ),
                (
                    self.frequency is None if hold else positive(self.frequency),
                    "frequency",
                    only if hold else "positive, in Hz",
                    self.frequency,
                ),
                (self.cycle in ("up-down", "up", "hold"), "cycle", "'up-down', 'up' or 'hold'", self.cycle),
                (
                    self.cycles == 1 if hold else whole(self.cycles),
                    "cycles",
                    "1 with 'hold'" if hold else "a whole number of cycles",
                    self.cycles,
                ),
                (waits, "dwell", f"{'' if hold else '0 or '}a positive time in s", self.dwell),
            ],
        )

    @property
    def rise(self) -> float:
        """How much higher it ends than it began [m]."""
        return self.cycles * (self.stroke or 0.0) if self.cycle == "up" else 0.0

    @property
    def stroke_time(self) -> float:
        """The time [s] of one stroke; inf when it holds."""
        return math.inf if self.frequency is None else (1.0 if self.cycle == "up" else 0.5) / self.frequency

    def pieces(self, height: float) -> tuple[FloatArray, FloatArray]:
        """Scales (S,) [s] and coefficients (S, 6) [m] of all its pieces, from a height [m] on."""
        if self.stroke is None or self.frequency is None:
            level = np.zeros((1, ORDER))
            level[0, 0] = height
            return np.array([self.dwell]), level
        count = int(self.cycles)
        if self.cycle == "up-down":
            _, scale, rows = up_down(self.stroke, self.frequency, self.dwell)
            rows = np.tile(rows, (count, 1))
            rows[:, 0] += height
            return np.tile(scale, count), rows
        steps = height + self.stroke * np.arange(count + 1)
        rows = np.tile(self.stroke * QUINTIC, (count, 1))
        rows[:, 0] = steps[:-1]
        scale = np.full(count, 1 / self.frequency)
        if self.dwell == 0:
            return scale, rows
        rests = np.zeros_like(rows)
        rests[:, 0] = steps[1:]
        waits = np.full(count, self.dwell)
        return np.stack([scale, waits], axis=1).ravel(), np.stack([rows, rests], axis=1).reshape(-1, ORDER)


@dataclass(frozen=True)
class SegmentDrive(Evaluated):
    """A schedule: segments one after the other from height 0, each from where the previous one ended.

    Afterwards the last height is held.

    Parameters
    ----------
    repeats : int or None
        Number of passes, None: without end; more than one only if the schedule ends at height 0.

    Raises
    ------
    ValueError
        A field is wrong; names each.
    """

    schedule: Sequence[Segment]
    repeats: int | None = 1
    delay: float = 0.0  # s

    def __post_init__(self) -> None:
        if isinstance(self.schedule, Sequence):
            object.__setattr__(self, "schedule", tuple(self.schedule))
        fine = isinstance(self.schedule, tuple) and all(isinstance(segment, Segment) for segment in self.schedule)
        known = self.schedule if fine else ()
        count = sum(segment.cycles for segment in known)
        most = f"one Segment or more, with {MAX_STROKES} cycles at most"
        again = self.repeats == 1 or returns(known)
        wanted = "a whole number or None, and 1 unless the schedule ends at height 0"
        refuse(
            "SegmentDrive",
            [
                (
                    len(known) > 0 and count <= MAX_STROKES,
                    "schedule",
                    most,
                    f"{count} cycles" if known else self.schedule,
                ),
                ((self.repeats is None or whole(self.repeats)) and again, "repeats", wanted, self.repeats),
                (not_negative(self.delay), "delay", "0 or a positive time in s", self.delay),
            ],
        )

    @property
    def stroke_time(self) -> float:
        """The shortest time [s] of one stroke; of a schedule that only holds the whole."""
        shortest = min(segment.stroke_time for segment in self.schedule)
        return shortest if math.isfinite(shortest) else sum(segment.dwell for segment in self.schedule)

    @property
    def frequency(self) -> float:
        """The highest of the segments' frequencies [Hz]; 0 for a schedule that only holds."""
        return max(segment.frequency or 0.0 for segment in self.schedule)

    @property
    def error(self) -> float:
        """0: the pieces are the motion."""
        return 0.0

    def segments(self) -> Segments:
        """Start (S,) and scale (S,) [s] and coefficients (S, 6) [m] of one pass, and how often it repeats."""
        height, parts = 0.0, []
        for segment in self.schedule:
            parts.append(segment.pieces(height))
            height += segment.rise
        scale = np.concatenate([scale for scale, _ in parts])
        start = np.concatenate([[0.0], np.cumsum(scale[:-1])])
        return Segments(start, scale, np.concatenate([rows for _, rows in parts]), float(self.repeats or math.inf))


def returns(schedule: Sequence[Segment]) -> bool:
    """Whether a schedule ends at height 0, up to rounding."""
    rises = [segment.rise for segment in schedule]
    return abs(math.fsum(rises)) <= 1e-12 * max(map(abs, rises), default=0.0)
