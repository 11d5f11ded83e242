"""The surface around a part: the polynomial in (x, y, t) of its cell, over the time until it is prepared anew.

`span.enter` prepares this scratch memory.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.drives import ORDER
from particle.jit import device_no_arrays, jit_no_arrays
from particle.lanes import LANES
from particle.records import Record, new_records
from particle.surface.cells import NOWHERE, WHOLE, Cells, Grid
from particle.surface.record import BASE, Surface
from particle.surface.rim import rim_gap
from particle.types import FloatArray


class Frame(Record):
    """The cell and the times for which a local surface holds, and what its polynomials are counted from."""

    time: float  # s, from which it holds
    end: float  # s, until which it holds
    unit: float  # s, its polynomials are in (t - time) / unit
    begun: float  # s, when it was prepared from nothing
    moment: float  # s, of `at` and `plane_at`; nan: there is none
    x: float  # m, the cell's centre
    y: float
    half_x: float  # m, half its width
    half_y: float
    clear: float  # m, the cell's distance from the rim
    surface_size: float  # m
    floor: float  # that of the logarithms, over the surface's size
    overhang: float  # half widths that the polynomial holds
    missing_x: float  # m, a place that has no cell yet
    missing_y: float
    velocity_error: float  # m/s, how far the surface may be off over breakpoints that are bridged
    acceleration_error: float  # m/s^2, the same
    min_jump: float  # m/s^3, drives whose third derivative jumps by as much end a span at their breakpoints
    max_bridge: float  # s, how long the others may be bridged
    cell: int
    drives: int  # those that count in the cell, those of shapes in the plane, and the base's
    logarithms: int
    monomials: int
    degree: int
    base_drives: int
    in_plane: int  # shapes in the plane
    plane_degree: int
    plane_monomials: int


class Clock(Record):
    """When the piece of one drive holds."""

    since: float  # s, what its polynomial is counted from
    until: float  # s, its next breakpoint, or the end of its bridge
    slack: float  # s, how close to that is as good as there
    jump: float  # m/s^3, by how much the third derivative of what it does in the cell jumps at its breakpoints
    passes: float  # that it had behind it
    segment: int  # of the drive, NO_SEGMENT: it holds


class LocalSurface(NamedTuple):
    """Scratch memory of one path: all that an evaluation needs, so that little is handed from kernel to kernel."""

    frame: NDArray[Frame]  # (1,)
    clock: NDArray[Clock]  # (D,)
    pieces: FloatArray  # (D, 6) m, the quintic of each drive
    smooth: FloatArray  # (6, M + J) m, the cell's polynomial; then the strengths of its logarithms
    at: FloatArray  # (3, M + J + LANES) m, these and their first two derivatives in time, at one time; then room
    sources: FloatArray  # (J, 2) m, where the logarithms are
    base: FloatArray  # (6, 3) m and rad, where the base is along x and y, and how far it is turned
    plane: FloatArray  # (6, 2 M) m, the cell's motion in its plane: polynomials along x, then along y
    plane_at: FloatArray  # (3, 2 M + LANES) m, as `at`
    ahead: FloatArray  # (6,) m, a drive's quintic at the end of the span


def new_local(surface: Surface) -> LocalSurface:
    """Scratch memory that fits the surface, with no cell and no time yet."""
    grid: Grid = surface.cells.grid[0]
    width, drives = monomial_count(grid.highest) + grid.most_near, grid.most_drives + surface.in_plane_count + BASE
    plane = 2 * monomial_count(grid.plane_highest)
    local = LocalSurface(
        frame=new_records(Frame),
        clock=new_records(Clock, drives),
        pieces=np.zeros((drives, ORDER)),
        smooth=np.zeros((ORDER, width)),
        at=np.zeros((3, width + LANES)),
        sources=np.zeros((grid.most_near, 2)),
        base=np.zeros((ORDER, BASE)),
        plane=np.zeros((ORDER, plane)),
        plane_at=np.zeros((3, plane + LANES)),
        ahead=np.zeros(ORDER),
    )
    prepare(surface, local)
    return local


def prepare(surface: Surface, local: LocalSurface) -> None:
    """Scratch memory of a surface before there is a cell and a time."""
    local.frame[0] = 0
    frame: Frame = local.frame[0]
    frame.surface_size, frame.floor, frame.overhang = surface.size, surface.floor / surface.size, surface.overhang
    frame.base_drives, frame.in_plane, frame.cell = surface.base_drives, surface.in_plane_count, NOWHERE


def missing_place(local: LocalSurface) -> FloatArray:
    """The place (1, 2) [m] where `enter` found no cell."""
    frame: Frame = local.frame[0]
    return np.array([[frame.missing_x, frame.missing_y]])


@jit_no_arrays
def monomial_count(degree: int) -> int:
    """How many monomials x^i y^j there are up to a degree."""
    return (degree + 1) * (degree + 2) // 2


@device_no_arrays
def cell_at(cells: Cells, x: float, y: float) -> int:
    """The cell that holds a point [m]; NOWHERE when there is no plate, UNBUILT when there may be."""
    grid: Grid = cells.grid[0]
    if not math.isfinite(grid.width_x):
        return 0
    i = _interval(x - grid.x, grid.width_x, cells.roots.shape[0])
    j = _interval(y - grid.y, grid.width_y, cells.roots.shape[1])
    if i == NOWHERE or j == NOWHERE:
        return NOWHERE
    cell = int(cells.roots[i, j])
    while cell >= 0 and cells.cell[cell].quarters != WHOLE:
        divided = cells.cell[cell]
        cell = int(divided.quarters) + 2 * (x >= divided.x) + (y >= divided.y)
    return NOWHERE if cell >= 0 and cells.cell[cell].first_row == NOWHERE else cell


@device_no_arrays
def _interval(along: float, width: float, count: int) -> int:
    """Which of `count` intervals of a width holds a coordinate; the outer edges belong to the outer ones."""
    place = int(math.floor(along / width))
    if place == count and along <= (count + 1e-6) * width:
        return count - 1
    if place == -1 and along >= -1e-6 * width:
        return 0
    return place if 0 <= place < count else NOWHERE


@device_no_arrays
def within_cell(local: LocalSurface, x: float, y: float) -> bool:
    """Whether the cell's polynomial holds at a point [m]."""
    return within_frame(local.frame[0], x, y)


@device_no_arrays
def within_frame(f: Frame, x: float, y: float) -> bool:
    """As `within_cell`, by the frame alone."""
    return abs(x - f.x) <= f.overhang * f.half_x and abs(y - f.y) <= f.overhang * f.half_y


@device_no_arrays
def gap_at(surface: Surface, local: LocalSurface, x: float, y: float) -> float:
    """A distance [m] that a point of the cell is from the rim at least, negative off the plate; exact near the rim."""
    clear: float = local.frame[0].clear
    return clear if clear > 0.0 else rim_gap(surface, x, y)
