"""Nitsche's rim (Nitsche, 1971) is consistent: biharmonic polynomials up to degree five come back to rounding.

By Goursat's formula all of them are real parts of z^n and conj(z) z^n.
"""

import numpy as np
import pytest
from scipy.sparse.linalg import splu

from fem_plate.space import PlateSpace
from meshes import disc

CASES = [(n, k) for k in (0, 1) for n in range(6 - k)]


class Goursat:
    """Re or Im of conj(z)^k z^n with its derivatives."""

    def __init__(self, n, k, imaginary):
        self.n, self.k, self.part = n, k, np.imag if imaginary else np.real

    def __call__(self, xy):
        z = xy[:, 0] + 1j * xy[:, 1]
        n, k = self.n, self.k
        conj = np.conj(z) ** k
        powers = [c * z ** max(n - i, 0) for i, c in enumerate((1, n, n * (n - 1)))]
        by_z, by_c = conj * powers[1], k * powers[0]
        zz, zc = conj * powers[2], k * powers[1]
        value, gradient = conj * powers[0], np.stack([by_z + by_c, 1j * (by_z - by_c)], axis=-1)
        hessian = np.stack([zz + 2 * zc, 1j * zz, 1j * zz, -zz + 2 * zc], axis=-1).reshape(-1, 2, 2)
        return self.part(value), self.part(gradient), self.part(hessian)


@pytest.fixture(scope="module", params=[0.0, 0.3, 0.45], ids=lambda nu: f"nu={nu}")
def solver(request):
    space = PlateSpace(disc(1.0, 1 / 4))
    matrix = space.stiffness(request.param)
    factor = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return space, factor, space.rim_operator(request.param)


@pytest.mark.parametrize("imaginary", [False, True], ids=["Re", "Im"])
@pytest.mark.parametrize("n, k", CASES)
def test_a_biharmonic_polynomial_comes_back_from_its_rim_data(solver, spots, radius, n, k, imaginary):
    space, factor, operator = solver
    polynomial, inside = Goursat(n, k, imaginary), spots[:300] / radius
    f, f_x, _ = polynomial(space.rim_points)
    found = space.evaluate(inside, factor.solve(operator @ np.concatenate([f, *f_x.T]))[:, None])
    for got, truth, bound in zip(found, polynomial(inside), (5e-11, 1e-9, 5e-8), strict=True):
        assert np.abs(got[:, 0] - truth).max() < bound


def test_the_stiffness_is_symmetric_and_positive_definite():
    matrix = PlateSpace(disc(1.0, 1 / 2)).stiffness(0.3).toarray()
    assert np.abs(matrix - matrix.T).max() < 1e-15 * np.abs(matrix).max()
    scale = 1 / np.sqrt(np.diag(matrix))
    assert np.linalg.eigvalsh(matrix * scale * scale[:, None])[0] > 0


def test_rim_points_lie_on_the_true_circle():
    points = PlateSpace(disc(0.5, 0.1)).rim_points
    assert np.abs(np.hypot(*points.T) - 1).max() < 4e-16
