"""Corners: the exponents of M. L. Williams (1952), J. Appl. Mech. 19, 526, and what a freed corner changes.

w ~ r^(lambda + 1).  With both sides clamped sin(lambda omega) = +-lambda sin(omega), simply supported
cos(2 lambda omega) = cos(2 omega), one clamped and one simply supported sin(2 lambda omega) = lambda sin(2 omega),
free sin(lambda omega) = +-lambda (1 - nu)/(3 + nu) sin(omega), clamped and free
sin^2(lambda omega) = (4 - (1 - nu)^2 lambda^2 sin^2(omega)) / ((3 + nu)(1 - nu)).
"""

import numpy as np
import pytest

from fem_plate.elements.corners import MAX_EXPONENT, exponent
from fem_plate.elements.grading import corner_rows, singular_corners
from fem_plate.elements.space import PlateSpace
from fem_plate.sections import bending_law
from meshes import polygon, rectangle

C, S, F = "clamped", "simply-supported", "free"
L_SHAPE = [(0, 0), (1, 0), (1, 1), (-1, 1), (-1, -1), (0, -1)]


def of(degrees, before=C, after=C, nu=0.3):
    return exponent(np.deg2rad(degrees), before, after, nu)


@pytest.mark.parametrize(
    "degrees, expected",
    [(90, 2.73959), (120, 2.094139), (270, 0.544484), (300, 0.512221), (330, 0.501453), (360, 0.5)],
)
def test_clamped_corners(degrees, expected):
    """Tabulated since Williams for the Stokes and the plane elastic problem, whose equation is the same."""
    assert of(degrees) == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize("degrees", [50, 75, 120, 150, 200, 270, 315])
def test_simply_supported_corners(degrees):
    """lambda = +-k 180 / degrees -+ 1, the smallest above 0: below 1 at every re-entrant corner."""
    ratios = 180 / degrees * np.arange(1, 9)
    candidates = np.concatenate([np.abs(ratios - 1), ratios + 1])
    smallest = candidates[candidates > 1e-9].min()
    assert of(degrees, S, S) == pytest.approx(smallest, abs=1e-6)


@pytest.mark.parametrize("degrees", [100, 225, 300])
@pytest.mark.parametrize("sides", [(C, C), (S, S), (C, S), (F, F), (C, F), (S, F)])
def test_the_exponent_is_the_smallest_root_of_the_frequency_equation(degrees, sides):
    """The roots up to just below the one found are counted by the argument principle: none but those at integers."""
    found, omega = of(degrees, *sides), np.deg2rad(degrees)
    assert 0 < found < MAX_EXPONENT and found == pytest.approx(of(degrees, *sides[::-1]), abs=1e-6)
    imaginary = np.linspace(0, 2, 20001)  # the part that is not returned
    assert np.abs(residual(found + 1j * imaginary, omega, sides, 0.3)).min() < 1e-3
    left, right, high = 0.02, found - 0.01, 3.0
    if right <= left:
        return
    corners = [left - 1j * high, right - 1j * high, right + 1j * high, left + 1j * high]
    path = np.concatenate([np.linspace(a, b, 4001)[:-1] for a, b in zip(corners, np.roll(corners, -1), strict=True)])
    values = residual(path, omega, sides, 0.3)
    turns = np.angle(np.roll(values, -1) / values).sum() / (2 * np.pi)
    whole = sum(root_order(k, omega, sides) for k in range(1, 4) if left < k < right)
    assert round(turns) == whole


def root_order(k, omega, sides):
    circle = k + 1e-4 * np.exp(2j * np.pi * np.arange(400) / 400)
    values = residual(circle, omega, sides, 0.3)
    return round(np.angle(np.roll(values, -1) / values).sum() / (2 * np.pi))


def residual(s, omega, sides, nu):
    pair = frozenset(sides)
    sine, part = np.sin(s * omega), s * np.sin(omega)
    if pair == {C}:
        return sine**2 - part**2
    if pair == {S}:
        return np.cos(2 * s * omega) - np.cos(2 * omega)
    if pair == {F}:
        return sine**2 - (part * (1 - nu) / (3 + nu)) ** 2
    if pair == {C, F}:
        return sine**2 - (4 - (1 - nu) ** 2 * part**2) / ((3 + nu) * (1 - nu))
    if pair == {C, S}:
        return np.sin(2 * s * omega) - s * np.sin(2 * omega)
    return np.sin(2 * s * omega) + s * (1 - nu) / (3 + nu) * np.sin(2 * omega)


@pytest.mark.parametrize("sides", [(S, S), (C, C), (F, F)])
def test_a_straight_rim_of_one_support_is_smooth(sides):
    assert of(180, *sides) == MAX_EXPONENT


def test_a_simply_supported_square_is_smooth_and_a_clamped_one_nearly():
    assert of(90, S, S) == MAX_EXPONENT
    assert 2 < of(90) < MAX_EXPONENT


@pytest.mark.parametrize("sides", [(C, S), (S, F), (C, F)])
def test_where_supports_change_on_a_straight_rim(sides):
    assert of(180, *sides) == pytest.approx(0.5, abs=1e-6)


@pytest.mark.parametrize("nu", [0.0, 0.49])
def test_poissons_ratio_counts_only_on_free_sides_and_none_with_clamped_ones(nu):
    assert of(270, C, C, nu) == of(270, C, C, 0.2)
    assert abs(of(250, F, F, nu) - of(250, F, F, 0.2)) > 1e-3


def test_only_corners_that_are_not_smooth_are_found():
    square = rectangle(2.0, 1.0, 0.5)
    kinds = dict.fromkeys(square.boundaries, S)
    assert singular_corners(square, kinds, 0.3) == []
    assert len(singular_corners(square, dict.fromkeys(square.boundaries, C), 0.3)) == 4
    l_shape = polygon(L_SHAPE, 0.5)
    found = singular_corners(l_shape, dict.fromkeys(l_shape.boundaries, C), 0.3)
    notch = min(found, key=lambda corner: corner.exponent)
    assert len(found) == 6 and notch.exponent == pytest.approx(0.544484, abs=1e-5)
    assert np.abs(notch.point).max() < 1e-15


@pytest.fixture(scope="module")
def freed():
    mesh = polygon(L_SHAPE, 0.5)
    kinds = dict.fromkeys(mesh.boundaries, C)
    rows = corner_rows(mesh, singular_corners(mesh, kinds, 0.3))
    return PlateSpace(mesh, kinds, rows), PlateSpace(mesh, kinds), rows


def both_sides(space, u, order):
    """Derivatives on both sides of each edge between triangles, at 9 points of it: two (d, k, 9), and the ends."""
    edges = space.dofs[:, 18:].ravel()
    order_of = np.argsort(edges, kind="stable")
    pair = np.flatnonzero(np.diff(edges[order_of]) == 0)
    triangle, side = np.divmod(order_of[pair], 3)
    at = np.arange(len(pair))
    corners = space.triangles.points[triangle]
    start, end = corners[at, side], corners[at, (side + 1) % 3]
    points = start[:, None] + np.linspace(0, 1, 9)[:, None] * (end - start)[:, None]
    local = space.element_dofs(u)[space.dofs]
    found = []
    for t in (triangle, order_of[pair + 1] // 3):
        found.append(np.einsum("dtnk,tk->dtn", space.triangles.derivatives(points, t, order), local[t]))
    return *found, start, end


def test_a_space_with_freed_corners_is_still_continuous_with_its_gradient(freed):
    space, _, _ = freed
    u = np.random.default_rng(2).normal(size=space.unknowns)
    for order, bound in ((0, 1e-11), (1, 1e-10)):
        left, right, *_ = both_sides(space, u, order)
        assert np.abs(left - right).max() < bound


def test_second_derivatives_jump_at_freed_corners_and_at_no_others(freed):
    space, plain, _ = freed
    u = np.random.default_rng(2).normal(size=space.unknowns)
    left, right, start, end = both_sides(space, u, 2)
    at_ends = np.abs(left - right)[:, :, [0, -1]].max(axis=0)  # (k, 2)
    notch = np.stack([np.hypot(*start.T), np.hypot(*end.T)], axis=1) < 1e-12
    assert at_ends[notch].min() > 1e-3
    corners = (np.stack([start, end], axis=1)[:, :, None] == np.array(L_SHAPE)).all(axis=3).any(axis=2)
    assert at_ends[~notch & ~corners].max() < 1e-8
    assert space.unknowns > plain.unknowns


def test_a_freed_corner_adds_one_unknown_for_each_edge_that_runs_into_it(freed):
    space, plain, rows = freed
    triangles = polygon(L_SHAPE, 0.5).triangles
    inner = sum(int((triangles == row).any(axis=1).sum()) - 1 for row in rows)
    assert space.unknowns - plain.unknowns == inner


def test_a_freed_space_holds_linear_functions_and_all_of_the_plain_space(freed):
    space, plain, _ = freed
    points = np.random.default_rng(3).uniform(-0.9, -0.1, (50, 2))
    value, gradient, hessian = space.evaluate(points, space.linear(), orders=3)
    assert np.abs(value - np.column_stack([np.ones(50), points])).max() < 1e-14
    assert np.abs(gradient - np.array([[0, 0], [1, 0], [0, 1]])).max() < 1e-12
    assert np.abs(hessian).max() < 1e-9
    for name in ("mass", "stiffness"):
        arguments = (bending_law(0.3),) if name == "stiffness" else ()
        ours, theirs = getattr(space, name)(*arguments), getattr(plain, name)(*arguments)
        # Without jumps, the last unknowns, nothing differs.
        assert abs(ours[: plain.unknowns, : plain.unknowns] - theirs).max() < 1e-12 * abs(theirs).max()


def test_a_function_of_random_jumps_is_evaluated_alike_through_points_and_fields(freed):
    space, _, _ = freed
    u, points = (
        np.random.default_rng(4).normal(size=space.unknowns),
        np.array([(-0.01, 0.02), (-0.3, -0.4), (0.2, 0.1)]),
    )
    assert np.abs(space.point_values(points) @ u - space.evaluate(points, u[:, None], 1)[0][:, 0]).max() < 1e-12
