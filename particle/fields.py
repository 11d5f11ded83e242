"""The surface where the part is: one polynomial in (x, y, t) per cell and stroke piece, plus the logarithms.

`Local` is scratch memory: `pin_time` fills in the drives' quintics for one span of time, `pin_cell` contracts the
cell's shapes with them. After that the smooth part costs the same for any number of shapes.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.drive import ORDER, drive_piece, next_kink
from particle.jit import jit
from particle.rim import rim_gap

FloatArray = NDArray[np.float64]

LOG_STRENGTH = 1 / (8 * math.pi)
NOWHERE = -1  # the cell of points where there is no plate
# Places in Local.frame.
TIME, UNIT, X, Y, HALF, CELL = range(6)


class Local(NamedTuple):
    """Scratch memory of one path; polynomials in time are in (t - frame[TIME]) / frame[UNIT]."""

    frame: FloatArray  # (6,) start [s] and unit [s] of time, centre [m] and half width [m] of the cell, its row
    heights: FloatArray  # (N or N + 2, 6) m, the drives
    forces: FloatArray  # (J, 6) m, the logarithms' strengths
    smooth: FloatArray  # (M, 6) m, the cell's polynomial
    at: FloatArray  # (M, 3) m, smooth and its first two derivatives in time, at one time
    force_at: FloatArray  # (J, 3) m, the same of the forces


class Fields(NamedTuple):
    """The surface at one point and time, in SI units, with the base's place, velocity and acceleration in its plane."""

    w: float
    w_t: float
    w_tt: float
    x: float
    y: float
    xt: float
    yt: float
    xx: float
    xy: float
    yy: float
    base_px: float
    base_py: float
    base_vx: float
    base_vy: float
    base_ax: float
    base_ay: float


@jit
def new_local(surface: Any) -> Local:
    """Scratch memory that fits the surface, with no cell and no time yet."""
    monomials, sources = surface.cells.shape[2], len(surface.sources)
    frame = np.zeros(6)
    frame[CELL] = NOWHERE
    return Local(
        frame,
        np.zeros((len(surface.drives.delay), ORDER)),
        np.zeros((sources, ORDER)),
        np.zeros((monomials, ORDER)),
        np.zeros((monomials, 3)),
        np.zeros((sources, 3)),
    )


@jit
def pin_time(surface: Any, local: Local, start: float, end: float) -> None:
    """Prepare for times from `start` to `end` [s], between which no drive has a kink; the cell must be pinned anew."""
    unit = end - start if math.isfinite(end) else 1.0
    local.frame[TIME], local.frame[UNIT], local.frame[CELL] = start, unit, NOWHERE
    shapes = surface.strengths.shape[1]
    for i in range(len(surface.drives.delay)):
        # The piece is chosen in the middle of the span, where rounding at its ends cannot mistake it.
        middle = drive_piece(surface.drives, i, start + 0.5 * unit, unit)
        for k in range(ORDER - 1):
            for j in range(ORDER - 2, k - 1, -1):
                middle[j] -= 0.5 * middle[j + 1]
        local.heights[i] = middle
    for j in range(len(surface.sources)):
        for k in range(ORDER):
            total = 0.0
            for i in range(shapes):
                total += surface.strengths[j, i] * local.heights[i, k]
            local.forces[j, k] = LOG_STRENGTH * total


@jit
def cell_at(surface: Any, x: float, y: float) -> int:
    """Row of the cell that holds a point [m]; NOWHERE when there is no plate."""
    if not math.isfinite(surface.cell_width):
        return 0
    i = _place(x - surface.origin[0], surface.cell_width, surface.cell_rows.shape[0])
    j = _place(y - surface.origin[1], surface.cell_width, surface.cell_rows.shape[1])
    if i == NOWHERE or j == NOWHERE:
        return NOWHERE
    return int(surface.cell_rows[i, j])


@jit
def _place(along: float, width: float, count: int) -> int:
    """Which of `count` intervals of a width holds a coordinate; the outer edges belong to the outer ones."""
    place = int(math.floor(along / width))
    if place == count and along <= (count + 1e-6) * width:
        return count - 1
    if place == -1 and along >= -1e-6 * width:
        return 0
    return place if 0 <= place < count else NOWHERE


@jit
def pin_cell(surface: Any, local: Local, x: float, y: float) -> bool:
    """Prepare for points around (x, y) [m]; False when there is no plate."""
    cell = cell_at(surface, x, y)
    if cell == NOWHERE:
        return False
    if cell == local.frame[CELL]:
        return True
    width = surface.cell_width
    local.frame[CELL] = cell
    if math.isfinite(width):
        i = _place(x - surface.origin[0], width, surface.cell_rows.shape[0])
        j = _place(y - surface.origin[1], width, surface.cell_rows.shape[1])
        local.frame[X] = surface.origin[0] + width * (i + 0.5)
        local.frame[Y] = surface.origin[1] + width * (j + 0.5)
        local.frame[HALF] = 0.5 * width
    else:
        local.frame[HALF] = surface.size
    shapes, monomials = surface.cells.shape[1], surface.cells.shape[2]
    local.smooth[:] = 0.0
    for i in range(shapes):
        for m in range(monomials):
            c = surface.cells[cell, i, m]
            for k in range(ORDER):
                local.smooth[m, k] += c * local.heights[i, k]
    return True


@jit
def within_cell(surface: Any, local: Local, x: float, y: float) -> bool:
    """Whether the pinned cell's polynomials hold at a point [m]."""
    reach = surface.overhang * local.frame[HALF]
    return abs(x - local.frame[X]) <= reach and abs(y - local.frame[Y]) <= reach


@jit
def at_time(local: Local, time: float) -> None:
    """Contract the polynomials in time: values and two derivatives at `time` [s]."""
    unit = local.frame[UNIT]
    s = (time - local.frame[TIME]) / unit
    for m in range(len(local.smooth)):
        local.at[m, 0], local.at[m, 1], local.at[m, 2] = quintic(local.smooth[m], s, unit)
    for j in range(len(local.forces)):
        local.force_at[j, 0], local.force_at[j, 1], local.force_at[j, 2] = quintic(local.forces[j], s, unit)


@jit
def quintic(c: FloatArray, s: float, unit: float) -> tuple[float, float, float]:
    """A quintic in s = t / unit, with its first and second derivative in t."""
    value = ((((c[5] * s + c[4]) * s + c[3]) * s + c[2]) * s + c[1]) * s + c[0]
    first = (((5 * c[5] * s + 4 * c[4]) * s + 3 * c[3]) * s + 2 * c[2]) * s + c[1]
    second = ((20 * c[5] * s + 12 * c[4]) * s + 6 * c[3]) * s + 2 * c[2]
    return value, first / unit, second / (unit * unit)


@jit
def fields(surface: Any, local: Local, x: float, y: float, time: float) -> Fields:
    """The surface at a point [m] of the pinned cell and a time [s] of the pinned span."""
    at_time(local, time)
    half = local.frame[HALF]
    u, v = (x - local.frame[X]) / half, (y - local.frame[Y]) / half
    w = w_u = w_uu = w_v = w_uv = w_vv = 0.0
    w_t = w_ut = w_vt = w_tt = 0.0
    m = len(local.at)
    # Horner in v inside Horner in u; w_uu and w_vv carry half of the second derivative.
    for i in range(surface.degree, -1, -1):
        a = a_v = a_vv = b = b_v = c = 0.0
        for _ in range(surface.degree + 1 - i):
            m -= 1
            a_vv = a_vv * v + a_v
            a_v = a_v * v + a
            a = a * v + local.at[m, 0]
            b_v = b_v * v + b
            b = b * v + local.at[m, 1]
            c = c * v + local.at[m, 2]
        w_uu = w_uu * u + w_u
        w_u = w_u * u + w
        w = w * u + a
        w_uv = w_uv * u + w_v
        w_v = w_v * u + a_v
        w_vv = w_vv * u + a_vv
        w_ut = w_ut * u + w_t
        w_t = w_t * u + b
        w_vt = w_vt * u + b_v
        w_tt = w_tt * u + c
    g_x, g_y, g_xt, g_yt = w_u / half, w_v / half, w_ut / half, w_vt / half
    h_xx, h_xy, h_yy = 2 * w_uu / half**2, w_uv / half**2, 2 * w_vv / half**2
    for j in range(len(surface.sources)):
        d_x = (x - surface.sources[j, 0]) / surface.size
        d_y = (y - surface.sources[j, 1]) / surface.size
        square = d_x * d_x + d_y * d_y
        least = (surface.floor / surface.size) ** 2
        bounded = max(square, least)
        logarithm = math.log(bounded)  # 2 ln r
        # Within the floor the parabola in r^2 that meets r^2 ln r with two derivatives: below, `inner` is not 0.
        inner = (square - bounded) / bounded
        f, f_t, f_tt = local.force_at[j, 0], local.force_at[j, 1], local.force_at[j, 2]
        value = 0.5 * bounded * (logarithm + inner * (logarithm + 1 + 0.5 * inner))
        slope = (logarithm + 1 + inner) / surface.size
        w += f * value
        w_t += f_t * value
        w_tt += f_tt * value
        g_x += f * slope * d_x
        g_y += f * slope * d_y
        g_xt += f_t * slope * d_x
        g_yt += f_t * slope * d_y
        bend = f / surface.size**2
        h_xx += bend * (logarithm + 1 + inner + 2 * d_x * d_x / bounded)
        h_xy += bend * 2 * d_x * d_y / bounded
        h_yy += bend * (logarithm + 1 + inner + 2 * d_y * d_y / bounded)
    base_px = base_py = base_vx = base_vy = base_ax = base_ay = 0.0
    if surface.moving_base:
        s, n = (time - local.frame[TIME]) / local.frame[UNIT], surface.strengths.shape[1]
        base_px, base_vx, base_ax = quintic(local.heights[n], s, local.frame[UNIT])
        base_py, base_vy, base_ay = quintic(local.heights[n + 1], s, local.frame[UNIT])
    return Fields(
        w, w_t, w_tt, g_x, g_y, g_xt, g_yt, h_xx, h_xy, h_yy, base_px, base_py, base_vx, base_vy, base_ax, base_ay
    )


@jit
def standing(surface: Any, local: Local, x: float, y: float, out: FloatArray) -> None:
    """The surface at a fixed point [m] as polynomials in time: w, w_x, w_y into `out` (3, 6)."""
    half = local.frame[HALF]
    u, v = (x - local.frame[X]) / half, (y - local.frame[Y]) / half
    out[:] = 0.0
    for k in range(ORDER):
        w = w_u = w_v = 0.0
        m = len(local.smooth)
        for i in range(surface.degree, -1, -1):
            a = a_v = 0.0
            for _ in range(surface.degree + 1 - i):
                m -= 1
                a_v = a_v * v + a
                a = a * v + local.smooth[m, k]
            w_u = w_u * u + w
            w = w * u + a
            w_v = w_v * u + a_v
        out[0, k], out[1, k], out[2, k] = w, w_u / half, w_v / half
    for j in range(len(surface.sources)):
        d_x = (x - surface.sources[j, 0]) / surface.size
        d_y = (y - surface.sources[j, 1]) / surface.size
        square = d_x * d_x + d_y * d_y
        bounded = max(square, (surface.floor / surface.size) ** 2)
        logarithm, inner = math.log(bounded), (square - bounded) / bounded
        value = 0.5 * bounded * (logarithm + inner * (logarithm + 1 + 0.5 * inner))
        slope = (logarithm + 1 + inner) / surface.size
        for k in range(ORDER):
            f = local.forces[j, k]
            out[0, k] += f * value
            out[1, k] += f * slope * d_x
            out[2, k] += f * slope * d_y


@jit
def evaluate_points(surface: Any, xy: FloatArray, time: float) -> FloatArray:
    """The first ten of `Fields` at points (n, 2) [m] and one time [s]: (n, 10), nan beyond the rim."""
    out = np.full((len(xy), 10), math.nan)
    local = new_local(surface)
    pin_time(surface, local, time, min(next_kink(surface.drives, time), time + 1.0))
    for n in range(len(xy)):
        x, y = xy[n]
        if rim_gap(surface, x, y) >= -1e-9 * surface.size and pin_cell(surface, local, x, y):
            f = fields(surface, local, x, y, time)
            out[n] = np.array([f.w, f.w_t, f.w_tt, f.x, f.y, f.xt, f.yt, f.xx, f.xy, f.yy])
    return out
