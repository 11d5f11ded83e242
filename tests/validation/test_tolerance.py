"""The error of an end point against the tolerance: proportional, with one constant for all cases.

Truths are `motion_oracle`'s, good to 2e-11: the two reference strokes and two actuators for 3 ms, whose paths are not
chaotic. Errors are distances over the radius.
"""

import math
from functools import cache

import numpy as np
import pytest
from motion_oracle import trace
from motion_problem import Problem
from motion_surfaces import boggio, up, up_down

from coupling.surface.motion import surface_motion
from fem_plate.analytic import DiscShapes
from particle import ConstantFriction, Drive, KogutEtsion, Micropart, simulate

MASS, RADIUS = 2e-9, 300e-6
PAIR = [[75e-6, 10e-6], [-75e-6, 10e-6]]
STROKES = [Drive(150e-6, 300), Drive(90e-6, 450, delay=0.4e-3)]
HEIGHTS = [up_down(150e-6, 300), up_down(90e-6, 450, 0.4e-3)]
BREAKPOINTS = [*(k / 600 for k in range(3)), *(0.4e-3 + k / 900 for k in range(3))]
ONCE, RISE = (Drive(150e-6, 300, cycles=1), up_down(150e-6, 300, cycles=1)), (Drive(150e-6, 450, "up"), up(150e-6, 450))
CONSTANT, ROUGH = ConstantFriction(20.9 * MASS), KogutEtsion.paper()
# Actuators, drives, their formulas and breakpoints, start, friction, gravity, duration.
CASES = {
    "up and down at 300 Hz": ([[0.0, 0.0]], [ONCE[0]], [ONCE[1]], [1 / 600, 1 / 300], (100e-6, 0.0), CONSTANT, 0, 8e-3),
    "up at 450 Hz": ([[0.0, 0.0]], [RISE[0]], [RISE[1]], [1 / 450], (100e-6, 0.0), CONSTANT, 0, 8e-3),
    "two actuators": (PAIR, STROKES, HEIGHTS, BREAKPOINTS, (60e-6, -40e-6), CONSTANT, 9.80665, 3e-3),
    "two actuators, rough contact": (PAIR, STROKES, HEIGHTS, BREAKPOINTS, (60e-6, -40e-6), ROUGH, 9.80665, 3e-3),
}
LONG = "up and down at 300 Hz", "two actuators, rough contact"
NAMES = [pytest.param(name, marks=[pytest.mark.slow] * (name in LONG)) for name in CASES]
TOLERANCES = 10.0 ** -np.arange(4, 12)
ORACLE = 2e-11  # of the radius; what the truth of a pass over an actuator may be wrong by
MOST, MOST_BELOW_1E_6 = 25, 2  # error over tolerance; the lower order down to 1e-6 is the coarser one
pytestmark = pytest.mark.compiled


@cache
def truth_and_runs(name):
    """The oracle's path, and for each tolerance the integrator's."""
    actuators, drives, heights, breakpoints, start, friction, gravity, duration = CASES[name]

    def limit(load):
        return float(friction.friction_limit(load))

    plate = boggio(actuators, RADIUS, heights)
    exact = Problem(plate, MASS, limit, breakpoints, (0.0, 0.0, -gravity), pull_off=friction.pull_off)
    truth = trace(exact, start, (0.0, 0.0), duration)
    surface = surface_motion(DiscShapes(actuators, RADIUS), drives, 1e-11)
    part = Micropart(MASS, start)
    return truth, [simulate(surface, part, friction, duration, gravity, t) for t in TOLERANCES]


@pytest.mark.parametrize("name", NAMES)
def test_the_error_is_at_most_the_tolerance_times_one_constant(name):
    truth, runs = truth_and_runs(name)
    errors = np.array([np.hypot(*(run.position[-1] - truth.position)) for run in runs]) / RADIUS
    assert (errors < MOST * TOLERANCES + ORACLE).all()
    fine = TOLERANCES < 5e-7
    assert (errors < MOST_BELOW_1E_6 * TOLERANCES + ORACLE)[fine].all()
    # Proportional: the slope of log error over log tolerance, where single runs may be lucky by a factor of 50.
    slope = np.polyfit(np.log(TOLERANCES), np.log(errors), 1)[0]
    assert slope == pytest.approx(1.0, abs=0.3)
    assert all(len(run.events) == len(truth.events) for run in runs)


@pytest.mark.parametrize("name", NAMES)
def test_at_1e_10_the_end_is_good_to_1e_9_and_events_to_1e_8(name):
    truth, runs = truth_and_runs(name)
    run = runs[int(np.argmin(abs(np.log(TOLERANCES / 1e-10))))]
    way = math.dist(truth.position, run.position[0])
    assert np.hypot(*(run.position[-1] - truth.position)) < 1e-9 * way
    assert [event.time for event in run.events] == pytest.approx([time for _, time, *_ in truth.events], rel=1e-8)


@pytest.mark.parametrize("name", NAMES)
def test_the_energy_ledger_closes_with_the_tolerance(name):
    balances = np.array([run.energy.balance for run in truth_and_runs(name)[1]])
    fine = TOLERANCES < 2e-9
    assert (balances[fine] < 1e-6).all()
