"""Where a part is, how it moves, and how far its path has come."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from particle.records import Record
from particle.types import FloatArray

INTEGRATED = 6  # numbers of a motion that a Runge-Kutta step integrates, the first ones
SIZE = 8  # numbers of a motion


class Motion(Record):
    """The state of a part, or its rate in time."""

    x: float  # m
    y: float
    v_x: float  # m/s; on the slow manifold the sliding speed u
    v_y: float  # m/s; on the slow manifold 0
    work: float  # J, done by the surface since the start
    dissipated: float  # J, since the start
    z: float  # m, of a flying part
    v_z: float  # m/s


class Now(Record):
    """What the part does."""

    mode: int  # Mode
    time: float  # s
    h: float  # s, the next step
    span_end: float  # s, until which the surface is prepared
    verdict: int  # Verdict
    gap: float  # m, from the rim, where a step starts


class Counts(Record):
    """How much work a path took."""

    evaluations: int  # of the surface
    spans: int
    long_steps: int


def as_numbers(motions: NDArray[Motion]) -> FloatArray:
    """The same memory as numbers (n, SIZE)."""
    return motions.view(np.float64).reshape(len(motions), SIZE)
