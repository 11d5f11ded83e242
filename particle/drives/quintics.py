"""QuinticDrive: a motion given by its quintics, made for many drives with common breakpoints."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from particle.drives.record import ORDER
from particle.drives.table import Evaluated, FloatArray, Segments

RESTS = 1e-12  # of the motions, over a piece: slower ones rest


@dataclass(frozen=True, eq=False)
class QuinticDrive(Evaluated):
    """A motion by its pieces, which may jump in velocity and acceleration from one to the next.

    It is made by the program, from pieces that it computes, so nothing is checked and nothing copied: drives may share
    the arrays of their times.
    """

    pieces: Segments
    stroke_time: float  # s, the shortest of the strokes that it answers to
    frequency: float  # Hz, of up-and-down strokes; 0 when nothing moves
    error: float = 0.0  # of the pieces, over the motion's extent
    delay: float = 0.0  # s

    def segments(self) -> Segments:
        """The pieces, and how often their pass repeats."""
        return self.pieces


def quintic_drives(
    edges: FloatArray,
    coefficients: FloatArray,
    loop: int | None,
    stroke_time: float,
    frequency: float,
    errors: FloatArray,
) -> list[QuinticDrive]:
    """Drives with common breakpoints from the time 0 on.

    Parameters
    ----------
    edges : array (S+1,)
        Where the pieces begin, from 0, and the end of the last, s.
    coefficients : array (k, S, 6)
        Of each drive's pieces, in (t - start) / length.
    loop : int, optional
        The piece with which the pass begins that repeats without end; None: all come once, and one more piece brings
        what still moves at the end to rest.
    stroke_time, frequency : float
        Of all, s and Hz.
    errors : array (k,)
        Of each.

    Returns
    -------
    drives : list of QuinticDrive
        One for each row of coefficients.
    """
    if loop is None:
        edges, coefficients = _to_rest(edges, coefficients, stroke_time)
    lead = 0 if loop is None else loop
    start, scale = edges[:-1] - edges[lead], np.diff(edges)
    repeats = 1.0 if loop is None else math.inf
    return [
        QuinticDrive(Segments(start, scale, rows, repeats, lead), stroke_time, frequency, float(error))
        for rows, error in zip(coefficients, np.broadcast_to(errors, len(coefficients)), strict=True)
    ]


def _to_rest(edges: FloatArray, rows: FloatArray, stroke_time: float) -> tuple[FloatArray, FloatArray]:
    """The pieces with one more that brings what still moves at the end to rest there, so that nothing jumps."""
    scale = edges[-1] - edges[-2]
    last, powers = rows[:, -1], np.arange(ORDER)
    value, velocity = last.sum(axis=1), last @ powers / scale
    acceleration = last @ (powers * (powers - 1)) / scale**2
    still = RESTS * np.abs(last).max()
    if np.abs(velocity * scale).max() <= still and np.abs(acceleration * scale**2).max() <= still:
        return edges, rows
    v, a = velocity * stroke_time, acceleration * stroke_time**2
    brake = np.stack([value, v, a / 2, -6 * v - 1.5 * a, 8 * v + 1.5 * a, -3 * v - 0.5 * a], axis=1)
    return np.append(edges, edges[-1] + stroke_time), np.concatenate([rows, brake[:, None]], axis=1)
