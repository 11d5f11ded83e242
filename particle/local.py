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
from particle.jit import jit
from particle.rim import rim_gap

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# Places in Local.frame and in Local.counts.
TIME, END, UNIT, X, Y, HALF_X, HALF_Y, CLEAR = range(8)
CELL, DRIVES, FIRST_NEAR, NEAR, CHANGES = range(5)
FRESH = 8  # times as many changes as there are drives: then rounding has piled up enough to begin anew


class Local(NamedTuple):
    """Scratch memory of one path; polynomials in time are in (t - frame[TIME]) / frame[UNIT]."""

    frame: FloatArray  # (8,) the times [s] it holds from and up to, their unit [s], the cell's centre, half width
    #                    and distance from the rim [m]
    counts: IntArray  # (5,) the cell, its drives (the base's included), its logarithms: first and how many, changes
    missing: FloatArray  # (2,) m, a place on the plate that has no cell yet
    pieces: FloatArray  # (D, 6) m, the quintic of each drive
    since: FloatArray  # (D,) s, the time from which that counts
    until: FloatArray  # (D,) s, the next kink of each
    smooth: FloatArray  # (6, M + J) m, the cell's polynomial; then the strengths of its logarithms
    at: FloatArray  # (3, M + J) m, these and their first two derivatives in time, at one time
    base: FloatArray  # (6, 2) m, where the base is


@jit
def new_local(surface: Any) -> Local:
    """Scratch memory that fits the surface, with no cell and no time yet."""
    cells = surface.cells
    drives = cells.most_drives + 2
    width = (surface.degree + 1) * (surface.degree + 2) // 2 + cells.most_near
    counts = np.zeros(5, dtype=np.int64)
    counts[CELL] = NOWHERE
    return Local(
        np.zeros(8),
        counts,
        np.zeros(2),
        np.zeros((drives, ORDER)),
        np.zeros(drives),
        np.zeros(drives),
        np.zeros((ORDER, width)),
        np.zeros((3, width)),
        np.zeros((ORDER, 2)),
    )


@jit
def forget(local: Local) -> None:
    """Make the memory good for another path."""
    local.counts[CELL] = NOWHERE


@jit
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


@jit
def _interval(along: float, width: float, count: int) -> int:
    """Which of `count` intervals of a width holds a coordinate; the outer edges belong to the outer ones."""
    place = int(math.floor(along / width))
    if place == count and along <= (count + 1e-6) * width:
        return count - 1
    if place == -1 and along >= -1e-6 * width:
        return 0
    return place if 0 <= place < count else NOWHERE


@jit
def enter(surface: Any, local: Local, x: float, y: float, time: float, end: float) -> int:
    """Prepare for points around (x, y) [m] and times from `time` [s] to the next kink, at most `end`: frame[END].

    Returns the cell, or NOWHERE or UNBUILT, which goes into `missing`; then what was prepared before stays.
    """
    cell = cell_at(surface.cells, x, y)
    if cell == UNBUILT:
        local.missing[0], local.missing[1] = x, y
    if cell < 0:
        return cell
    same = cell == local.counts[CELL] and time >= local.frame[TIME]
    if same and time < local.frame[END]:
        return cell
    if not (same and _go_on(surface, local, time, end)):
        _begin(surface, local, cell, time, end)
    return cell


@jit
def within_cell(surface: Any, local: Local, x: float, y: float) -> bool:
    """Whether the cell's polynomial holds at a point [m]."""
    f = local.frame
    return abs(x - f[X]) <= surface.overhang * f[HALF_X] and abs(y - f[Y]) <= surface.overhang * f[HALF_Y]


@jit
def gap_at(surface: Any, local: Local, x: float, y: float) -> float:
    """A distance [m] that a point of the cell is from the rim at least, negative off the plate; exact near the rim."""
    return local.frame[CLEAR] if local.frame[CLEAR] > 0.0 else rim_gap(surface, x, y)


@jit
def _drive(surface: Any, local: Local, i: int) -> int:
    """The drive that is i-th in the cell; the base's two follow the cell's."""
    beyond = i - (local.counts[DRIVES] - 2 * surface.moving_base)
    if beyond >= 0:
        return int(surface.shape_count + beyond)
    return int(surface.cells.drive[surface.cells.first_drive[local.counts[CELL]] + i])


@jit
def _begin(surface: Any, local: Local, cell: int, time: float, end: float) -> None:
    """Prepare for a cell from nothing."""
    cells, f, counts = surface.cells, local.frame, local.counts
    f[X], f[Y] = cells.centre[cell]
    f[HALF_X], f[HALF_Y] = cells.half[cell]
    f[CLEAR], f[TIME], f[END], f[UNIT] = cells.clear[cell], time, end, surface.unit
    counts[CELL], counts[CHANGES] = cell, 0
    counts[DRIVES] = cells.first_drive[cell + 1] - cells.first_drive[cell] + 2 * surface.moving_base
    counts[FIRST_NEAR] = cells.first_near[cell]
    counts[NEAR] = cells.first_near[cell + 1] - cells.first_near[cell]
    local.smooth[:] = 0.0
    local.base[:] = 0.0
    for i in range(counts[DRIVES]):
        local.until[i] = drive_kink(surface.drives, _drive(surface, local, i), time)
        f[END] = min(f[END], local.until[i])
    for i in range(counts[DRIVES]):
        _find_piece(surface, local, i)
        _add(surface, local, i, local.pieces[i])


@jit
def _go_on(surface: Any, local: Local, time: float, end: float) -> bool:
    """Move what is prepared on to a later time; False where that is not worth it."""
    f, counts = local.frame, local.counts
    passed = 0
    for i in range(counts[DRIVES]):
        passed += local.until[i] <= time + kink_slack(surface.drives, _drive(surface, local, i), time)
    counts[CHANGES] += passed
    if 2 * passed > counts[DRIVES] or counts[CHANGES] > FRESH * counts[DRIVES]:
        return False
    shift = (time - f[TIME]) / f[UNIT]
    _shift(local.smooth, shift)
    _shift(local.base, shift)
    f[TIME], f[END] = time, end
    change = np.zeros(ORDER)
    for i in range(counts[DRIVES]):
        drive = _drive(surface, local, i)
        if local.until[i] <= time + kink_slack(surface.drives, drive, time):
            local.until[i] = drive_kink(surface.drives, drive, time)
            change[:] = local.pieces[i]
            _shift_one(change, (time - local.since[i]) / f[UNIT])
            _find_piece(surface, local, i)
            for k in range(ORDER):
                change[k] = local.pieces[i, k] - change[k]
            _add(surface, local, i, change)
        f[END] = min(f[END], local.until[i])
    return True


@jit
def _find_piece(surface: Any, local: Local, i: int) -> None:
    """The quintic of the i-th drive, from frame[TIME] to its next kink."""
    time, unit, piece = local.frame[TIME], local.frame[UNIT], local.pieces[i]
    # It is chosen in the middle of the span, where rounding at its ends cannot mistake it.
    ahead = 0.5 * min(local.until[i] - time, unit)
    piece[:] = drive_piece(surface.drives, _drive(surface, local, i), time + ahead, unit)
    _shift_one(piece, -ahead / unit)
    local.since[i] = time


@jit
def _add(surface: Any, local: Local, i: int, piece: FloatArray) -> None:
    """Add a quintic (6,) times the shape of the i-th drive."""
    cells, counts = surface.cells, local.counts
    shapes = counts[DRIVES] - 2 * surface.moving_base
    if i >= shapes:
        for k in range(ORDER):
            local.base[k, i - shapes] += piece[k]
        return
    width = (surface.degree + 1) * (surface.degree + 2) // 2 + counts[NEAR]
    first = cells.first_row[counts[CELL]] + i * width
    row = cells.rows[first : first + width]
    for k in range(ORDER):
        if piece[k] != 0.0:
            for m in range(width):
                local.smooth[k, m] += row[m] * piece[k]


@jit
def _shift(c: FloatArray, shift: float) -> None:
    """Polynomials (6, n) of s as ones of s - shift."""
    for k in range(ORDER - 1):
        for j in range(ORDER - 2, k - 1, -1):
            for m in range(c.shape[1]):
                c[j, m] += shift * c[j + 1, m]


@jit
def _shift_one(c: FloatArray, shift: float) -> None:
    """A polynomial (6,) of s as one of s - shift."""
    for k in range(ORDER - 1):
        for j in range(ORDER - 2, k - 1, -1):
            c[j] += shift * c[j + 1]
