"""Polynomials in powers of time: sums, derivatives, and parts of an interval."""

from __future__ import annotations

import numpy as np

from particle.jit import device, device_no_arrays
from particle.types import FloatArray


@device
def derivative(c: FloatArray, unit: float) -> FloatArray:
    """The derivative in time of a polynomial of s = t / unit."""
    out = np.zeros(len(c) - 1)
    for k in range(len(out)):
        out[k] = (k + 1) * c[k + 1] / unit
    return out


@device
def second_derivative(c: FloatArray, unit: float) -> FloatArray:
    """The second derivative in time of a polynomial of s = t / unit."""
    out = np.zeros(len(c) - 2)
    for k in range(len(out)):
        out[k] = (k + 2) * (k + 1) * c[k + 2] / (unit * unit)
    return out


@device
def total(a: FloatArray, b: FloatArray) -> FloatArray:
    """The sum of two polynomials."""
    out = np.zeros(max(len(a), len(b)))
    out[: len(a)] += a
    out[: len(b)] += b
    return out


@device_no_arrays
def narrow(c: FloatArray, low: float, width: float) -> None:
    """A polynomial of s on [low, low + width] as one of r on [0, 1], in place."""
    n = len(c) - 1
    for k in range(n):
        for j in range(n - 1, k - 1, -1):
            c[j] += low * c[j + 1]
    factor = 1.0
    for k in range(n + 1):
        c[k] *= factor
        factor *= width
