"""What actuators do to a plate on one mesh: the shapes of unit strokes, and the plate under pressure between them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse import diags

from fem_plate.elements import PlateFunctions, PlateModel, SourceBasis
from fem_plate.inputs import check_held
from fem_plate.types import FloatArray, IntArray
from fem_plate.vibration import HeldPlate

CHUNK = 4096  # unknowns combined at a time
RANK = 1e-9  # of rigid motions: smaller deflections are none


def held_shapes(
    model: PlateModel,
    x: FloatArray,
    stiffness: FloatArray,
    stiffness_unit: float,
    chosen: IntArray | None = None,
    may_move: bool = False,
) -> tuple[PlateFunctions, FloatArray]:
    """The shapes of actuators at x (N, 2), of all or of the chosen rows, and the plate's compliance G (N, N).

    The held actuators' forces P and the rigid motions c obey, dimensionless and with strokes h,

        (G + diag(1 / stiffness)) P + R c = h,   R^T P = 0 over all actuators,

    where the force of a floating actuator is given: one newton.

    stiffness: (N,) N/m, of the actuators, inf rigid, 0 floating.  stiffness_unit: N/m, of dimensionless stiffness.
    may_move: whether supports and actuators may leave the plate rigid motions; the shapes then have any share of them.
    Raises ValueError when they do and may not.
    """
    held = stiffness > 0
    basis, responses, felt, motions, matrix = _held_system(model, x, stiffness, stiffness_unit, may_move)
    to_forces, to_basis = basis.matrix, basis.matrix.T.tocsr()
    columns = np.arange(len(x)) if chosen is None else chosen
    drives = np.eye(len(x))[:, columns] * np.where(held[columns], 1.0, 1 / stiffness_unit)
    strokes = (to_basis[:, held] @ drives[held])[held] - felt[np.ix_(held, ~held)] @ drives[~held]
    given = np.concatenate([strokes, -motions[~held].T @ drives[~held]])
    solution = np.linalg.lstsq(matrix, given)[0] if may_move else np.linalg.solve(matrix, given)
    coefficients = drives.copy()
    coefficients[held] = solution[: held.sum()]
    forces = np.asarray(to_forces @ coefficients)
    rigid = model.rigid @ solution[held.sum() :]
    if chosen is None:
        for start in range(0, len(responses), CHUNK):  # in place: there is not always room for two
            responses[start : start + CHUNK] = responses[start : start + CHUNK] @ coefficients
    else:
        responses = responses @ coefficients
    no_pressure = np.zeros(forces.shape[1])
    return PlateFunctions(model.space, responses, x, forces, rigid, no_pressure, model.infinite), basis.green(felt)


def held_under_pressure(
    model: PlateModel, x: FloatArray, stiffness: FloatArray, stiffness_unit: float
) -> PlateFunctions:
    """The plate under a unit pressure with its actuators at x (N, 2) held at 0: one function, dimensionless.

    With the deflection d and the resultant s under the pressure alone, forces P and rigid motions c obey

        (G + diag(1 / stiffness)) P + R c + d = 0,   R^T P + s = 0.

    stiffness, stiffness_unit: as of `held_shapes`.
    """
    held = stiffness > 0
    basis, responses, _, motions, matrix = _held_system(model, x, stiffness, stiffness_unit)
    nothing, alone = np.zeros((len(x), 1)), np.ones(1)
    unmoved = PlateFunctions(model.space, model.under_pressure(), x, nothing, np.zeros((3, 1)), alone, model.infinite)
    points, weights = model.space.quadrature
    deflected = (basis.matrix.T.tocsr() @ unmoved.values(x))[held]
    solution = np.linalg.solve(matrix, -np.concatenate([deflected, (weights @ model.motions(points))[:, None]]))
    coefficients = nothing.copy()
    coefficients[held] = solution[: held.sum()]
    rigid = model.rigid @ solution[held.sum() :]
    forces = np.asarray(basis.matrix @ coefficients)
    return replace(unmoved, unknowns=unmoved.unknowns + responses @ coefficients, forces=forces, rigid=rigid)


def _held_system(
    model: PlateModel, x: FloatArray, stiffness: FloatArray, stiffness_unit: float, may_move: bool = False
) -> tuple[SourceBasis, FloatArray, FloatArray, FloatArray, FloatArray]:
    """What the forces of held actuators follow from: their basis, the responses to it, G and R in it, the matrix."""
    held = stiffness > 0
    basis = model.basis(x, held)
    to_forces, to_basis = basis.matrix, basis.matrix.T.tocsr()  # P from coefficients; and what they feel from heights
    responses = model.under_forces(x, basis)
    felt = basis.point_values(model.infinite) + np.asarray((to_basis @ model.space.point_values(x)) @ responses)
    felt = (felt + felt.T) / 2
    motions = np.asarray(to_basis @ model.motions(x))
    r = motions.shape[1]
    if not may_move:
        check_held("influence", model.motions(x), held)
    springs = (to_basis[:, held] @ diags(stiffness_unit / stiffness[held]) @ to_forces[held])[held][:, held]
    yielding = felt[np.ix_(held, held)] + springs.toarray()
    matrix = np.block([[yielding, motions[held]], [motions[held].T, np.zeros((r, r))]])
    return basis, responses, felt, motions, matrix


def unheld_shapes(
    model: PlateModel, x: FloatArray, stiffness: FloatArray, stiffness_unit: float
) -> tuple[PlateFunctions, FloatArray]:
    """The same on a plate that supports and actuators may leave rigid motions u: shapes phi with (phi, u) = 0.

    A plate with mass does not pick up what nothing pushes: where no force acts along u, (w, u)'' = 0. Modes have no
    share of u either. So w = sum h_i phi_i + sum eta_n psi_n holds from rest, and in a steady state.
    Raises ValueError when u are left and an actuator pushes with a force, which would accelerate the plate for ever.
    """
    held = stiffness > 0
    motions = model.motions(x[held])
    r = motions.shape[1]
    if not r or np.linalg.matrix_rank(motions, tol=RANK) == r:
        return held_shapes(model, x, stiffness, stiffness_unit)
    if not held.all():
        check_held("influence", model.motions(x), held)
    functions, green = held_shapes(model, x, stiffness, stiffness_unit, may_move=True)
    free = np.linalg.svd(motions)[2][np.linalg.matrix_rank(motions, tol=RANK) :].T  # (r, f), 0 at all actuators
    plate = HeldPlate(model, x * model.mesh.size, stiffness_unit / stiffness)
    rigid = model.rigid @ free
    moved = model.space.linear() @ rigid
    shares = np.linalg.solve(moved.T @ plate.with_mass(moved), moved.T @ plate.inertia_of(functions))
    return replace(functions, rigid=functions.rigid - rigid @ shares), green
