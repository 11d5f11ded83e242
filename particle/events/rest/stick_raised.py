"""What holds a part at rest whose centre of mass is off the mid-plane, as polynomials in time.

With g = grad w, dots for its rates at a fixed place, U = gravity + w_tt, a the base's acceleration less gravity's share
in its plane, sigma = g.g', e = |g'|^2, k = g.g'' and m = g'.g'', `mechanics.parallel` gives at rest,
for the height z of the centre of mass,

    N - squeeze = m (C / s - z E / s^4)          C = U - a.g,   E = e s^2 - sigma^2
    s^2 |p|^2 = F + 2 z X / s^3 + z^2 Y / s^6    F = s^2 |p|^2 of a point part
    X = s^4 (p.n'') of both pulls = -s^4 a.g'' + s^2 (2 (a.g') sigma + (a.g - U) k) + 2 sigma^2 (U - a.g)
    Y = s^6 |g''|^2 - s^4 (k^2 + 4 sigma m) + 4 s^2 sigma^2 (k + e) - 4 sigma^4

A polynomial over s^3 lies between those over the least and the largest s^3, so Bernstein coefficients remain a proof.
"""

from __future__ import annotations

import math

from particle.events.bernstein import to_bernstein
from particle.events.mechanics import Part
from particle.events.polynomials import derivative, dot, product, second_derivative, total
from particle.friction import friction_limit
from particle.jit import jit, jit_no_arrays
from particle.types import FloatArray

DEGREE = 36  # of Y; everything else is raised to it
C, F, SQUARE, E, X, Y = range(6)


@jit
def fill_raised(
    c: FloatArray,
    force: FloatArray,
    square: FloatArray,
    b_x: FloatArray,
    b_y: FloatArray,
    motion: FloatArray,
    lasting: float,
    out: FloatArray,
) -> None:
    """C, F, s^2, E, X and Y in Bernstein form into `out` (6, 37).

    The first three and a are polynomials of the share of the time `lasting` [s], as are w, w_x and w_y in `motion`.
    """
    x, y = motion[1], motion[2]
    x_t, y_t = derivative(x, lasting), derivative(y, lasting)
    x_tt, y_tt = second_derivative(x, lasting), second_derivative(y, lasting)
    sigma, e = dot(x, y, x_t, y_t), dot(x_t, y_t, x_t, y_t)
    k, m = dot(x, y, x_tt, y_tt), dot(x_t, y_t, x_tt, y_tt)
    fourth, sigma_2 = product(square, square), product(sigma, sigma)
    cross = product(dot(b_x, b_y, x_t, y_t), 2 * sigma)
    cross = product(square, total(cross, -product(c, k)))
    cross = total(cross, total(-product(fourth, dot(b_x, b_y, x_tt, y_tt)), 2 * product(sigma_2, c)))
    bends = product(product(fourth, square), dot(x_tt, y_tt, x_tt, y_tt))
    bends = total(bends, -product(fourth, total(product(k, k), 4 * product(sigma, m))))
    bends = total(bends, 4 * product(product(square, sigma_2), total(k, e)))
    bends = total(bends, -4 * product(sigma_2, sigma_2))
    to_bernstein(c, out[C])
    to_bernstein(force, out[F])
    to_bernstein(square, out[SQUARE])
    to_bernstein(total(product(e, square), -sigma_2), out[E])
    to_bernstein(cross, out[X])
    to_bernstein(bends, out[Y])


@jit_no_arrays
def over(value: float, low: float, high: float) -> tuple[float, float]:
    """The least and the largest of a value over a divisor from `low` to `high`."""
    return (value / high, value / low) if value > 0.0 else (value / low, value / high)


@jit
def is_safe_raised(part: Part, rest: FloatArray, slack: float, least_square: float) -> bool:
    """Whether the Bernstein coefficients (6, n) of a subinterval prove that the part stays.

    least_square: what s^2 cannot be less than, whatever its coefficients.
    """
    low, high = math.sqrt(max(least_square, rest[SQUARE].min())), math.sqrt(max(least_square, rest[SQUARE].max()))
    z = part.centre
    least, most = over(rest[C].min(), low, high)[0], over(rest[C].max(), low, high)[1]
    least -= z * over(rest[E].max(), low**4, high**4)[1]
    most -= z * over(max(0.0, rest[E].min()), low**4, high**4)[0]
    load_low, load_high = part.mass * least + part.squeeze, part.mass * most + part.squeeze
    if load_low < -part.law.pull_off or load_high > part.law.largest_load:
        return False
    limit = part.law.static_ratio * friction_limit(part.law, load_low) / part.mass
    for i in range(rest.shape[1]):
        force = rest[F, i] + 2 * z * over(rest[X, i], low**3, high**3)[1] + z * z * over(rest[Y, i], low**6, high**6)[1]
        if force - slack > limit * limit * rest[SQUARE, i]:
            return False
    return True


@jit_no_arrays
def holds_raised(part: Part, rest: FloatArray, slack: float) -> bool:
    """Whether the part stays at the end of a subinterval."""
    last = rest.shape[1] - 1
    z, square = part.centre, rest[SQUARE, last]
    s = math.sqrt(square)
    load = part.mass * (rest[C, last] / s - z * rest[E, last] / square**2) + part.squeeze
    limit = part.law.static_ratio * friction_limit(part.law, load) / part.mass
    force = rest[F, last] + 2 * z * rest[X, last] / (s * square) + z * z * rest[Y, last] / square**3
    return -part.law.pull_off <= load <= part.law.largest_load and force - slack <= limit * limit * square
