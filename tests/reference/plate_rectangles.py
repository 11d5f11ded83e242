"""Rectangular Kirchhoff plates of rigidity 1 with two opposite sides simply supported: Levy's and Navier's theory.

Rectangles are centred on the origin; Timoshenko & Woinowsky-Krieger, "Theory of Plates and Shells", 1959, chapters 5
and 6. Every function returns w (n,), gradient (n, 2), Hessian (n, 2, 2) at xy (n, 2).
"""

from __future__ import annotations

import numpy as np
from scipy.special import bernoulli, factorial, zeta

CLAMPED, SIMPLY_SUPPORTED, FREE = "clamped", "simply-supported", "free"
ZETA = {3 - k: zeta(3.0 - k) if k < 2 else -bernoulli(k - 2)[-1] / (k - 2) for k in range(60) if k > 2 or k < 2}
ZETA[0] = -0.5


def polylogarithms(t, angle):
    """Li_3, Li_2, Li_1, Li_0 of exp(-t + i angle), t > 0; each (n,) complex. Series by t, or around 1 for small t.

    Around 1: Li_s(e^u) = u^(s-1)/(s-1)! (H_(s-1) - ln(-u)) + sum over k != s-1 of zeta(s-k) u^k / k!, |u| < 2 pi.
    """
    angle = (angle + np.pi) % (2 * np.pi) - np.pi
    u = -t + 1j * angle
    q = np.exp(u)
    far = t > 0.7
    k = np.arange(1, 70)[:, None]
    terms = np.where(far, q, 0) ** k
    near = np.where(far, -1, u)
    log = np.log(-near)
    three = near**2 / 2 * (1.5 - log) + sum(ZETA[3 - j] * near**j / factorial(j) for j in range(60) if j != 2)
    two = near * (1 - log) + sum(ZETA[2 - j] * near**j / factorial(j) for j in range(59) if j != 1)
    small = -np.expm1(u)
    return (
        np.where(far, (terms / k**3).sum(axis=0), three),
        np.where(far, (terms / k**2).sum(axis=0), two),
        -np.log(small),
        q / small,
    )


def supported_force(xy, source, width, height):
    """Simply supported rectangle under a force of 1 at `source`; the Hessian there means nothing.

    Navier's sum, one index in closed form (Nadai, TWK section 36), the other as polylogarithms: with t, theta the
    scaled distances along y and x a strip's deflection is a^2 / (4 pi^3) Re(Li_3 + t Li_2)(e^(-t + i theta)), twice,
    with opposite signs; images of the strip's source in the other two sides leave nothing out.
    """
    k, points = np.pi / width, np.asarray(xy, dtype=float)
    x, x0 = points[:, 0] + width / 2, source[0] + width / 2
    fields = np.zeros((6, len(points)))
    for j in range(-int(40 / (k * height)) - 1, int(40 / (k * height)) + 2):
        for sign, y0 in ((1, source[1] + 2 * j * height), (-1, height - source[1] + 2 * j * height)):
            y = points[:, 1] - y0
            t, side = k * np.abs(y), np.where(y < 0, -1, 1)
            for part, angle in ((sign, k * (x - x0)), (-sign, k * (x + x0))):
                at_source = (t == 0) & (np.sin(angle / 2) == 0)
                three, two, one, none = polylogarithms(np.where(at_source, 1e-300, t), angle)
                fields += part * np.array(
                    [
                        three.real + t * two.real,
                        -k * (two + t * one).imag,
                        -k * side * t * one.real,
                        -(k**2) * (one + t * none).real,
                        k**2 * side * t * none.imag,
                        k**2 * (t * none - one).real,
                    ]
                )
    w, *slope, xx, xy_, yy = fields * width**2 / (4 * np.pi**3)
    return w, np.stack(slope, axis=1), np.stack([xx, xy_, xy_, yy], axis=1).reshape(-1, 2, 2)


def levy_pressure(xy, width, height, supports=(SIMPLY_SUPPORTED, SIMPLY_SUPPORTED), nu=0.3, modes=400):
    """Rectangle under a pressure of 1, left and right simply supported, supports (bottom, top) for the others.

    Levy (TWK sections 30, 46 to 48): the beam's deflection across x, and for every odd m four functions of y times
    sin(m pi x / a), that meet two conditions at the bottom and two at the top. On these sides themselves the series
    converges like m^-5 (the Hessian like m^-3), elsewhere exponentially.
    """
    points, a = np.asarray(xy, dtype=float), width
    x, y = points[:, 0] + a / 2, points[:, 1] + height / 2
    k = np.arange(1, 2 * modes, 2) * np.pi / a
    load = 4 / (a * k**5)  # of the beam's deflection p(x) = sum load sin(k x)
    rows, right = [], []
    for place, support in zip((0.0, height), supports, strict=True):
        value, first, second, third = (f[:, :, 0] for f in _strips(k, np.array([place]), height))
        moment, shear = second - nu * k[:, None] ** 2 * value, third - (2 - nu) * k[:, None] ** 2 * first
        chosen = {CLAMPED: (value, first), SIMPLY_SUPPORTED: (value, moment), FREE: (moment, shear)}[support]
        known = {CLAMPED: (load, 0 * k), SIMPLY_SUPPORTED: (load, -nu * k**2 * load), FREE: (-nu * k**2 * load, 0 * k)}
        rows += chosen
        right += known[support]
    system, known = np.stack(rows, axis=1), -np.stack(right, axis=1)  # (modes, 4, 4), (modes, 4)
    scale = np.abs(system).max(axis=2, keepdims=True)
    weights = np.linalg.solve(system / scale, known[:, :, None] / scale)
    value, first, second, _ = ((weights * f).sum(axis=1) for f in _strips(k, y, height))
    sine, cosine, k = np.sin(np.outer(k, x)), np.cos(np.outer(k, x)), k[:, None]
    p = [x**4 - 2 * a * x**3 + a**3 * x, 4 * x**3 - 6 * a * x**2 + a**3, 12 * x**2 - 12 * a * x]
    w, slope, bend = (c / 24 for c in p)
    w = w + (value * sine).sum(axis=0)
    gradient = np.stack([slope + (k * value * cosine).sum(axis=0), (first * sine).sum(axis=0)], axis=1)
    mixed = (k * first * cosine).sum(axis=0)
    hessian = [bend - (k**2 * value * sine).sum(axis=0), mixed, mixed, (second * sine).sum(axis=0)]
    return w, gradient, np.stack(hessian, axis=1).reshape(-1, 2, 2)


def _strips(k, y, height):
    """e^(-k y), k y e^(-k y) and the same from the other side, with three derivatives by y: 4 of (modes, 4, n)."""
    k, found = k[:, None], []
    for order in range(4):
        parts = []
        for sign, s in ((-1, y), (1, height - y)):
            decay = np.exp(-k * s) * (sign * k) ** order
            parts += [decay, (k * s - order) * decay]
        found.append(np.stack(parts, axis=1))
    return found
