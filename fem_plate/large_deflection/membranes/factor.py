"""Sparse factors of symmetric matrices whose unknowns differ by many powers of ten."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix, diags
from scipy.sparse.linalg import splu

FloatArray = NDArray[np.float64]


def factorised(matrix: csc_matrix) -> Callable[[FloatArray], FloatArray]:
    """The inverse of a symmetric matrix that is positive definite, or quasi-definite: definite in two blocks.

    Such matrices need no pivoting (Vanderbei, 1995); symmetric ordering keeps the factor sparse.
    """
    scale = 1 / np.sqrt(np.abs(matrix.diagonal()))
    scaled = (diags(scale) @ matrix @ diags(scale)).tocsc()
    factor = splu(scaled, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})

    def solve(load: FloatArray) -> FloatArray:
        scales = scale if load.ndim == 1 else scale[:, None]
        return np.asarray(scales * factor.solve(scales * load))

    return solve
