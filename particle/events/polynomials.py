"""Polynomials on [0, 1]: in powers of time, and in Bernstein form, between whose coefficients they lie."""

from __future__ import annotations

import math

import numpy as np

from particle.jit import device, device_no_arrays, inlined
from particle.types import FloatArray

MAX_HALVINGS = 44  # halvings: a root is located to 2^-44 of the interval


@device_no_arrays
def to_bernstein(c: FloatArray, out: FloatArray) -> None:
    """Bernstein coefficients (n+1,) of a polynomial c_0 + c_1 s + ...: b_i = sum_k C(i, k) / C(n, k) c_k."""
    n = len(out) - 1
    for i in range(n + 1):
        out[i] = 0.0
    total = 1.0  # C(n, k)
    for k in range(len(c)):
        choose = 1.0  # C(i, k)
        for i in range(k, n + 1):
            out[i] += choose / total * c[k]
            choose *= (i + 1) / (i + 1 - k)
        total *= (n - k) / (k + 1)


@device_no_arrays
def quintic_to_bernstein(c: FloatArray, b: FloatArray) -> None:
    """The same of a quintic (6,), without divisions."""
    third, tenth = c[3] * 0.1, c[2] * 0.1
    fifth, fourth = c[1] * 0.2, c[4] * 0.2
    b[0] = c[0]
    b[1] = c[0] + fifth
    b[2] = c[0] + 2 * fifth + tenth
    b[3] = c[0] + 3 * fifth + 3 * tenth + third
    b[4] = c[0] + 4 * fifth + 6 * tenth + 4 * third + fourth
    b[5] = c[0] + c[1] + c[2] + c[3] + c[4] + c[5]


@device_no_arrays
def divide(right: FloatArray, left: FloatArray, share: float) -> None:
    """de Casteljau at a share: `right` holds the whole polynomial before and its right part after."""
    n, rest = len(right) - 1, 1.0 - share
    for k in range(n + 1):
        left[k] = right[0]
        for i in range(n - k):
            right[i] = rest * right[i] + share * right[i + 1]


@inlined
def first_negative(b: FloatArray) -> float:
    """The first place in [0, 1] where a polynomial of Bernstein coefficients b becomes negative; inf: nowhere."""
    n = len(b)
    pieces, low, width = np.zeros((MAX_HALVINGS + 2, n)), np.zeros(MAX_HALVINGS + 2), np.zeros(MAX_HALVINGS + 2)
    pieces[0], width[0] = b, 1.0
    top = 0
    while top >= 0:
        if pieces[top].min() >= 0.0:
            top -= 1
        elif width[top] <= 0.5**MAX_HALVINGS or pieces[top, 0] < 0.0:
            if pieces[top, n - 1] < 0.0 or pieces[top, 0] < 0.0:
                return float(low[top])
            top -= 1
        else:
            half = 0.5 * width[top]
            low[top + 1] = low[top]
            low[top] += half
            width[top] = width[top + 1] = half
            divide(pieces[top], pieces[top + 1], 0.5)
            top += 1
    return math.inf


@inlined
def quintic_value(b: FloatArray, s: float) -> float:
    """A quintic of Bernstein coefficients b at s."""
    r = 1.0 - s
    outer = b[0] * r**5 + 5 * b[1] * r**4 * s + 5 * b[4] * r * s**4 + b[5] * s**5
    return float(outer + 10 * r * r * s * s * (b[2] * r + b[3] * s))


@inlined
def quintic_between(start: tuple[float, float, float], end: tuple[float, float, float], h: float) -> FloatArray:
    """Bernstein coefficients (6,) of the quintic over h [s] with these values and derivatives at its ends."""
    return np.array(
        [
            start[0],
            start[0] + h * start[1] / 5,
            start[0] + 2 * h * start[1] / 5 + h * h * start[2] / 20,
            end[0] - 2 * h * end[1] / 5 + h * h * end[2] / 20,
            end[0] - h * end[1] / 5,
            end[0],
        ]
    )


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
    for k in range(len(a)):
        out[k] += a[k]
    for k in range(len(b)):
        out[k] += b[k]
    return out


@device_no_arrays
def narrow(c: FloatArray, low: float, width: float) -> None:
    """A polynomial of s on [low, low + width] as one of r on [0, 1], in place."""
    n = len(c) - 1
    while n > 0 and c[n] == 0.0:
        n -= 1
    for k in range(n):
        for j in range(n - 1, k - 1, -1):
            c[j] += low * c[j + 1]
    factor = 1.0
    for k in range(n + 1):
        c[k] *= factor
        factor *= width
