"""Small vibrations of a deflected plate, and its tangent stiffness."""

import numpy as np
import pytest

from fem_plate import Plate, PlateSection
from meshes import disc

UNIT = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0, density=1.0)
TWO = np.array([(0.3, 0.1), (-0.25, -0.35)])


def test_a_flat_state_has_the_modes_of_the_plate():
    plate = Plate(disc(1.0, 0.25), UNIT)
    flat = plate.large_deflection(TWO).solve([0.0, 0.0])
    assert plate.modes(4, TWO, deflected=flat).frequencies == pytest.approx(plate.frequencies(4, TWO), rel=5e-6)


@pytest.mark.slow
def test_the_tangent_stiffness_is_the_slope_of_the_reactions():
    large, heights = Plate(disc(1.0, 0.4), UNIT).large_deflection(TWO), np.array([1.5, -1.0])
    equilibrium = large.discrete(0, 0).equilibrium
    solution = equilibrium.solve(large.discrete(0, 0).loads(heights, 0.0))
    of_v, of_extra = np.zeros(equilibrium.space.unknowns), np.zeros(equilibrium.trial.count)
    step = 1e-4
    for direction in np.eye(2):
        tangent = equilibrium.solver(solution.state).solve(of_v, of_extra, direction)[2]
        ahead, behind = (large.solve(heights + sign * step * direction).reactions for sign in (1, -1))
        assert tangent == pytest.approx((ahead - behind) / (2 * step), rel=1e-5)


@pytest.mark.slow
def test_a_mode_is_a_slow_motion_of_a_soft_spring():
    """Where a heavy spring at a point gives way, it does so against the tangent stiffness of the deflected plate."""
    plate = Plate(disc(1.0, 0.25), UNIT)
    state = plate.large_deflection([(0, 0)]).solve([1.0])
    rigid = plate.modes(1, [(0, 0)], deflected=state).frequencies
    stiff, soft = (plate.modes(1, [(0, 0)], [k], deflected=state).frequencies for k in (1e7, 1e2))
    free = plate.modes(1, [], deflected=state).frequencies
    assert stiff == pytest.approx(rigid, rel=1e-4)
    assert free < soft < rigid


def test_points_that_are_no_actuators_are_refused():
    plate = Plate(disc(1.0, 0.4), UNIT)
    state = plate.large_deflection([(0, 0)]).solve([1.0])
    with pytest.raises(ValueError, match="must be actuators of the deflected state; it has none at"):
        plate.modes(1, [(0.2, 0.1)], deflected=state)
