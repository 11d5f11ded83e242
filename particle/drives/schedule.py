"""Schedules: drives whose frequency, stroke and cycle change from one segment to the next."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from particle.checks import finite, not_negative, positive, refuse, whole
from particle.drives.quintic import QUINTIC
from particle.drives.record import ORDER
from particle.drives.strokes import up_down
from particle.drives.table import Evaluated, FloatArray, Segments

MAX_STROKES = 1_000_000


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

    stroke: float | None = None  # m, needed but for "hold"
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
    """Whether a schedule ends at height 0, but for rounding."""
    rises = [segment.rise for segment in schedule]
    return abs(math.fsum(rises)) <= 1e-12 * max(map(abs, rises), default=0.0)
