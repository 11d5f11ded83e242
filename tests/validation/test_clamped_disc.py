"""The plate's finite elements against Boggio's function: two actuators off the centre of a clamped disc.

A central actuator could not show errors: its smooth part, c (1 - r^2), lies in every element's space.
"""

import numpy as np
import pytest

from fem_plate import Plate
from fem_plate.analytic import DiscShapes, central_load
from meshes import disc

DIVISIONS = (4, 8, 13)  # cells along a radius


@pytest.fixture(scope="module")
def errors(section, layout, exact, spots, radius):
    """Largest errors of w, gradient and Hessian over their largest values, a row for each mesh."""
    truth, rows = exact.evaluate(spots), []
    for k in DIVISIONS:
        shapes = Plate(disc(radius, radius / k), section).influence(layout)
        assert shapes.unknowns <= 6_000
        found = shapes.evaluate(spots)
        rows.append([np.abs(f - t).max() / np.abs(t).max() for f, t in zip(found, truth, strict=True)])
    return np.array(rows)


@pytest.mark.parametrize("field, order", [(0, 5.0), (1, 4.0), (2, 3.0)], ids=["value", "gradient", "hessian"])
def test_the_error_falls_at_least_at_order(errors, field, order):
    slope = np.log(errors[0] / errors[-1]) / np.log(DIVISIONS[-1] / DIVISIONS[0])
    assert slope[field] >= order


@pytest.mark.parametrize("field, bound", [(0, 4e-9), (1, 2e-7), (2, 2e-6)], ids=["value", "gradient", "hessian"])
def test_the_error_with_6000_unknowns_is_below(errors, field, bound):
    assert errors[-1, field] < bound


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
