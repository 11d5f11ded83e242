"""Natural frequencies and modes, also of a plate that actuators hold at points, rigidly or through springs.

At a held point a mode bends as under a point force, which polynomials follow badly. So trial functions are
w = v + sum_j c_j psi_j with psi_j the static answer to a unit force at held point j. A spring's force on it is
c_j = -k_j w(x_j), which makes c = -(G + 1/k)^-1 v(x_j), with 1/k = 0 where the hold is rigid. In the energy, with that
of the springs, where a(v, psi_j) = v(x_j) and a(psi_i, psi_j) = G_ij, this leaves the stiffness K - B^T (G + 1/k)^-1 B
(B takes v at the held points): K with a few rows of correction, as is its inverse.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse.linalg import LinearOperator, eigsh

from fem_plate.elements import Field, Fields, PlateModel, point_value
from fem_plate.influence import check_on_plate

FloatArray = NDArray[np.float64]

TOGETHER = 20_000  # quadrature points taken at once, to bound memory
RIGID_SHIFT = 1e12  # the dimensionless squared frequency that rigid motions are moved out to


@dataclass(frozen=True, eq=False)
class Modes:
    """Modes of vibration, each with a largest deflection of 1 over the mesh.

    Parameters
    ----------
    frequencies : array (count,)
        Natural frequencies, Hz, ascending, repeated ones repeated.
    """

    frequencies: FloatArray
    model: PlateModel
    field: Field

    def evaluate(self, xy: ArrayLike) -> Fields:
        """The modes at points.

        Parameters
        ----------
        xy : array (n, 2)
            Points, m.

        Returns
        -------
        value : array (n, count)
            Mode shapes.
        gradient : array (n, count, 2)
            Their gradients, 1/m.
        hessian : array (n, count, 2, 2)
            Their Hessians, 1/m^2.

        Raises
        ------
        ValueError
            A point lies beyond the rim.
        """
        xy, size = np.asarray(xy, dtype=float), self.model.mesh.size
        check_on_plate(self.model.mesh.outline, xy, size)
        value, gradient, hessian = self.field.evaluate(xy / size)
        return value, gradient / size, hessian / size**2


def modes(model: PlateModel, held: FloatArray, give: FloatArray, count: int, unit: float) -> Modes:
    """The lowest modes of a plate held at points (N, 2) [m].

    give: (N,) dimensionless, of the springs there under a unit force; 0 where it is held rigidly.
    unit: 1/s^2, the squared angular frequency that makes eigenvalues dimensionless.
    """
    space, x = model.space, held / model.mesh.size
    mass = space.mass()
    answers = model.under_forces(x) if len(x) else np.zeros((model.unknowns, 0))
    take = space.point_values(x)  # B
    green = point_value(x, x) + take @ answers
    yielding = (green + green.T) / 2 + np.diag(give)
    to_forces = -np.linalg.solve(yielding, take.toarray())  # v -> c, (N, unknowns)
    cross, inner = _masses(model, x, answers, mass)

    def with_mass(v: FloatArray) -> FloatArray:
        c = to_forces @ v
        return np.asarray(mass @ v + cross @ c + to_forces.T @ (cross.T @ v + inner @ c))

    # K's inverse knows the springs and not the held points; rows of correction with their weights turn it into the
    # inverse of the stiffness wanted, in which rigid motions are moved out of the way. The springs bear a unit force:
    # that is what psi_j weighs on each motion.
    sprung = model.mean.T + model.motions(x).T @ to_forces
    rigid = space.linear() @ model.rigid
    if rigid.size:
        free = np.linalg.svd(take @ rigid)[2] if len(x) else np.eye(rigid.shape[1])
        keep = np.linalg.matrix_rank(take @ rigid, tol=1e-9) if len(x) else 0
        rigid = rigid @ free[keep:].T
    moved = with_mass(rigid)
    if rigid.size:
        moved = moved @ np.linalg.inv(np.linalg.cholesky(rigid.T @ moved)).T
    rows = np.concatenate([take.toarray(), sprung, moved.T])
    shares = np.concatenate([np.ones(len(sprung)), np.full(moved.shape[1], -1 / RIGID_SHIFT)])
    inverse_weights = np.zeros((len(rows), len(rows)))
    inverse_weights[: len(x), : len(x)] = yielding
    inverse_weights[len(x) :, len(x) :] = np.diag(shares)
    solved = model.solve(np.ascontiguousarray(rows.T))
    correction = np.linalg.inv(inverse_weights - rows @ solved)

    def solve(load: FloatArray) -> FloatArray:
        plain = model.solve(load)
        return np.asarray(plain + solved @ (correction @ (rows @ plain)))

    shape = mass.shape
    squares, vectors = eigsh(
        LinearOperator(shape, matvec=with_mass, dtype=float),
        count,
        M=LinearOperator(shape, matvec=with_mass, dtype=float),
        sigma=0,
        OPinv=LinearOperator(shape, matvec=solve, dtype=float),
        v0=np.ones(len(mass.indptr) - 1),  # a start of its own would make results differ from run to run
    )
    order = np.argsort(squares)
    squares, vectors = squares[order], vectors[:, order]
    forces = to_forces @ vectors
    field = Field(space, vectors + answers @ forces, x, forces, np.zeros((3, count)), np.zeros(count))
    scale = 1 / np.abs(field.values(space.points)).max(axis=0)
    return Modes(np.sqrt(squares * unit) / (2 * np.pi), model, field.weighted(np.diag(scale)))


def _masses(model: PlateModel, x: FloatArray, answers: FloatArray, mass) -> tuple[FloatArray, FloatArray]:  # type: ignore[no-untyped-def]
    """int q psi_j (unknowns, N) and int psi_i psi_j (N, N) for psi = F + answers, F by quadrature."""
    space = model.space
    points, weights = space.quadrature
    with_singular, of_singular = np.zeros((space.unknowns, len(x))), np.zeros((len(x), len(x)))
    for start in range(0, len(points), TOGETHER):
        part = slice(start, start + TOGETHER)
        value = point_value(points[part], x)
        weighted = weights[part, None] * value
        with_singular += space.point_values(points[part]).T @ weighted  # int q F
        of_singular += value.T @ weighted
    cross = mass @ answers + with_singular
    inner = answers.T @ (mass @ answers) + answers.T @ with_singular + with_singular.T @ answers
    return cross, inner + of_singular
