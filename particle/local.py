"""What the part knows of the surface: the polynomial in (x, y, t) of its cell, up to the next kink of a drive there.

`enter` prepares this scratch memory. In a new cell it multiplies the cell's shapes with the drives that count there;
where only a kink has passed, it moves the polynomial on in time and exchanges the shapes of the drives that had it.
After that an evaluation costs the same for any number of drives.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.cells import NOWHERE, UNBUILT, WHOLE
from particle.drive import ORDER, drive_kink, drive_piece, kink_slack
from particle.jit import bare, jit
from particle.rim import rim_gap

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# Places in Local.frame, Local.counts and a row of Local.clock.
TIME, END, UNIT, X, Y, HALF_X, HALF_Y, CLEAR, SIZE, FLOOR, REACH, MISSING_X, MISSING_Y, BEGUN = range(14)
CELL, DRIVES, NEAR, MONOMIALS, DEGREE, BASE = range(6)
SINCE, UNTIL, SLACK = ORDER, ORDER + 1, ORDER + 2
FRESH = 2.0  # units of time over which a polynomial is moved on; rounding grows with the fifth power of that


class Local(NamedTuple):
    """Scratch memory of one path: all that an evaluation needs, so that little is handed from kernel to kernel.

    Polynomials in time are in (t - frame[TIME]) / frame[UNIT].
    """

    # The times [s] between which it holds and their unit [s], the cell's centre, half width and distance from the rim
    # [m], the surface's size [m] and its floor over that, how many half widths the polynomial holds, and a place [m]
    # that has no cell yet, and when it was prepared from nothing.
    frame: FloatArray  # (14,)
    counts: IntArray  # (6,) the cell, its drives, logarithms, monomials and degree, the base's drives
    smooth: FloatArray  # (6, M + J) m, the cell's polynomial; then the strengths of its logarithms
    at: FloatArray  # (3, M + J) m, these and their first two derivatives in time, at one time
    near: FloatArray  # (J, 2) m, where the logarithms are
    base: FloatArray  # (6, 2) m, where the base is
    clock: FloatArray  # (D, 9) m and s, of each drive its quintic, the time from which that counts, its next kink and
    #                     how close to that is as good as there


@jit
def new_local(surface: Any) -> Local:
    """Scratch memory that fits the surface, with no cell and no time yet."""
    width = _monomials(surface.cells.highest) + surface.cells.most_near
    local = Local(
        np.zeros(14),
        np.zeros(6, dtype=np.int64),
        np.zeros((ORDER, width)),
        np.zeros((3, width)),
        np.zeros((surface.cells.most_near, 2)),
        np.zeros((ORDER, 2)),
        np.zeros((surface.cells.most_drives + 2, ORDER + 3)),
    )
    local.frame[SIZE], local.frame[FLOOR], local.frame[REACH] = (
        surface.size,
        surface.floor / surface.size,
        surface.overhang,
    )
    local.counts[BASE] = 2 * surface.moving_base
    local.counts[CELL] = NOWHERE
    return local


@bare
def _monomials(degree: int) -> int:
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
def enter(surface: Any, local: Local, x: float, y: float, time: float, end: float) -> int:
    """Prepare for points around (x, y) [m] and times from `time` [s] to the next kink, at most `end`: frame[END].

    Returns the cell, or NOWHERE or UNBUILT, whose place is then kept in the frame; then what was prepared before stays.
    """
    cell = cell_at(surface.cells, x, y)
    if cell == UNBUILT:
        local.frame[MISSING_X], local.frame[MISSING_Y] = x, y
    if cell < 0:
        return cell
    same = cell == local.counts[CELL] and time >= local.frame[TIME]
    if same and time < local.frame[END]:
        return cell
    if same:
        go_on(surface, local, time, end)
    else:
        _begin(surface, local, cell, time, end)
    return cell


@bare
def go_on(surface: Any, local: Local, time: float, end: float) -> None:
    """Prepare for later times in the same cell."""
    if not _move_on(surface, local, time, end):
        _begin(surface, local, local.counts[CELL], time, end)


@bare
def within_cell(local: Local, x: float, y: float) -> bool:
    """Whether the cell's polynomial holds at a point [m]."""
    f = local.frame
    return abs(x - f[X]) <= f[REACH] * f[HALF_X] and abs(y - f[Y]) <= f[REACH] * f[HALF_Y]


@bare
def gap_at(surface: Any, local: Local, x: float, y: float) -> float:
    """A distance [m] that a point of the cell is from the rim at least, negative off the plate; exact near the rim."""
    return local.frame[CLEAR] if local.frame[CLEAR] > 0.0 else rim_gap(surface, x, y)


@bare
def _drive(surface: Any, local: Local, i: int) -> int:
    """The drive that is i-th in the cell; the base's two follow the cell's."""
    beyond = i - (local.counts[DRIVES] - local.counts[BASE])
    if beyond >= 0:
        return int(surface.shape_count + beyond)
    return int(surface.cells.drive[surface.cells.first_drive[local.counts[CELL]] + i])


@bare
def _begin(surface: Any, local: Local, cell: int, time: float, end: float) -> None:
    """Prepare for a cell from nothing."""
    cells, f, counts = surface.cells, local.frame, local.counts
    f[X], f[Y] = cells.centre[cell, 0], cells.centre[cell, 1]
    f[HALF_X], f[HALF_Y] = cells.half[cell, 0], cells.half[cell, 1]
    f[CLEAR], f[TIME], f[END], f[UNIT] = cells.clear[cell], time, end, surface.unit
    counts[CELL], f[BEGUN] = cell, time
    counts[DEGREE], counts[MONOMIALS] = cells.degree[cell], _monomials(cells.degree[cell])
    counts[DRIVES] = cells.first_drive[cell + 1] - cells.first_drive[cell] + counts[BASE]
    first = cells.first_near[cell]
    counts[NEAR] = cells.first_near[cell + 1] - first
    for j in range(counts[NEAR]):
        source = cells.near[first + j]
        local.near[j, 0], local.near[j, 1] = surface.sources[source, 0], surface.sources[source, 1]
    for k in range(ORDER):
        for m in range(counts[MONOMIALS] + counts[NEAR]):
            local.smooth[k, m] = 0.0
        local.base[k, 0] = local.base[k, 1] = 0.0
    for i in range(counts[DRIVES]):
        _find_piece(surface, local, i)
        _add(surface, local, i, 1.0)
        f[END] = min(f[END], local.clock[i, UNTIL])


@bare
def _move_on(surface: Any, local: Local, time: float, end: float) -> bool:
    """Move what is prepared on to a later time; False where that is not worth it."""
    f, counts, clock = local.frame, local.counts, local.clock
    passed = 0
    for i in range(counts[DRIVES]):
        passed += _has_passed(clock, i, time)
    if 2 * passed > counts[DRIVES] or time - f[BEGUN] > FRESH * f[UNIT]:
        return False
    shift = (time - f[TIME]) / f[UNIT]
    _shift(local.smooth, shift, counts[MONOMIALS] + counts[NEAR])
    _shift(local.base, shift, 2)
    f[TIME], f[END] = time, end
    for i in range(counts[DRIVES]):
        if _has_passed(clock, i, time):
            _shift_one(clock[i], (time - clock[i, SINCE]) / f[UNIT])
            _add(surface, local, i, -1.0)
            _find_piece(surface, local, i)
            _add(surface, local, i, 1.0)
        f[END] = min(f[END], clock[i, UNTIL])
    return True


@bare
def _has_passed(clock: FloatArray, i: int, time: float) -> bool:
    """Whether the next kink of the i-th drive has come by a time [s]."""
    return bool(clock[i, UNTIL] <= time + clock[i, SLACK])


@bare
def _find_piece(surface: Any, local: Local, i: int) -> None:
    """The quintic of the i-th drive, from frame[TIME] to its next kink."""
    time, unit, drive, row = local.frame[TIME], local.frame[UNIT], _drive(surface, local, i), local.clock[i]
    until = drive_kink(surface.drives, drive, time)
    # It is chosen in the middle of the span, where rounding at its ends cannot mistake it.
    ahead = 0.5 * min(until - time, unit)
    drive_piece(surface.drives, drive, time + ahead, unit, row)
    _shift_one(row, -ahead / unit)
    row[SINCE], row[UNTIL] = time, until
    row[SLACK] = kink_slack(surface.drives, drive, until) if math.isfinite(until) else 0.0


@bare
def _add(surface: Any, local: Local, i: int, sign: float) -> None:
    """Add the quintic of the i-th drive times its shape."""
    cells, counts, piece = surface.cells, local.counts, local.clock[i]
    shapes = counts[DRIVES] - counts[BASE]
    if i >= shapes:
        for k in range(ORDER):
            local.base[k, i - shapes] += sign * piece[k]
        return
    width = counts[MONOMIALS] + counts[NEAR]
    first = cells.first_row[counts[CELL]] + i * width
    for k in range(ORDER):
        c = sign * piece[k]
        if c != 0.0:
            for m in range(width):
                local.smooth[k, m] += cells.rows[first + m] * c


@bare
def _shift(c: FloatArray, shift: float, width: int) -> None:
    """Polynomials (6, width) of s as ones of s - shift."""
    for k in range(ORDER - 1):
        for j in range(ORDER - 2, k - 1, -1):
            for m in range(width):
                c[j, m] += shift * c[j + 1, m]


@bare
def _shift_one(c: FloatArray, shift: float) -> None:
    """A polynomial (6, ...) of s as one of s - shift."""
    for k in range(ORDER - 1):
        for j in range(ORDER - 2, k - 1, -1):
            c[j] += shift * c[j + 1]
