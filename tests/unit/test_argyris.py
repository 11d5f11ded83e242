"""The Argyris triangle (Argyris, Fried and Scharpf, 1968): duality, C1 continuity, degree five."""

import numpy as np
import pytest

from fem_plate.argyris import DERIVATIVES, EXPONENTS, ElementArgyris, monomials
from fem_plate.space import PlateSpace
from meshes import disc


@pytest.fixture(scope="module")
def space():
    return PlateSpace(disc(1.0, 1 / 3))


def normals(grid, facets):
    """Unit normals of edges, to the right of the way from their lower to their higher end."""
    along = grid.p[:, grid.facets[1, facets]] - grid.p[:, grid.facets[0, facets]]
    return np.stack([along[1], -along[0]]) / np.linalg.norm(along, axis=0)


def unknowns_of(space, function):
    """The unknowns that a smooth function, given by its derivatives (dx, dy), has on the mesh."""
    grid, dofs = space.grid, space.inner.dofs
    u = np.full(space.unknowns, np.nan)
    places = [derivative for order in range(3) for derivative in DERIVATIVES[order]]
    for row, derivative in zip(dofs.nodal_dofs, places, strict=True):
        u[row] = function(*grid.p, *derivative)
    middle = grid.p[:, grid.facets].mean(axis=1)
    normal = normals(grid, slice(None))
    u[dofs.facet_dofs[0]] = normal[0] * function(*middle, 1, 0) + normal[1] * function(*middle, 0, 1)
    assert np.isfinite(u).all()
    return u


def inside(space, count, seed=0):
    """Random points in each triangle, (triangles, count, 2)."""
    share = np.random.default_rng(seed).dirichlet(np.ones(3), (space.grid.nelements, count))
    return np.einsum("tnk,dkt->tnd", share, space.grid.p[:, space.grid.t])


def on_triangles(space, u, points, triangles, order):
    local = u[space.inner.dofs.element_dofs[:, triangles].T]
    return np.einsum("dtnk,tk->dtn", space.polynomials.evaluate(points, triangles, order), local)


def test_each_basis_function_has_one_unknown_1_and_the_others_0(space):
    grid, every = space.grid, np.arange(space.grid.nelements)
    corners = grid.p[:, grid.t].transpose(2, 1, 0)
    rows = []
    for corner in range(3):
        for order in range(3):
            rows += list(space.polynomials.evaluate(corners[:, [corner]], every, order)[:, :, 0])
    for edge in range(3):
        facet = grid.t2f[edge]
        middle = grid.p[:, grid.facets[:, facet]].mean(axis=1).T[:, None]
        slope = space.polynomials.evaluate(middle, every, 1)[:, :, 0]
        rows.append(np.einsum("dt,dtk->tk", normals(grid, facet), slope))
    assert np.abs(np.stack(rows, axis=1) - np.eye(21)).max() < 1e-10


def test_value_and_gradient_are_continuous_across_interior_edges(space):
    grid = space.grid
    u = np.random.default_rng(3).normal(size=space.unknowns)
    facets = np.setdiff1d(np.arange(grid.nfacets), grid.boundary_facets())
    start, end = (grid.p[:, row[facets]].T[:, None] for row in grid.facets)
    points = start + np.linspace(0, 1, 9)[:, None] * (end - start)
    left, right = grid.f2t[:, facets]
    jumps = [
        on_triangles(space, u, points, left, order) - on_triangles(space, u, points, right, order) for order in range(3)
    ]
    assert np.abs(jumps[0]).max() < 1e-11
    assert np.abs(jumps[1]).max() < 1e-10
    # Curvature jumps between corners: the element is C1 and no more.
    assert np.abs(jumps[2]).max() > 1
    assert np.abs(jumps[2][:, :, [0, -1]]).max() < 1e-9


@pytest.mark.parametrize("order, bound", [(0, 1e-13), (1, 2e-12), (2, 5e-11), (3, 1e-9)])
def test_a_quintic_is_reproduced_with_all_derivatives(space, order, bound):
    coefficients = np.random.default_rng(4).normal(size=len(EXPONENTS))

    def quintic(x, y, dx, dy):
        return monomials(x, y, dx, dy) @ coefficients

    u, points = unknowns_of(space, quintic), inside(space, 7)
    found = on_triangles(space, u, points, np.arange(space.grid.nelements), order)
    for values, (dx, dy) in zip(found, DERIVATIVES[order], strict=True):
        assert np.abs(values - quintic(points[..., 0], points[..., 1], dx, dy)).max() < bound


def test_monomials_are_those_of_numpy_with_their_derivatives():
    polynomial = np.polynomial.polynomial
    x, y = np.random.default_rng(5).normal(size=(2, 6))
    for column, (i, j) in enumerate(EXPONENTS):
        table = np.zeros((6, 6))
        table[i, j] = 1.0
        for dx, dy in [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (1, 2), (3, 0)]:
            derived = polynomial.polyder(polynomial.polyder(table, dx, axis=0), dy, axis=1)
            expected = polynomial.polyval2d(x, y, derived)
            assert monomials(x, y, dx, dy)[:, column] == pytest.approx(expected, rel=1e-13, abs=1e-13)


def test_each_point_is_evaluated_on_the_triangle_that_holds_it(space):
    """With random unknowns the curvature jumps between triangles, so that a wrong triangle shows."""
    u, points = np.random.default_rng(6).normal(size=(space.unknowns, 2)), inside(space, 25)
    value, gradient, hessian = space.evaluate(points.reshape(-1, 2), u)
    got = [value[..., None], gradient, hessian[:, :, [0, 0, 1], [0, 1, 1]]]
    every = np.arange(space.grid.nelements)
    for column in range(2):
        for order in range(3):
            expected = on_triangles(space, u[:, column], points, every, order)
            assert np.abs(got[order][:, column].T - expected.reshape(len(expected), -1)).max() < 1e-9


def test_evaluating_in_chunks_changes_nothing(space, monkeypatch):
    u, points = np.random.default_rng(7).normal(size=(space.unknowns, 1)), inside(space, 3).reshape(-1, 2)
    whole = space.evaluate(points, u)
    monkeypatch.setattr("fem_plate.space.CHUNK", 17)
    for one, other in zip(whole, space.evaluate(points, u), strict=True):
        assert np.abs(one - other).max() < 1e-12


def test_the_element_hands_out_fresh_tables_for_each_set_of_points(space):
    """scikit-fem asks for one function at a time; a table of other points must never be handed out."""
    element, mapping = ElementArgyris(space.polynomials, derivatives=3), space.grid.mapping()
    here, there = np.array([[0.2], [0.3]]), np.array([[0.6], [0.1]])
    first = element.gbasis(mapping, here, 4)[0]
    assert not np.allclose(element.gbasis(mapping, there, 4)[0].hess, first.hess)
    again = element.gbasis(mapping, here.copy(), 4)[0]
    assert np.array_equal(again.grad3, first.grad3)
