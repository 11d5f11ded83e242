"""Wedges: which corners they are, their functions by finite differences, and the energy of what elements leave."""

import numpy as np
import pytest

from fem_plate import Plate, PlateSection
from fem_plate.elements import forms
from fem_plate.elements.corner_functions import CornerFunction, CornerFunctions, singular_weights
from fem_plate.elements.enriched import EnrichedSpace
from fem_plate.elements.rim import unit_gauss
from fem_plate.elements.space import PlateSpace
from fem_plate.elements.wedges import wedges
from meshes import annulus, disc, polygon, rectangle, regular_polygon

C, S, F = "clamped", "simply-supported", "free"
UNIT = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0, density=1.0)
L_SHAPE = [(0, 0), (1, 0), (1, 1), (-1, 1), (-1, -1), (0, -1)]
# At the origin, sides along 0.3 and 0.3 + 2.2 rad.
HARMONIC = CornerFunction(0j, 0.3, 2.2, 1.1, np.pi / 2.2, False)
OTHER = CornerFunction(0j, 0.3, 2.2, 1.1, 1 + np.pi / 2.2, True)


def found(mesh, support=S, tension=0.0):
    return wedges(mesh, dict.fromkeys(mesh.boundaries, support), tension)


def test_wedges_are_obtuse_and_re_entrant_corners_of_simply_supported_sides():
    assert len(found(regular_polygon(30, 1.0, 0.3))) == 30  # turns of 12 degrees
    assert [wedge.angle for wedge in found(polygon(L_SHAPE, 0.5))] == pytest.approx([1.5 * np.pi])
    for mesh in (rectangle(2.0, 1.0, 0.5), regular_polygon(3, 1.0, 0.5), disc(1.0, 0.3), annulus(0.4, 1.0, 0.3)):
        assert found(mesh) == []
    for support in (C, F):
        assert found(regular_polygon(8, 1.0, 0.5), support) == []


def test_under_a_tension_re_entrant_corners_are_none():
    assert found(polygon(L_SHAPE, 0.5), S, 1.0) == []
    assert len(found(regular_polygon(5, 1.0, 0.5), S, 1.0)) == 5


def test_a_plate_without_wedges_has_argyris_functions_alone():
    assert type(Plate(rectangle(2.0, 1.0, 0.5), UNIT, S).model().space) is PlateSpace
    assert type(Plate(regular_polygon(6, 1.0, 0.5), UNIT, C).model().space) is PlateSpace


def test_no_cell_lies_at_two_wedges():
    mesh = Plate(regular_polygon(20, 1.0, 0.5), UNIT, S).model().mesh
    at_corner = np.abs(np.hypot(*mesh.points.T) - 1) < 1e-9
    assert at_corner.sum() == 20
    assert at_corner[mesh.triangles].sum(axis=1).max() == 1


@pytest.mark.parametrize("function", [HARMONIC, OTHER])
def test_derivatives_are_those_by_finite_differences(function):
    z = np.array([0.2 + 0.1j, -0.1 + 0.3j, 0.4 + 0.4j])
    step = 1e-5
    orders = function.derivatives(z, 4)
    for order in range(3):
        right, left = (function.derivatives(z + shift, 4)[order] for shift in (step, -step))
        above, below = (function.derivatives(z + 1j * shift, 4)[order] for shift in (step, -step))
        for k in range(order + 1):
            assert orders[order + 1][k] == pytest.approx((right[k] - left[k]) / (2 * step), rel=1e-6, abs=1e-6)
            assert orders[order + 1][k + 1] == pytest.approx((above[k] - below[k]) / (2 * step), rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("function", [HARMONIC, OTHER])
def test_sides_are_supported_and_nothing_is_loaded(function):
    for angle in (0.3, 2.5):
        z = np.array([0.1, 0.5]) * np.exp(1j * angle)
        (w,), _, (xx, xy, yy), _ = function.derivatives(z, 4)
        assert np.abs(w).max() < 1e-15
        n = np.array([-np.sin(angle), np.cos(angle)])
        across = n[0] ** 2 * (xx + 0.3 * yy) + 2 * 0.7 * n[0] * n[1] * xy + n[1] ** 2 * (yy + 0.3 * xx)
        assert np.abs(across).max() < 1e-13
    circle = 0.3 + 0.2j + 0.05 * np.exp(2j * np.pi * np.arange(64) / 64)  # the mean of laplace w is its middle's
    xx, _, yy = function.derivatives(circle, 3)[2]
    xx_middle, _, yy_middle = function.derivatives(np.array([0.3 + 0.2j]), 3)[2]
    assert (xx + yy).mean() == pytest.approx((xx_middle + yy_middle)[0], abs=1e-12)


@pytest.mark.parametrize("exponent", [0.3, -0.94, -1.67])
def test_singular_weights_integrate_a_power_times_a_polynomial(exponent):
    """Below -1 the finite part: s^(e + k + 1) / (e + k + 1) at 1."""
    s, weights = unit_gauss(8)
    for k in range(8):
        integral = weights @ (singular_weights(exponent) * s**exponent * s**k)
        assert integral == pytest.approx(1 / (exponent + k + 1), rel=1e-10)


@pytest.fixture(scope="module")
def octagon():
    return Plate(regular_polygon(8, 1.0, 0.4), UNIT, S).model()


def test_the_energy_of_what_elements_leave_is_the_difference_of_energies(octagon):
    """a(s, s) - a(X, X) by integrals over the rim alone, which rounding and eight points a side leave 1e-6 of."""
    space = octagon.space
    assert isinstance(space, EnrichedSpace)
    known, to_integrate = space.functions.at_rim(space.rim)
    of_known, of_tests = (forms.rim_traces(one, space.rim.normal, UNIT.law) for one in (known, to_integrate))
    _, coupling = forms.rim_forms(space.rim)
    flat = of_known.reshape(-1, len(space.functions))
    whole = np.einsum("ckne,kncd->edkn", of_tests, coupling).reshape(len(space.functions), -1) @ flat
    assert np.abs(whole - whole.T).max() < 1e-12 * np.abs(whole).max()
    load = space.load(UNIT.law) @ flat
    expected = whole - load.T @ space.solve(np.vstack([load, np.zeros_like(whole)]))[: space.plain]
    energies = space.stiffness(UNIT.law)[space.plain :, space.plain :].toarray()
    leading = [e for e, function in enumerate(space.functions.functions) if function.exponent < 2]
    pairs = np.ix_(leading, leading)
    assert len(leading) == 8
    assert np.abs(energies[pairs] - expected[pairs]).max() < 1e-5 * energies.max()
    assert np.linalg.eigvalsh(energies)[0] > 0


def test_functions_are_evaluated_alike_through_points_and_fields(octagon):
    space, xy = octagon.space, np.array([[0.3, 0.2], [-0.5, 0.7], [0.999, 1e-4]])
    u = np.random.default_rng(1).normal(size=space.unknowns)
    value, _, hessian = space.evaluate(xy, u[:, None], 3)
    assert space.point_values(xy) @ u == pytest.approx(value[:, 0], abs=1e-11)
    assert space.laplacians(xy, u[:, None])[:, 0] == pytest.approx(np.trace(hessian[:, 0], axis1=1, axis2=2), rel=1e-9)


def test_loads_cell_by_cell_are_those_on_values_at_points(octagon):
    space, rng = octagon.space, np.random.default_rng(2)
    for triangle, points, weights in space.cells(1000):  # triangles, and the slivers of a curved rim, here none
        loads = rng.normal(size=(*weights.shape, 2))
        summed = space.load_at(triangle, points, loads)
        values = space.point_values(points.reshape(-1, 2), np.repeat(triangle, weights.shape[1]))
        assert summed == pytest.approx(values.T @ loads.reshape(-1, 2), abs=1e-11)


def test_the_mass_of_corner_functions_is_that_of_their_values(octagon):
    space = octagon.space
    points, weights = space.quadrature
    values = space.point_values(points)[:, -3:].toarray()
    mass = space.mass()[-3:, -3:].toarray()
    assert np.abs(mass - values.T @ (weights[:, None] * values)).max() < 1e-14


def test_many_functions_are_those_one_by_one():
    xy = np.array([[[0.1, 0.2], [0.3, 0.1]]])
    both = CornerFunctions([HARMONIC, OTHER]).derivatives(xy, 4)
    for order, table in enumerate(both):
        assert table.shape == (order + 1, 1, 2, 2)
        assert np.allclose(table[..., 1], OTHER.derivatives(xy[..., 0] + 1j * xy[..., 1], 4)[order])


def test_under_a_tension_the_octagon_is_a_membrane_and_a_plate_at_once():
    """laplace(laplace - beta^2) w = p and w = laplace w = 0: w is the mean of the two without bending and stretching.

    So the first frequency squared is k^4 + beta^2 k^2 with the membrane's k.
    """
    plain, pulled = (Plate(regular_polygon(8, 1.0, 0.2), UNIT, S, tension=t) for t in (0.0, 5.0))
    without, under = (2 * np.pi * plate.frequencies(1)[0] for plate in (plain, pulled))
    assert under**2 == pytest.approx(without**2 + 5.0 * without, rel=2e-6)


def test_the_buckling_load_of_a_polygon_is_the_membranes_eigenvalue():
    plate = Plate(regular_polygon(8, 1.0, 0.2), UNIT, S)
    assert plate.buckling_load() == pytest.approx(2 * np.pi * plate.frequencies(1)[0], rel=2e-6)


def test_the_polygon_of_a_round_rim_draws_a_warning():
    mesh = regular_polygon(24, 1.0, 0.5)
    with pytest.warns(UserWarning, match="24 corners .* 26% less .* meshes.disc"):
        Plate(mesh, UNIT, S)
    Plate(mesh, UNIT, C)
    Plate(regular_polygon(20, 1.0, 0.5), UNIT, S)
