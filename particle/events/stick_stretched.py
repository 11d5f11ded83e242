"""What holds a part at rest where the mid-plane moves in its plane, as polynomials in time.

At a fixed X the place P = (X + u + base, w) is a polynomial in time, and so is N = P_x x P_y, which points along the
normal n = N/s, s^2 = N.N. With A = P'' less gravity, sigma = N.N' and k = N.N'', `particle.events.parallel` gives at
rest, for the height z of the centre of mass,

    N - squeeze = m (C / s - z E / s^4)          C = N.A,   E = |N'|^2 s^2 - sigma^2
    s^2 |p|^2 = F + 2 z X / s^3 + z^2 Y / s^6    F = |A|^2 s^2 - C^2
    X = s^4 A.N'' - s^2 C k - 2 sigma (s^2 A.N' - C sigma)
    Y = s^6 |N''|^2 - s^4 k^2 - 4 sigma (s^4 N'.N'' - s^2 k sigma) + 4 sigma^2 (s^2 |N'|^2 - sigma^2)

`stick_raised` proves that it stays, with the same powers of s.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from particle.drives import ORDER
from particle.events.bernstein import to_bernstein
from particle.events.equations import Part
from particle.events.polynomials import derivative, product, second_derivative, total
from particle.events.stick_raised import SQUARE, C, E, F, X, Y
from particle.friction import friction_limit
from particle.jit import jit, jit_no_arrays

FloatArray = NDArray[np.float64]
Vector = tuple[FloatArray, FloatArray, FloatArray]

DEGREE = 76  # of Y; everything else is raised to it
MOST_STRETCH = 0.5  # of the gradient of u, up to which the quick bounds are of use


@jit
def _normal(motion: FloatArray, plane: FloatArray) -> Vector:
    """N."""
    x_x, x_y, y_x, y_y = plane[1].copy(), plane[2], plane[4], plane[5].copy()
    x_x[0] += 1.0
    y_y[0] += 1.0
    w_x, w_y = motion[1], motion[2]
    return (
        total(product(y_x, w_y), -product(y_y, w_x)),
        total(product(x_y, w_x), -product(x_x, w_y)),
        total(product(x_x, y_y), -product(x_y, y_x)),
    )


@jit
def _dot(a: Vector, b: Vector) -> FloatArray:
    return total(total(product(a[0], b[0]), product(a[1], b[1])), product(a[2], b[2]))


@jit
def fill_stretched(part: Part, motion: FloatArray, plane: FloatArray, lasting: float, out: FloatArray) -> None:
    """C, F, s^2, E, X and Y in Bernstein form into `out` (6, 77).

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
    turns, fourth, sigma_2 = _dot(n_t, n_t), product(square, square), product(sigma, sigma)
    cross = total(product(fourth, _dot(a, n_tt)), -product(square, product(c, k)))
    cross = total(cross, -2 * product(sigma, total(product(square, _dot(a, n_t)), -product(c, sigma))))
    bends = total(product(product(fourth, square), _dot(n_tt, n_tt)), -product(fourth, product(k, k)))
    twist = total(product(fourth, _dot(n_t, n_tt)), -product(square, product(k, sigma)))
    e = total(product(turns, square), -sigma_2)
    bends = total(bends, total(-4 * product(sigma, twist), 4 * product(sigma_2, e)))
    to_bernstein(c, out[C])
    to_bernstein(total(product(_dot(a, a), square), -product(c, c)), out[F])
    to_bernstein(square, out[SQUARE])
    to_bernstein(e, out[E])
    to_bernstein(cross, out[X])
    to_bernstein(bends, out[Y])


@jit_no_arrays
def _extremes(row: FloatArray, lasting: float, b: FloatArray) -> tuple[float, float, float]:
    """Bounds of the size of a quintic (6,) of the share of `lasting` [s] and of its two derivatives; b: scratch."""
    to_bernstein(row, b)
    largest = fastest = sharpest = 0.0
    for k in range(ORDER):
        largest = max(largest, abs(b[k]))
    for k in range(ORDER - 1):
        fastest = max(fastest, abs(b[k + 1] - b[k]))
    for k in range(ORDER - 2):
        sharpest = max(sharpest, abs(b[k] - 2 * b[k + 1] + b[k + 2]))
    return largest, 5 * fastest / lasting, 20 * sharpest / (lasting * lasting)


@jit_no_arrays
def safe_by_extremes_stretched(
    part: Part, motion: FloatArray, plane: FloatArray, lasting: float, b: FloatArray
) -> bool:
    """Whether bounds of the slope, of the stretch and of the accelerations together leave the part at rest.

    With G the slope seen in space, |G| <= |grad w| / (1 - |grad u|), and so on for its derivatives. b: scratch (6,).
    """
    e = e_t = e_tt = g = g_t = g_tt = 0.0
    for row in (1, 2, 4, 5):
        size, rate, bend = _extremes(plane[row], lasting, b)
        e, e_t, e_tt = e + size * size, e_t + rate * rate, e_tt + bend * bend
    for row in (1, 2):
        size, rate, bend = _extremes(motion[row], lasting, b)
        g, g_t, g_tt = g + size * size, g_t + rate * rate, g_tt + bend * bend
    e, e_t, e_tt, g, g_t, g_tt = (
        math.sqrt(e),
        math.sqrt(e_t),
        math.sqrt(e_tt),
        math.sqrt(g),
        math.sqrt(g_t),
        math.sqrt(g_tt),
    )
    if e > MOST_STRETCH:
        return False
    kept = 1.0 - e
    g = g / kept
    g_t = (g_t + e_t * g) / kept
    g_tt = (g_tt + 2 * e_t * g_t + e_tt * g) / kept
    a_x, a_y = (
        _extremes(plane[0], lasting, b)[2] + abs(part.tilt_x),
        _extremes(plane[3], lasting, b)[2] + abs(part.tilt_y),
    )
    a = math.hypot(a_x, a_y)
    rises = _extremes(motion[0], lasting, b)[2]
    least, most = part.gravity - rises, part.gravity + rises
    s = math.sqrt(1.0 + g * g)
    turn = part.centre * g_t * g_t
    load_low = part.mass * ((least / s if least > 0.0 else least) - a * g - turn) + part.squeeze
    load_high = part.mass * ((most if most > 0.0 else most / s) + a * g) + part.squeeze
    if load_low < -part.law.pull_off or load_high > part.law.largest_load:
        return False
    limit = part.law.static_ratio * friction_limit(part.law, load_low) / part.mass
    return bool(max(abs(least), abs(most)) * g + a + part.centre * g_tt + 2 * turn <= limit)
