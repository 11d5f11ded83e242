"""Spans: the times over which a cell's surface is one polynomial in time, between breakpoints of its drives.

`enter` prepares a span. In a new cell it multiplies the cell's shapes with the drives that count there. Later it moves
the polynomial on in time and exchanges the shapes of the drives that had a breakpoint. An evaluation then costs the
same for any number of drives.
"""

from __future__ import annotations

import math

from particle.drives import (
    NO_SEGMENT,
    ORDER,
    breakpoint_slack,
    drive_breakpoint,
    expand_piece,
    find_piece,
    shift_quintic,
)
from particle.jit import device_no_arrays, spliced
from particle.lanes import LANES, load, nought, store
from particle.surface.bridge import bridge, drive_of, find_end, find_jump, is_bridged, shapes_in_cell
from particle.surface.cells import UNBUILT, Cell
from particle.surface.local import Clock, Frame, LocalSurface, cell_at, monomial_count
from particle.surface.record import Surface
from particle.types import FloatArray

MANY = 4  # where one drive in so many has passed a breakpoint, preparing a cell from nothing costs less
MAX_SHIFT = 2.0  # units of time over which a polynomial is moved on; rounding grows with the fifth power of that


@device_no_arrays
def enter(surface: Surface, local: LocalSurface, x: float, y: float, time: float, end: float) -> int:
    """Prepare for points around (x, y) [m] and times from `time` [s] to the span's end, at most `end`: frame.end.

    Returns the cell, or NOWHERE or UNBUILT, whose place is then kept in the frame; then what was prepared before stays.
    """
    frame: Frame = local.frame[0]
    cell = cell_at(surface.cells, x, y)
    if cell == UNBUILT:
        frame.missing_x, frame.missing_y = x, y
    if cell < 0:
        return cell
    same = cell == frame.cell and time >= frame.time
    if same and time < frame.end:
        return cell
    if not (same and _move_on(surface, local, time, end)):
        _begin(surface, local, cell, time, end)
    return cell


@device_no_arrays
def _begin(surface: Surface, local: LocalSurface, cell: int, time: float, end: float) -> None:
    """Prepare for a cell from nothing."""
    frame: Frame = local.frame[0]
    entered: Cell = surface.cells.cell[cell]
    frame.x, frame.y = entered.x, entered.y
    frame.half_x, frame.half_y = entered.half_x, entered.half_y
    frame.clear, frame.time, frame.unit = entered.clear, time, surface.unit
    frame.cell, frame.begun, frame.moment = cell, time, math.nan
    frame.degree, frame.monomials = entered.degree, monomial_count(entered.degree)
    frame.drives = entered.drives + frame.in_plane + frame.base_drives
    frame.plane_degree, frame.plane_monomials = entered.plane_degree, monomial_count(entered.plane_degree)
    frame.logarithms = entered.logarithms
    for j in range(frame.logarithms):
        source = surface.cells.near[entered.first_near + j]
        local.sources[j, 0], local.sources[j, 1] = surface.sources[source, 0], surface.sources[source, 1]
    for i in range(frame.drives):
        _find_piece(surface, local, i)
        find_jump(surface, local, i)
    frame.max_bridge = 0.0
    find_end(surface, local, end)
    for i in range(frame.drives):
        bridge(surface, local, i)
    count, width, first = entered.drives, frame.monomials + frame.logarithms, entered.first_row
    _sum_rows(local.smooth, surface.cells.rows[first : first + count * width], width, local.pieces[:count])
    if frame.in_plane > 0:
        moved, width, first = (
            local.pieces[count : count + frame.in_plane],
            2 * frame.plane_monomials,
            entered.first_plane,
        )
        _sum_rows(local.plane, surface.cells.plane_rows[first : first + len(moved) * width], width, moved)
    for k in range(ORDER):
        local.base[k, 0] = local.base[k, 1] = local.base[k, 2] = 0.0
    for i in range(count + frame.in_plane, frame.drives):
        _add(surface, local, i, 1.0)


@device_no_arrays
def _move_on(surface: Surface, local: LocalSurface, time: float, end: float) -> bool:
    """Move what is prepared on to a later time; False where that is not worth it."""
    frame: Frame = local.frame[0]
    clock = local.clock
    passed = 0
    for i in range(frame.drives):
        passed += _has_passed(clock[i], time)
    if MANY * passed > frame.drives or time - frame.begun > MAX_SHIFT * frame.unit:
        return False
    shift = (time - frame.time) / frame.unit
    _shift(local.smooth, shift, frame.monomials + frame.logarithms)
    _shift(local.base, shift, 3)
    if frame.in_plane > 0:
        _shift(local.plane, shift, 2 * frame.plane_monomials)
    frame.time, frame.moment = time, math.nan
    for i in range(frame.drives):
        if _has_passed(clock[i], time):
            _take_out(surface, local, i)
            _find_piece(surface, local, i)
    find_end(surface, local, end)
    for i in range(frame.drives):
        exchanged = clock[i].since == time
        if not exchanged and is_bridged(local, i):
            _take_out(surface, local, i)
            exchanged = True
        if exchanged:
            bridge(surface, local, i)
            _add(surface, local, i, 1.0)
    return True


@device_no_arrays
def _has_passed(clock: Clock, time: float) -> bool:
    """Whether a drive needs another piece from a time [s] on."""
    return bool(clock.until <= time + clock.slack)


@spliced
def _find_piece(surface: Surface, local: LocalSurface, i: int) -> None:
    """The quintic of the i-th drive, from frame.time to its next breakpoint."""
    frame: Frame = local.frame[0]
    time, unit, drive = frame.time, frame.unit, drive_of(surface, local, i)
    clock, piece, table = local.clock[i], local.pieces[i], surface.drives
    if i > 0 and table.alike[drive] and drive_of(surface, local, i - 1) == drive - 1:
        # Corrections of a plate that stretches have common breakpoints, which are searched once.
        before = local.clock[i - 1]
        if before.since == time and before.segment != NO_SEGMENT:
            segment = before.segment + table.first[drive] - table.first[drive - 1]
            expand_piece(table, drive, before.passes, segment, time, unit, piece)
            clock.since, clock.until, clock.slack = time, before.until, before.slack
            clock.passes, clock.segment = before.passes, segment
            return
    until = drive_breakpoint(table, drive, time)
    # It is chosen in the middle of the span, where rounding at its ends cannot mistake it.
    within = time + 0.5 * min(until - time, unit)
    clock.passes, clock.segment = find_piece(table, drive, within, time, unit, piece)
    clock.since, clock.until = time, until
    clock.slack = breakpoint_slack(table, drive, until) if math.isfinite(until) else 0.0


@device_no_arrays
def _take_out(surface: Surface, local: LocalSurface, i: int) -> None:
    """Move the quintic of the i-th drive on to frame.time, and take its shape out."""
    frame: Frame = local.frame[0]
    clock = local.clock[i]
    shift_quintic(local.pieces[i], (frame.time - clock.since) / frame.unit, 1.0, local.pieces[i])
    clock.since = frame.time
    _add(surface, local, i, -1.0)


@spliced
def _add(surface: Surface, local: LocalSurface, i: int, sign: float) -> None:
    """Add the quintic of the i-th drive times its shape."""
    frame: Frame = local.frame[0]
    cells, piece, shapes = surface.cells, local.pieces[i], shapes_in_cell(frame)
    if i >= shapes + frame.in_plane:
        for k in range(ORDER):
            local.base[k, i - shapes - frame.in_plane] += sign * piece[k]
    elif i >= shapes:
        width = 2 * frame.plane_monomials
        first = cells.cell[frame.cell].first_plane + (i - shapes) * width
        _add_row(local.plane, cells.plane_rows, first, width, piece, sign)
    else:
        width = frame.monomials + frame.logarithms
        _add_row(local.smooth, cells.rows, cells.cell[frame.cell].first_row + i * width, width, piece, sign)


@device_no_arrays
def _add_row(out: FloatArray, rows: FloatArray, first: int, width: int, piece: FloatArray, sign: float) -> None:
    """Add a quintic times the shape that begins at `first`."""
    row = rows[first : first + width]  # as slices, these loops fill the processor's vector units
    for k in range(ORDER):
        c = sign * piece[k]
        if c != 0.0:
            total = out[k, :width]
            for m in range(len(row)):
                total[m] += row[m] * c


@spliced
def _sum_rows(out: FloatArray, rows: FloatArray, width: int, pieces: FloatArray) -> None:
    """The sum of quintics (n, 6) times shapes, rows (n width,), into the first columns of `out` (6, ...)."""
    whole = width - width % LANES
    for m in range(0, whole, LANES):
        c_0 = c_1 = c_2 = c_3 = c_4 = c_5 = nought(load(out[0], m))
        for i in range(len(pieces)):
            shape, piece = load(rows, i * width + m), pieces[i]
            c_0 = c_0 + shape * piece[0]
            c_1 = c_1 + shape * piece[1]
            c_2 = c_2 + shape * piece[2]
            c_3 = c_3 + shape * piece[3]
            c_4 = c_4 + shape * piece[4]
            c_5 = c_5 + shape * piece[5]
        store(out[0], m, c_0)
        store(out[1], m, c_1)
        store(out[2], m, c_2)
        store(out[3], m, c_3)
        store(out[4], m, c_4)
        store(out[5], m, c_5)
    for m in range(whole, width):
        for k in range(ORDER):
            out[k, m] = 0.0
            for i in range(len(pieces)):
                out[k, m] += rows[i * width + m] * pieces[i, k]


@device_no_arrays
def _shift(c: FloatArray, shift: float, width: int) -> None:
    """Polynomials (6, width) of s as ones of s - shift."""
    for k in range(ORDER - 1):
        for j in range(ORDER - 2, k - 1, -1):
            for m in range(width):
                c[j, m] += shift * c[j + 1, m]
