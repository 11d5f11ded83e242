"""A block on a flat platform that is moved in its plane, as in the paper's figure 4: dry friction in closed form."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from particle import ConstantFriction, CoulombAdhesion, Drive, EventKind, Micropart, polynomial_surface, simulate

G, MU = 9.80665, 0.3
STROKE, FREQUENCY = 0.05, 2.0
UP = Drive(STROKE, FREQUENCY, cycle="up")
STILL = Drive(0.0, FREQUENCY, cycle="up")
Q = MU * G


def acceleration(time):
    return float(UP.evaluate(time)[2])


def closed_form():
    """When the block slips, stops, and where: relative velocity is -h' + h'(slip) + Q (t - slip) while it slides back."""
    peak = 0.5 / FREQUENCY * (1 - 1 / np.sqrt(3))
    slip = brentq(lambda t: acceleration(t) - Q, 1e-6, peak, xtol=1e-15)
    h_0, v_0 = float(UP.evaluate(slip)[0]), float(UP.evaluate(slip)[1])
    stop = brentq(lambda t: v_0 + Q * (t - slip) - float(UP.evaluate(t)[1]), slip + 0.02, 0.5, xtol=1e-15)
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
    """Two drives out of step: the block breaks away along a turning pull. From 1e-4 s after break-away on, DOP853."""
    drives = (UP, Drive(0.7 * STROKE, FREQUENCY, cycle="up", delay=0.06))
    surface = polynomial_surface([[0.0]], base=drives)
    end = 0.25
    ours = simulate(surface, Micropart(1.0, (0.0, 0.0)), CoulombAdhesion(MU), end, tolerance=1e-11)
    slip = ours.events[0].time

    def rate(time, state):
        pull = -np.array([float(drive.evaluate(time)[2]) for drive in drives])
        speed = np.hypot(*state[2:])
        return [*state[2:], *(pull - Q * state[2:] / speed)]

    later = slip + 5e-3
    start = ours.at(later)
    row = np.searchsorted(ours.time, later)
    first = np.concatenate([ours.position[row], ours.velocity[row]])
    assert start[2] == row - 1 and len(ours.events) == 1
    solution = solve_ivp(rate, (ours.time[row], 0.06), first, method="DOP853", rtol=1e-12, atol=1e-15) if (
        ours.time[row] < 0.06
    ) else None
    if solution is not None:
        first, begin = solution.y[:, -1], 0.06
    else:
        begin = ours.time[row]
    solution = solve_ivp(rate, (begin, end), first, method="DOP853", rtol=1e-12, atol=1e-15)
    assert ours.position[-1] == pytest.approx(solution.y[:2, -1], abs=1e-9)
    assert abs(ours.position[-1, 1]) > 1e-4
