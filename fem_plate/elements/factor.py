"""Factors of sparse symmetric matrices, such as stiffness matrices."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix, diags
from scipy.sparse.linalg import splu

FloatArray = NDArray[np.float64]


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

    if threading.current_thread() is not threading.main_thread():
        weakref.finalize(solve, _drop, kept).atexit = False
    return solve


def _kept(factor: Callable[[], Any]) -> list[Any]:
    """A factor that is made, and by `_drop` dropped, on a thread that stays.

    scipy counts the memory of factors by threads, and leaks what another thread drops than the one that made it.
    """
    if threading.current_thread() is threading.main_thread():
        return [factor()]
    return [_thread().submit(factor).result()]


def _drop(kept: list[Any]) -> None:
    _thread().submit(kept.clear)


@cache
def _thread() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(1, "factors")
