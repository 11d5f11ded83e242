"""Discs of varying thickness by Chebyshev's collocation in ln r, and on foundations by Kelvin functions.

The slope phi = w' of a disc of radius 1 under a pressure q and a central force P, up, obeys

    D (phi'' + phi'/r - phi/r^2) + D' (phi' + nu phi/r) = q r/2 + P/(2 pi r).
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BarycentricInterpolator
from scipy.special import bei, beip, ber, berp, kei, keip

FloatArray = NDArray[np.float64]

DEPTH = 20.0  # of ln r: what is inside e^-20 counts for nothing
COUNT = 200


def _chebyshev(count: int) -> tuple[FloatArray, FloatArray]:
    """The differentiation matrix and its points, from 1 down to -1 (Trefethen, Spectral Methods in MATLAB, 2000)."""
    x = np.cos(np.pi * np.arange(count + 1) / count)
    c = np.concatenate([[2.0], np.ones(count - 1), [2.0]]) * (-1.0) ** np.arange(count + 1)
    apart = x[:, None] - x
    matrix = np.outer(c, 1 / c) / (apart + np.eye(count + 1))
    return matrix - np.diag(matrix.sum(axis=1)), x


def tapered_disc(
    rigidity: Callable[[FloatArray], FloatArray],
    growth: Callable[[FloatArray], FloatArray],
    pressure: float,
    force: float,
    support: str,
    nu: float,
) -> Callable[[FloatArray], FloatArray]:
    """The deflection w(r), from D(r) and r D'(r)."""
    matrix, x = _chebyshev(COUNT)
    s, along = (x - 1) * DEPTH / 2, matrix * 2 / DEPTH  # s = ln r
    r, one = np.exp(s), np.eye(COUNT + 1)
    left = np.diag(rigidity(r)) @ (along @ along - one) + np.diag(growth(r)) @ (along + nu * one)
    right = r**2 * (pressure * r / 2 + force / (2 * np.pi * r))
    left[-1], right[-1] = one[-1], 0.0
    left[0], right[0] = one[0] if support == "clamped" else along[0] + nu * one[0], 0.0
    rise, height = np.linalg.solve(left, right) * r, along.copy()
    height[0], rise[0] = one[0], 0.0
    deflection = BarycentricInterpolator(s, np.linalg.solve(height, rise))
    return lambda radius: np.asarray(deflection(np.log(radius)))


def disc_on_foundation(modulus: float, radius: FloatArray) -> FloatArray:
    """The deflection of a clamped disc of radius and rigidity 1 on a foundation, under a unit force in its centre, up.

    w = -l^2 kei(r/l) / (2 pi) + a ber(r/l) + b bei(r/l), with l^4 = 1 / modulus.
    """
    length = modulus**-0.25
    z = 1 / length
    rows = np.array([[ber(z), bei(z)], [berp(z), beip(z)]])
    a, b = np.linalg.solve(rows, length**2 / (2 * np.pi) * np.array([kei(z), keip(z)]))
    z = radius / length
    return np.asarray(-(length**2) / (2 * np.pi) * kei(z) + a * ber(z) + b * bei(z))
