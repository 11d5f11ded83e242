"""What holds a part at rest where the mid-plane moves in its plane, as polynomials in time.

At a fixed X the place P = (X + u + base, w) is a polynomial in time, and so is N = P_x x P_y, which points along the
normal n = N/s, s^2 = N.N. With A = P'' less gravity, sigma = N.N' and k = N.N'', `mechanics.parallel` gives at
rest, for the height z of the centre of mass,

    N - squeeze = m (C / s - z E / s^4)          C = N.A,   E = |N'|^2 s^2 - sigma^2
    s^2 |p|^2 = F + 2 z X / s^3 + z^2 Y / s^6    F = |A|^2 s^2 - C^2
    X = s^4 A.N'' - s^2 C k - 2 sigma (s^2 A.N' - C sigma)
    Y = s^6 |N''|^2 - s^4 k^2 - 4 sigma (s^4 N'.N'' - s^2 k sigma) + 4 sigma^2 (s^2 |N'|^2 - sigma^2)

`stick_raised` proves that it stays, with the same powers of s. These polynomials have degrees up to 76. Over a short
subinterval their higher powers are far below rounding, so they are cut off at `DEGREE`.

Longer subintervals are proved by a bound. No tangential part of V is longer than V less any multiple of n. With G the
slope seen in space, U = gravity + w_tt and a the acceleration in the plane less gravity's share in it, so

    |p| <= |a + U G - z G''| + z (5/2 g^2 g'' + 4 g g'^2 + 6 g^3 g'^2)

for bounds g, g', g'' of |G|, |G'|, |G''|. As grad w = (I + grad u)^T G, the first term is within
U e g + z (e'' g + 2 e' g' + e g'') of |a + U grad w - z grad w''|, a vector of polynomials of degree 8; e, e' and e''
bound |grad u| and its rates.
"""

from __future__ import annotations

import math

import numpy as np

from particle.drives import ORDER
from particle.events.bernstein import quintic_to_bernstein, to_bernstein
from particle.events.mechanics import Part
from particle.events.polynomials import derivative, second_derivative, total
from particle.events.rest.stick_raised import SQUARE, C, E, F, X, Y
from particle.friction import friction_limit
from particle.jit import jit, jit_no_arrays
from particle.types import FloatArray

Vector = tuple[FloatArray, FloatArray, FloatArray]

# Over a share 2^-7 of a span the 15th power is 2^-105 of its coefficient, and that of a product of fifteen quintics
# like (1 - s)^5 is C(75, 15) = 2^51 times the constant one.
NARROW, DEGREE = 2.0**-7, 14
BOUND_DEGREE = 8  # of the bound's polynomials
_TO_BERNSTEIN = np.array(
    [[math.comb(i, k) / math.comb(BOUND_DEGREE, k) for k in range(BOUND_DEGREE + 1)] for i in range(BOUND_DEGREE + 1)]
)
MAX_STRETCH = 0.5  # of the gradient of u, up to which the quick bounds are of use


@jit
def _short(a: FloatArray, b: FloatArray) -> FloatArray:
    """The product of two polynomials, up to the highest power that counts."""
    out = np.zeros(min(len(a) + len(b) - 1, DEGREE + 1))
    for i in range(min(len(a), len(out))):
        for j in range(min(len(b), len(out) - i)):
            out[i + j] += a[i] * b[j]
    return out


@jit
def _normal(motion: FloatArray, plane: FloatArray) -> Vector:
    """N."""
    x_x, x_y, y_x, y_y = plane[1].copy(), plane[2], plane[4], plane[5].copy()
    x_x[0] += 1.0
    y_y[0] += 1.0
    w_x, w_y = motion[1], motion[2]
    return (
        total(_short(y_x, w_y), -_short(y_y, w_x)),
        total(_short(x_y, w_x), -_short(x_x, w_y)),
        total(_short(x_x, y_y), -_short(x_y, y_x)),
    )


@jit
def _dot(a: Vector, b: Vector) -> FloatArray:
    return total(total(_short(a[0], b[0]), _short(a[1], b[1])), _short(a[2], b[2]))


@jit
def _across(a: Vector, b: Vector) -> FloatArray:
    """|a|^2 |b|^2 - (a.b)^2, as the square of their vector product: it loses no digits where it is small."""
    x = total(_short(a[1], b[2]), -_short(a[2], b[1]))
    y = total(_short(a[2], b[0]), -_short(a[0], b[2]))
    z = total(_short(a[0], b[1]), -_short(a[1], b[0]))
    return _dot((x, y, z), (x, y, z))


@jit
def fill_stretched(part: Part, motion: FloatArray, plane: FloatArray, lasting: float, out: FloatArray) -> None:
    """C, F, s^2, E, X and Y in Bernstein form into `out` (6, 15), over a short share of a span.

    motion (3, 6): w, w_x and w_y as polynomials of the share of the time `lasting` [s].  plane (6, 6): u + base along
    x, its derivatives by x and y; the same along y.
    """
    a_x, a_y = second_derivative(plane[0], lasting), second_derivative(plane[3], lasting)
    upright = second_derivative(motion[0], lasting)
    a_x[0] -= part.tilt_x
    a_y[0] -= part.tilt_y
    upright[0] += part.gravity
    a, n = (a_x, a_y, upright), _normal(motion, plane)
    n_t = derivative(n[0], lasting), derivative(n[1], lasting), derivative(n[2], lasting)
    n_tt = (
        second_derivative(n[0], lasting),
        second_derivative(n[1], lasting),
        second_derivative(n[2], lasting),
    )
    c, square, sigma, k = _dot(n, a), _dot(n, n), _dot(n, n_t), _dot(n, n_tt)
    fourth, sigma_2 = _short(square, square), _short(sigma, sigma)
    cross = total(_short(fourth, _dot(a, n_tt)), -_short(square, _short(c, k)))
    cross = total(cross, -2 * _short(sigma, total(_short(square, _dot(a, n_t)), -_short(c, sigma))))
    bends = total(_short(_short(fourth, square), _dot(n_tt, n_tt)), -_short(fourth, _short(k, k)))
    twist = total(_short(fourth, _dot(n_t, n_tt)), -_short(square, _short(k, sigma)))
    force, e = _across(a, n), _across(n_t, n)
    bends = total(bends, total(-4 * _short(sigma, twist), 4 * _short(sigma_2, e)))
    to_bernstein(c, out[C])
    to_bernstein(force, out[F])
    to_bernstein(square, out[SQUARE])
    to_bernstein(e, out[E])
    to_bernstein(cross, out[X])
    to_bernstein(bends, out[Y])


@jit_no_arrays
def _extremes(row: FloatArray, lasting: float, b: FloatArray) -> tuple[float, float, float]:
    """Bounds of the size of a quintic (6,) of the share of `lasting` [s] and of its two derivatives; b: scratch."""
    quintic_to_bernstein(row, b)
    largest = fastest = sharpest = 0.0
    for k in range(ORDER):
        largest = max(largest, abs(b[k]))
    for k in range(ORDER - 1):
        fastest = max(fastest, abs(b[k + 1] - b[k]))
    for k in range(ORDER - 2):
        sharpest = max(sharpest, abs(b[k] - 2 * b[k + 1] + b[k + 2]))
    return largest, 5 * fastest / lasting, 20 * sharpest / (lasting * lasting)


@jit_no_arrays
def is_safe_stretched(
    part: Part, motion: FloatArray, plane: FloatArray, lasting: float, b: FloatArray, force: FloatArray
) -> bool:
    """Whether the bound leaves the part at rest; b (6,), force (9,): scratch.

    With G the slope seen in space, |G| <= |grad w| / (1 - |grad u|), and so on for its derivatives.
    """
    e = e_t = e_tt = g = g_t = g_tt = 0.0
    for row in (1, 2, 4, 5):
        size, rate, bend = _extremes(plane[row], lasting, b)
        e, e_t, e_tt = e + size * size, e_t + rate * rate, e_tt + bend * bend
    for row in (1, 2):
        size, rate, bend = _extremes(motion[row], lasting, b)
        g, g_t, g_tt = g + size * size, g_t + rate * rate, g_tt + bend * bend
    e, e_t, e_tt = math.sqrt(e), math.sqrt(e_t), math.sqrt(e_tt)
    g, g_t, g_tt = math.sqrt(g), math.sqrt(g_t), math.sqrt(g_tt)
    if e > MAX_STRETCH:
        return False
    kept = 1.0 - e
    g = g / kept
    g_t = (g_t + e_t * g) / kept
    g_tt = (g_tt + 2 * e_t * g_t + e_tt * g) / kept
    a_x = _extremes(plane[0], lasting, b)[2] + abs(part.tilt_x)
    a_y = _extremes(plane[3], lasting, b)[2] + abs(part.tilt_y)
    a = math.hypot(a_x, a_y)
    quintic_to_bernstein(motion[0], b)
    least, most = math.inf, -math.inf
    for k in range(ORDER - 2):
        upright = part.gravity + 20 * (b[k] - 2 * b[k + 1] + b[k + 2]) / (lasting * lasting)
        least, most = min(least, upright), max(most, upright)
    s = math.sqrt(1.0 + g * g)
    turn = part.centre * g_t * g_t
    load_low = part.mass * ((least / s if least > 0.0 else least) - a * g - turn) + part.squeeze
    load_high = part.mass * ((most if most > 0.0 else most / s) + a * g) + part.squeeze
    if load_low < -part.law.pull_off or load_high > part.law.largest_load:
        return False
    limit = part.law.static_ratio * friction_limit(part.law, load_low) / part.mass
    rest = max(abs(least), abs(most)) * e * g + part.centre * (e_tt * g + 2 * e_t * g_t + e * g_tt)
    rest += part.centre * (2.5 * g * g * g_tt + (4 + 6 * g * g) * g * g_t * g_t)
    return bool(largest_force(part, motion, plane, lasting, force) + rest <= limit)


@jit_no_arrays
def largest_force(part: Part, motion: FloatArray, plane: FloatArray, lasting: float, force: FloatArray) -> float:
    """What |a + U grad w - z grad w''| is at most [m/s^2]; force: scratch."""
    rate, square = 1.0 / (lasting * lasting), 0.0
    for row, along, tilt in ((1, 0, part.tilt_x), (2, 3, part.tilt_y)):
        for k in range(BOUND_DEGREE + 1):
            force[k] = 0.0
        force[0] = -tilt
        for k in range(ORDER - 2):
            twice = (k + 2) * (k + 1) * rate
            force[k] += twice * (plane[along, k + 2] - part.centre * motion[row, k + 2])
            upright = twice * motion[0, k + 2] + (part.gravity if k == 0 else 0.0)
            for j in range(ORDER):
                force[k + j] += upright * motion[row, j]
        most = 0.0
        for i in range(BOUND_DEGREE + 1):
            coefficient = 0.0
            for k in range(i + 1):
                coefficient += _TO_BERNSTEIN[i, k] * force[k]
            most = max(most, abs(coefficient))
        square += most * most
    return math.sqrt(square)
