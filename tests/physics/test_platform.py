"""A block on a flat platform that is moved in its plane, as in the paper's figure 4: dry friction in closed form."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from particle import (
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    EventKind,
    Micropart,
    platform_surface,
    polynomial_surface,
    simulate,
)

G, MU = 9.80665, 0.3
STROKE, FREQUENCY = 0.05, 3.4  # at most 3.3 m/s^2, a little more than friction gives
UP = Drive(STROKE, FREQUENCY, cycle="up")
STILL = Drive(0.0, FREQUENCY, cycle="up")
Q = MU * G


def acceleration(time):
    return float(UP.evaluate(time)[2])


def closed_form():
    """When the block slips, stops, and where: its relative velocity is h'(slip) + Q (t - slip) - h'(t)."""
    peak = 0.5 / FREQUENCY * (1 - 1 / np.sqrt(3))  # of the acceleration
    slip = brentq(lambda t: acceleration(t) - Q, 1e-6, peak, xtol=1e-15)
    h_0, v_0 = float(UP.evaluate(slip)[0]), float(UP.evaluate(slip)[1])
    stop = brentq(lambda t: v_0 + Q * (t - slip) - float(UP.evaluate(t)[1]), peak, 0.5, xtol=1e-15)
    way = h_0 + v_0 * (stop - slip) + Q * (stop - slip) ** 2 / 2 - float(UP.evaluate(stop)[0])
    return slip, stop, way


@pytest.mark.parametrize("law", [CoulombAdhesion(MU), ConstantFriction(Q)], ids=["coulomb", "constant"])
def test_a_block_on_a_jerked_platform_lags_as_dry_friction_says(law):
    slip, stop, way = closed_form()
    trajectory = simulate(polynomial_surface([[0.0]], base=(UP, STILL)), Micropart(1.0, (0.0, 0.0)), law, stop + 1e-3)
    assert [event.kind for event in trajectory.events[:2]] == [EventKind.SLIPS, EventKind.STOPS]
    assert trajectory.events[0].time == pytest.approx(slip, abs=1e-11)
    assert trajectory.events[1].time == pytest.approx(stop, abs=1e-8)
    assert trajectory.events[1].position == pytest.approx((way, 0.0), abs=1e-9)


def test_a_platform_that_moves_too_gently_takes_the_block_with_it():
    gentle = Drive(STROKE, 0.5 * FREQUENCY, cycle="up")  # a quarter of the acceleration
    surface = polynomial_surface([[0.0]], base=(gentle, STILL))
    trajectory = simulate(surface, Micropart(1.0, (0.1, 0.2)), CoulombAdhesion(MU), 2.0)
    assert not trajectory.events and (trajectory.position == [0.1, 0.2]).all()


def test_the_direction_of_the_platform_is_that_of_the_block():
    slip, stop, way = closed_form()
    base = (Drive(0.6 * STROKE, FREQUENCY, cycle="up"), Drive(-0.8 * STROKE, FREQUENCY, cycle="up"))
    surface = polynomial_surface([[0.0]], base=base)
    trajectory = simulate(surface, Micropart(1.0, (0.0, 0.0)), CoulombAdhesion(MU), stop + 1e-3)
    assert trajectory.events[0].time == pytest.approx(slip, abs=1e-11)
    assert trajectory.events[1].position == pytest.approx((0.6 * way, -0.8 * way), abs=1e-9)


def test_a_platform_that_turns_its_direction_agrees_with_an_independent_solution():
    """Two drives out of step: the block breaks away along a turning pull. From 5 ms after break-away on, DOP853."""
    drives = (UP, Drive(0.7 * STROKE, FREQUENCY, cycle="up", delay=0.01))
    end = 0.13
    surface = polynomial_surface([[0.0]], base=drives)
    ours = simulate(surface, Micropart(1.0, (0.0, 0.0)), CoulombAdhesion(MU), end, tolerance=1e-11)
    assert [event.kind for event in ours.events] == [EventKind.SLIPS]
    assert ours.events[0].time > 0.01
    row = np.searchsorted(ours.time, ours.events[0].time + 5e-3)

    def rate(time, state):
        pull = -np.array([float(drive.evaluate(time)[2]) for drive in drives])
        return [*state[2:], *(pull - Q * state[2:] / np.hypot(*state[2:]))]

    start = np.concatenate([ours.position[row], ours.velocity[row]])
    theirs = solve_ivp(rate, (ours.time[row], end), start, method="DOP853", rtol=1e-12, atol=1e-15).y[:, -1]
    assert ours.position[-1] == pytest.approx(theirs[:2], abs=1e-10)
    assert ours.velocity[-1] == pytest.approx(theirs[2:], abs=1e-9)
    turn = np.arctan2(*ours.velocity[[row, -1]].T)
    assert abs(turn[1] - turn[0]) > 0.1


def test_break_away_on_a_platform_that_turns_its_direction_is_that_of_a_fine_solution():
    """The stiff first moments as well: Radau from rest, in the direction of the pull, with a speed of 1e-12 m/s."""
    drives = (UP, Drive(0.7 * STROKE, FREQUENCY, cycle="up", delay=0.01))
    surface = polynomial_surface([[0.0]], base=drives)
    ours = simulate(surface, Micropart(1.0, (0.0, 0.0)), CoulombAdhesion(MU), 0.13, tolerance=1e-11)

    def pull(time):
        return -np.array([float(drive.evaluate(time)[2]) for drive in drives])

    def rate(time, state):
        return [*state[2:], *(pull(time) - Q * state[2:] / np.hypot(*state[2:]))]

    slip = ours.events[0].time
    assert np.hypot(*pull(slip)) == pytest.approx(Q, rel=1e-9)
    start = [0.0, 0.0, *(1e-9 * pull(slip) / Q)]
    theirs = solve_ivp(rate, (slip, 0.13), start, method="Radau", rtol=1e-9, atol=1e-14).y[:2, -1]
    assert ours.position[-1] == pytest.approx(theirs, abs=1e-8)


def test_a_jump_of_the_acceleration_under_a_sliding_part_ends_a_step():
    """A cosine begins at full acceleration: x' = v - mu (g t + h'), so x = v t - mu (g t^2 / 2 + h)."""
    v, mu, drive = 0.2, 0.2, Drive(1.5e-4, 50.0, "cosine", cycles=1, delay=0.003)
    block = Micropart(1.0, (0.0, 0.0), (v, 0.0))
    path = simulate(platform_surface(z=drive, size=1e-2), block, CoulombAdhesion(mu), 0.02, tolerance=1e-9)
    time, height = path.time[-1], float(drive.evaluate(path.time[-1])[0])
    assert time == 0.02
    assert path.position[-1, 0] == pytest.approx(v * time - mu * (G * time**2 / 2 + height), abs=1e-13)
