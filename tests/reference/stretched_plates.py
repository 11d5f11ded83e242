"""Kirchhoff plates of rigidity 1 under a tension, the same in all directions: closed forms and quick series.

They solve laplace^2 w - tension laplace w = load, which splits into laplace (laplace - tension). Negative tensions
press. Discs have a radius of 1. Functions of xy (n, 2) return w (n,), gradient (n, 2), Hessian (n, 2, 2).
"""

from __future__ import annotations

import mpmath
import numpy as np
from plate_modes import _side
from plate_theory import CLAMPED, radial
from scipy.linalg import eigh
from scipy.optimize import brentq
from scipy.special import i0e, i1e, ive, jv, k0, k1, y0, y1

DIGITS = 50
MIN_MODE = 1e-17  # rho^m of the last mode


def disc_force(xy, source, support, tension, nu=0.3):
    """Disc under a force of 1 at `source` (2,), where the Hessian means nothing.

    For each number m of nodal diameters w is a ring force's known response, by Graf's addition theorems, plus a r^m and
    b I_m(beta r) (in compression J_m), which meet the two conditions at the rim.
    """
    source = np.asarray(source, dtype=float)
    rho, turn = np.hypot(*source), np.arctan2(source[1], source[0])
    x, y = np.asarray(xy, dtype=float).T
    radius, angle = np.hypot(x, y), np.arctan2(y, x) - turn
    parts = [np.zeros(len(x)) for _ in range(6)]  # w, w_r, w_rr, w_a / r, w_ra, w_aa as seen along r
    for m in range(1 if rho == 0 else int(np.ceil(np.log(MIN_MODE) / np.log(rho)))):
        a, b = _coefficients(m, rho, support, tension, nu)
        f, f1, f2 = (a * p + b * q for p, q in zip(_powers(m, radius), _bessels(m, radius, tension), strict=True))
        cos, sin = np.cos(m * angle), np.sin(m * angle)
        parts[0] += f * cos
        parts[1] += f1 * cos
        parts[2] += f2 * cos
        parts[3] -= m * f / radius * sin
        parts[4] -= m * (f1 / radius - f / radius**2) * sin
        parts[5] += (f1 / radius - m**2 * f / radius**2) * cos
    w, first, second, around, mixed, across = parts
    e, t = np.stack([x, y], 1) / radius[:, None], np.stack([-y, x], 1) / radius[:, None]
    ee, et, tt = (p[:, :, None] * q[:, None, :] for p, q in ((e, e), (e, t), (t, t)))
    hessian = second[:, None, None] * ee + mixed[:, None, None] * (et + np.swapaxes(et, 1, 2))
    smooth = w, first[:, None] * e + around[:, None] * t, hessian + across[:, None, None] * tt
    known = _infinite(np.asarray(xy, dtype=float) - source, tension)
    return tuple(p + q for p, q in zip(smooth, known, strict=True))


def _infinite(offset, tension):
    """The infinite plate's response to a unit force, of which `_coefficients` has the modes."""
    r, k = np.hypot(*offset.T), np.sqrt(abs(tension))
    if tension > 0:
        f, f1 = k0(k * r), -k * k1(k * r)
    else:
        f, f1 = -np.pi / 2 * y0(k * r), np.pi / 2 * k * y1(k * r)
    f2 = tension * f - f1 / r
    scale = -1 / (2 * np.pi * tension)
    return radial(offset, scale * (np.log(r) + f), scale * (1 / r + f1), scale * (f2 - 1 / r**2))


def _coefficients(m, rho, support, tension, nu):
    with mpmath.workdps(DIGITS):
        k, tension, rho = mpmath.sqrt(abs(tension)), mpmath.mpf(tension), mpmath.mpf(rho)
        pulls = tension > 0
        inner, outer = (mpmath.besseli, mpmath.besselk) if pulls else (mpmath.besselj, mpmath.bessely)

        def jet(order, way):  # of a Bessel function of k r: value and two derivatives by r at r = 1
            f = order(m, k)
            f1 = m * f + way * k * order(m + 1, k)
            return f, f1, (m**2 + tension) * f - f1

        weight = (2 if m else 1) * (1 if pulls else -mpmath.pi / 2) * inner(m, k * rho)
        log = (-(rho**m) / m, rho**m, -(m + 1) * rho**m) if m else (0, 1, -1)
        known = zip(log, jet(outer, -1), strict=True)
        ring = [-(u + weight * v) / (2 * mpmath.pi * tension) for u, v in known]
        own = [v / mpmath.mpf(_scale(m, k, pulls)) for v in jet(inner, 1 if pulls else -1)]
        power = (1, m, m * (m - 1))

        def condition(f, f1, f2):
            return f1 if support == CLAMPED else f2 + nu * (f1 - m**2 * f)

        matrix = mpmath.matrix([[power[0], own[0]], [condition(*power), condition(*own)]])
        return [float(c) for c in mpmath.lu_solve(matrix, mpmath.matrix([-ring[0], -condition(*ring)]))]


def _scale(m, k, pulls):
    """What I_m(k r) is divided by, its value at 1; J_m(k r) by its leading term there, which is never 0."""
    return mpmath.besseli(m, k) if pulls else (k / 2) ** m / mpmath.factorial(m)


def _powers(m, r):
    return r**m, m * r ** max(m - 1, 0), m * (m - 1) * r ** max(m - 2, 0)


def _bessels(m, r, tension):
    """I_m(k r) or J_m(k r) over `_scale`, and its first two derivatives."""
    k = np.sqrt(abs(tension))
    if tension > 0:
        scale = np.exp(k * (r - 1)) / ive(m, k)
        f, after = scale * ive(m, k * r), scale * ive(m + 1, k * r)
    else:
        scale = float(_scale(m, mpmath.mpf(k), False))
        f, after = jv(m, k * r) / scale, -jv(m + 1, k * r) / scale
    f1 = k * after + m / r * f
    return f, f1, (m**2 / r**2 + tension) * f - f1 / r


def disc_pressure(xy, support, tension, nu=0.3):
    """Disc under a pressure of 1 and a tension that pulls: -r^2 / (4 tension) + a + b I_0(beta r)."""
    xy = np.asarray(xy, dtype=float)
    r, k = np.hypot(*xy.T), np.sqrt(tension)
    ratio = i1e(k) / i0e(k)  # I_0 is scaled to 1 at the rim
    slope, bend = k * ratio, k**2 - k * ratio
    p1, p2 = -1 / (2 * tension), -1 / (2 * tension)
    b = -p1 / slope if support == CLAMPED else -(p2 + nu * p1) / (bend + nu * slope)
    a = 1 / (4 * tension) - b
    scale = np.exp(k * (r - 1)) / i0e(k)
    f, f1 = scale * i0e(k * r), scale * k * i1e(k * r)
    with np.errstate(invalid="ignore"):
        f2 = np.where(r > 0, k**2 * f - f1 / r, k**2 / 2 * f)
    return radial(xy, a - r**2 / (4 * tension) + b * f, b * f1 + p1 * r, b * f2 + p2)


def supported_square_force(xy, source, side, tension, terms=400):
    """Simply supported square around the origin under a force of 1 at `source`: w (n,) alone.

    Away from the line through the source along x: (laplace - tension) and laplace have Green's functions of their own,
    both 0 at the rim, and w is their difference over the tension.
    """
    (x, y), (u, v) = np.asarray(xy, dtype=float).T[:, :, None] + side / 2, np.asarray(source) + side / 2
    k = np.arange(1, terms) * np.pi / side
    waves = 2 / side * np.sin(k * x) * np.sin(k * u)
    low, high = np.minimum(y, v), np.maximum(y, v)

    def green(q):  # sinh(q low) sinh(q (side - high)) / (q sinh(q side)) without overflow
        rise, fall = -np.expm1(-2 * q * low), -np.expm1(-2 * q * (side - high))
        return np.exp(q * (low - high)) * rise * fall / (-2 * q * np.expm1(-2 * q * side))

    return (waves * (green(k) - green(np.sqrt(k**2 + tension + 0j)).real)).sum(axis=1) / tension


def disc_frequencies(support, tension, count, nu=0.3):
    """omega (count,) of J_m(p r) and I_m(q r) with q^2 - p^2 = tension and omega = p q; repeated ones repeated."""
    found, m = [], 0
    while True:
        roots = _roots(support, m, tension, count, nu)
        if len(found) >= count and roots[0] > sorted(found)[count - 1] and m > 2:
            return np.sort(found)[:count]
        found += [root for root in roots for _ in range(2 if m else 1)]
        m += 1


def _roots(support, m, tension, count, nu):
    def determinant(p):
        q = np.sqrt(p**2 + tension)
        rows = []
        for k, sign, f, f1 in (
            (p, -1, jv(m, p), m * jv(m, p) - p * jv(m + 1, p)),
            (q, 1, ive(m, q), m * ive(m, q) + q * ive(m + 1, q)),
        ):
            moment = sign * k**2 * f - (1 - nu) * (f1 - m**2 * f)
            rows.append((f, f1 if support == CLAMPED else moment))
        return np.linalg.det(np.array(rows))

    grid = np.arange(max(0.05, 0.01 + np.sqrt(max(-tension, 0.0))), m + np.pi * (count + 2), 0.05)
    sign = np.sign([determinant(p) for p in grid])
    roots = [brentq(determinant, *grid[i : i + 2], xtol=1e-14) for i in np.flatnonzero(sign[1:] != sign[:-1])]
    return [p * np.sqrt(p**2 + tension) for p in roots]


def disc_buckling(support, nu=0.3):
    """kappa^2 with J_1(kappa) = 0 (clamped) or kappa J_0 = (1 - nu) J_1 (simply supported): the axisymmetric one."""
    if support == CLAMPED:
        return brentq(lambda k: jv(1, k), 3, 4.5, xtol=1e-15) ** 2
    return brentq(lambda k: k * jv(0, k) - (1 - nu) * jv(1, k), 1, 3, xtol=1e-15) ** 2


def rectangle_buckling(width, height, supports, degree=16, nu=0.3):
    """Rayleigh and Ritz: an upper bound. supports: (left, right, bottom, top)."""
    _, mx, cx, bx, sx = _side(width, supports[:2], degree)
    _, my, cy, by, sy = _side(height, supports[2:], degree)
    stiffness = np.kron(bx, my) + np.kron(mx, by) + 2 * (1 - nu) * np.kron(sx, sy)
    stiffness += nu * (np.kron(cx, cy.T) + np.kron(cx.T, cy))
    return 1 / eigh(np.kron(sx, my) + np.kron(mx, sy), stiffness, eigvals_only=True)[-1]
