"""The schemes with fixed steps: "fixed" is of order 1 and tends to scheme "events"; "paper" tends to its own equations.

Steps are halved; a slope is that of log error over log step. The strokes are those of test_single_stroke.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from coupling.surface.motion import surface_motion
from fem_plate.analytic import DiscShapes
from particle import ConstantFriction, Drive, KogutEtsion, Micropart, simulate

MASS, G = 2e-9, 9.80665
PAIR = [[75e-6, 10e-6], [-75e-6, 10e-6]]
STROKES = [Drive(150e-6, 300), Drive(90e-6, 450, delay=0.4e-3)]
CONSTANT = ConstantFriction(20.9 * MASS)
# Actuators, drives, start, friction, duration, gravity; then the largest error at a step of 0.5 us, over the radius.
CASES = {
    "up and down at 300 Hz": ([[0.0, 0.0]], [Drive(150e-6, 300, cycles=1)], (100e-6, 0.0), CONSTANT, 8e-3, 0.0, 1e-4),
    "up at 450 Hz": ([[0.0, 0.0]], [Drive(150e-6, 450, cycle="up")], (100e-6, 0.0), CONSTANT, 8e-3, 0.0, 7e-6),
    "two actuators": (PAIR, STROKES, (60e-6, -40e-6), CONSTANT, 3e-3, G, 1.2e-5),
    "two actuators, rough contact": (PAIR, STROKES, (60e-6, -40e-6), KogutEtsion.paper(), 3e-3, G, 1e-5),
}
HALVED = [4e-6, 2e-6, 1e-6, 0.5e-6]


def ends(case, radius, scheme, steps):
    actuators, drives, start, friction, duration, gravity, _ = case
    surface = surface_motion(DiscShapes(actuators, radius), drives)
    part = Micropart(MASS, start)
    truth = simulate(surface, part, friction, duration, gravity, tolerance=1e-12)
    runs = [simulate(surface, part, friction, duration, gravity, scheme=scheme, time_step=h) for h in steps]
    return truth, runs


def gap(run, end, radius):
    return np.hypot(*(run.position[-1] - end)) / radius


@pytest.mark.compiled
@pytest.mark.parametrize("name", CASES)
def test_fixed_steps_are_of_order_one(radius, name):
    truth, runs = ends(CASES[name], radius, "fixed", HALVED)
    errors = [gap(run, truth.position[-1], radius) for run in runs]
    slope = np.polyfit(np.log(HALVED), np.log(errors), 1)[0]
    assert slope == pytest.approx(1.0, abs=0.02)
    assert errors[-1] < CASES[name][-1]
    for run in runs:
        assert [event.kind for event in run.events] == [event.kind for event in truth.events]
        assert run.outcome is truth.outcome
    times = [[event.time for event in run.events] for run in (runs[-1], truth)]
    assert times[0] == pytest.approx(times[1], abs=2 * HALVED[-1])
    balances = [run.energy.balance for run in runs]
    assert np.polyfit(np.log(HALVED), np.log(balances), 1)[0] == pytest.approx(1.0, abs=0.05)


@pytest.mark.compiled
@pytest.mark.parametrize("name", CASES)
def test_the_paper_s_scheme_does_not_tend_to_the_same_path(radius, name):
    """It stays 0.3 % of the radius away, or more, however short the step; its energies do not add up either."""
    truth, runs = ends(CASES[name], radius, "paper", [1e-6, 0.5e-6, 0.25e-6])
    errors = [gap(run, truth.position[-1], radius) for run in runs]
    assert min(errors) > 2.5e-3
    assert np.ptp(errors) < 0.02 * errors[-1]
    assert truth.energy.balance < 1e-5 and min(run.energy.balance for run in runs) > 0.02


def limit_rate(surface, friction):
    """The equations that the paper's scheme tends to: v.grad(w_t) once, and a normal force without the velocity."""

    def rate(time, state):
        f, v = surface.evaluate(state[:2], time), state[2:]
        g, h = f.gradient[0], f.hessian[0]
        square = 1 + g @ g
        pull = G + f.w_tt[0] + v @ f.gradient_t[0] + v @ h @ v
        limit = float(friction.friction_limit(MASS * (G + f.w_tt[0]) / np.sqrt(square)))
        return [*v, *(-pull * g / square - limit / MASS * v / np.sqrt(v @ v + (v @ g) ** 2))]

    return rate


@pytest.mark.compiled
def test_the_paper_s_scheme_tends_to_its_own_equations_with_order_one(radius):
    """A part that slides from the start over one breakpoint, by scipy on the surface's public fields; rough contact."""
    friction, end = KogutEtsion.paper(), 1.2e-3
    surface = surface_motion(DiscShapes(PAIR, radius), STROKES)
    part = Micropart(MASS, (60e-6, -40e-6), (0.06, 0.09))
    state, edges = np.array([*part.position, *part.velocity]), [0.0, 0.4e-3, 0.4e-3 + 1 / 900 / 2, end]
    for one, other in zip(edges[:-1], edges[1:], strict=True):
        answer = solve_ivp(limit_rate(surface, friction), (one, other), state, method="DOP853", rtol=1e-11, atol=1e-15)
        state = answer.y[:, -1]
    runs = [simulate(surface, part, friction, end, G, scheme="paper", time_step=h) for h in HALVED]
    assert not any(run.events for run in runs)
    errors = [gap(run, state[:2], radius) for run in runs]
    assert np.polyfit(np.log(HALVED), np.log(errors), 1)[0] == pytest.approx(1.0, abs=0.02)
    truth = simulate(surface, part, friction, end, G, tolerance=1e-12)
    away = gap(runs[-1], truth.position[-1], radius)
    assert away > 50 * errors[-1]


@pytest.mark.compiled
def test_equal_errors_cost_fixed_steps_a_hundred_times_as_many_evaluations(radius):
    """1e-6 of the radius on two actuators over 3 ms: 50 ns steps, and a tolerance of 1e-7."""
    case = CASES["two actuators"]
    truth, (run,) = ends(case, radius, "fixed", [40e-9])
    actuators, drives, start, friction, duration, gravity, _ = case
    surface = surface_motion(DiscShapes(actuators, radius), drives)
    ours = simulate(surface, Micropart(MASS, start), friction, duration, gravity, tolerance=1e-7)
    fixed, located = (gap(path, truth.position[-1], radius) for path in (run, ours))
    assert located < fixed < 1e-6
    assert run.evaluations > 100 * ours.evaluations
