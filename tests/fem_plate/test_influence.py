"""Influence shapes: what they are by definition, their symmetries, their error estimate, and what is refused."""

import re

import numpy as np
import pytest

from fem_plate import Plate, PlateSection
from fem_plate.analytic import DiscShapes
from fem_plate.influence import SUMS
from meshes import disc, polygon, rectangle


@pytest.fixture(scope="module")
def plate(section, radius):
    return Plate(disc(radius, radius / 8), section)


@pytest.fixture(scope="module")
def shapes(plate, layout):
    return plate.influence(layout)


def turned(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])


def test_each_shape_is_1_at_its_actuator_and_0_at_the_others(shapes, layout):
    assert np.abs(shapes.evaluate(layout)[0] - np.eye(2)).max() < 1e-8


def test_shapes_are_flat_at_the_rim(shapes, radius):
    angle = np.linspace(0, 2 * np.pi, 101)
    value, gradient, _ = shapes.evaluate(radius * np.stack([np.cos(angle), np.sin(angle)], axis=1))
    assert np.abs(value).max() < 1e-7
    assert np.abs(gradient).max() * radius < 1e-5


def test_compliance_is_symmetric_and_stiffness_its_inverse(shapes):
    assert np.abs(shapes.compliance / shapes.compliance.T - 1).max() < 1e-15
    assert np.abs(shapes.stiffness @ shapes.compliance - np.eye(2)).max() < 1e-14


def test_compliance_is_the_deflection_under_one_newton(plate, shapes, layout):
    for j in range(2):
        w = plate.deflection(layout, np.eye(2)[j]).evaluate(layout)[0]
        assert w == pytest.approx(shapes.compliance[:, j], rel=1e-7)


def test_compliance_does_not_depend_on_the_plates_scale_but_through_a2_over_d(section, layout, shapes):
    larger = Plate(disc(3e-3, 3e-3 / 8), section).influence(10 * layout)
    assert larger.compliance == pytest.approx(100 * shapes.compliance, rel=1e-10)


def test_weights_give_the_weighted_sum(shapes, spots):
    weights = np.array([150e-6, -40e-6])
    for each, summed in zip(shapes.evaluate(spots), shapes.evaluate(spots, weights), strict=True):
        expected = np.einsum("ni...,i->n...", each, weights)
        assert summed.shape == expected.shape
        assert np.abs(summed - expected).max() < 1e-13 * np.abs(expected).max()


def test_gradient_and_hessian_are_the_derivatives_of_the_value(shapes, spots, radius):
    step, inner = 2e-5 * radius, spots[np.hypot(*spots.T) < 0.9 * radius][:200]
    _, gradient, hessian = shapes.evaluate(inner)
    for axis in range(2):
        shift = step * np.eye(2)[axis]
        after, before = shapes.evaluate(inner + shift), shapes.evaluate(inner - shift)
        by_value, by_gradient = ((a - b) / (2 * step) for a, b in zip(after[:2], before[:2], strict=True))
        assert np.abs(by_value - gradient[..., axis]).max() < 3e-7 * np.abs(gradient).max()
        # The mesh's Hessian jumps between triangles, by about its error.
        assert np.abs(by_gradient - hessian[..., axis]).max() < 1e-4 * np.abs(hessian).max()


def test_turning_the_layout_by_60_degrees_turns_the_answer(plate, shapes, layout, spots):
    """The mesh goes over into itself, so nothing but rounding may differ."""
    turn = turned(np.pi / 3)
    value, gradient, hessian = shapes.evaluate(spots)
    other = plate.influence(layout @ turn.T).evaluate(spots @ turn.T)
    assert np.abs(other[0] - value).max() < 1e-11
    assert np.abs(other[1] - gradient @ turn.T).max() < 1e-10 * np.abs(gradient).max()
    assert np.abs(other[2] - turn @ hessian @ turn.T).max() < 1e-9 * np.abs(hessian).max()


def test_turning_by_any_angle_changes_no_more_than_the_error(plate, shapes, layout, spots):
    turn = turned(0.3)
    other = plate.influence(layout @ turn.T).evaluate(spots @ turn.T)[0]
    assert np.abs(other - shapes.evaluate(spots)[0]).max() < 2e-7


@pytest.mark.parametrize("cells", [4, 8])
def test_the_error_estimate_is_within_a_factor_3_of_the_error(section, layout, radius, exact, spots, cells):
    shapes = Plate(disc(radius, radius / cells), section).influence(layout)
    error = np.abs(shapes.evaluate(spots)[0] - exact.evaluate(spots)[0]).max()
    assert error / 3 < shapes.error_estimate < 3 * error


L = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]]
RNG = np.random.default_rng(3)
SCATTERED = RNG.uniform(-0.6, 0.6, (36, 2))
KINDS = RNG.choice([np.inf, 2e7, 0.0], 36, p=[0.5, 0.3, 0.2])  # N/m


@pytest.mark.parametrize(
    ("mesh", "supports", "points", "springs"),
    [
        (rectangle(2.0, 2.0, 0.4), "clamped", 0.26 * (np.indices((6, 6)).reshape(2, -1).T - 2.5), None),
        (disc(1.0, 0.4), "free", SCATTERED, KINDS),
        (
            polygon(L, 0.3),
            "clamped",
            [p for p in 0.2 * np.indices((9, 9)).reshape(2, -1).T + 0.2 if min(p) < 0.9],
            None,
        ),
    ],
)
def test_the_error_estimate_of_many_actuators_is_about_that_of_all_their_shapes(mesh, supports, points, springs):
    shapes = Plate(mesh, PlateSection(1e11, 0.3, 0.01), supports).influence(points, springs)
    of_all = shapes.refine().difference(shapes)
    assert len(points) > 2 * SUMS and 0.8 * of_all < shapes.error_estimate < 2 * of_all


@pytest.mark.parametrize("supports", ["clamped", "free"])
def test_what_follows_from_the_shapes_is_as_found_from_the_plate(supports):
    plate = Plate(disc(1.0, 0.4), PlateSection(1e11, 0.3, 0.01, 2000.0), supports)
    place = np.array([0.1, 0.25])
    for springs in (KINDS, np.where(KINDS > 0, KINDS, np.inf)):
        shapes = plate.influence(SCATTERED, springs)
        loaded = plate.influence(np.concatenate([SCATTERED, place[None]]), np.append(springs, 0.0))
        assert shapes.compliance_at(place) == pytest.approx(loaded.own_heights()[-1], rel=1e-4)
        held = springs > 0
        expected = plate.frequencies(1, SCATTERED[held], springs[held])[0]
        exact = 1e-8 if held.all() else 1e-5  # cells are those for all actuators
        assert shapes.first_frequency(2000.0 * 0.01) == pytest.approx(expected, rel=exact)


@pytest.mark.parametrize("tolerance", [1e-5, 1e-7, 1e-8])
def test_a_tolerance_refines_until_it_is_met(section, layout, radius, exact, spots, tolerance):
    shapes = Plate(disc(radius, radius / 3), section, tolerance=tolerance).influence(layout)
    assert shapes.error_estimate <= tolerance
    assert np.abs(shapes.evaluate(spots)[0] - exact.evaluate(spots)[0]).max() < 3 * tolerance


def test_a_smaller_tolerance_takes_more_unknowns(section, layout, radius):
    mesh = disc(radius, radius / 2)
    unknowns = [Plate(mesh, section, tolerance=t).influence(layout).unknowns for t in (1e-4, 1e-7)]
    assert unknowns[0] < unknowns[1]


def test_all_refused_points_are_named_in_one_error(plate):
    wrong = [[0.0, 0.0], [300e-6, 0.0], [0.0, -600e-6], [1e-4, 0.0], [0.0, 0.0]]
    with pytest.raises(ValueError) as caught:
        plate.influence(wrong)
    text = str(caught.value)
    for part in ("point 1 at [0.0003, 0.0] m", "point 2 at [0.0, -0.0006] m", "points 0 and 4 must differ"):
        assert part in text
    assert "point 0 at" not in text and "point 3 at" not in text


def test_a_point_that_is_no_number_is_refused(plate):
    with pytest.raises(ValueError, match="point 0"):
        plate.influence([[float("nan"), 0.0]])


@pytest.mark.parametrize("place, bound", [(0.8, 5e-7), (0.9, 1.5e-6), (0.95, 5e-6), (0.98, 2e-5)])
def test_cells_are_small_where_an_actuator_is_close_to_the_rim(plate, spots, radius, place, bound):
    points = np.array([[place * radius, 0.0]])
    away = spots[np.linalg.norm(spots - points, axis=1) > 0.02 * radius]
    shapes = plate.influence(points)
    truth = DiscShapes(points, radius).evaluate(away)[0]
    assert np.abs(shapes.evaluate(away)[0] - truth).max() < bound


def test_an_actuator_at_the_centre_is_like_any_other(plate, spots, radius):
    truth = DiscShapes([[0.0, 0.0]], radius).evaluate(spots)[0]
    assert np.abs(plate.influence([[0.0, 0.0]]).evaluate(spots)[0] - truth).max() < 1e-11


def test_evaluating_beyond_the_rim_is_refused_and_on_it_allowed(shapes, radius):
    shapes.evaluate([[0.6 * radius, -0.8 * radius]])
    with pytest.raises(ValueError, match=re.escape(f"must lie on the plate; got [0.0, {1.001 * radius}] m")):
        shapes.evaluate([[0.0, 0.0], [0.0, 1.001 * radius]])


def test_one_point_may_be_given_without_brackets(plate):
    assert plate.influence([1e-4, 0.0]).points.shape == (1, 2)
