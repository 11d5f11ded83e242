"""Kernels get groups of arrays and numbers by their address, and read what Python reads."""

import sys
from typing import NamedTuple

import numpy as np
import pytest

from particle.group import grouped
from particle.jit import device_no_arrays, jit, jit_no_arrays


class Plain(NamedTuple):
    weights: np.ndarray
    factor: float


@grouped
class Inner(NamedTuple):
    values: np.ndarray
    first: int
    plain: Plain


@grouped
class Outer(NamedTuple):
    inner: Inner
    swaps: bool
    pair: tuple[float, int]
    grid: np.ndarray


@device_no_arrays
def _weighted(inner: Inner, k: int) -> float:
    return inner.values[k] * inner.plain.weights[k] * inner.plain.factor


@jit_no_arrays
def first(inner: Inner) -> float:
    return inner.values[inner.first]


@jit
def total(outer: Outer, count: int) -> float:
    inner, found = outer.inner, 0.0
    for k in range(inner.first, count):
        found += -_weighted(inner, k) if outer.swaps else _weighted(inner, k)
        outer.grid[k % 2, 0] += found
    return found * outer.pair[0] + outer.pair[1] + outer.grid.sum()


def group(swaps=False, step=1):
    values = np.arange(40.0)[::step]
    plain = Plain(np.linspace(1, 2, 40)[::step], 0.5)
    return Outer(Inner(values, 2, plain), swaps, (3.0, 7), np.ones((2, 4))[:, ::step])


@pytest.mark.parametrize("step", [1, 2])
@pytest.mark.parametrize("swaps", [False, True])
def test_a_kernel_reads_and_writes_what_python_does(swaps, step):
    ours, theirs = group(swaps, step), group(swaps, step)
    function = getattr(total, "py_func", total)
    for _ in range(3):
        assert total(ours, 15) == pytest.approx(function(theirs, 15), rel=1e-14)
        assert ours.grid == pytest.approx(theirs.grid, rel=1e-14)
        ours.inner.values[3] = theirs.inner.values[3] = 11.0  # seen by the next call


def test_a_short_kernel_reads_the_group_of_each_call():
    plain = group().inner.plain
    found = [first(Inner(np.array([0.0, 0.0, k]), 2, plain)) for k in range(9)]
    assert found == list(range(9))


def test_a_call_keeps_no_array():
    outer = group()
    arrays = (outer.inner.values, outer.inner.plain.weights, outer.grid)
    total(outer, 15)
    before = [sys.getrefcount(array) for array in arrays]
    for _ in range(50):
        total(outer, 15)
    assert [sys.getrefcount(array) for array in arrays] == before


def test_groups_of_other_types_have_kernels_of_their_own():
    wide = group()
    single = wide._replace(grid=wide.grid.astype(np.float32))
    assert total(single, 15) == pytest.approx(total(wide, 15), rel=1e-6)
