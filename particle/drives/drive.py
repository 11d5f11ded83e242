"""Drives: how far an actuator is raised over time, as polynomials of degree five between breakpoints."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from particle.checks import finite, not_negative, positive, refuse, whole
from particle.drives.quintic import QUINTIC, hermite
from particle.drives.record import ORDER
from particle.drives.table import Evaluated, FloatArray, Segments

CYCLES = ("up-down", "up", "sine", "cosine")
PIECES = 128  # of a period of a sine
# Of quintics through a sine's height, velocity and acceleration that far apart: step^6 / (6! 2^6), over the amplitude.
SINE_ERROR = (2 * math.pi / PIECES) ** 6 / 46080


@dataclass(frozen=True)
class Drive(Evaluated):
    """The stroke h(t) of one actuator, repeated or once.

    Strokes follow the quintic 10 s^3 - 15 s^4 + 6 s^5, at rest and unaccelerated at both ends. Sines and cosines are
    quintics through 128 points a period, C2 between them; `error` states how far off they are.

    Parameters
    ----------
    cycle : str
        `"up-down"`: up in half of 1/frequency, down in the other half, each followed by `dwell` at rest. `"up"`: up
        once in 1/frequency, then held. `"sine"`: stroke sin(2 pi f t), which begins and ends with a jump of velocity.
        `"cosine"`: stroke (1 - cos(2 pi f t)) / 2, from 0 up and back, which begins and ends with one of
        acceleration.
    cycles : int, optional
        Number of periods, by default without end; not for `"up"`.

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

    def __post_init__(self) -> None:
        counts = self.cycles is None or (self.cycle != "up" and whole(self.cycles))
        waits = not_negative(self.dwell) and (self.dwell == 0 or self.cycle == "up-down")
        refuse(
            "Drive",
            [
                (finite(self.stroke), "stroke", "a finite length in m", self.stroke),
                (positive(self.frequency), "frequency", "positive, in Hz", self.frequency),
                (self.cycle in CYCLES, "cycle", "'up-down', 'up', 'sine' or 'cosine'", self.cycle),
                (counts, "cycles", "a whole number of cycles, of any but 'up', or None", self.cycles),
                (not_negative(self.delay), "delay", "0 or a positive time in s", self.delay),
                (waits, "dwell", "0 or a positive time in s, the latter for 'up-down' only", self.dwell),
            ],
        )

    @property
    def stroke_time(self) -> float:
        """The time [s] of one stroke: half a cycle, or the whole of an up drive."""
        return (1.0 if self.cycle == "up" else 0.5) / self.frequency

    @property
    def error(self) -> float:
        """Of the quintics that stand for a sine, over the stroke; 0 for the other cycles, which are quintics."""
        return {"sine": SINE_ERROR, "cosine": SINE_ERROR / 2}.get(self.cycle, 0.0)

    def segments(self) -> Segments:
        """Start (S,) and scale (S,) [s] and coefficients (S, 6) [m] of one pass, and how often it repeats."""
        repeats = float(self.cycles or math.inf)
        if self.cycle == "up":
            return np.zeros(1), np.array([1 / self.frequency]), self.stroke * QUINTIC[None], 1.0
        if self.cycle == "up-down":
            return *up_down(self.stroke, self.frequency, self.dwell), repeats
        phase = np.arange(PIECES + 1) / PIECES  # in periods
        rate = 2 * math.pi
        sine, cosine = _sine_of_turns(phase), _sine_of_turns(phase + 0.25)
        if self.cycle == "sine":
            scale, rows = hermite(phase, sine, rate * cosine, -(rate**2) * sine)
        else:
            scale, rows = hermite(phase, 0.5 - 0.5 * cosine, 0.5 * rate * sine, 0.5 * rate**2 * cosine)
        return phase[:-1] / self.frequency, scale / self.frequency, self.stroke * rows, repeats


def up_down(stroke: float, frequency: float, dwell: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """One stroke up and down, each with a dwell [s] after it: starts (S,), scales (S,), coefficients (S, 6)."""
    half = 0.5 / frequency
    rise = stroke * QUINTIC
    fall = -rise
    fall[0] = stroke
    if dwell == 0:
        return np.array([0, half]), np.array([half, half]), np.array([rise, fall])
    top, bottom = np.zeros((2, ORDER))
    top[0] = stroke
    scale = np.array([half, dwell, half, dwell])
    return np.concatenate([[0], np.cumsum(scale[:-1])]), scale, np.array([rise, top, fall, bottom])


def _sine_of_turns(turns: FloatArray) -> FloatArray:
    """sin(2 pi turns), exactly 0 and 1 where it should be."""
    quarter = np.mod(4 * turns, 2)  # the sine of one half turn, from 0 to 1 and back
    sign = np.where(np.mod(turns, 1) < 0.5, 1.0, -1.0)
    return sign * np.sin(0.5 * math.pi * np.minimum(quarter, 2 - quarter))
