"""The surface where the part is: its height, slopes and curvatures, and their rates, from the cell that it is in."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from particle.drives import ORDER, evaluate_piece
from particle.jit import jit, jit_no_arrays
from particle.surface.cells import UNBUILT
from particle.surface.local import Frame, LocalSurface
from particle.surface.planar import planar_at
from particle.surface.record import Surface
from particle.surface.rim import rim_gap
from particle.surface.span import enter
from particle.types import BoolArray, FloatArray


class SurfacePoint(NamedTuple):
    """The surface at the material point X = (x, y) and one time, in SI units.

    Its place in space is P = (X + u + base, w). Where it moves in its plane, w_x and w_y are the slope g as seen in
    space, and the second and third derivatives of w, w_tt excepted, stand for (-g, 1).P_.. with the same derivatives
    of P. `base_...` are those of u + base.
    """

    w: float
    w_t: float
    w_tt: float
    w_x: float
    w_y: float
    w_xt: float
    w_yt: float
    w_xx: float
    w_xy: float
    w_yy: float
    w_xtt: float
    w_ytt: float
    w_xxt: float
    w_xyt: float
    w_yyt: float
    w_xxx: float
    w_xxy: float
    w_xyy: float
    w_yyy: float
    base_px: float
    base_py: float
    base_vx: float
    base_vy: float
    base_ax: float
    base_ay: float
    x_x: float  # derivatives of X + u by X: 1, 0, 0, 1 where u = 0
    x_y: float
    y_x: float
    y_y: float
    x_xt: float
    x_yt: float
    y_xt: float
    y_yt: float
    x_xx: float
    x_xy: float
    x_yy: float
    y_xx: float
    y_xy: float
    y_yy: float


@jit_no_arrays
def at_time(local: LocalSurface, time: float) -> None:
    """The cell's polynomial and logarithms at `time` [s], with two derivatives, into `at`."""
    frame: Frame = local.frame[0]
    unit = frame.unit
    s = (time - frame.time) / unit
    c, at = local.smooth, local.at
    for m in range(frame.monomials + frame.logarithms):
        at[0, m] = ((((c[5, m] * s + c[4, m]) * s + c[3, m]) * s + c[2, m]) * s + c[1, m]) * s + c[0, m]
        at[1, m] = ((((5 * c[5, m] * s + 4 * c[4, m]) * s + 3 * c[3, m]) * s + 2 * c[2, m]) * s + c[1, m]) / unit
        at[2, m] = (((20 * c[5, m] * s + 12 * c[4, m]) * s + 6 * c[3, m]) * s + 2 * c[2, m]) / (unit * unit)


@jit_no_arrays
def surface_at(local: LocalSurface, x: float, y: float, time: float) -> SurfacePoint:
    """The surface at a point [m] of the prepared cell and a time [s] of the prepared span."""
    at_time(local, time)
    frame: Frame = local.frame[0]
    at, size = local.at, frame.surface_size
    half_x, half_y = frame.half_x, frame.half_y
    u, v = (x - frame.x) / half_x, (y - frame.y) / half_y
    w = w_u = w_uu = w_uuu = w_v = w_uv = w_uuv = w_vv = w_uvv = w_vvv = 0.0
    w_t = w_ut = w_uut = w_vt = w_uvt = w_vvt = w_tt = w_utt = w_vtt = 0.0
    monomials, degree = frame.monomials, frame.degree
    m = monomials
    # Horner in v inside Horner in u; n times u or v in a name stands for the n-th derivative over n!.
    for i in range(degree, -1, -1):
        a = a_v = a_vv = a_vvv = b = b_v = b_vv = c = c_v = 0.0
        for _ in range(degree + 1 - i):
            m -= 1
            a_vvv = a_vvv * v + a_vv
            a_vv = a_vv * v + a_v
            a_v = a_v * v + a
            a = a * v + at[0, m]
            b_vv = b_vv * v + b_v
            b_v = b_v * v + b
            b = b * v + at[1, m]
            c_v = c_v * v + c
            c = c * v + at[2, m]
        w_uuu = w_uuu * u + w_uu
        w_uu = w_uu * u + w_u
        w_u = w_u * u + w
        w = w * u + a
        w_uuv = w_uuv * u + w_uv
        w_uv = w_uv * u + w_v
        w_v = w_v * u + a_v
        w_uvv = w_uvv * u + w_vv
        w_vv = w_vv * u + a_vv
        w_vvv = w_vvv * u + a_vvv
        w_uut = w_uut * u + w_ut
        w_ut = w_ut * u + w_t
        w_t = w_t * u + b
        w_uvt = w_uvt * u + w_vt
        w_vt = w_vt * u + b_v
        w_vvt = w_vvt * u + b_vv
        w_utt = w_utt * u + w_tt
        w_tt = w_tt * u + c
        w_vtt = w_vtt * u + c_v
    g_x, g_y, g_xt, g_yt = w_u / half_x, w_v / half_y, w_ut / half_x, w_vt / half_y
    g_xtt, g_ytt = w_utt / half_x, w_vtt / half_y
    h_xx, h_xy, h_yy = 2 * w_uu / half_x**2, w_uv / (half_x * half_y), 2 * w_vv / half_y**2
    h_xxt, h_xyt, h_yyt = 2 * w_uut / half_x**2, w_uvt / (half_x * half_y), 2 * w_vvt / half_y**2
    t_xxx, t_xxy = 6 * w_uuu / half_x**3, 2 * w_uuv / (half_x**2 * half_y)
    t_xyy, t_yyy = 2 * w_uvv / (half_x * half_y**2), 6 * w_vvv / half_y**3
    for j in range(frame.logarithms):
        d_x, d_y = (x - local.sources[j, 0]) / size, (y - local.sources[j, 1]) / size
        square = d_x * d_x + d_y * d_y
        bounded, inner, logarithm = _logarithm(frame.floor, square)
        m = monomials + j
        f, f_t, f_tt = at[0, m], at[1, m], at[2, m]
        value = 0.5 * bounded * (logarithm + inner * (logarithm + 1 + 0.5 * inner))
        slope = (logarithm + 1 + inner) / size
        w += f * value
        w_t += f_t * value
        w_tt += f_tt * value
        g_x += f * slope * d_x
        g_y += f * slope * d_y
        g_xt += f_t * slope * d_x
        g_yt += f_t * slope * d_y
        g_xtt += f_tt * slope * d_x
        g_ytt += f_tt * slope * d_y
        bend_t = f_t / (size * size)
        h_xxt += bend_t * (logarithm + 1 + inner + 2 * d_x * d_x / bounded)
        h_xyt += bend_t * 2 * d_x * d_y / bounded
        h_yyt += bend_t * (logarithm + 1 + inner + 2 * d_y * d_y / bounded)
        # Within the floor the third derivatives are those of the parabola in r^2.
        twist, once = f / (size * size * size), 2 / bounded
        cubed = -4 / (bounded * bounded) if inner == 0.0 else 0.0
        t_xxx += twist * d_x * (3 * once + cubed * d_x * d_x)
        t_xxy += twist * d_y * (once + cubed * d_x * d_x)
        t_xyy += twist * d_x * (once + cubed * d_y * d_y)
        t_yyy += twist * d_y * (3 * once + cubed * d_y * d_y)
        bend = f / (size * size)
        h_xx += bend * (logarithm + 1 + inner + 2 * d_x * d_x / bounded)
        h_xy += bend * 2 * d_x * d_y / bounded
        h_yy += bend * (logarithm + 1 + inner + 2 * d_y * d_y / bounded)
    base_px = base_py = base_vx = base_vy = base_ax = base_ay = 0.0
    if frame.base_drives > 0:
        s, unit = (time - frame.time) / frame.unit, frame.unit
        base_px, base_vx, base_ax = evaluate_piece(local.base[:, 0], s, unit)
        base_py, base_vy, base_ay = evaluate_piece(local.base[:, 1], s, unit)
    x_x, x_y, y_x, y_y = 1.0, 0.0, 0.0, 1.0
    x_xt = x_yt = y_xt = y_yt = x_xx = x_xy = x_yy = y_xx = y_xy = y_yy = 0.0
    if frame.in_plane > 0:
        along_x, along_y = planar_at(local, 0, x, y, time), planar_at(local, frame.plane_monomials, x, y, time)
        x_x, x_y, y_x, y_y = 1 + along_x.x, along_x.y, along_y.x, 1 + along_y.y
        x_xt, x_yt, y_xt, y_yt = along_x.xt, along_x.yt, along_y.xt, along_y.yt
        x_xx, x_xy, x_yy, y_xx, y_xy, y_yy = along_x.xx, along_x.xy, along_x.yy, along_y.xx, along_y.xy, along_y.yy
        base_px, base_vx, base_ax = base_px + along_x.u, base_vx + along_x.t, base_ax + along_x.tt
        base_py, base_vy, base_ay = base_py + along_y.u, base_vy + along_y.t, base_ay + along_y.tt
        # The slope seen in space: grad w = (I + grad u)^T g.
        det = x_x * y_y - x_y * y_x
        g_x, g_y = (y_y * g_x - y_x * g_y) / det, (x_x * g_y - x_y * g_x) / det
        g_xt, g_yt = g_xt - g_x * along_x.xt - g_y * along_y.xt, g_yt - g_x * along_x.yt - g_y * along_y.yt
        g_xtt, g_ytt = g_xtt - g_x * along_x.xtt - g_y * along_y.xtt, g_ytt - g_x * along_x.ytt - g_y * along_y.ytt
        h_xx, h_xy = h_xx - g_x * along_x.xx - g_y * along_y.xx, h_xy - g_x * along_x.xy - g_y * along_y.xy
        h_yy, h_xxt = h_yy - g_x * along_x.yy - g_y * along_y.yy, h_xxt - g_x * along_x.xxt - g_y * along_y.xxt
        h_xyt, h_yyt = h_xyt - g_x * along_x.xyt - g_y * along_y.xyt, h_yyt - g_x * along_x.yyt - g_y * along_y.yyt
        t_xxx, t_xxy = t_xxx - g_x * along_x.xxx - g_y * along_y.xxx, t_xxy - g_x * along_x.xxy - g_y * along_y.xxy
        t_xyy, t_yyy = t_xyy - g_x * along_x.xyy - g_y * along_y.xyy, t_yyy - g_x * along_x.yyy - g_y * along_y.yyy
    return SurfacePoint(
        *(w, w_t, w_tt, g_x, g_y, g_xt, g_yt, h_xx, h_xy, h_yy, g_xtt, g_ytt),
        *(h_xxt, h_xyt, h_yyt, t_xxx, t_xxy, t_xyy, t_yyy, base_px, base_py, base_vx, base_vy, base_ax, base_ay),
        *(x_x, x_y, y_x, y_y, x_xt, x_yt, y_xt, y_yt, x_xx, x_xy, x_yy, y_xx, y_xy, y_yy),
    )


@jit_no_arrays
def _logarithm(floor: float, square: float) -> tuple[float, float, float]:
    """What r^2 ln r is made of: r^2 outside the floor, how far r is inside it, and 2 ln r there; lengths over the size.

    Within the floor it is the parabola in r^2 that meets r^2 ln r with two derivatives: there `inner` is not 0.
    """
    bounded = max(square, floor * floor)
    return bounded, (square - bounded) / bounded, math.log(bounded)


@jit_no_arrays
def motion_at(local: LocalSurface, x: float, y: float, out: FloatArray) -> None:
    """The surface at a fixed point [m] as polynomials in time: w, w_x, w_y into `out` (3, 6)."""
    frame: Frame = local.frame[0]
    size, c = frame.surface_size, local.smooth
    u, v = (x - frame.x) / frame.half_x, (y - frame.y) / frame.half_y
    monomials, degree = frame.monomials, frame.degree
    for k in range(ORDER):
        w = w_u = w_v = 0.0
        m = monomials
        for i in range(degree, -1, -1):
            a = a_v = 0.0
            for _ in range(degree + 1 - i):
                m -= 1
                a_v = a_v * v + a
                a = a * v + c[k, m]
            w_u = w_u * u + w
            w = w * u + a
            w_v = w_v * u + a_v
        out[0, k], out[1, k], out[2, k] = w, w_u / frame.half_x, w_v / frame.half_y
    for j in range(frame.logarithms):
        d_x, d_y = (x - local.sources[j, 0]) / size, (y - local.sources[j, 1]) / size
        bounded, inner, logarithm = _logarithm(frame.floor, d_x * d_x + d_y * d_y)
        value = 0.5 * bounded * (logarithm + inner * (logarithm + 1 + 0.5 * inner))
        slope = (logarithm + 1 + inner) / size
        for k in range(ORDER):
            f = c[k, monomials + j]
            out[0, k] += f * value
            out[1, k] += f * slope * d_x
            out[2, k] += f * slope * d_y


@jit
def evaluate_points(surface: Surface, local: LocalSurface, xy: FloatArray, time: float) -> tuple[FloatArray, BoolArray]:
    """Height and slopes at points (n, 2) [m] and one time [s], nan beyond the rim: (n, 18).

    The first twelve of `SurfacePoint`, derivatives of w itself; then u, u_t and u_tt. Also (n,) which of the points
    have no cell yet.
    """
    out, missing = np.full((len(xy), 18), math.nan), np.zeros(len(xy), dtype=np.bool_)
    for n in range(len(xy)):
        x, y = xy[n]
        if rim_gap(surface, x, y) < -1e-9 * surface.size:
            continue
        cell = enter(surface, local, x, y, time, math.inf)
        missing[n] = cell == UNBUILT
        if cell >= 0:
            f = surface_at(local, x, y, time)
            out[n, :10] = np.array([f.w, f.w_t, f.w_tt, f.w_x, f.w_y, f.w_xt, f.w_yt, f.w_xx, f.w_xy, f.w_yy])
            out[n, 10:12] = np.array([f.w_xtt, f.w_ytt])
            out[n, 12:] = 0.0
            if local.frame[0].in_plane > 0:
                a = planar_at(local, 0, x, y, time)
                b = planar_at(local, local.frame[0].plane_monomials, x, y, time)
                out[n, 3:5] = np.array([f.x_x * f.w_x + f.y_x * f.w_y, f.x_y * f.w_x + f.y_y * f.w_y])
                out[n, 5:12] += f.w_x * np.array([a.xt, a.yt, a.xx, a.xy, a.yy, a.xtt, a.ytt])
                out[n, 5:12] += f.w_y * np.array([b.xt, b.yt, b.xx, b.xy, b.yy, b.xtt, b.ytt])
                out[n, 12:] = np.array([a.u, b.u, a.t, b.t, a.tt, b.tt])
    return out, missing
