"""Factors of matrices that are made on one thread and dropped on another."""

import gc
import os
import signal
import subprocess
import sys
import threading
from concurrent.futures.thread import _global_shutdown_lock

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


def after():
    """Wait until the thread that stays has done what was asked of it before."""
    done = threading.Event()
    factor._queue().put(done.set)
    assert done.wait(60)


def made_elsewhere():
    found = []
    worker = threading.Thread(target=lambda: found.append(factorised(MATRIX)))
    worker.start()
    worker.join()
    return found


@pytest.mark.parametrize("make", [made_elsewhere, lambda: [factorised(MATRIX)]])
def test_factors_are_made_and_dropped_on_a_thread_that_stays(seen, make):
    found = make()
    assert len(seen) == 1
    found.clear()
    gc.collect()
    after()
    assert len(seen) == 2 and seen[0] == seen[1] and seen[0].startswith("factors")


def test_one_is_dropped_while_a_pool_of_threads_is_locked(seen):
    """As the garbage collector may drop it while work is handed to a pool."""
    found = made_elsewhere()

    def drop():
        with _global_shutdown_lock:
            found.clear()
            gc.collect()

    worker = threading.Thread(target=drop, daemon=True)
    worker.start()
    worker.join(60)
    assert not worker.is_alive()
    after()
    assert len(seen) == 2


def test_what_cannot_be_factorised_is_an_error_there_too(monkeypatch):
    def broken(matrix, **_):
        raise RuntimeError("Factor is exactly singular")

    monkeypatch.setattr(factor, "splu", broken)
    said = []

    def work():
        with pytest.raises(RuntimeError, match="exactly singular"):
            factorised(MATRIX)
        said.append(True)

    worker = threading.Thread(target=work)
    worker.start()
    worker.join()
    assert said == [True]


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
def test_a_forked_process_has_such_a_thread_of_its_own():
    made_elsewhere()
    child = os.fork()
    if child == 0:
        signal.alarm(60)
        code = 1
        try:
            code = 0 if made_elsewhere() else 1
        finally:
            os._exit(code)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def test_they_solve_alike():
    found = made_elsewhere()
    load = np.array([1.0, 2.0, 3.0])
    np.testing.assert_array_equal(found[0](load), factorised(MATRIX)(load))
    np.testing.assert_allclose(found[0](load), load / [2.0, 3.0, 4.0], rtol=1e-15)


def test_the_program_forks_and_ends_without_a_word_while_factors_of_another_thread_are_there(tmp_path):
    code = """
import threading
import numpy as np
from scipy.sparse import csc_matrix, diags
from fem_plate.elements.factor import factorised
kept = []
worker = threading.Thread(target=lambda: kept.append(factorised(csc_matrix(diags(np.arange(1.0, 300.0))))))
worker.start()
worker.join()
print(kept[0](np.ones(299))[1])
from common import survives
survives(__file__)
"""
    path = tmp_path / "program.py"
    path.write_text(code)
    done = subprocess.run([sys.executable, path], capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "0.5\n", "")
