"""Kernels: sums of weighted rows, the one loop in which the reduced plate spends its time."""

from __future__ import annotations

from numpy import float64
from numpy.typing import NDArray

from particle import kernel_device_no_arrays

FloatArray = NDArray[float64]


@kernel_device_no_arrays
def add_rows(out: FloatArray, first: int, last: int, rows: FloatArray, weights: FloatArray, count: int) -> None:
    """Add the first `count` rows (k, m) times their weights to `out`, from entry `first` to before `last`.

    `out` must not be one of the rows. Four rows at a time keep the processor's vector units busy.
    """
    r, part = 0, out[first:last]
    while r + 3 < count:
        a, b, c, d = weights[r], weights[r + 1], weights[r + 2], weights[r + 3]
        one, two, three, four = rows[r], rows[r + 1], rows[r + 2], rows[r + 3]
        one, two, three, four = one[first:last], two[first:last], three[first:last], four[first:last]
        for j in range(len(part)):
            part[j] += (a * one[j] + b * two[j]) + (c * three[j] + d * four[j])
        r += 4
    while r < count:
        a, one = weights[r], rows[r]
        one = one[first:last]
        for j in range(len(part)):
            part[j] += a * one[j]
        r += 1


@kernel_device_no_arrays
def copy(values: FloatArray, out: FloatArray) -> None:
    """Copy as many values as `out` holds."""
    for j in range(len(out)):
        out[j] = values[j]


@kernel_device_no_arrays
def clear(out: FloatArray) -> None:
    """Set to 0."""
    for j in range(len(out)):
        out[j] = 0.0


@kernel_device_no_arrays
def dot(one: FloatArray, other: FloatArray) -> float:
    """The sum of products."""
    a = b = c = d = 0.0
    whole = len(one) // 4 * 4
    for j in range(0, whole, 4):  # four sums, as none waits for another
        a += one[j] * other[j]
        b += one[j + 1] * other[j + 1]
        c += one[j + 2] * other[j + 2]
        d += one[j + 3] * other[j + 3]
    for j in range(whole, len(one)):
        a += one[j] * other[j]
    return (a + b) + (c + d)
