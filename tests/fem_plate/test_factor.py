"""Factors of matrices that are made on one thread and dropped on another."""

import gc
import threading

import numpy as np
import pytest
from scipy.sparse import csc_matrix, diags

from fem_plate.elements import factor
from fem_plate.elements.factor import factorised

MATRIX = csc_matrix(diags([2.0, 3.0, 4.0]))


class Factor:
    """A factor that knows on which thread it came and went."""

    def __init__(self, seen):
        self._seen = seen
        seen.append(threading.current_thread().name)

    def __del__(self):
        self._seen.append(threading.current_thread().name)


@pytest.fixture
def seen(monkeypatch):
    """The threads on which factors came and went, in this order."""
    threads = []
    monkeypatch.setattr(factor, "splu", lambda matrix, **_: Factor(threads))
    return threads


def test_another_thread_than_the_first_has_its_factors_made_and_dropped_on_one_that_stays(seen):
    found = []
    worker = threading.Thread(target=lambda: found.append(factorised(MATRIX)))
    worker.start()
    worker.join()
    assert len(seen) == 1
    found.clear()
    gc.collect()
    factor._thread().submit(int).result()  # after what was asked of it before
    assert len(seen) == 2 and seen[0] == seen[1] and seen[0].startswith("factors")


def test_the_first_thread_makes_and_drops_its_own(seen):
    solve = factorised(MATRIX)
    del solve
    gc.collect()
    assert seen == ["MainThread", "MainThread"]


def test_they_solve_alike():
    found = []
    worker = threading.Thread(target=lambda: found.append(factorised(MATRIX)))
    worker.start()
    worker.join()
    load = np.array([1.0, 2.0, 3.0])
    np.testing.assert_array_equal(found[0](load), factorised(MATRIX)(load))
    np.testing.assert_allclose(found[0](load), load / [2.0, 3.0, 4.0], rtol=1e-15)
