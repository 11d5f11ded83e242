"""What tension a plate can carry."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from scipy.sparse import csc_matrix, diags
from scipy.sparse.linalg import LinearOperator, eigsh, splu

from fem_plate.elements import FREE, PlateModel


def check_tension(tension: float, supports: Mapping[str, str]) -> None:
    """ValueError unless a uniform tension [N/m] is in balance at every boundary; a free rim pulls on nothing."""
    if not math.isfinite(tension):
        raise ValueError(f"Input tension of Plate must be finite; got {tension!r}")
    free = [name for name, support in supports.items() if support == FREE]
    if tension and free:
        names = ", ".join(map(repr, free))
        raise ValueError(
            "Input tension of Plate must be 0 where a boundary is free, as a free rim carries none; "
            f"got {tension!r} N/m, and free {names}"
        )


def buckling_compression(model: PlateModel) -> float:
    """The smallest compression at which a plate without actuators buckles, over its rigidity [1/m^2].

    It is the lowest mu of int M(v):H(q) = mu int grad v.grad q.

    model: of the plate without a tension, which its supports hold.
    """
    return 1 / _largest(model, model.space.stretching()) / model.mesh.size**2


def softest_foundation(model: PlateModel) -> float:
    """The negative modulus of an even foundation at which a plate buckles, its size over the rigidity [1/m^4]."""
    return 1 / _largest(model, model.space.mass()) / model.mesh.size**4


def _largest(model: PlateModel, matrix: csc_matrix) -> float:
    """The largest eigenvalue of a symmetric matrix over a plate's stiffness."""
    # Lanczos finds that first, and the matrix may be far from singular or not.
    (largest,) = eigsh(
        matrix,
        1,
        M=model.pinned_stiffness,
        Minv=LinearOperator(matrix.shape, matvec=model.solve, dtype=float),
        which="LA",
        v0=np.ones(model.unknowns),  # eigsh would start from a random vector, and differ from run to run
        return_eigenvectors=False,
    )
    return float(largest)


def is_stable(model: PlateModel) -> bool:
    """Whether no deflection of a plate without actuators has a negative energy: all pivots are positive."""
    matrix = model.pinned_stiffness
    scale = 1 / np.sqrt(np.abs(matrix.diagonal()))
    scaled = (diags(scale) @ matrix @ diags(scale)).tocsc()
    factor = splu(scaled, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return bool((factor.U.diagonal() > 0).all())
