"""Factors of stiffness matrices."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix, diags
from scipy.sparse.linalg import splu

FloatArray = NDArray[np.float64]


def factorised(matrix: csc_matrix) -> Callable[[FloatArray], FloatArray]:
    """Solves with a symmetric positive definite matrix (n, n) for loads (n, ...)."""
    # Scaled, because unknowns of small and large cells differ by many powers of ten. Symmetric ordering without
    # pivoting: the matrix is positive definite, and rounding stays at 1e-11.
    scale = 1 / np.sqrt(matrix.diagonal())
    scaled = (diags(scale) @ matrix @ diags(scale)).tocsc()
    factor = splu(scaled, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})

    def solve(load: FloatArray) -> FloatArray:
        scales = scale if load.ndim == 1 else scale[:, None]
        return np.asarray(scales * factor.solve(scales * load))

    return solve
