"""Spans: the times over which a cell's surface is one polynomial in time, from one kink of its drives to the next.

`enter` prepares a span. In a new cell it multiplies the cell's shapes with the drives that count there; later it moves
the polynomial on in time and exchanges the shapes of the drives that had a kink. After that an evaluation costs the
same for any number of drives.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from particle.drives import ORDER, drive_kink, drive_piece, kink_slack
from particle.jit import bare
from particle.surface.bridge import bridge, drive_of, find_end, find_roughness, is_bridged
from particle.surface.cells import UNBUILT
from particle.surface.local import (
    BASE,
    BEGUN,
    CELL,
    CLEAR,
    DEGREE,
    DRIVES,
    END,
    HALF_X,
    HALF_Y,
    LONGEST,
    MISSING_X,
    MISSING_Y,
    MONOMIALS,
    NEAR,
    SINCE,
    SLACK,
    TIME,
    UNIT,
    UNTIL,
    Local,
    X,
    Y,
    cell_at,
    monomial_count,
)

FloatArray = NDArray[np.float64]

FRESH = 2.0  # units of time over which a polynomial is moved on; rounding grows with the fifth power of that


@bare
def enter(surface: Any, local: Local, x: float, y: float, time: float, end: float) -> int:
    """Prepare for points around (x, y) [m] and times from `time` [s] to the span's end, at most `end`: frame[END].

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
def _begin(surface: Any, local: Local, cell: int, time: float, end: float) -> None:
    """Prepare for a cell from nothing."""
    cells, f, counts = surface.cells, local.frame, local.counts
    f[X], f[Y] = cells.centre[cell, 0], cells.centre[cell, 1]
    f[HALF_X], f[HALF_Y] = cells.half[cell, 0], cells.half[cell, 1]
    f[CLEAR], f[TIME], f[UNIT] = cells.clear[cell], time, surface.unit
    counts[CELL], f[BEGUN] = cell, time
    counts[DEGREE], counts[MONOMIALS] = cells.degree[cell], monomial_count(cells.degree[cell])
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
        find_roughness(surface, local, i)
    f[LONGEST] = 0.0
    find_end(surface, local, end)
    for i in range(counts[DRIVES]):
        bridge(surface, local, i)
        _add(surface, local, i, 1.0)


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
    f[TIME] = time
    for i in range(counts[DRIVES]):
        if _has_passed(clock, i, time):
            _take_out(surface, local, i)
            _find_piece(surface, local, i)
    find_end(surface, local, end)
    for i in range(counts[DRIVES]):
        exchanged = clock[i, SINCE] == time
        if not exchanged and is_bridged(local, i):
            _take_out(surface, local, i)
            exchanged = True
        if exchanged:
            bridge(surface, local, i)
            _add(surface, local, i, 1.0)
    return True


@bare
def _has_passed(clock: FloatArray, i: int, time: float) -> bool:
    """Whether the i-th drive needs another piece from a time [s] on."""
    return bool(clock[i, UNTIL] <= time + clock[i, SLACK])


@bare
def _find_piece(surface: Any, local: Local, i: int) -> None:
    """The quintic of the i-th drive, from frame[TIME] to its next kink."""
    time, unit, drive, row = local.frame[TIME], local.frame[UNIT], drive_of(surface, local, i), local.clock[i]
    until = drive_kink(surface.drives, drive, time)
    # It is chosen in the middle of the span, where rounding at its ends cannot mistake it.
    ahead = 0.5 * min(until - time, unit)
    drive_piece(surface.drives, drive, time + ahead, unit, row)
    _shift_one(row, -ahead / unit)
    row[SINCE], row[UNTIL] = time, until
    row[SLACK] = kink_slack(surface.drives, drive, until) if math.isfinite(until) else 0.0


@bare
def _take_out(surface: Any, local: Local, i: int) -> None:
    """Move the quintic of the i-th drive on to frame[TIME], and take its shape out."""
    row = local.clock[i]
    _shift_one(row, (local.frame[TIME] - row[SINCE]) / local.frame[UNIT])
    row[SINCE] = local.frame[TIME]
    _add(surface, local, i, -1.0)


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
