"""A flat rigid surface that drives move."""

import numpy as np
import pytest

from particle import CoulombAdhesion, Drive, Micropart, Outcome, TableDrive, platform_surface, simulate

UP = Drive(2e-3, 50.0, "up")


def test_it_has_the_height_of_its_drive_everywhere_and_no_slope():
    surface = platform_surface(x=UP, z=Drive(1e-3, 30.0), size=2e-3)
    spots = np.array([[0.0, 0.0], [1.0, -3.0]])
    for time in (0.0, 4e-3, 0.3):
        state = surface.evaluate(spots, time)
        for found, expected, scale in zip(state[:3], Drive(1e-3, 30.0).evaluate(time), (1e-3, 0.1, 10), strict=True):
            assert found == pytest.approx(float(expected), abs=1e-12 * scale)
        for derivative in state[3:]:
            assert not derivative.any()


@pytest.mark.parametrize("axes", [{}, {"x": UP}, {"y": UP}])
def test_without_a_vertical_drive_it_stays_at_0(axes):
    state = platform_surface(**axes).evaluate([[0.1, 0.2]], 5e-3)
    assert not any(values.any() for values in state)


@pytest.mark.parametrize("axis", ["x", "y"])
def test_a_part_without_friction_stays_behind_the_platform(axis):
    surface = platform_surface(**{axis: UP}, size=2e-3)
    trajectory = simulate(surface, Micropart(1e-9, (0.0, 0.0)), CoulombAdhesion(0.0), 30e-3)
    expected = [-2e-3, 0.0] if axis == "x" else [0.0, -2e-3]
    assert trajectory.position[-1] == pytest.approx(expected, abs=1e-12)


def test_a_platform_at_rest_is_an_incline_under_tilted_gravity():
    """Down at g (sin - mu cos), in the plane's coordinates."""
    g, angle, mu = 9.81, 0.5, 0.3
    gravity = (g * np.sin(angle), 0.0, -g * np.cos(angle))
    trajectory = simulate(platform_surface(), Micropart(1e-9, (0.0, 0.0)), CoulombAdhesion(mu), 1.0, gravity)
    way = g * (np.sin(angle) - mu * np.cos(angle)) / 2
    assert trajectory.position[-1] == pytest.approx([way, 0.0], rel=1e-9)


def test_a_platform_that_falls_away_loses_the_part():
    down = TableDrive([0.0, 1e-3, 2e-3], [0.0, 0.0, -1e-3])
    trajectory = simulate(platform_surface(z=down, size=1e-3), Micropart(1e-9, (0.0, 0.0)), CoulombAdhesion(0.3), 2e-3)
    assert trajectory.outcome is Outcome.DETACHED
    after = trajectory.time[-1] - 1e-3
    assert float(down.evaluate(1e-3 + after)[2]) == pytest.approx(-9.80665, rel=1e-6)


@pytest.mark.parametrize("size", [0.0, -1.0, np.inf, np.nan])
def test_a_size_must_be_positive(size):
    with pytest.raises(ValueError, match="Input size of platform_surface must be a positive length in m; got"):
        platform_surface(size=size)
