"""Bridges: which breakpoints end a span, and what replaces the drives over those that do not.

Breakpoints of drives that hardly count in the cell need not end a span. Over these such a drive is replaced by the
quintic that has its height, velocity and acceleration at both ends, so that it differs only by what the third
derivative's jump does in between.
"""

from __future__ import annotations

import math

from particle.drives import DriveTable, drive_piece, quintic_end
from particle.jit import device_no_arrays, spliced
from particle.surface.local import Frame, LocalSurface
from particle.surface.record import Surface

# A jump J of the third derivative, bridged over a time T, is off by up to these times J T^2 and J T.
VELOCITY_ERROR, ACCELERATION_ERROR = 0.004737, 0.0625
MAX_BRIDGE, MIN_BRIDGE = 0.25, 0.02  # of the shortest stroke, of the longest bridge: shorter ones amplify rounding
JUMP_STEP, MIN_JUMP = 4.0, 1e-12  # factor between the jumps tried as limit, and the least of them over the largest
WORTHWHILE = 0.9  # of the spans: bridges must leave fewer


@device_no_arrays
def allow_bridges(local: LocalSurface, velocity_error: float, acceleration_error: float) -> None:
    """How far [m/s, m/s^2] the surface's motion may be off over bridges, from the next span on; 0: there are none."""
    frame: Frame = local.frame[0]
    frame.velocity_error, frame.acceleration_error = velocity_error, acceleration_error


@spliced
def drive_of(surface: Surface, local: LocalSurface, i: int) -> int:
    """The drive that is i-th in the cell; those of shapes in the plane and the base's two follow the cell's."""
    frame: Frame = local.frame[0]
    beyond = i - shapes_in_cell(frame)
    if beyond >= 0:
        return int(surface.shape_count + beyond)
    return int(surface.cells.drive[surface.cells.cell[frame.cell].first_drive + i])


@spliced
def shapes_in_cell(frame: Frame) -> int:
    """How many drives of shapes count in the cell."""
    return int(frame.drives - frame.in_plane - frame.base_drives)


@spliced
def find_jump(surface: Surface, local: LocalSurface, i: int) -> None:
    """By how much the third derivative of what the i-th drive does in this cell jumps."""
    frame: Frame = local.frame[0]
    cells, jump = surface.cells, surface.drives.rough[drive_of(surface, local, i)]
    counted = i < shapes_in_cell(frame)
    weight = cells.weight[cells.cell[frame.cell].first_drive + i] if counted else math.inf
    local.clock[i].jump = weight * jump if jump > 0.0 else 0.0


@device_no_arrays
def find_end(surface: Surface, local: LocalSurface, end: float) -> None:
    """When the span from frame.time ends, at most at `end` [s]."""
    frame: Frame = local.frame[0]
    clock = local.clock
    if frame.velocity_error == 0.0:
        frame.min_jump = frame.max_bridge = 0.0
    elif frame.max_bridge == 0.0:
        _choose(surface, local)
    first = unbridged = end
    for i in range(frame.drives):
        first = min(first, clock[i].until)
        if clock[i].jump >= frame.min_jump:
            unbridged = min(unbridged, clock[i].until)
    frame.end = max(first, min(unbridged, frame.time + frame.max_bridge))


@device_no_arrays
def _choose(surface: Surface, local: LocalSurface) -> None:
    """From which jump on breakpoints end a span, and how long the others may be bridged: what makes fewest spans."""
    frame: Frame = local.frame[0]
    clock, drives = local.clock, surface.drives
    largest = breakpoints = 0.0
    for i in range(frame.drives):
        breakpoints += _breakpoint_rate(drives, drive_of(surface, local, i))
        if math.isfinite(clock[i].jump):
            largest = max(largest, clock[i].jump)
    frame.min_jump, frame.max_bridge, fewest = 0.0, MAX_BRIDGE * frame.unit, WORTHWHILE * breakpoints
    limit = JUMP_STEP * largest
    while limit > MIN_JUMP * largest:
        breakpoints = bridged = 0.0
        for i in range(frame.drives):
            if clock[i].jump >= limit:
                breakpoints += _breakpoint_rate(drives, drive_of(surface, local, i))
            else:
                bridged += clock[i].jump
        longest = MAX_BRIDGE * frame.unit
        if bridged > 0.0:
            by_velocity = math.sqrt(frame.velocity_error / (VELOCITY_ERROR * bridged))
            longest = min(longest, by_velocity, frame.acceleration_error / (ACCELERATION_ERROR * bridged))
        if breakpoints + 1 / longest < fewest:
            frame.min_jump, frame.max_bridge, fewest = limit, longest, breakpoints + 1 / longest
        limit /= JUMP_STEP


@device_no_arrays
def _breakpoint_rate(drives: DriveTable, i: int) -> float:
    """Breakpoints a second of a drive that is running."""
    return float((drives.loop[i, 1] - drives.loop[i, 0]) / drives.span[i])


@spliced
def is_bridged(local: LocalSurface, i: int) -> bool:
    """Whether the i-th drive has a breakpoint within the span."""
    frame: Frame = local.frame[0]
    clock = local.clock[i]
    long_enough = frame.end - frame.time > MIN_BRIDGE * frame.max_bridge
    return bool(clock.until < frame.end - clock.slack and long_enough)


@spliced
def bridge(surface: Surface, local: LocalSurface, i: int) -> None:
    """Replace the piece of the i-th drive from frame.time on by a bridge to frame.end, if it needs one."""
    if not is_bridged(local, i):
        return
    frame: Frame = local.frame[0]
    piece, ahead = local.pieces[i], local.ahead
    drive_piece(surface.drives, drive_of(surface, local, i), frame.end, frame.unit, ahead)
    s = (frame.end - frame.time) / frame.unit
    height = ahead[0] - (piece[0] + s * (piece[1] + s * piece[2]))
    velocity = s * (ahead[1] - (piece[1] + 2 * s * piece[2]))
    acceleration = s * s * (ahead[2] - piece[2])
    third, fourth, fifth = quintic_end(height, 0.0, velocity, 0.0, 2 * acceleration)
    piece[3], piece[4], piece[5] = third / s**3, fourth / s**4, fifth / s**5
    local.clock[i].until = frame.end
