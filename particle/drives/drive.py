"""Drives: how far an actuator is raised over time, as polynomials of degree five between breakpoints."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from particle.checks import finite, not_negative, positive, refuse, whole
from particle.drives.quintic import QUINTIC
from particle.drives.sines import RAMPS, SINE_ERROR, WAVES, wave
from particle.drives.strokes import begun_at, up_down
from particle.drives.table import Evaluated, Segments

CYCLES = ("up-down", "up", *WAVES)


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
