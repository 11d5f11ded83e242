"""Natural frequencies of Kirchhoff plates, omega a^2 sqrt(rho h / D), computed: nothing here is a remembered digit.

A. W. Leissa, "Vibration of Plates", NASA SP-160, 1969: chapter 2 (discs), chapter 4 (rectangles). Lengths: the disc's
radius is 1; rectangles have their sides as arguments, so that for a unit square the numbers are Leissa's.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.linalg import eigh
from scipy.optimize import brentq
from scipy.special import eval_jacobi, ive, jv, kve, yv

CLAMPED, SIMPLY_SUPPORTED, FREE = "clamped", "simply-supported", "free"


def disc(support, count, nu=0.3, centre_held=False):
    """First frequencies of a disc, repeated ones repeated, without a free disc's rigid modes: (count,).

    For each number m of nodal diameters the roots of a 2 x 2 determinant of J_m and I_m, Leissa chapter 2. A held
    centre changes m = 0 only, to the two functions that vanish there: J_0 - I_0 and Y_0 + (2/pi) K_0, a point force's.
    """
    found, m = [], 0
    while True:
        roots = _disc_roots(support, m, count, nu, centre_held and m == 0)
        if len(found) >= count and roots[0] > sorted(found)[count - 1] and m > 2:
            return np.sort(found)[:count]
        found += [root for root in roots for _ in range(2 if m else 1)]
        m += 1


def _disc_roots(support, m, count, nu, held):
    def determinant(k):
        return np.linalg.det(_disc_conditions(support, m, k, nu, held))

    grid = np.arange(0.5, m + np.pi * (count + 2), 0.05)
    sign = np.sign([determinant(k) for k in grid])
    return [brentq(determinant, *grid[i : i + 2], xtol=1e-14) ** 2 for i in np.flatnonzero(sign[1:] != sign[:-1])]


def _disc_conditions(support, m, k, nu, held):
    """The two conditions at r = 1 on the two solutions: (2, 2). I is scaled by e^-k, K by e^k."""

    def conditions(f, slope, laplacian_sign):
        moment = laplacian_sign * k**2 * f - (1 - nu) * (slope - m**2 * f)
        shear = laplacian_sign * k**2 * slope - (1 - nu) * m**2 * (slope - f)
        rows = {CLAMPED: (f, slope), SIMPLY_SUPPORTED: (f, moment), FREE: (moment / k**2, shear / k**3)}
        return np.array(rows[support])

    def bessel(f, sign):
        """Value and slope at 1 of f(m, k r): f' = m f / x + sign f_(m+1)."""
        return f(m, k), m * f(m, k) + sign * k * f(m + 1, k)

    j, i = conditions(*bessel(jv, -1), -1), conditions(*bessel(ive, 1), 1)
    if not held:
        return np.stack([j, i], axis=1)
    y, big_k = conditions(*bessel(yv, -1), -1), conditions(*bessel(kve, -1), 1)
    return np.stack([j * np.exp(-k) - i, y + 2 / np.pi * np.exp(-k) * big_k], axis=1)


def supported_rectangle(width, height, count):
    """pi^2 (m^2 / a^2 + n^2 / b^2), Leissa chapter 4: (count,)."""
    m, n = np.meshgrid(*[np.arange(1, count + 1)] * 2)
    return np.sort(np.pi**2 * ((m / width) ** 2 + (n / height) ** 2).ravel())[:count]


def levy_rectangle(width, height, supports, count, nu=0.3):
    """Left and right simply supported, supports (bottom, top) for the others, by Levy's equations: (count,).

    sin(m pi x / a) times four exponentials in y, whose conditions' determinant vanishes (Leissa chapter 4, all six
    cases); Ritz's method in y says between which bounds to look, so that no root is missed.
    """
    found = []
    for m in range(1, count + 1):
        k = m * np.pi / width
        for guess in _levy_ritz(k, height, supports, nu)[:count]:
            bounds = guess * (1 - 1e-7), guess * (1 + 1e-7)
            found.append(brentq(_levy_determinant, *bounds, args=(k, height, supports, nu), xtol=1e-13))
    return np.sort(found)[:count]


def _levy_determinant(omega, k, height, supports, nu):
    slow = np.sqrt(complex(omega - k**2))  # w = cos, sin(slow y) also below k^2, where they are hyperbolic
    fast = np.sqrt(omega + k**2)
    rows = []
    for place, support in zip((0.0, height), supports, strict=True):
        s, t = slow * place, fast * place
        sine = np.sin(s) / slow
        up, down = np.exp(-fast * (height - place)), np.exp(-t)
        value = np.array([np.cos(s), sine, up, down])
        first = np.array([-(slow**2) * sine, np.cos(s), fast * up, -fast * down])
        square = np.array([-(slow**2), -(slow**2), fast**2, fast**2])
        moment, shear = (square - nu * k**2) * value, (square - (2 - nu) * k**2) * first
        rows += {CLAMPED: (value, first), SIMPLY_SUPPORTED: (value, moment), FREE: (moment, shear)}[support]
    return np.linalg.det(np.array(rows)).real


def _levy_ritz(k, height, supports, nu):
    _, mass, cross, bend, slope = _side(height, supports, 24)
    stiffness = bend - nu * k**2 * (cross + cross.T) + k**4 * mass + 2 * (1 - nu) * k**2 * slope
    return np.sqrt(eigh(stiffness, mass, eigvals_only=True))


def _side(length, supports, degree):
    """Functions (1+s)^q (1-s)^p P_j^(2p,2q)(s) of a side, orthogonal, that meet what its two ends hold; s from -1 to 1.

    Returns a function y -> values (n, degree + 1), y from -length / 2 to length / 2, and the integrals of f_i f_j,
    f_i f_j'', f_i'' f_j'' and f_i' f_j'.
    """
    q, p = ({CLAMPED: 2, SIMPLY_SUPPORTED: 1, FREE: 0}[s] for s in supports)
    j = np.arange(degree + 1)

    def derivative(s, order):
        """By Leibniz, of the weight (a polynomial) and of Jacobi's polynomials."""
        weight = np.polynomial.Polynomial([1, 1]) ** q * np.polynomial.Polynomial([1, -1]) ** p
        total = np.zeros((len(s), len(j)))
        for i, binomial in enumerate(([1], [1, 1], [1, 2, 1])[order]):
            rising = np.prod([(j + 2 * p + 2 * q + 1 + n) / 2 for n in range(i)], axis=0)
            jacobi = np.where(j >= i, rising * eval_jacobi(np.maximum(j - i, 0), 2 * p + i, 2 * q + i, s[:, None]), 0)
            total += binomial * (weight.deriv(order - i) if order > i else weight)(s)[:, None] * jacobi
        return total

    s, w = leggauss(degree + 8)  # exact
    norm = np.sqrt(w @ derivative(s, 0) ** 2 * length / 2)
    f, f1, f2 = (derivative(s, n) / norm * (2 / length) ** n for n in range(3))
    w = w[:, None] * length / 2
    integrals = f.T @ (w * f), f.T @ (w * f2), f2.T @ (w * f2), f1.T @ (w * f1)
    return lambda y: derivative(2 * np.asarray(y) / length, 0) / norm, *integrals


def ritz_rectangle(width, height, supports, degree=20, nu=0.3):
    """Rayleigh-Ritz with products of orthogonal polynomials, supports (left, right, bottom, top).

    All frequencies ((degree + 1)^2,), upper bounds, rigid modes included as zeros, and a function xy (n, 2) -> the
    modes' values (n, (degree + 1)^2), of mass 1.
    """
    fx, mx, cx, bx, sx = _side(width, supports[:2], degree)
    fy, my, cy, by, sy = _side(height, supports[2:], degree)
    stiffness = np.kron(bx, my) + np.kron(mx, by) + 2 * (1 - nu) * np.kron(sx, sy)
    stiffness += nu * (np.kron(cx, cy.T) + np.kron(cx.T, cy))
    # Inverted (raised by the mass: a free plate's is singular) and scaled: high modes cost the low ones no digits.
    raised = stiffness + np.eye(len(stiffness))
    scale = 1 / np.sqrt(np.diag(raised))
    inverse, modes = eigh(np.diag(scale**2), scale[:, None] * raised * scale)
    inverse = inverse[::-1]
    square, modes = 1 / inverse - 1, scale[:, None] * modes[:, ::-1] / np.sqrt(inverse)

    def evaluate(xy):
        x, y = np.asarray(xy, dtype=float).T
        return np.einsum("ni,nj->nij", fx(x), fy(y)).reshape(len(x), -1) @ modes

    return np.sqrt(np.maximum(square, 0)), evaluate


def held(omega, shapes, compliance, count, second=None):
    """Frequencies of a plate held at a point, from those of the free one: the first `count`.

    omega (N,): its frequencies.  shapes (N,): its modes there, of mass 1.  compliance: its deflection there under a
    unit force there.  second: the integral of that deflection's square over the plate, if known.
    A force holds the point where 0 = sum shapes^2 / (omega^2 - lambda). With its first two terms in lambda known,
    compliance and second, what is left to sum is lambda^2 shapes^2 / (omega^4 (omega^2 - lambda)): a few modes do.
    """
    order = np.argsort(omega)
    square, weight = omega[order] ** 2, shapes[order] ** 2
    starts = np.flatnonzero(np.diff(square, prepend=-1) > 1e-8 * square)
    repeats, weights, poles = np.diff(np.append(starts, len(square))), np.add.reduceat(weight, starts), square[starts]
    moves = weights > 1e-12 * weights.max()
    stay = np.repeat(poles, repeats - moves)  # of modes with one frequency, one combination moves the point
    poles, weights, moved = poles[moves], weights[moves], []
    second = (weights / poles**2).sum() if second is None else second

    def residual(square):
        return compliance + square * second + square**2 * (weights / (poles**2 * (poles - square))).sum()

    for low, high in zip(poles[:count], poles[1 : count + 1], strict=True):
        gap = (high - low) * 1e-10
        moved.append(brentq(residual, low + gap, high - gap, xtol=1e-14 * high, rtol=1e-15))
    return np.sqrt(np.sort(np.concatenate([stay, moved])))[:count]


def held_supported_rectangle(width, height, point, compliance, count, terms=150):
    """Frequencies (count,) of a simply supported rectangle around the origin, held at `point` (2,); see `held`."""
    m = np.arange(1, terms)
    across, along = (np.sin(m * np.pi * (x / a + 0.5)) ** 2 for x, a in zip(point, (width, height), strict=True))
    omega = np.pi**2 * ((m[:, None] / width) ** 2 + (m / height) ** 2)
    shapes = 2 * np.sqrt(across[:, None] * along / (width * height))
    return held(omega.ravel(), shapes.ravel(), compliance, count)
