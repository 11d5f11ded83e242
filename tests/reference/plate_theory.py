"""Deflections of circular and elliptical Kirchhoff plates of rigidity 1: closed forms and quickly converging series.

Every function takes xy (n, 2) and returns w (n,), gradient (n, 2), Hessian (n, 2, 2), positive along the load.
Supports: "clamped", "simply-supported", "free". TWK is Timoshenko & Woinowsky-Krieger, "Theory of Plates and Shells",
2nd edition, 1959. Rectangles: `plate_rectangles`; clamped ones have no such solution, `goursat` solves them.
"""

from __future__ import annotations

import numpy as np

CLAMPED, SIMPLY_SUPPORTED, FREE = "clamped", "simply-supported", "free"


def clamped_ellipse_pressure(xy, a, b):
    """Clamped ellipse with semi-axes a, b under a pressure of 1: Bryan's solution, TWK chapter 9."""
    x, y = np.asarray(xy, dtype=float).T
    top, u = 1 / (24 / a**4 + 16 / (a * b) ** 2 + 24 / b**4), 1 - (x / a) ** 2 - (y / b) ** 2
    slope = np.stack([-2 * x / a**2, -2 * y / b**2], axis=1)
    hessian = slope[:, :, None] * slope[:, None, :] - 2 * u[:, None, None] * np.diag([a**-2.0, b**-2.0])
    return top * u**2, 2 * top * u[:, None] * slope, 2 * top * hessian


def radial(xy, w, first, second):
    """Fields of an axisymmetric deflection from its derivatives by r, each (n,); in the centre the slope is 0."""
    r = np.linalg.norm(xy, axis=1)
    away = r > 0
    e = np.where(away[:, None], xy / np.where(away, r, 1)[:, None], 0)
    around = np.where(away, first / np.where(away, r, 1), second)
    outer = e[:, :, None] * e[:, None, :]
    return w, first[:, None] * e, (second - around)[:, None, None] * outer + around[:, None, None] * np.eye(2)


def disc_pressure(xy, radius, support, nu=0.3):
    """Disc under a pressure of 1: TWK section 16."""
    xy, a2 = np.asarray(xy, dtype=float), radius**2
    r2 = (xy**2).sum(axis=1)
    c = {CLAMPED: 1, SIMPLY_SUPPORTED: (5 + nu) / (1 + nu)}[support]  # w = (a^2 - r^2) (c a^2 - r^2) / 64
    first = (4 * r2 - 2 * (c + 1) * a2) * np.sqrt(r2) / 64
    return radial(xy, (a2 - r2) * (c * a2 - r2) / 64, first, (12 * r2 - 2 * (c + 1) * a2) / 64)


def disc_central_force(xy, radius, support, nu=0.3):
    """Disc under a force of 1 in its centre: TWK section 19; the Hessian at the centre itself means nothing.

    Free: a pressure of -1 / (pi a^2) holds the balance and w = 0 at the centre (M_r = 0 at the rim gives c).
    """
    xy = np.asarray(xy, dtype=float)
    r2 = (xy**2).sum(axis=1) / radius**2
    log = np.log(np.where(r2 > 0, r2, 1)) / 2
    soft = (3 + nu) / (1 + nu)
    # w = a^2 (2 r^2 ln r + c (1 - r^2) - p r^4 + h) / (16 pi), r in radii
    c, p, h = {CLAMPED: (1, 0, 0), SIMPLY_SUPPORTED: (soft, 0, 0), FREE: (soft / 2, 0.25, -soft / 2)}[support]
    w = 2 * r2 * log + c * (1 - r2) - p * r2**2 + h
    first = np.sqrt(r2) * (4 * log + 2 - 2 * c - 4 * p * r2)
    second = 4 * log + 6 - 2 * c - 12 * p * r2
    scale = 1 / (16 * np.pi)
    return radial(xy, scale * radius**2 * w, scale * radius * first, scale * second)


def annulus_pressure(xy, inner, outer, supports, nu=0.3):
    """Annulus under a pressure of 1, supports (inner, outer): TWK section 17.

    w = r^4 / 64 + A + B r^2 + C ln r + E r^2 ln r; the four constants meet two conditions at each edge.
    """
    xy = np.asarray(xy, dtype=float)

    def powers(r):
        """Rows w, w', w'', w''' of r^4/64, 1, r^2, ln r, r^2 ln r: (4, 5, n)."""
        log, o = np.log(r), 0 * r
        return np.array(
            [
                [r**4 / 64, o + 1, r**2, log, r**2 * log],
                [r**3 / 16, o, 2 * r, 1 / r, r * (2 * log + 1)],
                [3 * r**2 / 16, o, o + 2, -1 / r**2, 2 * log + 3],
                [3 * r / 8, o, o, 2 / r**3, 2 / r],
            ]
        )

    rows = []
    for r, support in zip((inner, outer), supports, strict=True):
        w, first, second, third = powers(np.array(float(r)))
        moment, shear = second + nu * first / r, third + second / r - first / r**2
        rows += {CLAMPED: [w, first], SIMPLY_SUPPORTED: [w, moment], FREE: [moment, shear]}[support]
    system = np.array(rows)
    weights = np.append(1, np.linalg.solve(system[:, 1:], -system[:, 0]))
    return radial(xy, *(weights @ values for values in powers(np.linalg.norm(xy, axis=1))[:3]))


def disc_force(xy, source, support, nu=0.3):
    """Unit disc, clamped or simply supported, under a force of 1 at `source` (2,), where the Hessian means nothing.

    w = (r^2 ln r around the source) / (8 pi) + sum_m (a_m + b_m r^2) r^m cos(m theta): Clebsch, TWK chapter 9. The
    logarithm's own Fourier series gives what each mode must cancel at the rim; the modes fall like |source|^m.
    """
    source = np.asarray(source, dtype=float) @ [1, 1j]
    rho, turn = abs(source), np.exp(1j * np.angle(source))
    m = np.arange(4 if rho == 0 else max(4, int(np.ceil(-45 / np.log(rho)))))
    high = m[2:]
    # Value, first and second derivative at r = 1 of the source's modes, times 8 pi: m = 0, m = 1, then c r^(2-m) + ...
    ring = np.zeros((3, len(m)))
    ring[:, 0] = rho**2, 1 + rho**2, 3 - rho**2
    ring[:, 1] = -rho - rho**3 / 2, -3 * rho + rho**3 / 2, -2 * rho - rho**3
    ring[:, 2:] = rho**high / (high * (high - 1)) * _power(2 - high) - rho ** (high + 2) / (high * (high + 1)) * _power(
        -high
    )

    def condition(value, first, second):
        return first if support == CLAMPED else second + nu * (first - m**2 * value)

    a_row, b_row = condition(*_power(m)), condition(*_power(m + 2))
    b = (a_row * ring[0] - condition(*ring)) / (b_row - a_row)
    a = -ring[0] - b
    z = np.asarray(xy, dtype=float) @ [1, 1j] * turn.conjugate()
    (f, f1, f2), (g, g1, g2) = (
        [np.polynomial.polynomial.polyval(z, np.polynomial.polynomial.polyder(c, k)) for k in range(3)] for c in (a, b)
    )
    c, r2, off = z.conj(), np.abs(z) ** 2, z - rho
    safe = np.where(off == 0, 1, off)
    log = np.log(np.abs(safe))
    w = (f + r2 * g).real + np.abs(off) ** 2 * log
    by_z = (f1 + c * g + r2 * g1 + (z * g).conj()) / 2 + off.conj() * (log + 0.5)
    by_zz, by_zy = (f2 + 2 * c * g1 + r2 * g2 + safe.conj() / safe) / 2, (g + z * g1).real + log + 1
    by_z, by_zz = by_z * turn.conjugate(), by_zz * turn.conjugate() ** 2
    xx, xy, yy = 2 * (by_zz.real + by_zy), -2 * by_zz.imag, 2 * (by_zy - by_zz.real)
    gradient, hessian = 2 * np.stack([by_z.real, -by_z.imag], axis=1), np.stack([xx, xy, xy, yy], axis=1)
    return w / (8 * np.pi), gradient / (8 * np.pi), hessian.reshape(-1, 2, 2) / (8 * np.pi)


def _power(p):
    """r^p and its first two derivatives at r = 1."""
    return np.array([1.0 + 0 * p, p, p * (p - 1.0)])
