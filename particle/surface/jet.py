"""Polynomials of a cell with their derivatives, at one place and time or at one place over time."""

from __future__ import annotations

from typing import Any, NamedTuple

from particle.drives import ORDER, quintic_at
from particle.jit import device_no_arrays, spliced
from particle.lanes import LANES, lanes_of, load, load_some, nought, store, total
from particle.types import FloatArray


class Jet(NamedTuple):
    """A function f of (x, y, t) with its derivatives, in SI units; numbers or lanes."""

    f: float
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


@device_no_arrays
def at_time(c: FloatArray, at: FloatArray, end: int, s: float, unit: float) -> None:
    """sum_k c[k, m] s^k and its two derivatives in t = unit s [s] into at[:3, m], m < end."""
    per, whole = 1 / unit, end - end % LANES
    for m in range(0, whole, LANES):
        c_0, c_1, c_2 = load(c[0], m), load(c[1], m), load(c[2], m)
        value, first, second = quintic_at(c_0, c_1, c_2, load(c[3], m), load(c[4], m), load(c[5], m), s)
        store(at[0], m, value)
        store(at[1], m, first * per)
        store(at[2], m, second * (per * per))
    for m in range(whole, end):
        value, first, second = quintic_at(c[0, m], c[1, m], c[2, m], c[3, m], c[4, m], c[5, m], s)
        at[0, m], at[1, m], at[2, m] = value, first * per, second * (per * per)


@spliced
def jet(at: FloatArray, end: int, degree: int, u: Any, v: Any, half_x: float, half_y: float) -> Jet:
    """f = sum c_ij u^i v^j, i + j <= degree, and its derivatives, with the monomials at[:, m] that end before `end`.

    at (3, ...): their values and two derivatives in time.  half_x, half_y: dx/du and dy/dv [m].
    """
    zero = nought(u)
    w = w_u = w_uu = w_uuu = w_v = w_uv = w_uuv = w_vv = w_uvv = w_vvv = zero
    w_t = w_ut = w_uut = w_vt = w_uvt = w_vvt = w_tt = w_utt = w_vtt = zero
    m = end
    # Horner in v inside Horner in u; n times u or v in a name stands for the n-th derivative over n!.
    for i in range(degree, -1, -1):
        a = a_v = a_vv = a_vvv = b = b_v = b_vv = c = c_v = zero
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
    return Jet(
        *(w, w_t, w_tt, w_u / half_x, w_v / half_y, w_ut / half_x, w_vt / half_y),
        *(2 * w_uu / half_x**2, w_uv / (half_x * half_y), 2 * w_vv / half_y**2, w_utt / half_x, w_vtt / half_y),
        *(2 * w_uut / half_x**2, w_uvt / (half_x * half_y), 2 * w_vvt / half_y**2),
        *(6 * w_uuu / half_x**3, 2 * w_uuv / (half_x**2 * half_y)),
        *(2 * w_uvv / (half_x * half_y**2), 6 * w_vvv / half_y**3),
    )


@spliced
def point_jet(at: FloatArray, end: int, degree: int, u: float, v: float, half_x: float, half_y: float) -> Jet:
    """As `jet` at one place, of numbers; lanes are powers of v.

    at: (3, ...) with LANES columns or more after `end`, of any numbers.
    """
    v_2 = v * v
    v_3, v_4 = v_2 * v, v_2 * v_2
    # Powers of v with their derivatives: the n-th over n!.
    p, p_v = lanes_of(1.0, v, v_2, v_3), lanes_of(0.0, 1.0, 2.0 * v, 3.0 * v_2)
    p_vv, p_vvv = lanes_of(0.0, 0.0, 1.0, 3.0 * v), lanes_of(0.0, 0.0, 0.0, 1.0)
    zero = nought(p)
    w = w_u = w_uu = w_uuu = w_v = w_uv = w_uuv = w_vv = w_uvv = w_vvv = zero
    w_t = w_ut = w_uut = w_vt = w_uvt = w_vvt = w_tt = w_utt = w_vtt = zero
    for first in range(0, degree + 1, LANES):
        a = a_u = a_uu = a_uuu = b = b_u = b_uu = c = c_u = zero
        m = end - first * (first + 1) // 2  # the end of the rows i <= degree - first
        for i in range(degree - first, -1, -1):
            m -= degree + 1 - i
            count = degree + 1 - i - first
            a_uuu = a_uuu * u + a_uu
            a_uu = a_uu * u + a_u
            a_u = a_u * u + a
            a = a * u + load_some(at[0], m + first, count)
            b_uu = b_uu * u + b_u
            b_u = b_u * u + b
            b = b * u + load_some(at[1], m + first, count)
            c_u = c_u * u + c
            c = c * u + load_some(at[2], m + first, count)
        w, w_v, w_vv, w_vvv = w + a * p, w_v + a * p_v, w_vv + a * p_vv, w_vvv + a * p_vvv
        w_u, w_uv, w_uvv = w_u + a_u * p, w_uv + a_u * p_v, w_uvv + a_u * p_vv
        w_uu, w_uuv, w_uuu = w_uu + a_uu * p, w_uuv + a_uu * p_v, w_uuu + a_uuu * p
        w_t, w_vt, w_vvt = w_t + b * p, w_vt + b * p_v, w_vvt + b * p_vv
        w_ut, w_uvt, w_uut = w_ut + b_u * p, w_uvt + b_u * p_v, w_uut + b_uu * p
        w_tt, w_vtt, w_utt = w_tt + c * p, w_vtt + c * p_v, w_utt + c_u * p
        p_vvv = p_vvv * v_4 + p_vv * (4.0 * v_3) + p_v * (6.0 * v_2) + p * (4.0 * v)
        p_vv = p_vv * v_4 + p_v * (4.0 * v_3) + p * (6.0 * v_2)
        p_v, p = p_v * v_4 + p * (4.0 * v_3), p * v_4
    x, y = 1 / half_x, 1 / half_y
    return Jet(
        *(total(w), total(w_t), total(w_tt), total(w_u) * x, total(w_v) * y, total(w_ut) * x, total(w_vt) * y),
        *(2 * total(w_uu) * (x * x), total(w_uv) * (x * y), 2 * total(w_vv) * (y * y)),
        *(total(w_utt) * x, total(w_vtt) * y),
        *(2 * total(w_uut) * (x * x), total(w_uvt) * (x * y), 2 * total(w_vvt) * (y * y)),
        *(6 * total(w_uuu) * (x * x * x), 2 * total(w_uuv) * (x * x * y)),
        *(2 * total(w_uvv) * (x * y * y), 6 * total(w_vvv) * (y * y * y)),
    )


@device_no_arrays
def fill_quintics(
    c: FloatArray, end: int, degree: int, u: float, v: float, half_x: float, half_y: float, out: FloatArray
) -> None:
    """f, f_x, f_y, f_xx, f_xy and f_yy at one place as polynomials of s into the rows of `out` (6, 6).

    c (6, ...): as in `at_time`.
    """
    for k in range(ORDER):
        w = w_u = w_v = w_uu = w_uv = w_vv = 0.0
        m = end
        for i in range(degree, -1, -1):
            a = a_v = a_vv = 0.0
            for _ in range(degree + 1 - i):
                m -= 1
                a_vv = a_vv * v + a_v
                a_v = a_v * v + a
                a = a * v + c[k, m]
            w_uu = w_uu * u + w_u
            w_u = w_u * u + w
            w = w * u + a
            w_uv = w_uv * u + w_v
            w_v = w_v * u + a_v
            w_vv = w_vv * u + a_vv
        out[0, k], out[1, k], out[2, k] = w, w_u / half_x, w_v / half_y
        out[3, k], out[4, k], out[5, k] = 2 * w_uu / half_x**2, w_uv / (half_x * half_y), 2 * w_vv / half_y**2
