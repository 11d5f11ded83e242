"""Drives through given points or by their quintics: heights at rest, measured, analytic and computed motions."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from particle.checks import as_row, not_negative, positive, refuse, times_fault, whole
from particle.drives.pieces import ORDER
from particle.drives.quintics import hermite, through
from particle.drives.table import Evaluated, Segments
from particle.types import FloatArray

RESTS = 1e-12  # of the motions, over a piece: slower ones rest
TIMES = "two or more times in s that increase from 0"


@dataclass(frozen=True, eq=False)
class TableDrive(Evaluated):
    """Heights at given times, at rest and unaccelerated at each, joined by the quintic of a stroke.

    Before the delay the first height is held, after the end the last.

    Parameters
    ----------
    repeats : int or None
        Number of passes, None: without end; more than one only if the table ends where it began.

    Raises
    ------
    ValueError
        A field is wrong; names each.
    """

    times: FloatArray  # (n,) s, increasing from 0
    heights: FloatArray  # (n,) m
    repeats: int | None = 1
    delay: float = 0.0  # s

    def __post_init__(self) -> None:
        for name in ("times", "heights"):
            object.__setattr__(self, name, as_row(getattr(self, name)))
        fault = times_fault(self.times)
        returns = self.heights.size > 0 and self.heights[-1] == self.heights[0]
        again = self.repeats == 1 or returns
        wanted = "a whole number or None, and 1 unless the last height is the first"
        refuse(
            "TableDrive",
            [
                (fault is None, "times", TIMES, Text(fault)),
                row_check("heights", self.heights, self.times, "m"),
                ((self.repeats is None or whole(self.repeats)) and again, "repeats", wanted, self.repeats),
                (not_negative(self.delay), "delay", "0 or a positive time in s", self.delay),
            ],
        )

    @property
    def stroke_time(self) -> float:
        """The shortest time [s] between two neighbouring points of different height; of a level table the whole."""
        moves = np.diff(self.times)[np.diff(self.heights) != 0]
        return float(moves.min(initial=self.times[-1]))

    @property
    def frequency(self) -> float:
        """Of strokes up and down, each as short as the shortest [Hz]; 0 for a level table."""
        return 0.5 / self.stroke_time if np.ptp(self.heights) else 0.0

    @property
    def error(self) -> float:
        """0: the pieces are the motion."""
        return 0.0

    def segments(self) -> Segments:
        """Start (S,) and scale (S,) [s] and coefficients (S, 6) [m] of one pass, and how often it repeats."""
        rest = np.zeros(len(self.times))
        pieces = hermite(self.times, self.heights, rest, rest)
        return Segments(self.times[:-1], *pieces, float(self.repeats or math.inf))


@dataclass(frozen=True, eq=False)
class HermiteDrive(Evaluated):
    """A motion by its height, velocity and acceleration at points in time, joined by quintics.

    It is twice continuously differentiable from the first point to the last. The first height is held before, the
    last afterwards, so a motion that is not at rest there begins and ends with a jump.

    Raises
    ------
    ValueError
        A field is wrong; names each.
    """

    times: FloatArray  # (n,) s, increasing from 0
    heights: FloatArray  # (n,) m
    velocities: FloatArray  # (n,) m/s
    accelerations: FloatArray  # (n,) m/s^2
    delay: float = 0.0  # s
    error: float = 0.0  # of the quintics, over the motion's extent; 0: what was given says no more

    def __post_init__(self) -> None:
        for name in ("times", "heights", "velocities", "accelerations"):
            object.__setattr__(self, name, as_row(getattr(self, name)))
        fault = times_fault(self.times)
        refuse(
            "HermiteDrive",
            [
                (fault is None, "times", TIMES, Text(fault)),
                row_check("heights", self.heights, self.times, "m"),
                row_check("velocities", self.velocities, self.times, "m/s"),
                row_check("accelerations", self.accelerations, self.times, "m/s^2"),
                (not_negative(self.delay), "delay", "0 or a positive time in s", self.delay),
                (not_negative(self.error), "error", "0 or positive", self.error),
            ],
        )

    @classmethod
    def of(cls, function: Callable[[FloatArray], Any], end: float, pieces: int, delay: float = 0.0) -> HermiteDrive:
        """The motion h(t) from 0 to `end` in pieces of equal length.

        Parameters
        ----------
        function : callable
            Of times (n,) in s, returns h in m, h' in m/s and h'' in m/s^2, each (n,) or one number.
        end : float
            End of the motion, s.
        pieces : int
            Number of pieces.
        delay : float
            Rest before the motion, s.

        Returns
        -------
        drive : HermiteDrive
            The motion. Its `error` is the largest difference from h at seven points inside each piece.
        """
        refuse(
            "HermiteDrive.of",
            [
                (positive(end), "end", "a positive time in s", end),
                (whole(pieces), "pieces", "a whole number of pieces", pieces),
            ],
        )
        times = np.linspace(0, end, int(pieces) + 1)
        drive = cls(times, *_three(function, times), delay)
        inside = (times[:-1, None] + np.diff(times)[:, None] * np.arange(1, 8) / 8).ravel()
        truth = _three(function, inside)[0]
        extent = float(np.ptp(np.concatenate([truth, drive.heights])))
        wrong = float(np.abs(cls(*drive._rows()).evaluate(inside)[0] - truth).max())
        return cls(*drive._rows(), delay, wrong / extent if extent else 0.0)

    @property
    def stroke_time(self) -> float:
        """The shortest time [s] between neighbouring turning points, or from the start to the first of them.

        They are where the velocity's line between two points crosses 0; no time is shorter than the shortest piece.
        """
        t, v = self.times, self.velocities
        moving = np.flatnonzero(v)
        one, other = moving[:-1], moving[1:]
        turns = np.sign(v[one]) != np.sign(v[other])
        one, other = one[turns], other[turns]
        turning = t[one] + (t[other] - t[one]) * v[one] / (v[one] - v[other])
        strokes = np.diff(turning, prepend=0.0)
        return float(max(strokes.min(initial=t[-1]), np.diff(t).min()))

    @property
    def frequency(self) -> float:
        """Of strokes up and down, each as short as the shortest [Hz]; 0 for a level motion."""
        return 0.5 / self.stroke_time if self.velocities.any() or np.ptp(self.heights) else 0.0

    def segments(self) -> Segments:
        """Start (S,) and scale (S,) [s] and coefficients (S, 6) [m] of the pieces, and 1: they come once."""
        return Segments(self.times[:-1], *hermite(*self._rows()), 1.0)

    def _rows(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        return self.times, self.heights, self.velocities, self.accelerations


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
    none = np.zeros(len(rows))
    brake = through(value, none, (v, none), (a, none))
    return np.append(edges, edges[-1] + stroke_time), np.concatenate([rows, brake[:, None]], axis=1)


def _three(function: Callable[[FloatArray], Any], times: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """h, h' and h'' of a function at times (n,): three rows (n,)."""
    try:
        h, v, a = (np.broadcast_to(np.asarray(row, dtype=float), times.shape) for row in function(times))
    except (TypeError, ValueError) as error:
        wanted = "return h, h' and h'', each a number or as many as there are times"
        raise ValueError(f"Input function of HermiteDrive.of must {wanted}; got {error}") from None
    return h, v, a


class Text(str):
    """What was got, in words: shown without quotes."""

    def __repr__(self) -> str:
        return str(self)


def row_check(name: str, row: FloatArray, times: ArrayLike, unit: str) -> tuple[bool, str, str, Text]:
    """The check that a row holds one finite number in `unit` for each time."""
    count, bad = np.size(times), row[~np.isfinite(row)]
    fine = len(row) == count > 0 and not bad.size
    return fine, name, f"a finite number in {unit} for each time", Text(bad[0] if bad.size else f"{len(row)} numbers")
