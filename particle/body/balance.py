"""The equations of motion of a part with a face: a rigid body on the moving surface.

The state is (X, Y, theta): the point of the mid-plane under the face's origin and the heading. With the averages y =
(P_0, a_1, a_2) of `averages`, the body's axes (e_1, e_2, n) are the polar factor of (a_1, a_2): with U^2 = a_i.a_j,

    (e_1, e_2) = (a_1, a_2) U^-1,     n = e_1 x e_2,     G = (e_1, e_2, n).(a_1', a_2'),
    (-Omega_2, Omega_1) = G_n U^-1,     Omega_3 = (G_21 - G_12)/tr U        angular velocity, in body axes

so that no slope is taken as small; the face is at P_0 + z_k n, the centre of mass at P_0 + z_c n. Newton's and Euler's
equations give the contact's wrench about the face's origin in body axes, affine in u = (X'', Y'', theta''): planar
(f_1, f_2, tau) = p_0 + p_u u and normal (N, M_1, M_2) = n_0 + n_u u. With the twist of the face for the rates
(X', Y', theta') at a fixed time, planar K and normal B, pressure does no work in sliding, so

    planar = W(K (X', Y', theta'); N, M) + P normal,     P = -K^-T B^T

with the wrench W of friction under the tractions (Q(N) + Q'(N) rho.S^-1 (-M_2, M_1))/A of a linear pressure. Q is made
linear around a load, so that u follows from a 3 x 3 system, again until the load agrees.
"""

from __future__ import annotations

import math
from typing import Annotated, NamedTuple

from particle.body.averages import AT, BY, BY_BY, BY_T, PLACE, ROWS, TT, X_BY, XT, XX, XY, Y_BY, YT, YY, T, X, Y
from particle.body.face import Face
from particle.body.press import Press, fill_pressed_friction, press
from particle.body.wrench import fill_wrenches
from particle.events.mechanics import Part
from particle.friction import LOCAL, friction_limit, friction_slope
from particle.jit import device_no_arrays
from particle.types import FloatArray

MOST_PASSES, SETTLED = 30, 1e-14


class Base(NamedTuple):
    """The base's place along x and y and its turn, with two derivatives in time."""

    x: float
    y: float
    turn: float
    v_x: float
    v_y: float
    spin: float
    a_x: float
    a_y: float
    spin_rate: float


class Balance(Press):
    """Scratch memory of the equations at one state."""

    averages: Annotated[FloatArray, ROWS, PLACE]
    axes: Annotated[FloatArray, 3, 3]  # rows e_1, e_2, n
    unstretch: Annotated[FloatArray, 2, 2]  # U^-1
    rate: Annotated[FloatArray, PLACE]  # y'
    second: Annotated[FloatArray, PLACE]  # y'' at u = 0
    twist: Annotated[FloatArray, 6]  # velocity of P_0 and angular velocity in body axes
    planar: Annotated[FloatArray, 3, 3]  # K
    normal: Annotated[FloatArray, 3, 3]  # B
    workless: Annotated[FloatArray, 3, 3]  # P
    forces: Annotated[FloatArray, 6, 4]  # (f_1, f_2, tau, N, M_1, M_2): at u = 0, then by u
    carried: Annotated[FloatArray, 6]  # the face's twist at (X', Y', theta') = 0, like `forces`
    wrenches: Annotated[FloatArray, 3, 3]  # of `wrench`
    friction: Annotated[FloatArray, 3, 4]  # the wrench W, then by what it changes with N, M_1 and M_2
    matrix: Annotated[FloatArray, 3, 4]  # a system of equations
    rates: Annotated[FloatArray, 3]  # u
    slip: Annotated[FloatArray, 3]  # the face's planar twist
    load: Annotated[FloatArray, 3]  # N + squeeze, M_1, M_2
    on_film: int  # 1 on a film of air, which bears a share of the load; these five are of it
    at: float  # N, a load
    limit: float  # N, friction's limit at that load
    by_load: float  # by which the limit changes with the load, which the film shares
    by_borne: float  # by which it changes with what asperities bear
    drag: float  # N s/m


@device_no_arrays
def solve(m: FloatArray, out: FloatArray) -> bool:
    """Solve the system (3, 4) by Cramer's rule; False where it is singular."""
    # The second column by the third, and the first by the right side.
    a_0 = m[1, 1] * m[2, 2] - m[2, 1] * m[1, 2]
    a_1 = m[2, 1] * m[0, 2] - m[0, 1] * m[2, 2]
    a_2 = m[0, 1] * m[1, 2] - m[1, 1] * m[0, 2]
    b_0 = m[1, 0] * m[2, 3] - m[2, 0] * m[1, 3]
    b_1 = m[2, 0] * m[0, 3] - m[0, 0] * m[2, 3]
    b_2 = m[0, 0] * m[1, 3] - m[1, 0] * m[0, 3]
    det = m[0, 0] * a_0 + m[1, 0] * a_1 + m[2, 0] * a_2
    if det == 0.0 or not math.isfinite(det):
        return False
    out[0] = (m[0, 3] * a_0 + m[1, 3] * a_1 + m[2, 3] * a_2) / det
    out[1] = (m[0, 2] * b_0 + m[1, 2] * b_1 + m[2, 2] * b_2) / det
    out[2] = -(m[0, 1] * b_0 + m[1, 1] * b_1 + m[2, 1] * b_2) / det
    return True


@device_no_arrays
def fill_pose(part: Part, base: Base, b: Balance) -> bool:
    """Axes, K, B, P and the carried twist from the averages; False where K is singular."""
    y = b.averages[AT]
    xx = y[3] * y[3] + y[4] * y[4] + y[5] * y[5]
    xy = y[3] * y[6] + y[4] * y[7] + y[5] * y[8]
    yy = y[6] * y[6] + y[7] * y[7] + y[8] * y[8]
    root = math.sqrt(xx * yy - xy * xy)  # det U
    trace = math.sqrt(xx + yy + 2 * root)  # tr U
    u_xx, u_xy, u_yy = (xx + root) / trace, xy / trace, (yy + root) / trace
    b.unstretch[0, 0], b.unstretch[1, 1] = u_yy / root, u_xx / root
    b.unstretch[0, 1] = b.unstretch[1, 0] = -u_xy / root
    for i in range(3):
        b.axes[0, i] = y[3 + i] * b.unstretch[0, 0] + y[6 + i] * b.unstretch[1, 0]
        b.axes[1, i] = y[3 + i] * b.unstretch[0, 1] + y[6 + i] * b.unstretch[1, 1]
        j, k = (i + 1) % 3, (i + 2) % 3
        b.axes[2, i] = (y[3 + j] * y[6 + k] - y[3 + k] * y[6 + j]) / root
    for column, row in ((0, X), (1, Y), (2, BY)):
        _fill_twist(b, b.averages[row])
        t = b.twist
        b.planar[0, column], b.planar[1, column] = t[0] + part.contact * t[4], t[1] - part.contact * t[3]
        b.planar[2, column] = t[5]
        b.normal[0, column], b.normal[1, column], b.normal[2, column] = t[2], t[3], t[4]
    m, n, det = b.planar, b.normal, 0.0
    for i in range(3):  # P = -K^-T B^T, K^-T being the cofactors of K over its determinant
        j, k = (i + 1) % 3, (i + 2) % 3
        c_0 = m[j, 1] * m[k, 2] - m[j, 2] * m[k, 1]
        c_1 = m[j, 2] * m[k, 0] - m[j, 0] * m[k, 2]
        c_2 = m[j, 0] * m[k, 1] - m[j, 1] * m[k, 0]
        if i == 0:
            det = m[0, 0] * c_0 + m[0, 1] * c_1 + m[0, 2] * c_2
            if det == 0.0 or not math.isfinite(det):
                return False
        for column in range(3):
            b.workless[i, column] = -(c_0 * n[column, 0] + c_1 * n[column, 1] + c_2 * n[column, 2]) / det
    # The second derivatives of w, in the body's axes.
    cosine, sine = b.axes[0, 0], b.axes[0, 1]
    size = cosine * cosine + sine * sine
    w_xx, w_xy, w_yy = b.averages[XX, 2] / size, b.averages[XY, 2] / size, b.averages[YY, 2] / size
    b.bend[0] = cosine * cosine * w_xx + 2 * cosine * sine * w_xy + sine * sine * w_yy
    b.bend[1] = cosine * sine * (w_yy - w_xx) + (cosine * cosine - sine * sine) * w_xy
    b.bend[2] = sine * sine * w_xx - 2 * cosine * sine * w_xy + cosine * cosine * w_yy
    _fill_twist(b, b.averages[T])
    t, c = b.twist, b.carried
    x, y_ = y[0] + part.contact * b.axes[2, 0], y[1] + part.contact * b.axes[2, 1]
    v_x, v_y = _turned_back(base, base.v_x, base.v_y)
    v_x, v_y = v_x - base.spin * y_, v_y + base.spin * x
    e = b.axes
    c[0] = t[0] + part.contact * t[4] + e[0, 0] * v_x + e[0, 1] * v_y
    c[1] = t[1] - part.contact * t[3] + e[1, 0] * v_x + e[1, 1] * v_y
    c[2] = t[5] + base.spin * e[2, 2]
    c[3] = t[2] + e[2, 0] * v_x + e[2, 1] * v_y
    c[4], c[5] = t[3] + base.spin * e[0, 2], t[4] + base.spin * e[1, 2]
    return True


@device_no_arrays
def _turned_back(base: Base, x: float, y: float) -> tuple[float, float]:
    """A vector in the base's axes."""
    cosine, sine = math.cos(base.turn), math.sin(base.turn)
    return cosine * x + sine * y, cosine * y - sine * x


@device_no_arrays
def _trace(b: Balance) -> float:
    """tr U."""
    u = b.unstretch
    return (u[0, 0] + u[1, 1]) / (u[0, 0] * u[1, 1] - u[0, 1] * u[1, 0])


@device_no_arrays
def _along(b: Balance, i: int, y: FloatArray, first: int) -> float:
    """The part of a vector along the i-th axis of the body."""
    return b.axes[i, 0] * y[first] + b.axes[i, 1] * y[first + 1] + b.axes[i, 2] * y[first + 2]


@device_no_arrays
def _fill_twist(b: Balance, rate: FloatArray) -> None:
    """The velocity of P_0 and the angular velocity, in body axes, of y' = `rate` (9,) into b.twist."""
    u, t = b.unstretch, b.twist
    for i in range(3):
        t[i] = _along(b, i, rate, 0)
    n_1, n_2 = _along(b, 2, rate, 3), _along(b, 2, rate, 6)
    t[3] = n_1 * u[0, 1] + n_2 * u[1, 1]
    t[4] = -(n_1 * u[0, 0] + n_2 * u[1, 0])
    t[5] = (_along(b, 1, rate, 3) - _along(b, 0, rate, 6)) / _trace(b)


@device_no_arrays
def fill_forces(part: Part, face: Face, base: Base, v_x: float, v_y: float, omega: float, b: Balance) -> None:
    """The contact's wrench, its change with u, and the face's slip, at the rates (X', Y', theta')."""
    a, z, h = b.averages, part.centre, part.centre - part.contact
    for i in range(3):
        b.slip[i] = b.planar[i, 0] * v_x + b.planar[i, 1] * v_y + b.planar[i, 2] * omega
    for j in range(PLACE):
        b.rate[j] = a[T, j] + a[X, j] * v_x + a[Y, j] * v_y + a[BY, j] * omega
        bend = a[XX, j] * v_x * v_x + 2 * a[XY, j] * v_x * v_y + a[YY, j] * v_y * v_y
        bend += 2 * omega * (a[X_BY, j] * v_x + a[Y_BY, j] * v_y) + a[BY_BY, j] * omega * omega
        b.second[j] = a[TT, j] + 2 * (a[XT, j] * v_x + a[YT, j] * v_y + a[BY_T, j] * omega) + bend
    for column, row in ((1, X), (2, Y), (3, BY)):
        _fill_twist(b, a[row])
        t = b.twist
        _set_forces(part, face, t[0] + z * t[4], t[1] - z * t[3], t[2], t[3], t[4], t[5], h, b, column)
    _fill_twist(b, b.rate)
    e, u, t, trace = b.axes, b.unstretch, b.twist, _trace(b)
    o_1, o_2, o_3 = t[3], t[4], t[5]
    # G, and its rate (e_1, e_2, n).(a_1'', a_2'') - Omega x G.
    g_11, g_12 = _along(b, 0, b.rate, 3), _along(b, 0, b.rate, 6)
    g_21, g_22 = _along(b, 1, b.rate, 3), _along(b, 1, b.rate, 6)
    g_31, g_32 = _along(b, 2, b.rate, 3), _along(b, 2, b.rate, 6)
    d_21 = _along(b, 1, b.second, 3) - (o_3 * g_11 - o_1 * g_31)
    d_12 = _along(b, 0, b.second, 6) - (o_2 * g_32 - o_3 * g_22)
    d_31 = _along(b, 2, b.second, 3) - (o_1 * g_21 - o_2 * g_11)
    d_32 = _along(b, 2, b.second, 6) - (o_1 * g_22 - o_2 * g_12)
    # U' = G - Omega_3 J U, J the turn by a right angle.
    det = u[0, 0] * u[1, 1] - u[0, 1] * u[1, 0]
    u_11, u_12, u_22 = u[1, 1] / det, -u[0, 1] / det, u[0, 0] / det
    s_11, s_12, s_21, s_22 = g_11 + o_3 * u_12, g_12 + o_3 * u_22, g_21 - o_3 * u_11, g_22 - o_3 * u_12
    n_1 = d_31 + o_2 * s_11 - o_1 * s_21
    n_2 = d_32 + o_2 * s_12 - o_1 * s_22
    r_1, r_2 = n_1 * u[0, 1] + n_2 * u[1, 1], -(n_1 * u[0, 0] + n_2 * u[1, 0])
    r_3 = (d_21 - d_12 - o_3 * (s_11 + s_22)) / trace
    a_1 = _along(b, 0, b.second, 0) + z * (r_2 + o_1 * o_3)
    a_2 = _along(b, 1, b.second, 0) + z * (-r_1 + o_2 * o_3)
    a_3 = _along(b, 2, b.second, 0) - z * (o_1 * o_1 + o_2 * o_2)
    # What the base adds: b'', and its turn, at c = P_0 + z n with the velocity c' in its axes; less gravity.
    f_x, f_y = _turned_back(base, base.a_x - part.tilt_x, base.a_y - part.tilt_y)
    if base.spin != 0.0 or base.spin_rate != 0.0:
        c_x, c_y = a[AT, 0] + z * e[2, 0], a[AT, 1] + z * e[2, 1]
        v_1, v_2, v_3 = t[0] + z * o_2, t[1] - z * o_1, t[2]
        w_x = e[0, 0] * v_1 + e[1, 0] * v_2 + e[2, 0] * v_3
        w_y = e[0, 1] * v_1 + e[1, 1] * v_2 + e[2, 1] * v_3
        f_x += -2 * base.spin * w_y - base.spin_rate * c_y - base.spin * base.spin * c_x
        f_y += 2 * base.spin * w_x + base.spin_rate * c_x - base.spin * base.spin * c_y
        r_1 += base.spin_rate * e[0, 2] + base.spin * (e[1, 2] * o_3 - e[2, 2] * o_2)
        r_2 += base.spin_rate * e[1, 2] + base.spin * (e[2, 2] * o_1 - e[0, 2] * o_3)
        r_3 += base.spin_rate * e[2, 2] + base.spin * (e[0, 2] * o_2 - e[1, 2] * o_1)
        o_1, o_2, o_3 = o_1 + base.spin * e[0, 2], o_2 + base.spin * e[1, 2], o_3 + base.spin * e[2, 2]
    a_1 += e[0, 0] * f_x + e[0, 1] * f_y + e[0, 2] * part.gravity
    a_2 += e[1, 0] * f_x + e[1, 1] * f_y + e[1, 2] * part.gravity
    a_3 += e[2, 0] * f_x + e[2, 1] * f_y + e[2, 2] * part.gravity
    _set_forces(part, face, a_1, a_2, a_3, r_1, r_2, r_3, h, b, 0)
    # Omega x I Omega.
    m = face.inertia
    l_1 = m[0, 0] * o_1 + m[0, 1] * o_2 + m[0, 2] * o_3
    l_2 = m[1, 0] * o_1 + m[1, 1] * o_2 + m[1, 2] * o_3
    l_3 = m[2, 0] * o_1 + m[2, 1] * o_2 + m[2, 2] * o_3
    b.forces[4, 0] += o_2 * l_3 - o_3 * l_2
    b.forces[5, 0] += o_3 * l_1 - o_1 * l_3
    b.forces[2, 0] += o_1 * l_2 - o_2 * l_1


@device_no_arrays
def _set_forces(
    part: Part,
    face: Face,
    a_1: float,
    a_2: float,
    a_3: float,
    r_1: float,
    r_2: float,
    r_3: float,
    h: float,
    b: Balance,
    column: int,
) -> None:
    """m a and I r about the face's origin, h below the centre of mass, into a column of b.forces."""
    i, mass, f = face.inertia, part.mass, b.forces
    f[0, column], f[1, column], f[3, column] = mass * a_1, mass * a_2, mass * a_3
    f[4, column] = i[0, 0] * r_1 + i[0, 1] * r_2 + i[0, 2] * r_3 - h * mass * a_2
    f[5, column] = i[1, 0] * r_1 + i[1, 1] * r_2 + i[1, 2] * r_3 + h * mass * a_1
    f[2, column] = i[2, 0] * r_1 + i[2, 1] * r_2 + i[2, 2] * r_3


@device_no_arrays
def set_load(part: Part, u_1: float, u_2: float, u_3: float, b: Balance) -> None:
    """The normal wrench at u into b.load."""
    for i in range(3):
        row = b.forces[3 + i]
        b.load[i] = row[0] + row[1] * u_1 + row[2] * u_2 + row[3] * u_3
    b.load[0] += part.squeeze


@device_no_arrays
def least_pressure(face: Face, b: Balance) -> float:
    """The least pressure on the face times its area [N], under the load b.load."""
    load, m_1, m_2 = b.load[0], b.load[1], b.load[2]
    if not face.linear:
        return load
    s = face.unmoments
    x, y = -s[0, 0] * m_2 + s[0, 1] * m_1, -s[1, 0] * m_2 + s[1, 1] * m_1
    if face.radius > 0.0:
        return load - face.radius * math.hypot(x, y)
    least = math.inf
    for k in range(len(face.hull)):
        least = min(least, load + x * face.hull[k, 0] + y * face.hull[k, 1])
    return least


@device_no_arrays
def find_rates(part: Part, face: Face, s_1: float, s_2: float, s_3: float, b: Balance) -> bool:
    """u under friction against the slip s into b.rates, with its load b.load; False where there is none.

    Beyond the end of a local contact friction goes on as at the last gap.
    """
    local = borne = part.law.kind == LOCAL
    if not local:
        fill_wrenches(face, s_1, s_2, s_3, b.wrenches)
    for _ in range(MOST_PASSES):
        if borne:
            borne = press(part.law, face, b.load, b, False)
        fill_friction(part, face, s_1, s_2, s_3, b)
        n, m_1, m_2 = b.load[0], b.load[1], b.load[2]
        _fill_system(part, face, b)
        if not solve(b.matrix, b.rates):
            return False
        set_load(part, b.rates[0], b.rates[1], b.rates[2], b)
        off = abs(b.load[0] - n)
        if local:
            off += (abs(b.load[1] - m_1) + abs(b.load[2] - m_2)) / face.reach
        if off <= SETTLED * (abs(b.load[0]) + part.mass * abs(part.gravity)) or part.law.kind < 2:
            return True
    return True


@device_no_arrays
def limits(part: Part, b: Balance) -> tuple[float, float, float]:
    """Friction's limit Q [N] under b.load, by which it changes with the load, and with what asperities bear."""
    if b.on_film == 1:
        return b.limit + b.by_load * (b.load[0] - b.at), b.by_load, b.by_borne
    slope = friction_slope(part.law, b.load[0])
    return friction_limit(part.law, b.load[0]), slope, slope


@device_no_arrays
def fill_friction(part: Part, face: Face, s_1: float, s_2: float, s_3: float, b: Balance) -> None:
    """The wrench of friction while sliding against the slip s under b.load, and by what it changes, into b.friction.

    Made before: with a local contact its gap, `press`, else b.wrenches.
    """
    if part.law.kind == LOCAL:
        fill_pressed_friction(part.law, face, s_1, s_2, s_3, b, b.wrenches, b.friction)
        return
    load, w, s = b.load, b.wrenches, face.unmoments
    limit, by_load, slope = limits(part, b)
    limit, by_load, slope = limit / face.area, by_load / face.area, slope / face.area
    for i in range(3):
        by_m_1 = by_m_2 = 0.0
        if face.linear:
            by_m_1 = slope * (w[i, 1] * s[0, 1] + w[i, 2] * s[1, 1])
            by_m_2 = -slope * (w[i, 1] * s[0, 0] + w[i, 2] * s[1, 0])
        b.friction[i, 0] = limit * w[i, 0] + by_m_1 * load[1] + by_m_2 * load[2]
        b.friction[i, 1], b.friction[i, 2], b.friction[i, 3] = by_load * w[i, 0], by_m_1, by_m_2


@device_no_arrays
def _fill_system(part: Part, face: Face, b: Balance) -> None:
    """[p_u - (W' + P) n_u] u = W - W' L - D xi + (W' + P) n_0 - p_0 into b.matrix, W linear around the load L = b.load.

    D = c (1, 1, tr S) is the drag of air at the face's slip xi.
    """
    f, w, load, s = b.forces, b.friction, b.load, face.unmoments
    spread = (s[0, 0] + s[1, 1]) / (s[0, 0] * s[1, 1] - s[0, 1] * s[1, 0])
    for i in range(3):
        right = -(part.drag + b.drag) * b.slip[i] * (spread if i == 2 else 1.0)
        right += w[i, 0] - w[i, 1] * (load[0] - part.squeeze) - w[i, 2] * load[1] - w[i, 3] * load[2]
        by_load, by_m_1, by_m_2 = w[i, 1] + b.workless[i, 0], w[i, 2] + b.workless[i, 1], w[i, 3] + b.workless[i, 2]
        for j in range(4):
            normal = by_load * f[3, j] + by_m_1 * f[4, j] + by_m_2 * f[5, j]
            if j == 0:
                b.matrix[i, 3] = right + normal - f[i, 0]
            else:
                b.matrix[i, j - 1] = f[i, j] - normal


@device_no_arrays
def friction_wrench(part: Part, b: Balance) -> tuple[float, float, float]:
    """Friction's wrench (f_1, f_2, tau) under b.rates and b.load: the planar one less the pressure's share."""
    f, p, n, u = b.forces, b.workless, b.load, b.rates
    load = n[0] - part.squeeze
    return (
        f[0, 0] + f[0, 1] * u[0] + f[0, 2] * u[1] + f[0, 3] * u[2] - p[0, 0] * load - p[0, 1] * n[1] - p[0, 2] * n[2],
        f[1, 0] + f[1, 1] * u[0] + f[1, 2] * u[1] + f[1, 3] * u[2] - p[1, 0] * load - p[1, 1] * n[1] - p[1, 2] * n[2],
        f[2, 0] + f[2, 1] * u[0] + f[2, 2] * u[1] + f[2, 3] * u[2] - p[2, 0] * load - p[2, 1] * n[1] - p[2, 2] * n[2],
    )


@device_no_arrays
def powers(part: Part, b: Balance) -> tuple[float, float]:
    """The surface's power on the part, and what friction dissipates [W], under b.rates and b.load."""
    f, u, c, n = b.forces, b.rates, b.carried, b.load
    work = (n[0] - part.squeeze) * c[3] + n[1] * c[4] + n[2] * c[5]
    for i in range(3):
        work += (f[i, 0] + f[i, 1] * u[0] + f[i, 2] * u[1] + f[i, 3] * u[2]) * c[i]
    w_1, w_2, w_3 = friction_wrench(part, b)
    return work, -(w_1 * b.slip[0] + w_2 * b.slip[1] + w_3 * b.slip[2])


@device_no_arrays
def energy_of(
    part: Part, face: Face, base: Base, v_x: float, v_y: float, omega: float, b: Balance
) -> tuple[float, float]:
    """Kinetic and potential energy [J] at the rates (X', Y', theta'), from b.averages and b.axes."""
    a, e, z, i = b.averages, b.axes, part.centre, face.inertia
    for j in range(PLACE):
        b.rate[j] = a[T, j] + a[X, j] * v_x + a[Y, j] * v_y + a[BY, j] * omega
    _fill_twist(b, b.rate)
    t = b.twist
    c_x, c_y, c_z = a[AT, 0] + z * e[2, 0], a[AT, 1] + z * e[2, 1], a[AT, 2] + z * e[2, 2]
    b_x, b_y = _turned_back(base, base.v_x, base.v_y)
    b_x, b_y = b_x - base.spin * c_y, b_y + base.spin * c_x
    v_1 = t[0] + z * t[4] + e[0, 0] * b_x + e[0, 1] * b_y
    v_2 = t[1] - z * t[3] + e[1, 0] * b_x + e[1, 1] * b_y
    v_3 = t[2] + e[2, 0] * b_x + e[2, 1] * b_y
    o_1, o_2, o_3 = t[3] + base.spin * e[0, 2], t[4] + base.spin * e[1, 2], t[5] + base.spin * e[2, 2]
    spin = i[0, 0] * o_1 * o_1 + i[1, 1] * o_2 * o_2 + i[2, 2] * o_3 * o_3
    spin += 2 * (i[0, 1] * o_1 * o_2 + i[0, 2] * o_1 * o_3 + i[1, 2] * o_2 * o_3)
    cosine, sine = math.cos(base.turn), math.sin(base.turn)
    x, y = base.x + cosine * c_x - sine * c_y, base.y + sine * c_x + cosine * c_y
    height = part.gravity * c_z - part.tilt_x * x - part.tilt_y * y
    return 0.5 * (part.mass * (v_1 * v_1 + v_2 * v_2 + v_3 * v_3) + spin), part.mass * height
