"""Kernels: the drives between two of their breakpoints, what they do to each form of the reduced plate, and its sums.

Time is s, from -1 at the first breakpoint to 1 at the second. As each drive is a quintic d(s), the part of a form that
the drives alone make is a polynomial of degree ten, and what multiplies a correction is a quintic: their cost at a
moment does not depend on the number of drives. Nearly all time goes into one loop, `add_rows`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fem_plate.large_deflection import Forms
from particle import grouped, kernel, kernel_device_no_arrays, kernel_inlined
from particle.drives import ORDER, DriveTable, drive_piece

FloatArray = NDArray[np.float64]

grouped(Forms)  # here, as fem_plate knows no kernels

DEGREES = 2 * ORDER - 1  # coefficients of a quintic's square


class Interval(NamedTuple):
    """Polynomials in s between two breakpoints."""

    drives: FloatArray  # (N, 6), d
    own: FloatArray  # (S, 11), 1/2 d'C_dd d of each form C
    mixed: FloatArray  # (6, S * n), C_cd d


class Moment(NamedTuple):
    """The same at one s, with the first and second derivatives."""

    powers: FloatArray  # (3, 11), of s
    own: FloatArray  # (3, S)
    mixed: FloatArray  # (3, S, n)
    mixed_flat: FloatArray  # (3, S * n), the same array


@kernel_inlined
def new_interval(forms: Forms) -> Interval:
    """Room for the polynomials."""
    s, count, n = forms.mixed.shape
    return Interval(np.zeros((count, ORDER)), np.zeros((s, DEGREES)), np.zeros((ORDER, s * n)))


@kernel
def new_moment(forms: Forms) -> Moment:
    """Room for their values."""
    s, _, n = forms.mixed.shape
    mixed = np.zeros((3, s, n))
    return Moment(np.zeros((3, DEGREES)), np.zeros((3, s)), mixed, mixed.reshape(3, s * n))


@kernel_inlined
def enter_interval(forms: Forms, table: DriveTable, begin: float, end: float, interval: Interval) -> None:
    """Find the polynomials between two breakpoints [s]."""
    enter_drives(table, begin, end, interval)
    interval.own[:] = 0.0
    interval.mixed[:] = 0.0
    product, count, n = np.zeros(ORDER), len(interval.drives), len(forms.load)
    for r in range(len(interval.own)):
        for i in range(count):
            clear(product)
            add_rows(product, 0, ORDER, interval.drives, forms.drives[r, i], count)
            for k in range(ORDER):
                share = interval.drives[i, k]
                if share != 0.0:
                    for m in range(ORDER):
                        interval.own[r, k + m] += 0.5 * share * product[m]
                    for j in range(n):
                        interval.mixed[k, r * n + j] += share * forms.mixed[r, i, j]


@kernel_device_no_arrays
def enter_drives(table: DriveTable, begin: float, end: float, interval: Interval) -> None:
    """Find those of the drives alone."""
    half = 0.5 * (end - begin)
    middle = begin + half
    for i in range(len(interval.drives)):  # the piece in the middle, where rounding at the ends cannot mistake it
        drive_piece(table, i, middle, half, interval.drives[i])


@kernel_inlined
def enter_moment(interval: Interval, s: float, moment: Moment) -> None:
    """Evaluate the polynomials at s."""
    powers, own, mixed = moment.powers, moment.own, moment.mixed_flat
    powers[0, 0] = 1.0
    for k in range(1, DEGREES):
        powers[0, k] = s * powers[0, k - 1]
        powers[1, k] = k * powers[0, k - 1]
        powers[2, k] = k * powers[1, k - 1]
    for r in range(own.shape[1]):
        value = rate = acceleration = 0.0
        for k in range(DEGREES):
            value += powers[0, k] * interval.own[r, k]
            rate += powers[1, k] * interval.own[r, k]
            acceleration += powers[2, k] * interval.own[r, k]
        own[0, r], own[1, r], own[2, r] = value, rate, acceleration
    for order in range(3):
        clear(mixed[order])
        add_rows(mixed[order], 0, mixed.shape[1], interval.mixed, powers[order], ORDER)


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
