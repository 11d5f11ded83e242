"""The motion of the mid-plane in its plane, where the part is: the polynomials of its cell along x and y."""

from __future__ import annotations

from typing import NamedTuple

from particle.drives import ORDER
from particle.jit import jit_no_arrays
from particle.surface.local import Frame, LocalSurface
from particle.types import FloatArray


class Planar(NamedTuple):
    """One component of the motion u of a material point in the plane, with its derivatives, in SI units."""

    u: float
    t: float
    tt: float
    x: float
    y: float
    xt: float
    yt: float
    xx: float
    xy: float
    yy: float
    xtt: float
    ytt: float
    xxt: float
    xyt: float
    yyt: float
    xxx: float
    xxy: float
    xyy: float
    yyy: float


@jit_no_arrays
def planar_at(local: LocalSurface, first: int, x: float, y: float, time: float) -> Planar:
    """One component of the motion in the plane; first: the first of its monomials."""
    frame: Frame = local.frame[0]
    unit, degree = frame.unit, frame.plane_degree
    half_x, half_y = frame.half_x, frame.half_y
    u, v = (x - frame.x) / half_x, (y - frame.y) / half_y
    s = (time - frame.time) / unit
    p, at = local.plane, local.plane_at
    w = w_u = w_uu = w_uuu = w_v = w_uv = w_uuv = w_vv = w_uvv = w_vvv = 0.0
    w_t = w_ut = w_uut = w_vt = w_uvt = w_vvt = w_tt = w_utt = w_vtt = 0.0
    for m in range(first, first + frame.plane_monomials):
        at[0, m] = ((((p[5, m] * s + p[4, m]) * s + p[3, m]) * s + p[2, m]) * s + p[1, m]) * s + p[0, m]
        at[1, m] = (((5 * p[5, m] * s + 4 * p[4, m]) * s + 3 * p[3, m]) * s + 2 * p[2, m]) * s + p[1, m]
        at[2, m] = ((20 * p[5, m] * s + 12 * p[4, m]) * s + 6 * p[3, m]) * s + 2 * p[2, m]
    m = first + frame.plane_monomials
    # As in `surface_at`.
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
    r_x, r_y, rate, bend = 1 / half_x, 1 / half_y, 1 / unit, 1 / (unit * unit)
    return Planar(
        *(w, w_t * rate, w_tt * bend, w_u * r_x, w_v * r_y, w_ut * r_x * rate, w_vt * r_y * rate),
        *(2 * w_uu * r_x * r_x, w_uv * r_x * r_y, 2 * w_vv * r_y * r_y, w_utt * r_x * bend, w_vtt * r_y * bend),
        *(2 * w_uut * r_x * r_x * rate, w_uvt * r_x * r_y * rate, 2 * w_vvt * r_y * r_y * rate),
        *(6 * w_uuu * r_x * r_x * r_x, 2 * w_uuv * r_x * r_x * r_y),
        *(2 * w_uvv * r_x * r_y * r_y, 6 * w_vvv * r_y * r_y * r_y),
    )


@jit_no_arrays
def planar_motion_at(local: LocalSurface, x: float, y: float, out: FloatArray) -> None:
    """The motion in the plane of a fixed point [m] as polynomials in time into `out` (6, 6), the base excluded.

    Rows: u along x, its derivatives by x and y; the same along y.
    """
    frame: Frame = local.frame[0]
    u, v = (x - frame.x) / frame.half_x, (y - frame.y) / frame.half_y
    for component in range(2):
        for k in range(ORDER):
            w = w_u = w_v = 0.0
            m = (component + 1) * frame.plane_monomials
            for i in range(frame.plane_degree, -1, -1):
                a = a_v = 0.0
                for _ in range(frame.plane_degree + 1 - i):
                    m -= 1
                    a_v = a_v * v + a
                    a = a * v + local.plane[k, m]
                w_u = w_u * u + w
                w = w * u + a
                w_v = w_v * u + a_v
            row = 3 * component
            out[row, k], out[row + 1, k], out[row + 2, k] = w, w_u / frame.half_x, w_v / frame.half_y
