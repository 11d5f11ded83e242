"""Surfaces and drives of `motion_oracle` in closed form: Boggio's plate, polynomials, quintic strokes, sines."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from motion_problem import Height, Point, Surface


def still(time: float) -> tuple[float, float, float]:
    return 0.0, 0.0, 0.0


def rise(s: float) -> tuple[float, float, float]:
    """10 s^3 - 15 s^4 + 6 s^5 and its derivatives, held before 0 and after 1."""
    s = min(max(s, 0.0), 1.0)
    return s**3 * (10 - 15 * s + 6 * s * s), 30 * s * s * (1 - s) ** 2, 60 * s * (1 - s) * (1 - 2 * s)


def up_down(stroke: float, frequency: float, delay: float = 0.0, cycles: float = math.inf) -> Height:
    """Up in half a period, down in the other half."""
    rate = 2 * frequency

    def height(time: float) -> tuple[float, float, float]:
        halves = (time - delay) * rate
        if not 0 < halves < 2 * cycles:
            return still(time)
        whole = math.floor(halves)
        h, h_t, h_tt = rise(halves - whole)
        sign = 1 if whole % 2 == 0 else -1
        return stroke * (h if sign > 0 else 1 - h), sign * stroke * rate * h_t, sign * stroke * rate**2 * h_tt

    return height


def up(stroke: float, frequency: float, delay: float = 0.0) -> Height:
    """Up once in a whole period, then held."""

    def height(time: float) -> tuple[float, float, float]:
        h, h_t, h_tt = rise((time - delay) * frequency)
        return stroke * h, stroke * frequency * h_t, stroke * frequency**2 * h_tt

    return height


def boggio(points: Sequence[Sequence[float]], radius: float, heights: Sequence[Height]) -> Surface:
    """A clamped disc: 16 pi G = R ln(R/S) + S - R around each source, weighted so that w = h_i at each of them."""
    sources = np.array(points, float) / radius

    def terms(x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        value, gradient, hessian = np.zeros(len(sources)), np.zeros((2, len(sources))), np.zeros((2, 2, len(sources)))
        for k, y in enumerate(sources):
            a, c, yy = x - y, (y @ y) * x - y, y @ y  # half the gradients of R and S
            big_r, big_s = max(a @ a, 1e-40), (x @ x) * yy - 2 * x @ y + 1
            by_r, by_s = math.log(big_r / big_s), 1 - big_r / big_s
            value[k] = big_r * by_r + big_s - big_r
            gradient[:, k] = 2 * by_r * a + 2 * by_s * c
            cross = np.outer(a, c)
            bent = np.outer(a, a) / big_r - (cross + cross.T) / big_s + np.outer(c, c) * big_r / big_s**2
            hessian[..., k] = 4 * bent + (2 * by_r + 2 * yy * by_s) * np.eye(2)
        return value, gradient, hessian

    weights = np.linalg.inv(np.array([terms(y)[0] for y in sources]))

    def surface(x: float, y: float, time: float) -> Point:
        value, gradient, hessian = terms(np.array([x, y]) / radius)
        h, h_t, h_tt = (weights @ row for row in np.array([height(time) for height in heights]).T)
        return Point(
            value @ h,
            value @ h_t,
            value @ h_tt,
            gradient @ h / radius,
            gradient @ h_t / radius,
            hessian @ h / radius**2,
        )

    return surface


def polynomial(coefficients, base: Sequence[Height] = (still, still)) -> Surface:
    """w = sum c[i, j, k] x^i y^j t^k (or c[i, j]), on a base that moves."""
    c = np.atleast_3d(np.asarray(coefficients, float))

    def powers(x: float, count: int) -> list[np.ndarray]:
        """The monomials, their first and their second derivatives."""
        n = np.arange(count)
        return [x**n, n * x ** np.maximum(n - 1, 0), n * (n - 1) * x ** np.maximum(n - 2, 0)]

    def surface(x: float, y: float, time: float) -> Point:
        p, q, r = (powers(value, count) for value, count in zip((x, y, time), c.shape, strict=True))

        def of(i: int, j: int, k: int) -> float:
            return float(p[i] @ (c @ r[k]) @ q[j])

        return Point(
            of(0, 0, 0),
            of(0, 0, 1),
            of(0, 0, 2),
            np.array([of(1, 0, 0), of(0, 1, 0)]),
            np.array([of(1, 0, 1), of(0, 1, 1)]),
            np.array([[of(2, 0, 0), of(1, 1, 0)], [of(1, 1, 0), of(0, 2, 0)]]),
            np.array([height(time)[2] for height in base]),
        )

    return surface
