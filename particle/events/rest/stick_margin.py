"""What friction must resist for a part to stay at rest, as polynomials in time, and the proof that it does.

At a fixed X the place P = (X + u + base, w) is a polynomial in time, and so is N = P_x x P_y, which points along the
normal n = N/s, s^2 = N.N. With A = P'' less gravity, sigma = N.N' and k = N.N'', `mechanics.parallel` gives at
rest, for the height z of the centre of mass,

    N - squeeze = m (C / s - z E / s^4)          C = N.A,   E = |N'|^2 s^2 - sigma^2
    s^2 |p|^2 = F + 2 z X / s^3 + z^2 Y / s^6    F = |A|^2 s^2 - C^2
    X = s^4 A.N'' - s^2 C k - 2 sigma (s^2 A.N' - C sigma)
    Y = s^6 |N''|^2 - s^4 k^2 - 4 sigma (s^4 N'.N'' - s^2 k sigma) + 4 sigma^2 (s^2 |N'|^2 - sigma^2)

for its load and the pull p along the surface. These polynomials have degrees up to 76. Over a short subinterval their
higher powers are far below rounding, so they are cut off at `DEGREE`.
"""

from __future__ import annotations

import math

import numpy as np

from particle.events.mechanics import Part
from particle.events.polynomials import derivative, second_derivative, to_bernstein, total
from particle.friction import friction_limit
from particle.jit import device, device_no_arrays, inlined
from particle.types import FloatArray

Vector = tuple[FloatArray, FloatArray, FloatArray]

# Over a share 2^-7 of a span the 15th power is 2^-105 of its coefficient, and that of a product of fifteen quintics
# like (1 - s)^5 is C(75, 15) = 2^51 times the constant one.
NARROW, DEGREE = 2.0**-7, 14
C, F, SQUARE, E, X, Y = range(6)
# A part sticks up to the limit itself, as on a slope at the angle of friction: rounding must not decide.
ROUNDING = 1 + 1e-14


@device
def _short(a: FloatArray, b: FloatArray) -> FloatArray:
    """The product of two polynomials, up to the highest power that counts."""
    out = np.zeros(min(len(a) + len(b) - 1, DEGREE + 1))
    for i in range(min(len(a), len(out))):
        for j in range(min(len(b), len(out) - i)):
            out[i + j] += a[i] * b[j]
    return out


@inlined
def _normal(motion: FloatArray, plane: FloatArray) -> Vector:
    """N = P_x x P_y."""
    x_x, x_y, y_x, y_y = plane[1].copy(), plane[2], plane[4], plane[5].copy()
    x_x[0] += 1.0
    y_y[0] += 1.0
    w_x, w_y = motion[1], motion[2]
    return (
        total(_short(y_x, w_y), -_short(y_y, w_x)),
        total(_short(x_y, w_x), -_short(x_x, w_y)),
        total(_short(x_x, y_y), -_short(x_y, y_x)),
    )


@device
def _dot(a: Vector, b: Vector) -> FloatArray:
    """a.b."""
    return total(total(_short(a[0], b[0]), _short(a[1], b[1])), _short(a[2], b[2]))


@device
def _across(a: Vector, b: Vector) -> FloatArray:
    """|a|^2 |b|^2 - (a.b)^2, as the square of their vector product: it loses no digits where it is small."""
    x = total(_short(a[1], b[2]), -_short(a[2], b[1]))
    y = total(_short(a[2], b[0]), -_short(a[0], b[2]))
    z = total(_short(a[0], b[1]), -_short(a[1], b[0]))
    return _dot((x, y, z), (x, y, z))


@inlined
def fill_margin(part: Part, motion: FloatArray, plane: FloatArray, lasting: float, out: FloatArray) -> None:
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


@device_no_arrays
def _over(value: float, low: float, high: float) -> tuple[float, float]:
    """The least and the largest of a value over a divisor from `low` to `high`."""
    return (value / high, value / low) if value > 0.0 else (value / low, value / high)


@inlined
def is_safe_by_margin(part: Part, margin: FloatArray, slack: float) -> bool:
    """Whether the Bernstein coefficients (6, n) of a subinterval prove that the part stays throughout it.

    A polynomial over a power of s lies between those over the least and the largest s, so the coefficients of
    Q^2 s^2 - s^2 |m p|^2 remain bounds, with the least Q that the subinterval's loads allow.
    """
    least_square = margin[SQUARE].min()
    if least_square <= 0.0:
        return False
    low, high, z = math.sqrt(least_square), math.sqrt(margin[SQUARE].max()), part.centre
    least, most = _over(margin[C].min(), low, high)[0], _over(margin[C].max(), low, high)[1]
    least -= z * _over(margin[E].max(), low**4, high**4)[1]
    most -= z * _over(max(0.0, margin[E].min()), low**4, high**4)[0]
    load_low, load_high = part.mass * least + part.squeeze, part.mass * most + part.squeeze
    if load_low < -part.law.pull_off or load_high > part.law.largest_load:
        return False
    limit = part.law.static_ratio * friction_limit(part.law, load_low) / part.mass
    for i in range(margin.shape[1]):
        force = margin[F, i] + 2 * z * _over(margin[X, i], low**3, high**3)[1]
        force += z * z * _over(margin[Y, i], low**6, high**6)[1]
        if force - slack > limit * limit * margin[SQUARE, i] * ROUNDING:
            return False
    return True


@device_no_arrays
def holds_at_end(part: Part, margin: FloatArray, slack: float) -> bool:
    """Whether the part stays at the end of a subinterval: -pull-off <= N <= largest load and |m p| <= Q(N)."""
    last = margin.shape[1] - 1
    z, square = part.centre, margin[SQUARE, last]
    s = math.sqrt(square)
    load = part.mass * (margin[C, last] / s - z * margin[E, last] / square**2) + part.squeeze
    limit = part.law.static_ratio * friction_limit(part.law, load) / part.mass
    force = margin[F, last] + 2 * z * margin[X, last] / (s * square) + z * z * margin[Y, last] / square**3
    return -part.law.pull_off <= load <= part.law.largest_load and force - slack <= limit * limit * square * ROUNDING
