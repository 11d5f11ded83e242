"""Scheme "paper": its rotation (8), curved way (10), friction logic (6) and (7), forces and rest."""

import math

import numpy as np
import pytest
from motions import motion

from particle import ConstantFriction, CoulombAdhesion, EventKind, Micropart, Outcome, polynomial_surface, simulate
from particle.events.mechanics.equations import Part
from particle.fixed.paper_scheme import across, paper_step, rotation
from particle.modes import Mode
from particle.surface.at_point import SurfacePoint

MASS, G = 2e-9, 9.80665


def point_of(**values):
    return SurfacePoint(**(dict.fromkeys(SurfacePoint._fields, 0.0) | {"x_x": 1.0, "y_y": 1.0} | values))


def part_with(limit, gravity=0.0):
    return Part(MASS, gravity, 0.0, 0.0, 0.0, ConstantFriction(limit * MASS).law)


def hill(r, angle):
    """w = exp(-r^2), which falls away from the origin, at a point; R = r is the radius of its level lines."""
    x, y = r * math.cos(angle), r * math.sin(angle)
    w = math.exp(-r * r)
    return point_of(
        w=w,
        w_x=-2 * x * w,
        w_y=-2 * y * w,
        w_xx=(4 * x * x - 2) * w,
        w_xy=4 * x * y * w,
        w_yy=(4 * y * y - 2) * w,
    )


@pytest.mark.parametrize("gradient", [(0.3, -0.4), (-2.0, 0.1), (0.0, 0.7), (0.0, 0.0)])
def test_the_rotation_turns_x_along_the_gradient_and_z_along_the_normal(gradient):
    turn = rotation(point_of(w_x=gradient[0], w_y=gradient[1]))
    assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-15)
    assert np.linalg.det(turn) == pytest.approx(1.0)
    q = math.hypot(*gradient)
    assert turn[0] * q == pytest.approx(np.array([*gradient, q * q]) / math.sqrt(1 + q * q), abs=1e-15)
    assert turn[2] == pytest.approx(np.array([-gradient[0], -gradient[1], 1.0]) / math.sqrt(1 + q * q), abs=1e-15)


@pytest.mark.parametrize("r", [0.2, 0.9, 2.0])
def test_the_way_across_the_gradient_is_that_of_equation_10(r):
    f = hill(r, 0.7)
    sine = math.sin(math.atan(math.hypot(f.w_x, f.w_y)))
    for way in (0.05, -0.3):
        y, z = across(f, rotation(f), way)
        assert y == pytest.approx(r / sine * math.sin(way * sine / r), rel=1e-12)
        assert z == pytest.approx(-r / sine * (1 - math.cos(way * sine / r)), rel=1e-12)


def test_on_level_ground_the_way_is_straight():
    f = point_of()
    assert across(f, rotation(f), 0.4) == (0.4, 0.0)


def test_above_the_threshold_friction_works_against_the_velocity():
    """Level ground shaken by nothing: V_T = Q h/m = 0.2 m/s."""
    start, after = motion(0.0, 0.0, 0.3, 0.4), motion()
    mode, load, way_x, way_y = paper_step(point_of(w_tt=5.0), part_with(2.0), 0.1, int(Mode.SLIDING), start, after)
    assert mode == Mode.SLIDING and load == pytest.approx(5 * MASS)
    assert [after.v_x, after.v_y] == pytest.approx([0.18, 0.24])
    assert [way_x, way_y] == pytest.approx([0.018, 0.024])


def test_below_the_threshold_the_force_decides():
    f, h = point_of(w_x=1.0, w_tt=-math.sqrt(2) * 6.0), 0.1  # F_e / m = 6 up the slope of 45 degrees
    start, after = motion(0.0, 0.0, 0.0, 0.1), motion()
    mode, _, way_x, way_y = paper_step(f, part_with(7.0), h, int(Mode.SLIDING), start, after)
    assert mode == Mode.RESTING
    assert after.v_x == after.v_y == after.v_z == way_x == way_y == 0.0
    mode, *_ = paper_step(f, part_with(4.0), h, int(Mode.SLIDING), start, after)
    up = h * (6 - 4)
    assert mode == Mode.SLIDING
    assert [after.v_x, after.v_y, after.v_z] == pytest.approx([up / math.sqrt(2), 0.1, up / math.sqrt(2)])


def test_the_normal_force_knows_nothing_of_the_velocity():
    f = point_of(w_x=0.5, w_y=-0.2, w_xt=3.0, w_yt=1.0, w_xx=4.0, w_yy=-1.0, w_tt=2.0)
    for velocity in ((0.0, 0.0), (0.3, 2.0)):
        start = motion(0.0, 0.0, *velocity)
        load = paper_step(f, part_with(0.5, G), 1e-3, int(Mode.SLIDING), start, motion())[1]
        assert load == pytest.approx(MASS * (G + 2.0) / math.sqrt(1.29), rel=1e-14)


@pytest.mark.parametrize("tangent, outcome", [(0.299, Outcome.STUCK), (0.301, Outcome.MOVING)])
def test_a_part_rests_below_the_angle_of_friction(tangent, outcome):
    """On a plane at rest no term is missing: the part slides as any textbook has it."""
    surface = polynomial_surface([[0.0], [tangent]])
    found = simulate(surface, Micropart(1.0, (0.0, 0.0)), CoulombAdhesion(0.3), 1.0, scheme="paper", time_step=1e-2)
    assert found.outcome is outcome
    if outcome is Outcome.STUCK:
        assert not found.events and not found.position.any() and not found.velocity.any()
    else:
        speed = -G * (tangent - 0.3) / (1 + tangent**2)
        assert [event.kind for event in found.events] == [EventKind.SLIPS]
        assert found.velocity[-1] == pytest.approx([speed, 0.0], rel=1e-9)
        assert found.position[-1] == pytest.approx([speed / 2, 0.0], rel=0.011)  # one step of a hundred


def test_a_part_stops_to_the_bit():
    part = Micropart(1.0, (0.0, 0.0), (1.2, -1.6))
    found = simulate(polynomial_surface([[0.0]]), part, ConstantFriction(1.0), 3.0, scheme="paper", time_step=0.03)
    assert [event.kind for event in found.events] == [EventKind.STOPS]
    assert found.events[0].time == pytest.approx(2.0, abs=0.031)
    rest = found.time >= found.events[0].time
    assert not found.velocity[rest].any() and (found.position[rest] == found.position[-1]).all()


def test_the_error_against_its_own_limit_falls_with_the_step():
    """On a bowl at rest without friction: g + v.H v is all that the limit has, and all that is true."""
    surface, part = (
        polynomial_surface([[0, 0.05, 0.9], [0, 0.2, 0], [0.6, 0, 0]]),
        Micropart(1.0, (0.5, -0.2), (0.3, 0.8)),
    )
    truth = simulate(surface, part, ConstantFriction(0.0), 0.4, tolerance=1e-11).position[-1]
    errors = []
    for h in (2e-3, 1e-3):
        found = simulate(surface, part, ConstantFriction(0.0), 0.4, scheme="paper", time_step=h)
        errors.append(np.hypot(*(found.position[-1] - truth)))
    assert math.log2(errors[0] / errors[1]) == pytest.approx(1.0, abs=0.1) and errors[1] < 5e-3


def test_rows_hold_the_scheme_s_own_forces():
    c = np.zeros((3, 1, 4))
    c[2, 0, 0], c[2, 0, 2], c[0, 0, 3] = 0.5, 1.0, 2.0
    surface, mass = polynomial_surface(c), 2.0
    part = Micropart(mass, (0.3, 0.0), (0.5, 0.5))
    found = simulate(surface, part, CoulombAdhesion(0.4), 0.1, scheme="paper", time_step=2e-3)
    for k in (0, 20, 50):
        state = surface.evaluate(found.position[k], found.time[k])
        load = mass * (G + state.w_tt[0]) / math.sqrt(1 + state.gradient[0] @ state.gradient[0])
        assert found.normal_force[k] == pytest.approx(load, rel=1e-12)
        assert found.friction_force[k] == pytest.approx(0.4 * load, rel=1e-12)
    between = found.at([0.5 * (found.time[20] + found.time[21])])
    assert found.normal_force[20] < between.normal_force[0] < found.normal_force[21]
