"""Lanes are worked on as numbers are, each for itself."""

import numpy as np
import pytest
from numpy.polynomial.polynomial import polyder, polyval2d

from particle.jit import jit_no_arrays, spliced
from particle.lanes import LANES, at_least, load, log, nought, store, where_zero
from particle.surface.jet import jet

DEGREE = 4
COUNT = (DEGREE + 1) * (DEGREE + 2) // 2


@spliced
def _many(x, y, c):
    """One expression of all that lanes can do."""
    f = jet(c, COUNT, DEGREE, x, y, 2.0, 0.5)
    total = nought(x)
    total += f.f + 2 * f.xy - f.yyy / y
    return -total * x + log(at_least(x * x, 0.25)) + where_zero(x - y, 3.0 + 0.0 * x) - 1 / y


@jit_no_arrays
def _by_lanes(x, y, c, out):
    for first in range(0, len(x), LANES):
        store(out, first, _many(load(x, first), load(y, first), c))


@jit_no_arrays
def _one_by_one(x, y, c, out):
    for k in range(len(x)):
        out[k] = _many(x[k], y[k], c)


def test_lanes_are_numbers():
    random = np.random.default_rng(3)
    x, y = random.uniform(-2, 2, (2, 3 * LANES))
    y[1] = x[1]
    c = random.normal(size=(3, COUNT))
    lanes, numbers = np.empty_like(x), np.empty_like(x)
    _by_lanes(x, y, c, lanes)
    _one_by_one(x, y, c, numbers)
    assert lanes == pytest.approx(numbers, rel=1e-13)
    matrix = np.zeros((DEGREE + 1, DEGREE + 1))
    rows, columns = zip(*((i, j) for i in range(DEGREE + 1) for j in range(DEGREE + 1 - i)), strict=True)
    matrix[rows, columns] = c[0]
    mixed, third = polyder(polyder(matrix, axis=0), axis=1), polyder(matrix, 3, axis=1)
    total = polyval2d(x, y, matrix) + 2 * polyval2d(x, y, mixed) / (2.0 * 0.5) - polyval2d(x, y, third) / 0.5**3 / y
    wanted = -total * x + np.log(np.maximum(x * x, 0.25)) + np.where(x == y, 3.0, 0.0) - 1 / y
    assert lanes == pytest.approx(wanted, rel=1e-10)
