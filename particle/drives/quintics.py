"""Quintics of strokes up and down and of waves, begun anywhere in their cycle, and through given points.

Waves are in cycles: they grow from rest and decay to it.
"""

from __future__ import annotations

import math

import numpy as np

from particle.drives.pieces import MERGED, ORDER, hermite_end
from particle.drives.table import Segments, joined
from particle.types import FloatArray

QUINTIC = np.array([0.0, 0.0, 0.0, 10.0, -15.0, 6.0])  # from 0 to 1 with no velocity and acceleration at either end
WAVES = ("sine", "cosine")
PIECES = 128  # of a period
# Of quintics through a sine's height, velocity and acceleration that far apart: step^6 / (6! 2^6), over the amplitude.
SINE_ERROR = (2 * math.pi / PIECES) ** 6 / 46080
RAMPS = (0.01, 1000)  # cycles, the shortest and the longest
WHOLE = 1e-12  # cycles: less is rounding
# The largest of the ramp's factor and its derivatives from the first to the fifth.
_FACTORS = (1.0, 1.875, 10 / math.sqrt(3), 60.0, 360.0, 720.0)
_FACTOR = [np.polynomial.Polynomial(QUINTIC).deriv(order) for order in range(3)]

Ends = tuple[FloatArray, FloatArray]
Values = tuple[FloatArray, FloatArray, FloatArray]
Pass = tuple[FloatArray, FloatArray, FloatArray]
"""Starts (S,) and scales (S,) [s] and coefficients (S, 6) [m] of pieces, the first from 0 on."""


def hermite(times: FloatArray, h: FloatArray, v: FloatArray, a: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The quintics between times (n,) [s] with heights [m], velocities and accelerations (n,) given at each.

    Returns their scales (n-1,) [s] and coefficients (n-1, 6) [m] in (t - start) / scale.
    """
    scale = np.diff(times)
    return scale, through(h[:-1], np.diff(h), (v[:-1] * scale, v[1:] * scale), (a[:-1] * scale**2, a[1:] * scale**2))


def through(height: FloatArray, rise: FloatArray, first: Ends, second: Ends) -> FloatArray:
    """Quintics on [0, 1] (n, 6) from heights (n,) on, by how much they rise and their derivatives at both ends."""
    return np.stack([height, first[0], 0.5 * second[0], *hermite_end(rise, *first, *second)], axis=1)


def up_down(stroke: float, frequency: float, dwell: float) -> Pass:
    """One stroke up and down, each with a dwell [s] after it."""
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


def begun_at(turns: float, cycle: Pass, repeats: float) -> Segments:
    """A cycle over and over, begun at a share of it in [0, 1): first its remainder, at the end the share skipped."""
    start, scale, rows = cycle
    span = start[-1] + scale[-1]
    k = int(np.searchsorted(start, turns * span, side="right")) - 1
    share = float((turns * span - start[k]) / scale[k])
    if share > 1 - MERGED:
        k, share = k + 1, 0.0
    if k == len(start) or (k == 0 and share < MERGED):
        return Segments(start, scale, rows, repeats)
    before = _part(cycle, slice(0, k + 1), 0.0, share) if share >= MERGED else tuple(part[:k] for part in cycle)
    after = _part(cycle, slice(k, None), share, 1.0) if share >= MERGED else tuple(part[k:] for part in cycle)
    lead = (after[0] - span, *after[1:])
    return joined(lead, cycle, before if math.isfinite(repeats) else None, repeats - 1)


def _part(cycle: Pass, pieces: slice, low: float, high: float) -> Pass:
    """Pieces of a cycle, the first from a share of it on if that is above 0, else the last up to a share of it."""
    start, scale, rows = (part[pieces].copy() for part in cycle)
    k = 0 if low > 0 else -1
    # Taylor's shift of the polynomial to `low`, by repeated Horner; then the rest is its unit.
    for i in range(ORDER - 1):
        for j in range(ORDER - 2, i - 1, -1):
            rows[k, j] += low * rows[k, j + 1]
    rows[k] *= (high - low) ** np.arange(ORDER)
    start[k] += low * scale[k]
    scale[k] *= high - low
    return start, scale, rows


def wave(cycle: str, turns: float, ramp: float, cycles: int | None) -> Segments:
    """A wave of height 1, with times in cycles.

    turns: the share of a cycle at which it begins, in [0, 1).  ramp: cycles over which it grows, and decays at the end.
    """
    grid, begin = np.arange(PIECES + 1) / PIECES, (turns + ramp) % 1.0
    places = np.mod(begin + grid, 1.0)
    places[-1] = places[0]  # a pass ends where it began, to the bit
    pieces = grid[:-1], *hermite(grid, *_values(cycle, places))
    if ramp == 0:
        return Segments(*pieces, float(cycles or math.inf))
    growth = np.linspace(0.0, 1.0, _pieces(ramp) + 1)
    lead = _ramped(cycle, begin, ramp * (growth - 1), growth, ramp)
    if cycles is None:
        return joined(lead, pieces, None, math.inf)
    passes = math.floor(cycles - 2 * ramp + WHOLE)
    rest = max(cycles - 2 * ramp - passes, 0.0)
    steady = np.linspace(0.0, rest, math.ceil(PIECES * rest) + 1)[:-1] if rest > WHOLE else np.zeros(0)
    times = np.concatenate([steady, rest + ramp * growth])
    tail = _ramped(cycle, begin, times, np.concatenate([np.ones(len(steady)), 1 - growth]), -ramp)
    return joined(lead, pieces, tail, passes)


def _pieces(ramp: float) -> int:
    """How many pieces a ramp takes to be as exact as the wave, by the largest sixth derivative of their product."""
    sixth = sum(math.comb(6, k) * factor / (2 * math.pi * ramp) ** k for k, factor in enumerate(_FACTORS))
    return math.ceil(PIECES * ramp * sixth ** (1 / 6))


def _ramped(cycle: str, begin: float, times: FloatArray, growth: FloatArray, ramp: float) -> tuple[FloatArray, ...]:
    """Pieces of a wave between times (k,) [cycles], from how far it has grown at each (k,), in [0, 1].

    begin: its share of a cycle at the time 0.  ramp: cycles over which it grows; negative: decays.
    """
    h, v, a = _values(cycle, np.mod(begin + times, 1.0))
    factor, rate, bend = (_FACTOR[order](growth) / ramp**order for order in range(3))
    ends = growth == 0
    factor[ends] = rate[ends] = bend[ends] = 0.0
    rate[growth == 1] = bend[growth == 1] = 0.0
    return times[:-1], *hermite(times, factor * h, rate * h + factor * v, bend * h + 2 * rate * v + factor * a)


def _values(cycle: str, turns: FloatArray) -> Values:
    """Height, velocity and acceleration of a wave of height 1 at shares of a cycle (k,), per cycle."""
    rate = 2 * math.pi
    sine, cosine = _sine_of_turns(turns), _sine_of_turns(turns + 0.25)
    if cycle == "sine":
        return sine, rate * cosine, -(rate**2) * sine
    return 0.5 - 0.5 * cosine, 0.5 * rate * sine, 0.5 * rate**2 * cosine


def _sine_of_turns(turns: FloatArray) -> FloatArray:
    """sin(2 pi turns), exactly 0 and 1 where it should be."""
    quarter = np.mod(4 * turns, 2)  # the sine of one half turn, from 0 to 1 and back
    sign = np.where(np.mod(turns, 1) < 0.5, 1.0, -1.0)
    return sign * np.sin(0.5 * math.pi * np.minimum(quarter, 2 - quarter))
