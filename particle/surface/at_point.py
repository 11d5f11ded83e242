"""The surface where the part is: its height, slopes and curvatures, and their rates, from the cell that it is in."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.drives import ORDER, evaluate_piece
from particle.jit import device_no_arrays, jit, spliced
from particle.lanes import at_least, log, where_zero
from particle.surface.cells import UNBUILT
from particle.surface.jet import Jet, at_time, fill_quintics, point_jet
from particle.surface.local import Frame, LocalSurface
from particle.surface.record import Surface
from particle.surface.rim import rim_gap
from particle.surface.span import enter
from particle.types import FloatArray


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


POINT_SIZE = len(SurfacePoint._fields)


@device_no_arrays
def set_time(local: LocalSurface, time: float) -> None:
    """Prepare `height_here` and `plane_jet` for a time [s] of the prepared span."""
    frame: Frame = local.frame[0]
    if time == frame.moment:
        return
    frame.moment, s = time, (time - frame.time) / frame.unit
    at_time(local.smooth, local.at, frame.monomials + frame.logarithms, s, frame.unit)
    if frame.in_plane > 0:
        at_time(local.plane, local.plane_at, 2 * frame.plane_monomials, s, frame.unit)


@spliced
def height_here(local: LocalSurface, x: Any, y: Any, jet_of: Any) -> Jet:
    """w and its derivatives at a point [m] of the prepared cell, or at lanes of such, and the time of `set_time`.

    w = sum c_ij u^i v^j + sum f_k |X - X_k|^2 ln |X - X_k|, lengths in the logarithms over the surface's size.
    jet_of: `point_jet`, or for lanes `jet`.
    """
    frame: Frame = local.frame[0]
    size = frame.surface_size
    u, v = (x - frame.x) / frame.half_x, (y - frame.y) / frame.half_y
    f = jet_of(local.at, frame.monomials, frame.degree, u, v, frame.half_x, frame.half_y)
    w, w_t, w_tt, g_x, g_y, g_xt, g_yt, g_xtt, g_ytt = f.f, f.t, f.tt, f.x, f.y, f.xt, f.yt, f.xtt, f.ytt
    h_xx, h_xy, h_yy, h_xxt, h_xyt, h_yyt = f.xx, f.xy, f.yy, f.xxt, f.xyt, f.yyt
    t_xxx, t_xxy, t_xyy, t_yyy = f.xxx, f.xxy, f.xyy, f.yyy
    per = 1 / size
    for j in range(frame.logarithms):
        d_x, d_y = (x - local.sources[j, 0]) * per, (y - local.sources[j, 1]) * per
        bounded, inner, logarithm = _logarithm(frame.floor, d_x * d_x + d_y * d_y)
        m = frame.monomials + j
        f_k, f_t, f_tt = local.at[0, m], local.at[1, m], local.at[2, m]
        value = 0.5 * bounded * (logarithm + inner * (logarithm + 1 + 0.5 * inner))
        bend, once = logarithm + 1 + inner, 2 / bounded
        w += f_k * value
        w_t += f_t * value
        w_tt += f_tt * value
        slope_x, slope_y = bend * d_x * per, bend * d_y * per
        g_x += f_k * slope_x
        g_y += f_k * slope_y
        g_xt += f_t * slope_x
        g_yt += f_t * slope_y
        g_xtt += f_tt * slope_x
        g_ytt += f_tt * slope_y
        bend_xx, bend_yy = (bend + once * d_x * d_x) * per * per, (bend + once * d_y * d_y) * per * per
        bend_xy = once * d_x * d_y * per * per
        h_xx += f_k * bend_xx
        h_xy += f_k * bend_xy
        h_yy += f_k * bend_yy
        h_xxt += f_t * bend_xx
        h_xyt += f_t * bend_xy
        h_yyt += f_t * bend_yy
        # Within the floor the third derivatives are those of the parabola in r^2.
        twist, cubed = f_k * per * per * per, where_zero(inner, -once * once)
        t_xxx += twist * d_x * (3 * once + cubed * d_x * d_x)
        t_xxy += twist * d_y * (once + cubed * d_x * d_x)
        t_xyy += twist * d_x * (once + cubed * d_y * d_y)
        t_yyy += twist * d_y * (3 * once + cubed * d_y * d_y)
    return Jet(
        *(w, w_t, w_tt, g_x, g_y, g_xt, g_yt, h_xx, h_xy, h_yy, g_xtt, g_ytt),
        *(h_xxt, h_xyt, h_yyt, t_xxx, t_xxy, t_xyy, t_yyy),
    )


@device_no_arrays
def surface_at(local: LocalSurface, x: float, y: float, time: float) -> SurfacePoint:
    """The surface at a point [m] of the prepared cell and a time [s] of the prepared span."""
    return surface_here(local, x, y, time)


@spliced
def surface_here(local: LocalSurface, x: float, y: float, time: float) -> SurfacePoint:
    """As `surface_at`, compiled into its caller."""
    frame: Frame = local.frame[0]
    set_time(local, time)
    f = height_here(local, x, y, point_jet)
    g_x, g_y, g_xt, g_yt, g_xtt, g_ytt = f.x, f.y, f.xt, f.yt, f.xtt, f.ytt
    h_xx, h_xy, h_yy, h_xxt, h_xyt, h_yyt = f.xx, f.xy, f.yy, f.xxt, f.xyt, f.yyt
    t_xxx, t_xxy, t_xyy, t_yyy = f.xxx, f.xxy, f.xyy, f.yyy
    s, unit = (time - frame.time) / frame.unit, frame.unit
    base_px = base_py = base_vx = base_vy = base_ax = base_ay = 0.0
    if frame.base_drives > 0:
        base_px, base_vx, base_ax = evaluate_piece(local.base[:, 0], s, unit)
        base_py, base_vy, base_ay = evaluate_piece(local.base[:, 1], s, unit)
    x_x, x_y, y_x, y_y = 1.0, 0.0, 0.0, 1.0
    x_xt = x_yt = y_xt = y_yt = x_xx = x_xy = x_yy = y_xx = y_xy = y_yy = 0.0
    if frame.in_plane > 0:
        along_x, along_y = plane_jet(local, 0, x, y, point_jet), plane_jet(local, 1, x, y, point_jet)
        x_x, x_y, y_x, y_y = 1 + along_x.x, along_x.y, along_y.x, 1 + along_y.y
        x_xt, x_yt, y_xt, y_yt = along_x.xt, along_x.yt, along_y.xt, along_y.yt
        x_xx, x_xy, x_yy, y_xx, y_xy, y_yy = along_x.xx, along_x.xy, along_x.yy, along_y.xx, along_y.xy, along_y.yy
        base_px, base_vx, base_ax = base_px + along_x.f, base_vx + along_x.t, base_ax + along_x.tt
        base_py, base_vy, base_ay = base_py + along_y.f, base_vy + along_y.t, base_ay + along_y.tt
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
        *(f.f, f.t, f.tt, g_x, g_y, g_xt, g_yt, h_xx, h_xy, h_yy, g_xtt, g_ytt),
        *(h_xxt, h_xyt, h_yyt, t_xxx, t_xxy, t_xyy, t_yyy, base_px, base_py, base_vx, base_vy, base_ax, base_ay),
        *(x_x, x_y, y_x, y_y, x_xt, x_yt, y_xt, y_yt, x_xx, x_xy, x_yy, y_xx, y_xy, y_yy),
    )


@spliced
def plane_jet(local: LocalSurface, along: int, x: Any, y: Any, jet_of: Any) -> Jet:
    """The motion u [m] of the mid-plane in its plane along x (0) or y (1), the base's excluded, as `height_here`."""
    frame: Frame = local.frame[0]
    u, v = (x - frame.x) / frame.half_x, (y - frame.y) / frame.half_y
    end = (along + 1) * frame.plane_monomials
    return jet_of(local.plane_at, end, frame.plane_degree, u, v, frame.half_x, frame.half_y)


@spliced
def _logarithm(floor: float, square: Any) -> tuple[Any, Any, Any]:
    """What r^2 ln r is made of: r^2 outside the floor, how far r is inside it, and 2 ln r there; lengths over the size.

    Within the floor it is the parabola in r^2 that meets r^2 ln r with two derivatives: there `inner` is not 0.
    """
    bounded = at_least(square, floor * floor)
    return bounded, (square - bounded) / bounded, log(bounded)


@device_no_arrays
def motion_at(local: LocalSurface, x: float, y: float, motion: FloatArray, plane: FloatArray) -> None:
    """The surface at a fixed point [m] as polynomials in (t - time) / unit.

    motion (6, 6): w, w_x, w_y, w_xx, w_xy, w_yy.  plane (2, 6, 6): the same of the place along x and y, base included.
    """
    frame: Frame = local.frame[0]
    size = frame.surface_size
    u, v = (x - frame.x) / frame.half_x, (y - frame.y) / frame.half_y
    half_x, half_y = frame.half_x, frame.half_y
    fill_quintics(local.smooth, frame.monomials, frame.degree, u, v, half_x, half_y, motion)
    for j in range(frame.logarithms):
        d_x, d_y = (x - local.sources[j, 0]) / size, (y - local.sources[j, 1]) / size
        bounded, inner, logarithm = _logarithm(frame.floor, d_x * d_x + d_y * d_y)
        value = 0.5 * bounded * (logarithm + inner * (logarithm + 1 + 0.5 * inner))
        slope = (logarithm + 1 + inner) / size
        for k in range(ORDER):
            f = local.smooth[k, frame.monomials + j]
            motion[0, k] += f * value
            motion[1, k] += f * slope * d_x
            motion[2, k] += f * slope * d_y
            bend = f / (size * size)
            motion[3, k] += bend * (logarithm + 1 + inner + 2 * d_x * d_x / bounded)
            motion[4, k] += bend * 2 * d_x * d_y / bounded
            motion[5, k] += bend * (logarithm + 1 + inner + 2 * d_y * d_y / bounded)
    plane[:] = 0.0
    if frame.in_plane > 0:
        count, degree = frame.plane_monomials, frame.plane_degree
        for along in range(2):
            fill_quintics(local.plane, (along + 1) * count, degree, u, v, half_x, half_y, plane[along])
    for k in range(ORDER):
        plane[0, 0, k] += local.base[k, 0]
        plane[1, 0, k] += local.base[k, 1]


@jit
def sample_surface(
    surface: Surface, local: LocalSurface, xy: FloatArray, times: FloatArray
) -> tuple[FloatArray, NDArray[np.bool_]]:
    """The surface at points (n, 2) [m] and times (n,) [s], nan beyond the rim: (n, 49); (n,) which lack a cell yet.

    A row is a `SurfacePoint`; then u, u_t, u_tt, u_xtt and u_ytt along x and along y, the base's motion excluded.
    """
    out, missing = np.full((len(xy), POINT_SIZE + 10), math.nan), np.zeros(len(xy), dtype=np.bool_)
    for n in range(len(xy)):
        x, y = xy[n, 0], xy[n, 1]
        if rim_gap(surface, x, y) < -1e-9 * surface.size:
            continue
        cell = enter(surface, local, x, y, times[n], math.inf)
        missing[n] = cell == UNBUILT
        if cell < 0:
            continue
        f = surface_at(local, x, y, times[n])
        for k in range(POINT_SIZE):
            out[n, k] = f[k]
        for k in range(POINT_SIZE, out.shape[1]):
            out[n, k] = 0.0
        if local.frame[0].in_plane > 0:
            for along in range(2):
                u, k = plane_jet(local, along, x, y, point_jet), POINT_SIZE + 5 * along
                out[n, k], out[n, k + 1], out[n, k + 2], out[n, k + 3], out[n, k + 4] = u.f, u.t, u.tt, u.xtt, u.ytt
    return out, missing


@device_no_arrays
def point_of(row: FloatArray) -> SurfacePoint:
    """The `SurfacePoint` of a row of `sample_surface`."""
    return SurfacePoint(
        *(row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7], row[8], row[9], row[10], row[11], row[12]),
        *(row[13], row[14], row[15], row[16], row[17], row[18], row[19], row[20], row[21], row[22], row[23], row[24]),
        *(row[25], row[26], row[27], row[28], row[29], row[30], row[31], row[32], row[33], row[34], row[35], row[36]),
        *(row[37], row[38]),
    )
