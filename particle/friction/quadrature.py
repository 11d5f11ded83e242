"""Integrals of powers over a Gaussian height distribution, to rounding, for many separations at once; least values."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

import numpy as np
from scipy.special import eval_jacobi, roots_jacobi

from particle.types import FloatArray

POINTS = 40
REACH = 12.0  # widths beyond which a Gaussian adds nothing, also to what is left at pull-off: exp(-12^2/2) = 5e-32
PANEL = 1.5  # widths that one Gauss rule covers


@cache
def _jacobi(power: float) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights for the weight (1 + t)^power on [-1, 1]; with the power 0 Gauss-Legendre's."""
    nodes = roots_jacobi(POINTS, 0.0, power)[0]
    # One over the sum of the squared orthonormal polynomials: the library's weights are off by up to 1e-12.
    order = np.arange(POINTS)[:, None]
    squares = eval_jacobi(order, 0.0, power, nodes) ** 2 * (2 * order + power + 1)
    return nodes, 2 ** (power + 1) / squares.sum(axis=0)


def gaussian(z: FloatArray, width: float) -> FloatArray:
    return np.asarray(np.exp(-0.5 * (z / width) ** 2) / (math.sqrt(2 * math.pi) * width))


def from_power(d: FloatArray, power: float, low: float, high: float, unit: float, width: float) -> FloatArray:
    """The integral of x^power phi(d + unit x) dx for x from `low` to `high`, for each separation d (n,).

    unit and width are in the same lengths as d. The end x = 0 is integrated with the power as weight (Gauss-Jacobi).
    """
    total = np.zeros(len(d))
    tail = max(float(REACH * width - d.min()) / unit, low)
    high = min(high, tail)
    panel = PANEL * width / unit
    while low < high:
        # From zero on, panels also grow with x, so that the power stays polynomial-like on each.
        end = min(high, low + panel, low + max(low, 1.0))
        span = end - low
        if low == 0:
            nodes, weights = _jacobi(power)
            x, w = span * (nodes + 1) / 2, weights * (span / 2) ** (power + 1)
        else:
            nodes, weights = _jacobi(0.0)
            x = low + span * (nodes + 1) / 2
            w = weights * span / 2 * x**power
        total += gaussian(d[:, None] + unit * x, width) @ w
        low = end
    return total


def on_panels(d: FloatArray, eps: float, width: float) -> FloatArray:
    """The integral of [(eps/x)^2 - 0.25 (eps/x)^8] phi(d - (x - eps)) dx for gaps x from eps to infinity, (n,)."""
    nodes, weights = _jacobi(0.0)
    total = np.zeros(len(d))
    low, high = eps, eps + REACH * width + float(d.max())
    while low < high:
        end = min(high, 2 * low, low + PANEL * width)
        x = low + (end - low) * (nodes + 1) / 2
        ratio = eps / x
        kernel = weights * (end - low) / 2 * (ratio**2 - 0.25 * ratio**8)
        total += gaussian(d[:, None] - (x - eps), width) @ kernel
        low = end
    return total


def lowest(f: Callable[[FloatArray], FloatArray], low: float, high: float) -> float:
    """Where a smooth f is least between two places.

    Found where the derivative of its polynomial vanishes: the values themselves are flat to rounding over 1e-8 there.
    """
    polynomial = np.polynomial.Chebyshev.interpolate(f, 12, domain=[low, high])
    roots = polynomial.deriv().roots()
    level = roots.real[(np.abs(roots.imag) < 1e-6) & (roots.real > low) & (roots.real < high)]
    places = np.concatenate([[low, high], level])
    return float(places[np.argmin(polynomial(places))])
