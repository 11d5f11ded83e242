"""Simply supported regular polygons of rigidity 1, by harmonic expansions; corners at distance 1 from the centre.

With straight sides w = 0 and M_n = 0 are w = 0 and laplace w = 0: two problems of Laplace, one after the other. Both
are solved by least squares on half a side over Re z^(N m) and, around all corners, r^(k alpha) cos(k alpha theta) with
alpha = pi / omega. By the maximum principle no error of laplace w, and then of w, exceeds the residual there. A mode of
the plate is one of a membrane with the same rim, its frequency the membrane's eigenvalue k^2: the method of particular
solutions (Betcke & Trefethen, SIAM Review 2005), with Bessel's functions in place of powers.
"""

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.special import jv

PLAIN, SINGULAR = 60, 7  # how many functions of each kind
RANK = 1e-11  # of the largest singular value: less is rounding


def corners(sides):
    return np.exp(2j * np.pi * np.arange(sides) / sides)


def exponents(sides, count=SINGULAR):
    """k alpha for odd k, those of functions that are the same on both sides of the bisector, but for whole ones."""
    found = sides / (sides - 2) * np.arange(1, 2 * count, 2)
    return found[np.abs(found - np.round(found)) > 1e-9]


def around(sides, z):
    """z (n,) from each corner, the real axis pointing to the centre: (N, n)."""
    place = corners(sides)[:, None]
    return (place - z) / place


def half_side(sides):
    """Points from a corner to the middle of a side, closest at the corner."""
    start, end = corners(sides)[:2]
    t = np.concatenate([np.exp(-np.linspace(0, 25, 400)), 1 - np.exp(-np.linspace(0.01, 8, 150))])
    return start + (end - start) * t / 2


def harmonic(sides, z):
    """All functions and what the Laplacian takes to them, each (n, k)."""
    powers = sides * np.arange(PLAIN)
    plain = np.real(z[:, None] ** powers)
    columns, lifted = [plain], [np.abs(z[:, None]) ** 2 * plain / (4 * (powers + 1))]
    zeta = around(sides, z)
    for p in exponents(sides):
        each = np.abs(zeta) ** p * np.cos(p * np.angle(zeta))
        columns.append(each.sum(axis=0)[:, None])
        lifted.append((np.abs(zeta) ** 2 * each).sum(axis=0)[:, None] / (4 * (p + 1)))
    return np.concatenate(columns, axis=1), np.concatenate(lifted, axis=1)


class Polygon:
    """w under a uniform pressure of 1 or a central force of 1. residual: of laplace w and of w on the rim."""

    def __init__(self, sides, load):
        self.sides, self.load = sides, load
        z = half_side(sides)
        functions, lifted = harmonic(sides, z)
        w, laplacian = self._known(z)
        scale = np.abs(functions).max(axis=0)
        self.bent, self.flat = np.zeros((2, len(scale)))
        self.bent = self._fit(functions, scale, -laplacian)
        self.flat = self._fit(functions, scale, -w - lifted @ self.bent)
        self.residual = np.abs(functions @ self.bent + laplacian).max() + np.abs(self.at(z)).max()

    def _fit(self, functions, scale, values):
        return np.linalg.lstsq(functions / scale, values, rcond=1e-14)[0] / scale

    def _known(self, z):
        r = np.where(np.abs(z) > 0, np.abs(z), 1e-300)
        if self.load == "pressure":
            return r**4 / 64, r**2 / 4
        return r**2 * np.log(r) / (8 * np.pi), (np.log(r) + 1) / (2 * np.pi)

    def at(self, z):
        functions, lifted = harmonic(self.sides, z)
        return self._known(z)[0] + lifted @ self.bent + functions @ self.flat


def first_frequency(sides):
    """The lowest k^2: omega with rigidity and mass per area 1."""
    if sides in (3, 4):
        return {3: 16 * np.pi**2 / 9, 4: np.pi**2}[sides]  # sides of sqrt(3), sqrt(2)
    inside = np.sqrt(np.random.default_rng(1).uniform(0, 0.9, 150)) * np.cos(np.pi / sides)
    inside = inside * np.exp(2j * np.pi * np.random.default_rng(2).uniform(0, 1, 150))
    rim = half_side(sides)
    z = np.concatenate([rim, inside])
    zeta, powers = around(sides, z), sides * np.arange(max(4, 60 // sides + 3))

    def mismatch(k):
        plain = jv(powers, k * np.abs(z[:, None])) * np.cos(powers * np.angle(z[:, None]))
        columns = [jv(p, k * np.abs(zeta)) * np.cos(p * np.angle(zeta)) for p in exponents(sides)]
        table = np.column_stack([plain, *(column.sum(axis=0) for column in columns)])
        orthonormal, size, _ = np.linalg.svd(table / np.abs(table).max(axis=0), full_matrices=False)
        orthonormal = orthonormal[:, size > RANK * size[0]]
        return np.linalg.svd(orthonormal[: len(rim)], compute_uv=False)[-1] ** 2

    area = sides / 2 * np.sin(2 * np.pi / sides)
    low = 2.404825557695773 * np.sqrt(np.pi / area)  # of the disc of that area, the lowest of all (Faber and Krahn)
    grid = np.linspace(low, 1.05 * low, 40)
    best = int(np.argmin([mismatch(k) for k in grid]))
    k = minimize_scalar(mismatch, bounds=(grid[max(best - 1, 0)], grid[best + 1]), method="bounded").x
    for step in (1e-4, 1e-5, 1e-5):
        before, here, after = (mismatch(k + shift) for shift in (-step, 0.0, step))
        k += step / 2 * (before - after) / (before - 2 * here + after)
    return k**2
