"""The surfaces parallel to the mid-plane, at a height z along its normal n: the contact's and the centre of mass's.

The plate's normals stay normal, so a point stuck to the plate is at P + z n with P = (x, y, w). Vectors along the
surface are given by their x and y components a; their third is g.a, g = grad w, and their length |a|_M, M = I + g g^T.
With s^2 = 1 + |g|^2 and S = M^-1 H / s, H the matrix of second derivatives of w,

    d(P + z n)/d(x, y) a = (I - z S) a

and for derivatives along two parameters p and q of place and time, sigma_p = g.g_p,

    n_p.n_q = (g_p.g_q - sigma_p sigma_q / s^2) / s^2 = -n.n_pq
    n_pq along the surface = (-g_pq + (g_p sigma_q + g_q sigma_p + g (g.g_pq)) / s^2 - 2 g sigma_p sigma_q / s^4) / s
"""

from __future__ import annotations

import math
from typing import NamedTuple

from particle.jit import jit_no_arrays
from particle.surface import SurfacePoint


class Shape(NamedTuple):
    """The shape operator S [1/m], by rows."""

    xx: float
    xy: float
    yx: float
    yy: float


@jit_no_arrays
def shape_operator(f: SurfacePoint) -> Shape:
    """S; its eigenvalues are the principal curvatures, positive where the surface is hollow."""
    square = 1 + f.w_x * f.w_x + f.w_y * f.w_y
    s = math.sqrt(square)
    h_x, h_y = (f.w_x * f.w_xx + f.w_y * f.w_xy) / square, (f.w_x * f.w_xy + f.w_y * f.w_yy) / square
    return Shape(
        *((f.w_xx - f.w_x * h_x) / s, (f.w_xy - f.w_x * h_y) / s),
        *((f.w_xy - f.w_y * h_x) / s, (f.w_yy - f.w_y * h_y) / s),
    )


@jit_no_arrays
def to_height(shape: Shape, z: float, x: float, y: float) -> tuple[float, float]:
    """(I - z S) a: the velocity at the height z [m] of a point whose normal moves over the mid-plane by a = (x, y)."""
    return x - z * (shape.xx * x + shape.xy * y), y - z * (shape.yx * x + shape.yy * y)


@jit_no_arrays
def from_height(shape: Shape, z: float, x: float, y: float) -> tuple[float, float]:
    """(I - z S)^-1 a, the inverse of `to_height`."""
    xx, xy, yx, yy = 1 - z * shape.xx, -z * shape.xy, -z * shape.yx, 1 - z * shape.yy
    det = xx * yy - xy * yx
    return (yy * x - xy * y) / det, (xx * y - yx * x) / det


@jit_no_arrays
def inner(f: SurfacePoint, a_x: float, a_y: float, b_x: float, b_y: float) -> float:
    """The scalar product of two vectors along the surface."""
    return a_x * b_x + a_y * b_y + (a_x * f.w_x + a_y * f.w_y) * (b_x * f.w_x + b_y * f.w_y)


@jit_no_arrays
def slope_rate(f: SurfacePoint, v_x: float, v_y: float) -> tuple[float, float]:
    """The rate [1/s] of grad w as seen by a point that moves by (v_x, v_y) [m/s]."""
    return f.w_xt + f.w_xx * v_x + f.w_xy * v_y, f.w_yt + f.w_xy * v_x + f.w_yy * v_y


@jit_no_arrays
def _slope_bend(f: SurfacePoint, v_x: float, v_y: float) -> tuple[float, float]:
    """The second derivative [1/s^2] in time of grad w as seen by a point that moves steadily."""
    along_x, along_y = _slope_bend_along(f, v_x, v_y)
    return (
        f.w_xtt + f.w_xxt * v_x + f.w_xyt * v_y + along_x,
        f.w_ytt + f.w_xyt * v_x + f.w_yyt * v_y + along_y,
    )


@jit_no_arrays
def _slope_bend_along(f: SurfacePoint, v_x: float, v_y: float) -> tuple[float, float]:
    """The derivative along v of the `slope_rate` of a point that moves by v."""
    xx, xy, yy = v_x * v_x, 2 * v_x * v_y, v_y * v_y
    return (
        f.w_xxt * v_x + f.w_xyt * v_y + f.w_xxx * xx + f.w_xxy * xy + f.w_xyy * yy,
        f.w_xyt * v_x + f.w_yyt * v_y + f.w_xxy * xx + f.w_xyy * xy + f.w_yyy * yy,
    )


@jit_no_arrays
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


@jit_no_arrays
def normal_bend(f: SurfacePoint, v_x: float, v_y: float) -> Bend:
    """The second derivative of the normal in time, at a point that moves steadily by (v_x, v_y) [m/s]."""
    p_x, p_y = slope_rate(f, v_x, v_y)
    pp_x, pp_y = _slope_bend(f, v_x, v_y)
    return _bend(f, p_x, p_y, p_x, p_y, pp_x, pp_y)


@jit_no_arrays
def normal_bend_along(f: SurfacePoint, v_x: float, v_y: float) -> Bend:
    """The derivative along v of the normal's rate in time, at a point that moves steadily by v [m/s]."""
    p_x, p_y = f.w_xx * v_x + f.w_xy * v_y, f.w_xy * v_x + f.w_yy * v_y
    q_x, q_y = slope_rate(f, v_x, v_y)
    pq_x, pq_y = _slope_bend_along(f, v_x, v_y)
    return _bend(f, p_x, p_y, q_x, q_y, pq_x, pq_y)


@jit_no_arrays
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
