"""Factors of sparse symmetric matrices, such as stiffness matrices."""

from __future__ import annotations

import atexit
import os
import threading
import weakref
from collections.abc import Callable
from concurrent.futures import Future
from functools import partial
from queue import SimpleQueue
from typing import Any

import numpy as np
from scipy.sparse import csc_matrix, diags
from scipy.sparse.linalg import splu

from fem_plate.types import FloatArray


def factorised(matrix: csc_matrix) -> Callable[[FloatArray], FloatArray]:
    """Solves with a symmetric matrix (n, n) for loads (n, ...).

    The matrix is positive definite, or quasi-definite: definite in two blocks. Such matrices need no pivoting
    (Vanderbei, 1995), rounding stays at 1e-11, and symmetric ordering keeps the factor sparse.
    """
    # Scaled, because unknowns of small and large cells differ by many powers of ten.
    scale = 1 / np.sqrt(np.abs(matrix.diagonal()))
    scaled = (diags(scale) @ matrix @ diags(scale)).tocsc()
    factor = partial(splu, scaled, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    kept = _kept(factor)

    def solve(load: FloatArray) -> FloatArray:
        scales = scale if load.ndim == 1 else scale[:, None]
        return np.asarray(scales * kept[0].solve(scales * load))

    weakref.finalize(solve, _drop, kept).atexit = False
    return solve


def _kept(factor: Callable[[], Any]) -> list[Any]:
    """A factor that is made, and by `_drop` dropped, on a thread that stays.

    scipy counts the memory of factors by threads, and leaks what another thread drops than the one that made it.
    """
    made: Future[Any] = Future()
    _queue().put(partial(_make, factor, made))
    return [made.result()]


def _drop(kept: list[Any]) -> None:
    # The garbage collector calls this at any moment, in the midst of what holds a lock: this takes none.
    if _work is not None:
        _work.put(kept.clear)


def _make(factor: Callable[[], Any], made: Future[Any]) -> None:
    try:
        made.set_result(factor())
    except BaseException as error:
        made.set_exception(error)


Work = SimpleQueue[Callable[[], None] | None]
_work: Work | None = None
_beginning = threading.Lock()


def _queue() -> Work:
    """The work of that thread, which begins with the first."""
    global _work
    with _beginning:
        if _work is None:
            _work = _begun()
        return _work


def _begun() -> Work:
    queue: Work = SimpleQueue()

    def work() -> None:
        for task in iter(queue.get, None):
            task()
            del task  # with what it holds

    def end() -> None:
        queue.put(None)
        thread.join()

    thread = threading.Thread(target=work, name="factors", daemon=True)
    thread.start()
    # scipy raises an error in whoever ends a thread with factors other than itself, such as the interpreter.
    atexit.register(end)
    return queue


def _forget() -> None:
    """A forked process has the queue, and not the thread."""
    global _work, _beginning
    _work, _beginning = None, threading.Lock()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget)
