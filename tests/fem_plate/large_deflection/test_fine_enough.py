"""The largest cells on which a stretching plate meets its tolerance."""

import numpy as np
import pytest

from fem_plate import Plate, PlateSection
from fem_plate.large_deflection import fine_enough
from meshes import disc

UNIT = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0)
POINTS, HEIGHTS = [[0.3, 0.1], [-0.25, -0.35]], np.array([1.0, -0.6])


def large_of(tolerance, cell_size=0.5):
    return Plate(disc(1.0, cell_size), UNIT, tolerance=tolerance).large_deflection(POINTS)


@pytest.mark.slow
@pytest.mark.parametrize("tolerance, halvings", [(None, 0), (1e-3, 0), (2.1e-6, 1)])
def test_cells_are_halved_until_the_tolerance_is_met(tolerance, halvings):
    discrete, error = fine_enough(large_of(tolerance), HEIGHTS)
    assert (discrete.level, discrete.halvings) == (0, halvings)
    assert tolerance is None or error <= tolerance


@pytest.mark.slow
def test_the_error_is_that_against_a_much_finer_mesh():
    large = large_of(None)
    error = fine_enough(large, HEIGHTS)[1]
    finest = large_of(None, 0.12).solve(HEIGHTS)
    assert finest.difference(large.solve(HEIGHTS)) == pytest.approx(error, rel=1.0)


def test_cells_follow_the_deflection():
    assert fine_enough(large_of(None), 6 * HEIGHTS)[0].level == 1
