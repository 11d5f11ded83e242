"""What tension a plate can carry."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from scipy.sparse import diags
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
    bending, stretching = model.pinned_stiffness, model.space.stretching()
    # The largest 1/mu: Lanczos finds that first, and the stretching may be far from singular or not.
    (largest,) = eigsh(
        stretching,
        1,
        M=bending,
        Minv=LinearOperator(bending.shape, matvec=model.solve, dtype=float),
        which="LA",
        v0=np.ones(model.unknowns),  # eigsh would start from a random vector, and differ from run to run
        return_eigenvectors=False,
    )
    return float(1 / largest) / model.mesh.size**2


def check_stability(model: PlateModel) -> None:
    """ValueError if a plate without actuators has a deflection of negative energy: a pivot of its stiffness is."""
    matrix = model.pinned_stiffness
    scale = 1 / np.sqrt(np.abs(matrix.diagonal()))
    scaled = (diags(scale) @ matrix @ diags(scale)).tocsc()
    factor = splu(scaled, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    if (factor.U.diagonal() <= 0).any():
        raise ValueError("Input foundation and forms of Plate must leave it stable without actuators; it buckles")
