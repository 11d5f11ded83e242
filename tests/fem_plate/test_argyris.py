"""The Argyris triangle (Argyris, Fried and Scharpf, 1968): duality, C1 continuity, degree five and more."""

from math import factorial

import numpy as np
import pytest

from fem_plate.elements.argyris import DERIVATIVES, EDGES, Triangles, exponents, polynomials
from fem_plate.elements.space import PlateSpace
from meshes import disc, polygon


@pytest.fixture(scope="module", params=["disc", "crooked"])
def space(request):
    mesh = disc(1.0, 1 / 3) if request.param == "disc" else polygon([(-1, -1), (0.9, -0.6), (0.4, 1), (-0.8, 0.3)], 0.4)
    space = PlateSpace(mesh, dict.fromkeys(mesh.boundaries, "clamped"))
    space.mesh = mesh
    return space


@pytest.fixture(scope="module")
def scattered():
    """Triangles of any shape, size and place, counter-clockwise, none of them a sliver, of a degree."""
    rng = np.random.default_rng(8)
    points = rng.uniform(-1, 1, (400, 3, 2)) * 10.0 ** rng.uniform(-2, 0, (400, 1, 1)) + rng.uniform(-1, 1, (400, 1, 2))
    sides = np.roll(points, -1, axis=1) - points
    area = np.cross(*np.moveaxis(np.pad(sides[:, :2], ((0, 0), (0, 0), (0, 1))), 1, 0))[:, 2]
    points[area < 0] = points[area < 0][:, ::-1]
    good = np.abs(area) > 0.2 * (sides**2).sum(axis=2).max(axis=1)
    points = points[good].reshape(-1, 2)
    row = np.random.default_rng(9).permutation(len(points))  # so that edges run either way
    return lambda degree=5: Triangles(points[np.argsort(row)], row.reshape(-1, 3), degree)


def unknowns_on(triangles, function):
    """The unknowns (m, 21) of a smooth function, given by its derivatives (dx, dy), on each triangle."""
    x, y = np.moveaxis(triangles.points, 2, 0)
    corners = np.stack([function(x, y, *d) for order in range(3) for d in DERIVATIVES[order]], axis=2)
    middle = np.stack([triangles.points[:, edge].mean(axis=1) for edge in map(list, EDGES)], axis=1)
    gradient = np.stack([function(*np.moveaxis(middle, 2, 0), *d) for d in DERIVATIVES[1]], axis=2)
    slopes = (gradient * triangles.normals).sum(axis=2)
    return np.concatenate([corners.reshape(-1, 18), slopes], axis=1)


def inside(triangles, count, seed=0):
    """Random points in each triangle, (m, count, 2)."""
    share = np.random.default_rng(seed).dirichlet(np.ones(3), (len(triangles.points), count))
    return share @ triangles.points


def derived(coefficients, x, y, dx, dy):
    """A derivative of the sum of coefficients[i, j] x^i y^j."""
    polynomial = np.polynomial.polynomial
    return polynomial.polyval2d(x, y, polynomial.polyder(polynomial.polyder(coefficients, dx, axis=0), dy, axis=1))


def quintics(triangles):
    """Which unknowns are those of degree five."""
    functions = triangles.functions
    return [*range(18), *(18 + functions.more + functions.on_edge * np.arange(3))]


def every(triangles):
    return np.arange(len(triangles.points))


def on_triangles(space, u, points, triangle, order):
    local = space.element_dofs(u)[space.dofs[triangle]]
    return np.einsum("dtnk,tk->dtn", space.triangles.derivatives(points, triangle, order), local)


def test_each_basis_function_has_one_unknown_1_and_the_others_0(scattered):
    scattered, rows = scattered(), []
    for corner in range(3):
        at = scattered.points[:, [corner]]
        for order in range(3):
            rows += list(scattered.derivatives(at, every(scattered), order)[:, :, 0])
    for edge, ends in enumerate(EDGES):
        middle = scattered.points[:, ends].mean(axis=1, keepdims=True)
        slope = scattered.derivatives(middle, every(scattered), 1)[:, :, 0]
        rows.append(np.einsum("td,dtk->tk", scattered.normals[:, edge], slope))
    # A unit slope or curvature counts with the triangle's size and its square.
    size = np.sqrt(scattered.determinant)[:, None]
    scale = size ** np.array([0, 1, 1, 2, 2, 2] * 3 + [1] * 3)
    found = np.stack(rows, axis=1) * scale[:, :, None] / scale[:, None]
    assert np.abs(found - np.eye(21)).max() < 2e-10


@pytest.mark.parametrize("degree", [5, 6, 8, 10])
@pytest.mark.parametrize("order, bound", [(0, 1e-13), (1, 3e-12), (2, 1e-10), (3, 3e-9)])
def test_a_quintic_is_reproduced_with_all_derivatives(scattered, degree, order, bound):
    """At a higher degree too, where it has the unknowns of degree five and no more."""
    coefficients, scattered = np.random.default_rng(4).normal(size=(6, 6)), scattered(degree)
    coefficients *= np.add.outer(range(6), range(6)) <= 5

    def quintic(x, y, dx, dy):
        return derived(coefficients, x, y, dx, dy)

    of_quintic = unknowns_on(scattered, quintic)
    u, points = np.zeros((len(of_quintic), scattered.functions.count)), inside(scattered, 7)
    u[:, quintics(scattered)] = of_quintic
    found = np.einsum("dtnk,tk->dtn", scattered.derivatives(points, every(scattered), order), u)
    size = np.sqrt(scattered.determinant)[:, None]
    for values, d in zip(found, DERIVATIVES[order], strict=True):
        error = np.abs(values - quintic(*np.moveaxis(points, 2, 0), *d))
        assert (error * np.minimum(size, 1) ** order).max() < bound


@pytest.mark.parametrize("degree", [6, 7, 8, 9, 10])
def test_every_polynomial_of_the_degree_is_a_sum_of_functions(scattered, degree):
    """It has the unknowns that fit its values, and these give its second derivatives."""
    triangles = scattered(degree)
    rng = np.random.default_rng(degree)
    centre, size = triangles.centre[:, None], np.sqrt(triangles.determinant)[:, None, None]
    coefficients = rng.normal(size=(degree + 1, degree + 1))
    coefficients *= np.add.outer(range(degree + 1), range(degree + 1)) <= degree
    at = inside(triangles, 4 * triangles.functions.count, seed=1)
    table = triangles.derivatives(at, every(triangles), 0)[0]
    scale = np.abs(table).max(axis=1, keepdims=True)
    values = derived(coefficients, *np.moveaxis((at - centre) / size, 2, 0), 0, 0)
    u = np.stack([np.linalg.lstsq(a, b)[0] for a, b in zip(table / scale, values, strict=True)]) / scale[:, 0]
    points = inside(triangles, 5)
    found = np.einsum("dtnk,tk->dtn", triangles.derivatives(points, every(triangles), 2), u) * size[..., 0] ** 2
    for got, d in zip(found, DERIVATIVES[2], strict=True):
        assert np.abs(got - derived(coefficients, *np.moveaxis((points - centre) / size, 2, 0), *d)).max() < 1e-7


@pytest.mark.parametrize("degree", [5, 6, 7, 8, 9, 10])
def test_value_and_gradient_are_continuous_across_interior_edges(space, degree):
    space = PlateSpace(space.mesh, dict.fromkeys(space.mesh.boundaries, "clamped"), degree=degree)
    u = np.random.default_rng(3).normal(size=space.unknowns)
    # Functions of equal size, which their unknowns of moments do not give.
    for triangle, dofs in enumerate(space.dofs):
        at = np.random.default_rng(0).dirichlet(np.ones(3), 30) @ space.triangles.points[triangle]
        largest = np.abs(space.triangles.derivatives(at[None], np.array([triangle]), 0)[0, 0]).max(axis=0)
        u[dofs] = np.sign(u[dofs]) / np.maximum(largest, 1.0)
    (start, end), (left, right) = interior_edges(space)
    points = start[:, None] + np.linspace(0, 1, 9)[:, None] * (end - start)[:, None]
    jumps = [
        on_triangles(space, u, points, left, order) - on_triangles(space, u, points, right, order) for order in range(3)
    ]
    assert np.abs(jumps[0]).max() < 1e-11
    assert np.abs(jumps[1]).max() < 1e-10
    # Curvature jumps between corners: the element is C1 and no more.
    assert np.abs(jumps[2]).max() > 1
    assert np.abs(jumps[2][:, :, [0, -1]]).max() < 1e-8


def interior_edges(space):
    """The ends ((k, 2), (k, 2)) of the edges between two triangles, and these triangles (2, k)."""
    functions = space.triangles.functions
    edge = space.dofs[:, 18 : 18 + 3 * functions.on_edge : functions.on_edge]
    order = np.argsort(edge.ravel(), kind="stable")
    numbers = edge.ravel()[order]
    pair = np.flatnonzero(numbers[1:] == numbers[:-1])
    triangle, side = np.divmod(order, 3)
    ends = np.array(EDGES)[side[pair]]
    points = space.triangles.points[triangle[pair]]
    at = np.arange(len(pair))
    return (points[at, ends[:, 0]], points[at, ends[:, 1]]), (triangle[pair], triangle[pair + 1])


@pytest.mark.parametrize("degree", [5, 8, 10])
def test_polynomials_are_bernsteins_with_their_derivatives(degree):
    x, y = np.random.default_rng(5).uniform(-1 / 3, 1 / 3, (2, 6))
    polynomial = np.polynomial.Polynomial
    for column, (i, j, k) in enumerate(exponents(degree).tolist()):
        # (1 - s - t)^i s^j t^k multiplied out, with s = x + 1/3 and t = y + 1/3.
        table = np.zeros((degree + 1, degree + 1))
        for a in range(i + 1):
            of_s = (polynomial([1, -1]) ** (i - a)).coef * factorial(i) / factorial(a) / factorial(i - a) * (-1.0) ** a
            table[j : j + len(of_s), k + a] += of_s
        table *= factorial(degree) / factorial(i) / factorial(j) / factorial(k)
        for dx, dy in [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (1, 2), (3, 0)]:
            expected = derived(table, x + 1 / 3, y + 1 / 3, dx, dy)
            scale = float(degree) ** (dx + dy)
            assert polynomials(x, y, dx, dy, degree)[:, column] == pytest.approx(expected, rel=1e-9, abs=1e-10 * scale)


def test_each_point_is_evaluated_on_the_triangle_that_holds_it(space):
    """With random unknowns the curvature jumps between triangles, so that a wrong triangle shows."""
    u, points = np.random.default_rng(6).normal(size=(space.unknowns, 2)), inside(space.triangles, 25)
    value, gradient, hessian = space.evaluate(points.reshape(-1, 2), u, orders=3)
    got = [value[..., None], gradient, hessian[:, :, [0, 0, 1], [0, 1, 1]]]
    for column in range(2):
        for order in range(3):
            expected = on_triangles(space, u[:, column], points, every(space.triangles), order)
            assert np.abs(got[order][:, column].T - expected.reshape(len(expected), -1)).max() < 1e-9


def test_point_values_are_the_matrix_of_evaluation(space):
    u, points = np.random.default_rng(6).normal(size=space.unknowns), inside(space.triangles, 2).reshape(-1, 2)
    assert np.abs(space.point_values(points) @ u - space.evaluate(points, u[:, None], 1)[0][:, 0]).max() < 1e-13


def test_evaluating_in_chunks_changes_nothing(space, monkeypatch):
    u, points = np.random.default_rng(7).normal(size=(space.unknowns, 1)), inside(space.triangles, 3).reshape(-1, 2)
    whole = space.evaluate(points, u, orders=3)
    monkeypatch.setattr("fem_plate.elements.space.CHUNK", 17)
    for one, other in zip(whole, space.evaluate(points, u, orders=3), strict=True):
        assert np.abs(one - other).max() < 1e-12


def test_linear_functions_are_in_the_space(space):
    points = inside(space.triangles, 3).reshape(-1, 2)
    value, gradient, hessian = space.evaluate(points, space.linear(), orders=3)
    assert np.abs(value - np.column_stack([np.ones(len(points)), points])).max() < 1e-14
    assert np.abs(gradient - np.array([[0, 0], [1, 0], [0, 1]])).max() < 1e-12
    assert np.abs(hessian).max() < 1e-10
