"""Inclines in closed form: a part that is held, one that slides down, one that slides across."""

import math

import pytest

from particle import CoulombAdhesion, Micropart, Outcome, polynomial_surface, simulate

G = 9.80665
ANGLE = math.radians(30)


def incline(angle):
    """Rises along x."""
    return polynomial_surface([[0.0], [math.tan(angle)]])


@pytest.mark.parametrize("tolerance", [1e-6, 1e-9])
def test_above_the_friction_angle_the_part_slides_by_g_sin_minus_mu_cos(tolerance):
    mu, time = 0.4, 0.7
    trajectory = simulate(incline(ANGLE), Micropart(1.0, (0.0, 0.0)), CoulombAdhesion(mu), time, tolerance=tolerance)
    way = 0.5 * G * (math.sin(ANGLE) - mu * math.cos(ANGLE)) * time**2
    assert trajectory.position[-1] == pytest.approx([-way * math.cos(ANGLE), 0.0], abs=1e-12)
    assert trajectory.normal_force[-1] == pytest.approx(G * math.cos(ANGLE), rel=1e-14)
    assert trajectory.friction_force[-1] == pytest.approx(mu * G * math.cos(ANGLE), rel=1e-14)


def test_it_slides_straight_down_whichever_way_the_incline_faces():
    surface = polynomial_surface([[0.0, 0.6 * math.tan(ANGLE)], [0.8 * math.tan(ANGLE), 0.0]])
    trajectory = simulate(surface, Micropart(1.0, (0.0, 0.0)), CoulombAdhesion(0.4), 0.7)
    way = 0.5 * G * (math.sin(ANGLE) - 0.4 * math.cos(ANGLE)) * 0.49 * math.cos(ANGLE)
    assert trajectory.position[-1] == pytest.approx([-0.8 * way, -0.6 * way], abs=1e-12)


@pytest.mark.parametrize("tolerance, bound", [(1e-6, 5e-5), (1e-9, 5e-9), (1e-12, 5e-11)])
def test_a_push_across_the_incline_is_turned_downhill_as_the_pursuit_curve_says(tolerance, bound):
    """With mu = tan(angle) pull and friction have one size, f: u + v_down stays what it was (Landau's sledge).

    Then u' = -f (1 + cos) and the part ends up straight downhill with half of its speed.
    """
    mu, u = math.tan(ANGLE), 2.0
    trajectory = simulate(
        incline(ANGLE), Micropart(1.0, (0.0, 0.0), (0.0, u)), CoulombAdhesion(mu), 2.0, tolerance=tolerance
    )
    down = -trajectory.velocity[:, 0] / math.cos(ANGLE)
    speed = [math.hypot(d, v) for d, v in zip(down, trajectory.velocity[:, 1], strict=True)]
    assert down + speed == pytest.approx([u] * len(speed), abs=bound)
    assert down[-1] == pytest.approx(u / 2, abs=2e-3)


def test_static_friction_holds_a_part_that_kinetic_friction_would_not():
    held = CoulombAdhesion(0.4, static_coefficient=0.6)
    resting = simulate(incline(ANGLE), Micropart(1.0, (0.0, 0.0)), held, 1.0)
    moving = simulate(incline(ANGLE), Micropart(1.0, (0.0, 0.0), (-1e-6, 0.0)), held, 1.0)
    assert resting.outcome is Outcome.STUCK and not resting.position.any()
    assert moving.outcome is Outcome.MOVING and moving.position[-1, 0] < -0.5
