"""Lanes are worked on as numbers are, each for itself."""

import numpy as np
import pytest
from numpy.polynomial.polynomial import polyder, polyval2d

from particle.jit import jit_no_arrays, spliced
from particle.lanes import LANES, at_least, load, log, nought, store, where_zero
from particle.surface.jet import Jet, jet, point_jet

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


@jit_no_arrays
def _jets(c, degree, count, u, v, by_lanes, by_numbers):
    for k in range(len(u)):
        one, other = point_jet(c, count, degree, u[k], v[k], 2.0, 0.5), jet(c, count, degree, u[k], v[k], 2.0, 0.5)
        for i in range(len(one)):
            by_lanes[k, i], by_numbers[k, i] = one[i], other[i]


@pytest.mark.parametrize("degree", [0, 1, 2, 3, 4, 7, 8, 11])
def test_at_one_place_lanes_are_powers(degree):
    """Whatever stands behind the coefficients, such as those of logarithms."""
    random, count = np.random.default_rng(5), (degree + 1) * (degree + 2) // 2
    c = np.full((3, count + LANES), np.nan)
    c[:, :count] = random.normal(size=(3, count))
    u, v = random.uniform(-1.2, 1.2, (2, 5))
    by_lanes, by_numbers = np.empty((2, 5, len(Jet._fields)))
    _jets(c, degree, count, u, v, by_lanes, by_numbers)
    np.testing.assert_allclose(by_lanes, by_numbers, rtol=0, atol=1e-13 * np.abs(by_numbers).max())
