"""The load of a part at rest and the friction that it needs, as polynomials in time, and the proof that it stays.

At a fixed X the place P = (X + u + base, w) and its derivatives by X are polynomials in time. Over a short subinterval
all that follows from them is a power series, of which the powers above `DEGREE` are far below rounding. With the
heights z_k of the contact and z of the centre of mass, z - z_k = h,

    n = P_x x P_y / s,  s = |P_x x P_y|      V = P'' - gravity + z n''
    N = m n.V + squeeze                      T = n x V, the pull turned by a right angle

and K of `mechanics.equations`, turned likewise, gives the friction that is needed,

    |K^-1 p| = |(1 - 2 z H + z z_k C) T + h S T| / (1 - 2 z_k H + z_k^2 C)

where S a = -(a_x n_x + a_y n_y) for a = a_x P_x + a_y P_y, 2 H is the trace of S and C its determinant.
"""

from __future__ import annotations

import math

import numpy as np

from particle.events.mechanics import Part
from particle.events.polynomials import second_derivative, to_bernstein, total
from particle.friction import friction_limit
from particle.jit import device, device_no_arrays, inlined
from particle.types import FloatArray

Vector = tuple[FloatArray, FloatArray, FloatArray]

# Over a share 2^-7 of a span the 15th power is 2^-105 of its coefficient, and that of a product of fifteen quintics
# like (1 - s)^5 is C(75, 15) = 2^51 times the constant one. The two above it are for n''.
NARROW, DEGREE = 2.0**-7, 16
LOAD, NEEDED = range(2)
# A part sticks up to the limit itself, as on a slope at the angle of friction: rounding must not decide.
ROUNDING = 1 + 1e-14
LEAST_OFF, MOST_OFF = 2.0**-10, 0.25  # of a subinterval: how far from the slip it is divided
NOISE = 1e-13  # of what is needed: what rounding may make of it


@device
def _short(a: FloatArray, b: FloatArray) -> FloatArray:
    """The product of two series, up to the highest power that counts."""
    out = np.zeros(min(len(a) + len(b) - 1, DEGREE + 1))
    for i in range(min(len(a), len(out))):
        for j in range(min(len(b), len(out) - i)):
            out[i + j] += a[i] * b[j]
    return out


@device
def _inverse(a: FloatArray) -> FloatArray:
    """1 / a."""
    out = np.zeros(DEGREE + 1)
    out[0] = 1.0 / a[0]
    for k in range(1, DEGREE + 1):
        for j in range(1, min(k, len(a) - 1) + 1):
            out[k] -= out[0] * a[j] * out[k - j]
    return out


@device
def _root(a: FloatArray) -> FloatArray:
    """The square root of a."""
    out = np.zeros(DEGREE + 1)
    out[0] = math.sqrt(a[0])
    for k in range(1, DEGREE + 1):
        left = a[k] if k < len(a) else 0.0
        for j in range(1, k):
            left -= out[j] * out[k - j]
        out[k] = 0.5 * left / out[0]
    return out


@device
def _dot(a: Vector, b: Vector) -> FloatArray:
    """a.b."""
    return total(total(_short(a[0], b[0]), _short(a[1], b[1])), _short(a[2], b[2]))


@device
def _cross(a: Vector, b: Vector) -> Vector:
    """a x b."""
    return (
        total(_short(a[1], b[2]), -_short(a[2], b[1])),
        total(_short(a[2], b[0]), -_short(a[0], b[2])),
        total(_short(a[0], b[1]), -_short(a[1], b[0])),
    )


@device
def _sum(a: Vector, b: Vector) -> Vector:
    """a + b."""
    return total(a[0], b[0]), total(a[1], b[1]), total(a[2], b[2])


@device
def _times(a: Vector, b: FloatArray) -> Vector:
    """a b, b a scalar."""
    return _short(a[0], b), _short(a[1], b), _short(a[2], b)


@device
def _along(n: Vector, normal: Vector, inverse: FloatArray) -> Vector:
    """The derivative of n = N / s for one of N: its part at right angles to n, over s."""
    return _times(_sum(normal, _times(n, -_dot(n, normal))), inverse)


@device
def _borne(
    part: Part,
    motion: FloatArray,
    plane: FloatArray,
    p_x: Vector,
    p_y: Vector,
    n: Vector,
    v: Vector,
    inverse: FloatArray,
) -> FloatArray:
    """|K^-1 p|^2; p_x, p_y: P_x and P_y.  inverse: 1 / s."""
    t, h, z, z_k = _cross(n, v), part.centre - part.contact, part.centre, part.contact
    if h == 0.0:
        return _dot(t, t)
    p_xx, p_xy = (plane[0, 3], plane[1, 3], motion[3]), (plane[0, 4], plane[1, 4], motion[4])
    p_yy = (plane[0, 5], plane[1, 5], motion[5])
    n_x = _along(n, _sum(_cross(p_xx, p_y), _cross(p_x, p_xy)), inverse)
    n_y = _along(n, _sum(_cross(p_xy, p_y), _cross(p_x, p_yy)), inverse)
    twice_mean = -_short(_dot(n, _sum(_cross(n_x, p_y), _cross(p_x, n_y))), inverse)
    gauss = _short(_dot(n, _cross(n_x, n_y)), inverse)
    shaped = _sum(_times(n_x, _short(_dot(p_y, v), inverse)), _times(n_y, -_short(_dot(p_x, v), inverse)))
    factor, divisor = total(-z * twice_mean, z * z_k * gauss), total(-z_k * twice_mean, z_k * z_k * gauss)
    factor[0] += 1.0
    divisor[0] += 1.0
    over = _inverse(divisor)
    borne = _sum(_times(t, _short(factor, over)), _times(shaped, h * over))
    return _dot(borne, borne)


@inlined
def fill_margin(part: Part, motion: FloatArray, plane: FloatArray, lasting: float, out: FloatArray) -> None:
    """N and |K^-1 p|^2 in Bernstein form into `out` (2, 17), over a short share of a span.

    motion (6, 6) and plane (2, 6, 6): as in `stick.Rest`, of the share of the time `lasting` [s].
    """
    p_x, p_y = (plane[0, 1].copy(), plane[1, 1], motion[1]), (plane[0, 2], plane[1, 2].copy(), motion[2])
    p_x[0][0] += 1.0
    p_y[1][0] += 1.0
    normal = _cross(p_x, p_y)
    inverse = _inverse(_root(_dot(normal, normal)))
    n = _times(normal, inverse)
    a_x, a_y = second_derivative(plane[0, 0], lasting), second_derivative(plane[1, 0], lasting)
    upright = second_derivative(motion[0], lasting)
    a_x[0] -= part.tilt_x
    a_y[0] -= part.tilt_y
    upright[0] += part.gravity
    v = a_x, a_y, upright
    if part.centre > 0.0:
        n_tt = (
            second_derivative(n[0], lasting),
            second_derivative(n[1], lasting),
            second_derivative(n[2], lasting),
        )
        v = _sum(v, (part.centre * n_tt[0], part.centre * n_tt[1], part.centre * n_tt[2]))
    load = part.mass * _dot(n, v)
    load[0] += part.squeeze
    to_bernstein(load, out[LOAD])
    to_bernstein(_borne(part, motion, plane, p_x, p_y, n, v, inverse), out[NEEDED])


@inlined
def is_safe_by_margin(part: Part, margin: FloatArray, slack: float) -> bool:
    """Whether the Bernstein coefficients (2, n) of a subinterval prove that the part stays throughout it.

    They bound what is needed, and the least Q is that of the least load.
    """
    load_low, load_high, needed = margin[LOAD, 0], margin[LOAD, 0], margin[NEEDED, 0]
    for k in range(1, margin.shape[1]):
        load_low, load_high = min(load_low, margin[LOAD, k]), max(load_high, margin[LOAD, k])
        needed = max(needed, margin[NEEDED, k])
    within = -part.law.pull_off <= load_low and load_high <= part.law.largest_load
    return within and _excess(part, load_low, needed, slack) <= 0.0


@device_no_arrays
def _excess(part: Part, load: float, needed: float, slack: float) -> float:
    """By how much the squared force [m^2/s^4] that is needed exceeds what friction bears under a load [N]."""
    limit = part.law.static_ratio * friction_limit(part.law, load) / part.mass
    return float(needed - slack - limit * limit * ROUNDING)


@device_no_arrays
def holds_at_end(part: Part, margin: FloatArray, slack: float) -> bool:
    """Whether the part stays at the end of a subinterval: -pull-off <= N <= largest load and |m K^-1 p| <= Q(N)."""
    last = margin.shape[1] - 1
    load = margin[LOAD, last]
    within = -part.law.pull_off <= load <= part.law.largest_load
    return bool(within and _excess(part, load, margin[NEEDED, last], slack) <= 0.0)


@device_no_arrays
def best_division(part: Part, margin: FloatArray, slack: float) -> float:
    """The share of a subinterval at which it is divided: next to where the part slips, if that is nearly linear.

    It lies as far from there as the excess at the coefficients (2, n) bends, on the side that leaves the shorter part.
    """
    last = margin.shape[1] - 1
    begin = _excess(part, margin[LOAD, 0], margin[NEEDED, 0], slack)
    end = _excess(part, margin[LOAD, last], margin[NEEDED, last], slack)
    if not begin < 0.0 < end:
        return 0.5
    bend = largest = 0.0
    for k in range(last + 1):
        excess = _excess(part, margin[LOAD, k], margin[NEEDED, k], slack)
        bend = max(bend, abs(excess - begin - k / last * (end - begin)))
        largest = max(largest, abs(margin[NEEDED, k]))
    slips, off = begin / (begin - end), max(2.0 * bend, NOISE * largest) / (end - begin)
    off = max(off, LEAST_OFF)
    return (slips - off if slips > 0.5 else slips + off) if off < MOST_OFF else 0.5
