"""Small vibrations of a plate about a deflected state."""

from __future__ import annotations

import numpy as np
from scipy.sparse.linalg import LinearOperator, eigsh

from fem_plate.elements import PlateFunctions
from fem_plate.large_deflection.solution import BorderedSolver, Coefficients, DiscretePlate, Trial
from fem_plate.types import FloatArray

CHUNK = 20_000  # quadrature points evaluated at a time, to bound memory


def modes_about(
    discrete: DiscretePlate, state: Coefficients, compliance: FloatArray, count: int
) -> tuple[FloatArray, PlateFunctions]:
    """The lowest dimensionless squared frequencies (count,), ascending, and the modes.

    compliance: (J,) of the actuators: 0 rigid, inf one that pushes with the same force all the time.
    Raises ValueError when the state is not stable.
    """
    equilibrium = discrete.equilibrium
    trial, n = equilibrium.trial, discrete.model.unknowns
    held = np.isfinite(compliance)
    solver = BorderedSolver(trial, *equilibrium.tangent(state), held, compliance)
    mass, cross, own = discrete.model.space.mass(), *_masses(trial)
    still = np.zeros(int(held.sum()))

    def with_mass(x: FloatArray) -> FloatArray:
        v, extra = x[:n], x[n:]
        return np.concatenate([mass @ v + cross @ extra, cross.T @ v + own @ extra])

    def solve(load: FloatArray) -> FloatArray:
        return np.concatenate(solver.solve(load[:n], load[n:], still)[:2])

    shape = (n + trial.count,) * 2
    operator = LinearOperator(shape, matvec=with_mass, dtype=float)
    squares, vectors = eigsh(
        operator,  # only its shape is used: with sigma = 0 all that is solved with is OPinv
        count,
        M=operator,
        sigma=0,
        OPinv=LinearOperator(shape, matvec=solve, dtype=float),
        v0=solve(with_mass(np.ones(shape[0]))),  # meets the constraints; eigsh would start from a random vector
    )
    order = np.argsort(squares)
    squares, vectors = squares[order], vectors[:, order]
    if squares[0] <= 0:
        raise ValueError("Input deflected of modes must be a stable state; it is not: it has a growing motion")
    functions = trial.functions(vectors[:n], vectors[n:])
    scale = 1 / np.abs(functions.values(functions.space.points)).max(axis=0)
    return squares, functions.weighted(np.diag(scale))


def _masses(trial: Trial) -> tuple[FloatArray, FloatArray]:
    """The integrals of the extra functions with finite elements (unknowns, e) and with each other (e, e)."""
    space, count = trial.model.space, trial.count
    (points, weights), triangles = space.quadrature, space.quadrature_triangles
    cross, own = np.zeros((space.unknowns, count)), np.zeros((count, count))
    for start in range(0, len(points), CHUNK):
        part = slice(start, start + CHUNK)
        value = trial.extra.values(points[part])[:, :-1]
        weighted = weights[part, None] * value
        cross += space.point_values(points[part], triangles[part]).T @ weighted
        own += value.T @ weighted
    return cross, own
