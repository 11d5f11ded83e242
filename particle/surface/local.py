"""What the part knows of the surface: the polynomial in (x, y, t) of its cell, over the time until it is prepared anew.

`span.enter` prepares this scratch memory.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.drives import ORDER
from particle.jit import bare, jit
from particle.surface.cells import NOWHERE, WHOLE
from particle.surface.rim import rim_gap

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# Places in Local.frame, Local.counts and a row of Local.clock.
TIME, END, UNIT, X, Y, HALF_X, HALF_Y, CLEAR, SIZE, FLOOR, REACH, MISSING_X, MISSING_Y, BEGUN = range(14)
VELOCITY, ACCELERATION, LANDED, LONGEST = range(14, 18)
CELL, DRIVES, NEAR, MONOMIALS, DEGREE, BASE = range(6)
SINCE, UNTIL, SLACK, ROUGH = ORDER, ORDER + 1, ORDER + 2, ORDER + 3


class Local(NamedTuple):
    """Scratch memory of one path: all that an evaluation needs, so that little is handed from kernel to kernel.

    Polynomials in time are in (t - frame[TIME]) / frame[UNIT].
    """

    # The times [s] between which it holds and their unit [s], the cell's centre, half width and distance from the rim
    # [m], the surface's size [m] and its floor over that, how many half widths the polynomial holds, and a place [m]
    # that has no cell yet, and when it was prepared from nothing; by how much [m/s, m/s^2] the surface's motion may be
    # off where kinks are bridged, how rough [m/s^3] a drive is whose kinks are not, and how long [s] a bridge may be.
    frame: FloatArray  # (18,)
    counts: IntArray  # (6,) the cell, its drives, logarithms, monomials and degree, the base's drives
    smooth: FloatArray  # (6, M + J) m, the cell's polynomial; then the strengths of its logarithms
    at: FloatArray  # (3, M + J) m, these and their first two derivatives in time, at one time
    near: FloatArray  # (J, 2) m, where the logarithms are
    base: FloatArray  # (6, 2) m, where the base is
    ahead: FloatArray  # (6,) m, a drive's quintic at the end of the span
    clock: FloatArray  # (D, 10) m and s, of each drive its quintic, the time from which that counts, until when it
    #                     does, how close to that is as good as there, and how rough [m/s^3] it is in the cell


@jit
def new_local(surface: Any) -> Local:
    """Scratch memory that fits the surface, with no cell and no time yet."""
    width = monomial_count(surface.cells.highest) + surface.cells.most_near
    local = Local(
        np.zeros(18),
        np.zeros(6, dtype=np.int64),
        np.zeros((ORDER, width)),
        np.zeros((3, width)),
        np.zeros((surface.cells.most_near, 2)),
        np.zeros((ORDER, 2)),
        np.zeros(ORDER),
        np.zeros((surface.cells.most_drives + 2, ORDER + 4)),
    )
    prepare(surface, local)
    return local


@jit
def prepare(surface: Any, local: Local) -> None:
    """Scratch memory of a surface before there is a cell and a time."""
    local.frame[:] = 0.0
    local.frame[SIZE], local.frame[FLOOR], local.frame[REACH] = (
        surface.size,
        surface.floor / surface.size,
        surface.overhang,
    )
    local.counts[BASE] = 2 * surface.moving_base
    local.counts[CELL] = NOWHERE


@bare
def monomial_count(degree: int) -> int:
    """How many monomials x^i y^j there are up to a degree."""
    return (degree + 1) * (degree + 2) // 2


def missing_place(local: Local) -> FloatArray:
    """The place (1, 2) [m] where `enter` found no cell."""
    return local.frame[None, [MISSING_X, MISSING_Y]]


@bare
def cell_at(cells: Any, x: float, y: float) -> int:
    """The cell that holds a point [m]; NOWHERE when there is no plate, UNBUILT when there may be."""
    if not math.isfinite(cells.width[0]):
        return 0
    i = _interval(x - cells.origin[0], cells.width[0], cells.roots.shape[0])
    j = _interval(y - cells.origin[1], cells.width[1], cells.roots.shape[1])
    if i == NOWHERE or j == NOWHERE:
        return NOWHERE
    cell = int(cells.roots[i, j])
    while cell >= 0 and cells.quarters[cell] != WHOLE:
        cell = int(cells.quarters[cell]) + 2 * (x >= cells.centre[cell, 0]) + (y >= cells.centre[cell, 1])
    return NOWHERE if cell >= 0 and cells.first_row[cell] == NOWHERE else cell


@bare
def _interval(along: float, width: float, count: int) -> int:
    """Which of `count` intervals of a width holds a coordinate; the outer edges belong to the outer ones."""
    place = int(math.floor(along / width))
    if place == count and along <= (count + 1e-6) * width:
        return count - 1
    if place == -1 and along >= -1e-6 * width:
        return 0
    return place if 0 <= place < count else NOWHERE


@bare
def within_cell(local: Local, x: float, y: float) -> bool:
    """Whether the cell's polynomial holds at a point [m]."""
    f = local.frame
    return abs(x - f[X]) <= f[REACH] * f[HALF_X] and abs(y - f[Y]) <= f[REACH] * f[HALF_Y]


@bare
def gap_at(surface: Any, local: Local, x: float, y: float) -> float:
    """A distance [m] that a point of the cell is from the rim at least, negative off the plate; exact near the rim."""
    return local.frame[CLEAR] if local.frame[CLEAR] > 0.0 else rim_gap(surface, x, y)
