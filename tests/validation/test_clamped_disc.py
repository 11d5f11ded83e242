"""The plate's finite elements against Boggio's function: actuators off the centre of a clamped disc.

A central actuator could not show errors: its smooth part, c (1 - r^2), lies in every element's space.
"""

import numpy as np
import pytest

from fem_plate import Plate
from fem_plate.analytic import DiscShapes, central_load
from meshes import disc

DIVISIONS = (4, 8, 13)  # cells along a radius
FIELDS = pytest.mark.parametrize("field", range(3), ids=["value", "gradient", "hessian"])


def errors_of(shapes, radius, spots, distance=0.02):
    """Largest errors of w, gradient and Hessian over their largest values, away from the actuators."""
    away = spots[np.linalg.norm(spots[:, None] - shapes.points, axis=-1).min(axis=1) > distance * radius]
    truth, found = DiscShapes(shapes.points, radius).evaluate(away), shapes.evaluate(away)
    return np.array([np.abs(f - t).max() / np.abs(t).max() for f, t in zip(found, truth, strict=True)])


@pytest.fixture(scope="module")
def errors(section, layout, spots, radius):
    rows = []
    for k in DIVISIONS:
        shapes = Plate(disc(radius, radius / k), section).influence(layout)
        assert shapes.unknowns <= 6_000
        rows.append(errors_of(shapes, radius, spots))
    return np.array(rows)


@FIELDS
def test_the_error_falls_at_its_order(errors, field):
    slope = np.log(errors[0] / errors[-1]) / np.log(DIVISIONS[-1] / DIVISIONS[0])
    assert slope[field] >= (5.5, 4.5, 3.5)[field]


@FIELDS
def test_the_error_with_6000_unknowns_is_below(errors, field):
    assert errors[-1, field] < (4e-9, 2e-7, 2e-6)[field]


@pytest.fixture(scope="module")
def nine(section, radius, spots):
    angle = np.arange(8) * 2.399963  # the golden angle
    place = radius * np.linspace(0.2, 0.75, 8)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    shapes = Plate(disc(radius, radius / 16), section).influence(np.concatenate([[(0.05 * radius, 0.0)], place]))
    assert shapes.unknowns <= 20_000
    return errors_of(shapes, radius, spots)


@FIELDS
def test_nine_actuators_up_to_three_quarters_of_the_radius(nine, field):
    assert nine[field] < (1e-8, 2e-7, 1e-5)[field]


def test_an_actuator_near_the_rim_and_two_close_to_each_other(section, radius, spots):
    points = radius * np.array([(0.9, 0.0), (-0.3, 0.2), (-0.3, 0.22)])
    w, _, hessian = errors_of(Plate(disc(radius, radius / 10), section).influence(points), radius, spots)
    assert w < 1e-6
    assert hessian < 1e-2


def test_actuators_one_micrometre_apart(section, radius, spots):
    points = np.array([[100e-6, 0.0], [101e-6, 0.0], [-50e-6, 80e-6]])
    w, gradient, hessian = errors_of(Plate(disc(radius, radius / 10), section).influence(points), radius, spots)
    assert w < 1e-7 and gradient < 1e-5 and hessian < 1e-3


def test_forces_need_no_actuator_in_a_node_to_be_exact(section, radius, layout, spots):
    forces = np.array([2e-3, -1e-3])
    plate = Plate(disc(radius, radius / 8), section)
    found = plate.deflection(layout, forces).evaluate(spots)
    exact = DiscShapes(layout, radius)
    compliance = np.linalg.inv(exact.strengths) * radius**2 / section.rigidity
    truth = exact.evaluate(spots, compliance @ forces)
    for f, t, bound in zip(found, truth, (1e-7, 2e-6, 2e-5), strict=True):
        assert np.abs(f - t).max() < bound * np.abs(t).max()


def test_a_central_load_gives_equation_2_to_rounding(section, radius):
    r = np.linspace(0, radius, 60)
    w = Plate(disc(radius, radius / 4), section).deflection([[0, 0]], [1e-3]).evaluate(np.stack([0.8 * r, 0.6 * r], 1))
    truth = central_load(r, radius, section.rigidity, 1e-3)
    assert np.abs(w[0] - truth).max() < 1e-12 * truth[0]
