"""The arrays that cells are kept in."""

import weakref

import numpy as np
import pytest

from particle.surface.cells import CellFit, CellPool

CENTRE, HALF, NONE = np.zeros(2), np.ones(2), np.zeros(0, dtype=np.int64)


@pytest.fixture
def pool():
    return CellPool(np.zeros(2), np.full(2, 2.0), np.array([[-2]]))


def fit(rows, shared=False):
    return CellFit(0, np.arange(len(rows)), np.ones(len(rows)), NONE, rows, 0.0, shared)


def test_rows_that_are_shared_are_kept_once(pool):
    rows = np.arange(3.0)[:, None]
    for _ in range(3):
        pool.add(CENTRE, HALF, fit(rows, shared=True))
        pool.add(CENTRE, HALF, fit(rows + 3))
    assert pool.cells().cell["first_row"].tolist() == [0, 3, 0, 6, 0, 9]
    assert pool.cells().rows.tolist() == [0, 1, 2] + [3, 4, 5] * 3


def test_rows_of_one_cell_are_not_kept_beside_the_pool(pool):
    rows = np.ones((100, 1))
    then = weakref.ref(rows)
    pool.add(CENTRE, HALF, fit(rows))
    del rows
    assert then() is None and len(pool.cells().rows) == 100
