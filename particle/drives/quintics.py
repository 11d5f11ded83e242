"""QuinticDrive: a motion given by its quintics, made for many drives with common breakpoints."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from particle.drives.table import Evaluated, FloatArray, Segments


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
        The piece with which the pass begins that repeats without end; None: all come once, and the end is held.
    stroke_time, frequency : float
        Of all, s and Hz.
    errors : array (k,)
        Of each.

    Returns
    -------
    drives : list of QuinticDrive
        One for each row of coefficients.
    """
    lead = 0 if loop is None else loop
    start, scale = edges[:-1] - edges[lead], np.diff(edges)
    repeats = 1.0 if loop is None else math.inf
    return [
        QuinticDrive(Segments(start, scale, rows, repeats, lead), stroke_time, frequency, float(error))
        for rows, error in zip(coefficients, np.broadcast_to(errors, len(coefficients)), strict=True)
    ]
