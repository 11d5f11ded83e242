"""Strokes up and down, begun anywhere in their cycle."""

from __future__ import annotations

import math

import numpy as np

from particle.drives.quintic import QUINTIC
from particle.drives.record import MERGED, ORDER
from particle.drives.table import FloatArray, Segments, joined

Pass = tuple[FloatArray, FloatArray, FloatArray]
"""Starts (S,) and scales (S,) [s] and coefficients (S, 6) [m] of pieces, the first from 0 on."""


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
