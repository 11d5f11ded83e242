"""What load a plate can carry without buckling, and which plates are not what they seem."""

from __future__ import annotations

import warnings

import numpy as np
from scipy.sparse import csc_matrix, diags
from scipy.sparse.linalg import LinearOperator, eigsh, splu

from fem_plate.elements import MeshGrading, PlateModel, grade_mesh, rounded_corners
from fem_plate.graded import GradedPlate, check_tension


def buckling_load(plate: GradedPlate) -> float:
    """The compression at which a plate buckles without actuators and tension [N/m]; raises as `Plate.buckling_load`.

    It is the rigidity times the lowest mu of int M(v):H(q) = mu int grad v.grad q.
    """
    check_tension(1.0, plate.supports)
    if plate.energy is not None and plate.energy.may_soften:
        check_stability(plate, 0.0)
    model = plate.model_on(grade_mesh(plate.mesh, MeshGrading.of(plate.mesh), plate.graded_corners), 0.0)
    return 1 / _largest(model, model.space.stretching()) / model.mesh.size**2 * plate.section.rigidity


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
        v0=np.random.default_rng(0).standard_normal(model.unknowns),  # as for modes
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


def check_stability(plate: GradedPlate, tension: float) -> None:
    """ValueError if a plate buckles without actuators, under another tension [N/m]."""
    if is_stable(plate.model_on(plate.cells(), tension)):
        return
    if callable(plate.foundation) or plate.forms:
        raise ValueError("Input foundation and forms of Plate must leave it stable without actuators; it buckles")
    alone = GradedPlate(plate.mesh, plate.section, plate.supports, tension=tension).model()
    critical = 0.0 if alone.rigid.size else -softest_foundation(alone) * plate.section.rigidity
    raise ValueError(
        f"Input foundation of Plate must exceed {critical:.6g} N/m^3, at which it buckles without actuators; "
        f"got {plate.foundation!r}"
    )


def warn_of_polygon(plate: GradedPlate) -> None:
    """Warn, in the caller's caller, of a simply supported rim of many straight sides."""
    if many := rounded_corners(plate.mesh, plate.supports):
        nu = plate.section.poisson_ratio
        warnings.warn(
            f"The simply supported rim of Plate has {many} corners of 15 degrees or less, as a round one's polygon."
            f" With more of them its deflection under a pressure tends to {1 - 3 * (1 + nu) / (5 + nu):.0%} less "
            "than the round plate's (Babuska's paradox). If the rim is round, give its true curve: meshes.disc, "
            "meshes.ellipse, or a mesh file of second order",
            stacklevel=3,
        )


def warn_of_wedges(where: str, count: int) -> None:
    """Warn, in the caller's caller, of obtuse corners whose functions a plate leaves out there."""
    if count:
        estimate = "leaves that out too" if where == "on patches" else "says by how much"
        warnings.warn(
            f"Plate has {count} simply supported corners over 90 degrees. A plate {where} leaves out "
            "what is singular there: it is less accurate, the more the wider the corners are; its error estimate "
            f"{estimate}",
            stacklevel=3,
        )
