"""Influence shapes of actuators that yield or float, and of plates under any support, or held by actuators alone.

Forces are exact in the discrete plate's symmetric compliance; heights at the actuators follow to the mesh's error.
"""

import numpy as np
import pytest

from fem_plate import Plate
from meshes import annulus, disc, rectangle

FOUR = np.array([[90e-6, 40e-6], [-60e-6, 120e-6], [-100e-6, -80e-6], [70e-6, -150e-6]])


@pytest.fixture(scope="module")
def plate(section, radius):
    return Plate(disc(radius, radius / 8), section)


def test_a_springy_actuator_yields_by_its_force_over_its_stiffness(plate):
    """phi_i(x_i) = h - P_i / k, whatever the others do."""
    springs = np.array([20.0, np.inf, 300.0, 5.0])
    shapes = plate.influence(FOUR, springs)
    heights = shapes.evaluate(FOUR)[0]
    assert np.abs(heights - (np.eye(4) - shapes.stiffness / springs[:, None])).max() < 2e-8
    assert heights[0, 0] < 0.9 and heights[1, 1] == pytest.approx(1, abs=2e-8)


def test_one_stiffness_counts_for_all(plate):
    one, each = plate.influence(FOUR, 50.0), plate.influence(FOUR, [50.0] * 4)
    assert (one.stiffness == each.stiffness).all() and np.abs(one.stiffness - plate.influence(FOUR).stiffness).max() > 1


def test_the_springs_forces_are_those_of_compliances_in_series(plate):
    """(C + 1/k) P = h, and the shapes are the sum of the forces' deflections."""
    springs, points = np.array([20.0, 7.0, 300.0, 5.0]), np.array([[10e-6, 200e-6], [-240e-6, 20e-6]])
    shapes = plate.influence(FOUR, springs)
    forces = np.linalg.inv(shapes.compliance + np.diag(1 / springs))
    assert shapes.stiffness == pytest.approx(forces, rel=1e-10)
    for i in range(4):
        assert shapes.evaluate(points)[0][:, i] == pytest.approx(
            plate.deflection(FOUR, forces[:, i]).evaluate(points)[0], rel=1e-10
        )


def test_very_stiff_springs_are_rigid(plate, spots):
    rigid, stiff = plate.influence(FOUR), plate.influence(FOUR, 1e12)
    assert np.abs(rigid.evaluate(spots)[0] - stiff.evaluate(spots)[0]).max() < 1e-8


def test_a_floating_actuator_holds_nothing_and_its_shape_is_that_of_a_newton(plate):
    springs = [np.inf, 0.0, np.inf, 30.0]
    shapes = plate.influence(FOUR, springs)
    heights = shapes.evaluate(FOUR)[0]
    held = plate.influence(FOUR[[0, 2, 3]], [np.inf, np.inf, 30.0])
    spots = np.array([[10e-6, 200e-6], [-240e-6, 20e-6]])
    # The others' shapes are those of a plate without it, and take no force there.
    assert np.abs(shapes.evaluate(spots)[0][:, [0, 2, 3]] - held.evaluate(spots)[0]).max() < 1e-12
    assert np.abs(shapes.stiffness[1, [0, 2, 3]]).max() == 0 and shapes.stiffness[1, 1] == pytest.approx(1, rel=1e-14)
    # Its own is the answer to one newton with the others at rest.
    assert np.abs(heights[[0, 2], 1]).max() < 1e-7 * heights[1, 1]
    assert heights[3, 1] == pytest.approx(-shapes.stiffness[3, 1] / 30.0, rel=1e-6)
    truth = plate.deflection(FOUR, shapes.stiffness[:, 1]).evaluate(spots)[0]
    assert shapes.evaluate(spots)[0][:, 1] == pytest.approx(truth, rel=1e-10)


def test_floating_actuators_are_reciprocal_among_themselves_and_with_held_ones(plate):
    shapes = plate.influence(FOUR, [0.0, 0.0, np.inf, np.inf])
    heights = shapes.evaluate(FOUR)[0]
    assert heights[0, 1] == pytest.approx(heights[1, 0], rel=1e-7)
    # Betti: one metre at a held one moves a floating one as one newton there pulls at the held one.
    assert heights[:2, 2:] == pytest.approx(-shapes.stiffness[2:, :2].T, rel=1e-6)


def test_all_floating_is_the_compliance(plate):
    shapes = plate.influence(FOUR, 0.0)
    assert shapes.evaluate(FOUR)[0] == pytest.approx(shapes.compliance, rel=1e-7)


@pytest.mark.parametrize("wrong", [-1.0, float("nan"), [1.0, 2.0, -3.0, np.inf]])
def test_a_negative_stiffness_is_refused(plate, wrong):
    with pytest.raises(ValueError, match="^Input stiffness of influence must be 0 or more; got .* N/m for point [02]$"):
        plate.influence(FOUR, wrong)


def test_there_must_be_one_stiffness_a_point(plate):
    with pytest.raises(ValueError, match=r"^Input stiffness of influence must be one a point, 4; got shape \(3,\)$"):
        plate.influence(FOUR, [1.0, 2.0, 3.0])


FREE = {
    "disc": disc(300e-6, 75e-6),
    "annulus": annulus(30e-6, 300e-6, 100e-6),
    "rectangle": rectangle(600e-6, 500e-6, 150e-6),
}


@pytest.fixture(scope="module", params=FREE)
def free(request, section):
    return Plate(FREE[request.param], section, "free")


def on_free(free, count=60):
    xy = np.random.default_rng(5).uniform(-1, 1, (40 * count, 2)) * free.mesh.size
    xy = xy[free.mesh.outline.gap(xy) > 0]
    return xy[np.linalg.norm(xy[:, None] - FOUR, axis=-1).min(axis=1) > 0.02 * free.mesh.size][:count]


def test_a_free_plate_on_three_actuators_only_tilts(free):
    """The shapes are Lagrange's linear functions, and no force is needed."""
    shapes, spots = free.influence(FOUR[:3]), on_free(free)
    plane = np.linalg.inv(np.column_stack([np.ones(3), FOUR[:3]]))
    value, gradient, hessian = shapes.evaluate(spots)
    assert np.abs(value - np.column_stack([np.ones(len(spots)), spots]) @ plane).max() < 1e-11
    assert np.abs(gradient - plane[1:].T).max() < 1e-10 / free.mesh.size
    assert np.abs(hessian).max() < 1e-8 / free.mesh.size**2
    assert np.abs(shapes.strengths).max() < 1e-9


def test_a_free_plate_on_four_actuators_is_in_balance(free):
    for springs in (None, [30.0, np.inf, 10.0, 70.0]):
        shapes = free.influence(FOUR, springs)
        heights, forces = shapes.evaluate(FOUR)[0], shapes.stiffness
        yielding = 0 if springs is None else forces / np.array(springs)[:, None]
        assert np.abs(heights - (np.eye(4) - yielding)).max() < 1e-5
        scale = np.abs(forces).max()
        assert scale > 0.1
        assert np.abs(forces.sum(axis=0)).max() < 1e-12 * scale
        assert np.abs(FOUR.T @ forces).max() < 1e-12 * scale * free.mesh.size
        assert np.abs(forces / forces.T - 1).max() < 1e-9


def test_a_free_plate_follows_a_tilt_of_all_its_actuators(free):
    spots = on_free(free)
    value, gradient, hessian = free.influence(FOUR).evaluate(spots, 2e-6 + FOUR @ [0.01, -0.02])
    assert np.abs(value - 2e-6 - spots @ [0.01, -0.02]).max() < 1e-15
    assert np.abs(gradient - [0.01, -0.02]).max() < 1e-11
    assert np.abs(hessian).max() * free.mesh.size < 1e-9


def test_a_floating_actuator_bends_a_free_plate_that_three_hold(free):
    shapes = free.influence(FOUR, [np.inf, np.inf, np.inf, 0.0])
    heights, forces = shapes.evaluate(FOUR)[0], shapes.stiffness[:, 3]
    assert np.abs(heights[:3, 3]).max() < 1e-4 * heights[3, 3] and heights[3, 3] > 0
    assert forces[3] == pytest.approx(1, rel=1e-14)
    assert abs(forces.sum()) < 1e-12 and np.abs(FOUR.T @ forces).max() < 1e-12 * free.mesh.size


@pytest.mark.parametrize(
    "points, stiffness",
    [
        (FOUR[:2], None),
        (FOUR[:1], 5.0),
        (np.array([[-1e-4, -1e-4], [0.5e-4, 0.5e-4], [1e-4, 1e-4]]), None),
        (FOUR[:3], [np.inf, 0.0, 20.0]),
        (FOUR, 0.0),
    ],
    ids=["two", "one spring", "on one line", "two and a floating one", "all floating"],
)
def test_actuators_that_leave_a_free_plate_a_motion_are_refused(free, points, stiffness):
    with pytest.raises(
        ValueError, match="^Input points of influence leave the plate a rigid motion: .* must fix three"
    ):
        free.influence(points, stiffness)


def test_a_free_plate_has_no_compliance(free):
    with pytest.raises(ValueError, match="^Input supports of Plate must hold it without actuators for a compliance"):
        _ = free.influence(FOUR).compliance


def test_a_hinged_plate_turns_on_one_actuator(section):
    plate = Plate(rectangle(600e-6, 500e-6, 150e-6), section, {"left": "simply-supported"})
    spots = np.array([[-290e-6, 200e-6], [0.0, 0.0], [300e-6, -250e-6]])
    value = plate.influence([[100e-6, 30e-6]]).evaluate(spots)[0][:, 0]
    assert np.abs(value - (spots[:, 0] + 300e-6) / 400e-6).max() < 1e-9
    with pytest.raises(ValueError, match="leave the plate a rigid motion"):
        plate.influence([[100e-6, 30e-6]], 0.0)


@pytest.mark.parametrize("supports", ["clamped", "simply-supported"])
@pytest.mark.parametrize("name", FREE)
def test_compliance_is_symmetric_and_positive_under_any_support(section, supports, name):
    shapes = Plate(FREE[name], section, supports).influence(FOUR)
    assert np.abs(shapes.compliance / shapes.compliance.T - 1).max() < 1e-14
    assert np.linalg.eigvalsh(shapes.compliance)[0] > 0
    assert np.abs(shapes.evaluate(FOUR)[0] - np.eye(4)).max() < 1e-4


def test_green_functions_are_reciprocal_before_they_are_made_so(section):
    """G_ij from the answers themselves, without the mean with its transpose."""
    model = Plate(FREE["rectangle"], section, {"left": "clamped", "top": "simply-supported"}).model(FOUR)
    x = FOUR / model.mesh.size
    smooth = model.space.point_values(x) @ model.under_forces(x)
    assert np.abs(smooth - smooth.T).max() < 1e-5 * np.abs(smooth).max()
