"""Friction on a face that slides and turns: force and torque in closed form.

A face slides over the surface by the twist (v_1, v_2, omega) of its origin, so that its point rho moves at
omega z x r, r = rho - r_c, around the centre of rotation r_c = z x v/omega. Under tractions q = q_0 + q_1.rho

    (f_1, f_2) = sgn(omega) (J_2, -J_1)     tau = -sgn(omega) T
    J = (q_0 + q_1.r_c) I + K q_1           T = (q_0 + q_1.r_c) M + q_1.L + r_c.J

with I = int r/|r| dA, M = int |r| dA, L = int r |r| dA and K = int r r^T/|r| dA. By the divergence theorem these are
sums over a polygon's sides, and integrals around a disc, which are complete elliptic ones.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from particle.body.face import Face
from particle.jit import device_no_arrays
from particle.types import FloatArray

# Reaches from the face to the centre of rotation, beyond which rules over the face are as exact.
FAR, FARTHER = 8.0, 60.0
CIRCLE = 64  # points around a disc whose centre of rotation is far from its rim


class _Integrals(NamedTuple):
    """I, M, L and K."""

    i_x: float
    i_y: float
    m: float
    l_x: float
    l_y: float
    k_xx: float
    k_xy: float
    k_yy: float


@device_no_arrays
def fill_wrenches(face: Face, v_1: float, v_2: float, omega: float, out: FloatArray) -> None:
    """The wrenches (f_1, f_2, tau) of friction against a twist under the tractions 1, rho_1 and rho_2, columns of out.

    out: (3, 3) m^2, m^3 and, of tau, once more m.
    """
    distance, turn = math.sqrt(v_1 * v_1 + v_2 * v_2), face.reach * abs(omega)
    if distance > FARTHER * turn:
        _fill_far(face.farther, v_1, v_2, omega, out)
        return
    if distance > FAR * turn:
        _fill_far(face.far, v_1, v_2, omega, out)
        return
    x, y = -v_2 / omega, v_1 / omega
    a = _of_disc(face.radius, x, y) if face.radius > 0.0 else _of_polygon(face.corners, x, y)
    sign = math.copysign(1.0, omega)
    for j in range(3):
        at_centre = 1.0 if j == 0 else (x if j == 1 else y)
        j_1, j_2, torque = at_centre * a.i_x, at_centre * a.i_y, at_centre * a.m
        if j == 1:
            j_1, j_2, torque = j_1 + a.k_xx, j_2 + a.k_xy, torque + a.l_x
        elif j == 2:
            j_1, j_2, torque = j_1 + a.k_xy, j_2 + a.k_yy, torque + a.l_y
        torque += x * j_1 + y * j_2
        out[0, j], out[1, j], out[2, j] = sign * j_2, -sign * j_1, -sign * torque


@device_no_arrays
def _fill_far(rule: FloatArray, v_1: float, v_2: float, omega: float, out: FloatArray) -> None:
    """The same by a rule over the face, rows of x, y [m] and weights [m^2]."""
    a_1 = a_2 = a_3 = b_1 = b_2 = b_3 = c_1 = c_2 = c_3 = 0.0
    for k in range(len(rule)):
        x, y = rule[k, 0], rule[k, 1]
        u_1, u_2 = v_1 - omega * y, v_2 + omega * x
        weight = rule[k, 2] / math.sqrt(u_1 * u_1 + u_2 * u_2)
        f_1, f_2 = -weight * u_1, -weight * u_2
        torque = x * f_2 - y * f_1
        a_1, a_2, a_3 = a_1 + f_1, a_2 + f_2, a_3 + torque
        b_1, b_2, b_3 = b_1 + f_1 * x, b_2 + f_2 * x, b_3 + torque * x
        c_1, c_2, c_3 = c_1 + f_1 * y, c_2 + f_2 * y, c_3 + torque * y
    out[0, 0], out[1, 0], out[2, 0] = a_1, a_2, a_3
    out[0, 1], out[1, 1], out[2, 1] = b_1, b_2, b_3
    out[0, 2], out[1, 2], out[2, 2] = c_1, c_2, c_3


@device_no_arrays
def _of_polygon(corners: FloatArray, x: float, y: float) -> _Integrals:
    """The integrals of a polygon around (x, y): by sides, with t along, n outward, h its distance,

    E = int |r| ds = [s r + h^2 asinh(s/|h|)]/2,  p = int r |r| ds = h n E + t [r^3]/3,
    I = sum n E,  M = sum h E/3,  L = sum h p/4,  K_ij = sum p_i n_j - delta_ij M.
    """
    i_x = i_y = m = l_x = l_y = k_xx = k_xy = k_yy = 0.0
    a_x, a_y = corners[-1, 0] - x, corners[-1, 1] - y
    r_a = math.sqrt(a_x * a_x + a_y * a_y)
    for k in range(len(corners)):
        b_x, b_y = corners[k, 0] - x, corners[k, 1] - y
        r_b = math.sqrt(b_x * b_x + b_y * b_y)
        t_x, t_y = b_x - a_x, b_y - a_y
        side = math.sqrt(t_x * t_x + t_y * t_y)
        t_x, t_y = t_x / side, t_y / side
        n_x, n_y = t_y, -t_x
        h, s_a, s_b = a_x * n_x + a_y * n_y, a_x * t_x + a_y * t_y, b_x * t_x + b_y * t_y
        e = s_b * r_b - s_a * r_a
        if h != 0.0:
            e += h * h * (math.asinh(s_b / abs(h)) - math.asinh(s_a / abs(h)))
        e *= 0.5
        e_1 = (r_b**3 - r_a**3) / 3
        p_x, p_y = h * n_x * e + t_x * e_1, h * n_y * e + t_y * e_1
        i_x, i_y, m = i_x + n_x * e, i_y + n_y * e, m + h * e / 3
        l_x, l_y = l_x + 0.25 * h * p_x, l_y + 0.25 * h * p_y
        k_xx, k_xy, k_yy = k_xx + p_x * n_x, k_xy + p_x * n_y, k_yy + p_y * n_y
        a_x, a_y, r_a = b_x, b_y, r_b
    return _Integrals(i_x, i_y, m, l_x, l_y, k_xx - m, k_xy, k_yy - m)


@device_no_arrays
def _of_disc(radius: float, x: float, y: float) -> _Integrals:
    """The integrals of a disc around (x, y), at c from its centre, by b_j = int cos(j phi) |r| dphi around it:

    along the line to the centre I = R b_1, M = R (R b_0 - c b_1)/3, 4 L = R (A b_1 - R c (3 b_0 + b_2)/2),
    K = R^2 (b_0 + b_2)/2 - R c b_1 - M, and across it K = R^2 (b_0 - b_2)/2 - M, with A = R^2 + c^2.
    """
    c = math.hypot(x, y)
    e_x, e_y = (x / c, y / c) if c > 0.0 else (1.0, 0.0)
    square, twice = radius * radius + c * c, 2 * radius * c
    if min(c, radius) < 0.5 * max(c, radius):
        b_0 = b_1 = b_2 = 0.0
        for k in range(CIRCLE):
            cosine = math.cos(2 * math.pi * k / CIRCLE)
            r = math.sqrt(square - twice * cosine) * 2 * math.pi / CIRCLE
            b_0, b_1, b_2 = b_0 + r, b_1 + cosine * r, b_2 + (2 * cosine * cosine - 1) * r
    else:
        first, second = _elliptic(math.sqrt(2 * twice) / (radius + c))
        b_0 = 4 * (radius + c) * second
        b_1 = 4 * (radius + c) / (3 * twice) * ((radius - c) ** 2 * first - square * second)
        b_2 = (4 * square * b_1 + twice * b_0) / (5 * twice)
    m = radius * (radius * b_0 - c * b_1) / 3
    along = 0.25 * radius * (square * b_1 - 0.5 * radius * c * (3 * b_0 + b_2))
    k_along = radius * (0.5 * radius * (b_0 + b_2) - c * b_1) - m
    k_across = 0.5 * radius * radius * (b_0 - b_2) - m
    return _Integrals(
        *(radius * b_1 * e_x, radius * b_1 * e_y, m, along * e_x, along * e_y),
        k_along * e_x * e_x + k_across * e_y * e_y,
        (k_along - k_across) * e_x * e_y,
        k_along * e_y * e_y + k_across * e_x * e_x,
    )


@device_no_arrays
def _elliptic(k: float) -> tuple[float, float]:
    """The complete elliptic integrals K and E of the modulus k by the arithmetic-geometric mean; at k = 1 K counts 0.

    There it only comes multiplied by 0.
    """
    if k >= 1.0:
        return 0.0, 1.0
    a, b, c, power, total = 1.0, math.sqrt((1.0 - k) * (1.0 + k)), k, 0.5, 0.5 * k * k
    while c > 1e-14 * a:  # c is squared in each turn
        a, b, c = 0.5 * (a + b), math.sqrt(a * b), 0.5 * (a - b)
        power *= 2.0
        total += power * c * c
    first = 0.5 * math.pi / a
    return first, first * (1.0 - total)
