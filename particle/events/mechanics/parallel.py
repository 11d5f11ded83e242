"""The surfaces parallel to the mid-plane, at a height z along its normal n: the contact's and the centre of mass's.

The plate's normals stay normal, so the point X stuck to the plate is at P + z n with P = (X + u, w). Vectors along the
surface are given by their x and y components a; their third is g.a, g the slope as seen in space, and their length
|a|_M, M = I + g g^T. With F = I + grad u, grad w = F^T g, s^2 = 1 + |g|^2 and S = M^-1 G / s, G = dg/dX,

    d(P + z n)/dX a = (F - z S) a

and for derivatives along two parameters p and q of place and time, sigma_p = g.g_p,

    n_p.n_q = (g_p.g_q - sigma_p sigma_q / s^2) / s^2 = -n.n_pq
    n_pq along the surface = (-g_pq + (g_p sigma_q + g_q sigma_p + g (g.g_pq)) / s^2 - 2 g sigma_p sigma_q / s^4) / s

The derivatives of g follow from those of F^T g = grad w. With w_p the derivatives of P times (-g, 1) that a
`SurfacePoint` holds, F^T g_p = grad w_p and F^T g_pq = grad w_pq - F_p^T g_q - F_q^T g_p. Where u = 0, F = I and G is
the matrix of second derivatives of w.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from particle.jit import device_no_arrays, inlined
from particle.surface import SurfacePoint


class Shape(NamedTuple):
    """The shape operator S [1/m], and the stretch F, both by rows."""

    xx: float
    xy: float
    yx: float
    yy: float
    f_xx: float
    f_xy: float
    f_yx: float
    f_yy: float


@device_no_arrays
def shape_operator(f: SurfacePoint) -> Shape:
    """S and F; where F = I, the eigenvalues of S are the principal curvatures, positive where the surface is hollow."""
    square = 1 + f.w_x * f.w_x + f.w_y * f.w_y
    s = math.sqrt(square)
    xx, yx = seen_in_space(f, f.w_xx, f.w_xy)
    xy, yy = seen_in_space(f, f.w_xy, f.w_yy)
    h_x, h_y = (f.w_x * xx + f.w_y * yx) / square, (f.w_x * xy + f.w_y * yy) / square
    return Shape(
        *((xx - f.w_x * h_x) / s, (xy - f.w_x * h_y) / s),
        *((yx - f.w_y * h_x) / s, (yy - f.w_y * h_y) / s),
        *(f.x_x, f.x_y, f.y_x, f.y_y),
    )


@device_no_arrays
def to_height(shape: Shape, z: float, x: float, y: float) -> tuple[float, float]:
    """(F - z S) a: the velocity at the height z [m] of a point whose normal moves over the mid-plane by a = (x, y)."""
    f_x, f_y = shape.f_xx * x + shape.f_xy * y, shape.f_yx * x + shape.f_yy * y
    return f_x - z * (shape.xx * x + shape.xy * y), f_y - z * (shape.yx * x + shape.yy * y)


@device_no_arrays
def from_height(shape: Shape, z: float, x: float, y: float) -> tuple[float, float]:
    """(F - z S)^-1 a, the inverse of `to_height`."""
    xx, xy = shape.f_xx - z * shape.xx, shape.f_xy - z * shape.xy
    yx, yy = shape.f_yx - z * shape.yx, shape.f_yy - z * shape.yy
    det = xx * yy - xy * yx
    return (yy * x - xy * y) / det, (xx * y - yx * x) / det


@device_no_arrays
def stretched(f: SurfacePoint, x: float, y: float) -> tuple[float, float]:
    """F a: the velocity in space, over its material, of a point that moves over the mid-plane by a = (x, y)."""
    return f.x_x * x + f.x_y * y, f.y_x * x + f.y_y * y


@device_no_arrays
def unstretched(f: SurfacePoint, x: float, y: float) -> tuple[float, float]:
    """F^-1 a, the inverse of `stretched`."""
    det = f.x_x * f.y_y - f.x_y * f.y_x
    return (f.y_y * x - f.x_y * y) / det, (f.x_x * y - f.y_x * x) / det


@device_no_arrays
def seen_in_space(f: SurfacePoint, x: float, y: float) -> tuple[float, float]:
    """F^-T a."""
    det = f.x_x * f.y_y - f.x_y * f.y_x
    return (f.y_y * x - f.y_x * y) / det, (f.x_x * y - f.x_y * x) / det


@device_no_arrays
def stretch_rate(f: SurfacePoint, v_x: float, v_y: float, a_x: float, a_y: float) -> tuple[float, float]:
    """F' a [m/s^2], F' the rate of F as seen by a point that moves by v."""
    return (
        f.x_xt * a_x + f.x_yt * a_y + f.x_xx * v_x * a_x + f.x_xy * (v_x * a_y + v_y * a_x) + f.x_yy * v_y * a_y,
        f.y_xt * a_x + f.y_yt * a_y + f.y_xx * v_x * a_x + f.y_xy * (v_x * a_y + v_y * a_x) + f.y_yy * v_y * a_y,
    )


@device_no_arrays
def inner(f: SurfacePoint, a_x: float, a_y: float, b_x: float, b_y: float) -> float:
    """The scalar product of two vectors along the surface."""
    return a_x * b_x + a_y * b_y + (a_x * f.w_x + a_y * f.w_y) * (b_x * f.w_x + b_y * f.w_y)


@device_no_arrays
def slope_rate(f: SurfacePoint, v_x: float, v_y: float) -> tuple[float, float]:
    """The rate [1/s] of the slope as seen by a point that moves by (v_x, v_y) [m/s]."""
    return seen_in_space(f, f.w_xt + f.w_xx * v_x + f.w_xy * v_y, f.w_yt + f.w_xy * v_x + f.w_yy * v_y)


@inlined
def _slope_bend(f: SurfacePoint, v_x: float, v_y: float, p_x: float, p_y: float) -> tuple[float, float]:
    """The second derivative [1/s^2] in time of the slope as seen by a point that moves steadily.

    p: its first.
    """
    along_x, along_y = _slope_bend_along(f, v_x, v_y)
    t_x, t_y = _pulled_back(f, 1.0, v_x, v_y, p_x, p_y)
    return seen_in_space(
        f,
        f.w_xtt + f.w_xxt * v_x + f.w_xyt * v_y + along_x - 2 * t_x,
        f.w_ytt + f.w_xyt * v_x + f.w_yyt * v_y + along_y - 2 * t_y,
    )


@device_no_arrays
def _pulled_back(f: SurfacePoint, time: float, v_x: float, v_y: float, p_x: float, p_y: float) -> tuple[float, float]:
    """F_q^T p, with q along `time` and v."""
    xx, xy = time * f.x_xt + f.x_xx * v_x + f.x_xy * v_y, time * f.x_yt + f.x_xy * v_x + f.x_yy * v_y
    yx, yy = time * f.y_xt + f.y_xx * v_x + f.y_xy * v_y, time * f.y_yt + f.y_xy * v_x + f.y_yy * v_y
    return xx * p_x + yx * p_y, xy * p_x + yy * p_y


@device_no_arrays
def _slope_bend_along(f: SurfacePoint, v_x: float, v_y: float) -> tuple[float, float]:
    """That of w, (-g, 1).P, in the derivative along v of the `slope_rate` of a point that moves by v."""
    xx, xy, yy = v_x * v_x, 2 * v_x * v_y, v_y * v_y
    return (
        f.w_xxt * v_x + f.w_xyt * v_y + f.w_xxx * xx + f.w_xxy * xy + f.w_xyy * yy,
        f.w_xyt * v_x + f.w_yyt * v_y + f.w_xxy * xx + f.w_xyy * xy + f.w_yyy * yy,
    )


@device_no_arrays
def normal_rate(f: SurfacePoint, v_x: float, v_y: float) -> tuple[float, float, float]:
    """The rate [1/s] of the normal, in space, at a point that moves by (v_x, v_y) [m/s]."""
    g_x, g_y = slope_rate(f, v_x, v_y)
    square = 1 + f.w_x * f.w_x + f.w_y * f.w_y
    s, sigma = math.sqrt(square), f.w_x * g_x + f.w_y * g_y
    return (f.w_x * sigma / square - g_x) / s, (f.w_y * sigma / square - g_y) / s, -sigma / (square * s)


class Bend(NamedTuple):
    """A second derivative of the normal: along the surface, and its part against the normal."""

    x: float  # 1/s^2
    y: float  # 1/s^2
    down: float  # 1/s^2


@device_no_arrays
def normal_bend(f: SurfacePoint, v_x: float, v_y: float) -> Bend:
    """The second derivative of the normal in time, at a point that moves steadily by (v_x, v_y) [m/s]."""
    p_x, p_y = slope_rate(f, v_x, v_y)
    pp_x, pp_y = _slope_bend(f, v_x, v_y, p_x, p_y)
    return _bend(f, p_x, p_y, p_x, p_y, pp_x, pp_y)


@device_no_arrays
def normal_bend_along(f: SurfacePoint, v_x: float, v_y: float) -> Bend:
    """The derivative along v of the normal's rate in time, at a point that moves steadily by v [m/s]."""
    p_x, p_y = seen_in_space(f, f.w_xx * v_x + f.w_xy * v_y, f.w_xy * v_x + f.w_yy * v_y)
    q_x, q_y = slope_rate(f, v_x, v_y)
    pq_x, pq_y = _slope_bend_along(f, v_x, v_y)
    s_x, s_y = _pulled_back(f, 0.0, v_x, v_y, q_x, q_y)
    t_x, t_y = _pulled_back(f, 1.0, v_x, v_y, p_x, p_y)
    pq_x, pq_y = seen_in_space(f, pq_x - s_x - t_x, pq_y - s_y - t_y)
    return _bend(f, p_x, p_y, q_x, q_y, pq_x, pq_y)


@device_no_arrays
def _bend(f: SurfacePoint, p_x: float, p_y: float, q_x: float, q_y: float, pq_x: float, pq_y: float) -> Bend:
    """n_pq from g_p, g_q and g_pq."""
    square = 1 + f.w_x * f.w_x + f.w_y * f.w_y
    s = math.sqrt(square)
    p, q, pq = f.w_x * p_x + f.w_y * p_y, f.w_x * q_x + f.w_y * q_y, f.w_x * pq_x + f.w_y * pq_y
    along = pq / square - 2 * p * q / (square * square)
    return Bend(
        (-pq_x + (p_x * q + q_x * p) / square + f.w_x * along) / s,
        (-pq_y + (p_y * q + q_y * p) / square + f.w_y * along) / s,
        (p_x * q_x + p_y * q_y - p * q / square) / square,
    )
