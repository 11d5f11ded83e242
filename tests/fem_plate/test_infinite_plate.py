"""The infinite plate's closed forms under a tension: in 40 digits, as solutions, and near none."""

import mpmath
import numpy as np
import pytest

from fem_plate.elements.infinite import IsotropicPlate

TENSIONS = (1e-8, 0.5, 1.0, 10.0, 1e4, 1e6, -1e-6, -0.5, -14.0, -900.0)


def exact(tension, r):
    """F, (1/r d/dr) F, ... of order 0 to 3 in 60 digits, from Bessel functions."""
    with mpmath.workdps(60):
        k, r = mpmath.sqrt(abs(mpmath.mpf(tension))), mpmath.mpf(r)
        z, scale = k * r, -1 / (2 * mpmath.pi * mpmath.mpf(tension))
        small = max(k, 1) / k  # the constant's logarithm has a tension of 1 at least
        outer = mpmath.besselk if tension > 0 else mpmath.bessely
        inner = mpmath.besseli if tension > 0 else mpmath.besselj
        weight, turn = (1, 1) if tension > 0 else (-mpmath.pi / 2, -1)
        logarithms = mpmath.log(max(k, 1) / 2) + mpmath.euler + mpmath.log(r), 1 / r**2, -2 / r**4, 8 / r**6
        found = []
        for order, log in enumerate(logarithms):  # (1/z d/dz)^n z^0 K_0 = (-1)^n K_n / z^n; I_n, J_n and Y_n likewise
            bessel = weight * (-1) ** order * outer(order, z) / z**order
            regular = mpmath.log(small) * (turn**order * inner(order, z) / z**order - (order == 0))
            found.append(
                float(scale * (log + k ** (2 * order) * (bessel - regular) - (order == 0) * mpmath.log(small)))
            )
        return found


@pytest.mark.parametrize("tension", TENSIONS)
def test_the_response_to_a_force_is_exact_to_rounding(tension):
    for z in (1e-9, 1e-4, 1e-2, 0.5, 2.0, 2.8, 2.9, 8.0, 60.0, 100.0):
        r = z / np.sqrt(abs(tension))
        if r > 2.8:
            continue
        found = IsotropicPlate(tension)._force(np.array([r * r]), 4)
        for order, expected in enumerate(exact(tension, r)):
            # In compression the functions have zeros: what counts are the values around.
            scale = max(abs(expected), r ** (2 - 2 * order) * min(1.0, z ** (order - 2.5)) / 30)
            assert abs(found[order][0] - expected) < 1e-14 * scale


@pytest.mark.parametrize("tension", TENSIONS)
def test_all_functions_are_derivatives_of_one(tension):
    plate, step = IsotropicPlate(tension), 1e-3
    rng = np.random.default_rng(3)
    source, xy = np.array([0.1, -0.2]), rng.uniform(-1, 1, (20, 2)) * min(1.0, 30 / np.sqrt(abs(tension)))
    orders = plate.point_derivatives(source + xy[:, None], source)
    value, gradient, hessian = plate.point_load(source + xy, source[None])
    assert np.allclose(orders[0][0], value, rtol=1e-13) and np.allclose(
        plate.point_value(source + xy, source[None]), value
    )
    assert np.allclose(np.stack(orders[1])[:, :, 0].T, gradient[:, 0], rtol=1e-12)
    for row, (i, j) in zip(orders[2], ((0, 0), (0, 1), (1, 1)), strict=True):
        assert np.allclose(row[:, 0], hessian[:, 0, i, j], rtol=1e-12)
    laplacian = plate.point_laplacian(source + xy, source[None], 1e-9)[:, 0]
    assert np.allclose(laplacian, np.trace(hessian[:, 0], axis1=1, axis2=2), rtol=1e-10, atol=1e-14)
    step /= max(1.0, np.sqrt(abs(tension)))
    for axis in range(2):
        shift = step * np.eye(2)[axis]
        for order in range(3):
            up, down = (plate.point_derivatives(source + xy[:, None] + s * shift, source)[order] for s in (1, -1))
            slopes = (up - down) / (2 * step)
            for k, row in enumerate(slopes):
                expected = orders[order + 1][k + axis]
                assert np.allclose(row, expected, rtol=1e-3, atol=1e-4 * np.abs(expected).max())


@pytest.mark.parametrize("tension", [1e-8, 0.5, 0.99, 1.0, 10.0, 1e6, -0.5, -14.0])
def test_the_response_to_a_pressure_solves_the_equation(tension):
    """laplace^2 Q - tension laplace Q = 1, by differences of the exact third derivatives and the Hessian."""
    xy, step = np.random.default_rng(4).uniform(-1, 1, (20, 2)), 1e-4
    plate = IsotropicPlate(tension)
    _, _, (xx, _, yy), _ = plate.pressure_derivatives(xy)
    bilaplacian = 0.0
    for axis in range(2):
        thirds = [plate.pressure_derivatives(xy + s * step * np.eye(2)[axis])[3] for s in (1, -1)]
        slopes = (thirds[0] - thirds[1]) / (2 * step)
        bilaplacian = bilaplacian + slopes[axis] + slopes[axis + 2]  # of xxx + xyy, of xxy + yyy
    assert np.abs(bilaplacian - tension * (xx + yy) - 1).max() < 1e-7


def test_a_source_itself():
    value, gradient, hessian = IsotropicPlate(10.0).point_load(np.zeros((1, 2)), np.zeros((1, 2)))
    assert value == 0 and (gradient == 0).all()
    assert (np.diagonal(hessian[0, 0]) == -np.inf).all() and hessian[0, 0, 0, 1] == 0
    assert IsotropicPlate(10.0).point_value(np.zeros((1, 2)), np.zeros((1, 2))) == 0


def test_the_laplacian_stays_bounded_at_a_source():
    """Within the floor it continues as that of a parabola in r^2, with the slope it has there."""
    r = np.array([0.0, 0.0999999, 0.1, 0.1000001])
    found = IsotropicPlate(50.0).point_laplacian(np.stack([r, 0 * r], 1), np.zeros((1, 2)), 0.1)[:, 0]
    assert np.isfinite(found).all() and np.ptp(found[1:]) < 1e-6


def test_without_tension_it_is_the_plain_plate():
    xy, sources = np.random.default_rng(5).uniform(-1, 1, (10, 2)), np.array([[0.1, 0.2]])
    for none, weak in zip(
        IsotropicPlate().pressure_derivatives(xy), IsotropicPlate(1e-9).pressure_derivatives(xy), strict=True
    ):
        assert np.abs(none - weak).max() < 1e-9
    plain, weak = (plate.point_load(xy, sources) for plate in (IsotropicPlate(), IsotropicPlate(1e-9)))
    # They differ by a multiple of r^2, which carries no load where there is no tension.
    square = ((xy - sources) ** 2).sum(axis=1)
    assert np.ptp((weak[0] - plain[0])[:, 0] / square) < 1e-9
