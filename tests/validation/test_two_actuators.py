"""Paths between two actuators 150 um apart: finite elements against Boggio's surface, our integrator against DOP853."""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from coupling.surface.motion import surface_motion
from fem_plate import Plate
from fem_plate.analytic import DiscShapes
from meshes import disc
from particle import ConstantFriction, Drive, EventKind, KogutEtsion, Micropart, simulate

MASS, G = 2e-9, 9.80665
LAYOUT = np.array([[75e-6, 10e-6], [-75e-6, 10e-6]])
DRIVES = [Drive(150e-6, 300), Drive(90e-6, 450, delay=0.4e-3)]
CONSTANT, ROUGH = ConstantFriction(20.9 * MASS), KogutEtsion.paper()
STARTS = [(100e-6, 100e-6), (60e-6, -40e-6), (0.0, 100e-6)]


@pytest.fixture(scope="module")
def boggio(radius):
    return surface_motion(DiscShapes(LAYOUT, radius), DRIVES)


def path(surface, start, friction, duration=20e-3, tolerance=1e-9):
    return simulate(surface, Micropart(MASS, start), friction, duration, gravity=G, tolerance=tolerance)


@pytest.fixture(scope="module")
def finite(section, radius):
    return surface_motion(Plate(disc(radius, radius / 12), section).influence(LAYOUT), DRIVES)


@pytest.fixture(scope="module")
def whole(boggio):
    """The path from a start; each is found once."""
    return cache(lambda start: path(boggio, start, CONSTANT))


@pytest.fixture(scope="module")
def tight(boggio):
    """The same under a law, from the second start up to 3 ms at a tight tolerance."""
    return cache(lambda friction: path(boggio, STARTS[1], friction, 3e-3, 1e-11))


@pytest.mark.parametrize("start", STARTS)
def test_finite_elements_and_closed_form_end_within_1e_6_of_the_path(finite, whole, start):
    truth, found = whole(start), path(finite, start, CONSTANT)
    assert truth.distance > 50e-6
    assert found.outcome is truth.outcome
    assert np.hypot(*(found.position[-1] - truth.position[-1])) < 1e-6 * truth.distance


@pytest.mark.parametrize("friction", [CONSTANT, ROUGH], ids=["constant", "rough"])
@pytest.mark.parametrize("tolerance, bound", [(1e-6, 5e-5), (1e-9, 2e-8)])
def test_a_sliding_path_is_that_of_dop853(boggio, tight, friction, tolerance, bound):
    """From the first row at 10 mm/s to 3 ms, by scipy on the surface's public fields, breakpoint by breakpoint."""
    start, end, reference = STARTS[1], 3e-3, tight(friction)
    assert [event.kind for event in reference.events] == [EventKind.SLIPS]
    first = np.flatnonzero(np.hypot(*reference.velocity.T) > 10e-3)[0]

    def rate(time, state):
        f, v = boggio.evaluate(state[:2], time), state[2:]
        g, h = f.gradient[0], f.hessian[0]
        b = G + f.w_tt[0] + 2 * v @ f.gradient_t[0] + v @ h @ v
        square = 1 + g @ g
        limit = 20.9 * MASS
        if isinstance(friction, KogutEtsion):
            limit = float(friction.friction_limit(MASS * b / np.sqrt(square)))
        return [*v, *(-b * g / square - limit / MASS * v / np.sqrt(v @ v + (v @ g) ** 2))]

    state, begin = np.concatenate([reference.position[first], reference.velocity[first]]), reference.time[first]
    breakpoints = np.unique(np.concatenate([np.arange(4) / 600, 0.4e-3 + np.arange(4) / 900]))
    edges = [begin, *breakpoints[(breakpoints > begin) & (breakpoints < end)], end]
    for one, other in zip(edges[:-1], edges[1:], strict=True):
        state = solve_ivp(rate, (one, other), state, method="DOP853", rtol=1e-10, atol=1e-14).y[:, -1]
    ours = path(boggio, start, friction, end, tolerance).position
    way = np.hypot(*(state[:2] - reference.position[first]))
    assert way > 50e-6
    assert np.ptp(np.arctan2(*reference.velocity[first:].T)) > 0.3  # in two dimensions
    assert np.hypot(*(ours[-1] - state[:2])) < bound * way


def test_the_error_falls_with_the_tolerance(boggio):
    """Over the first 5 ms, which start with a break-away in two dimensions."""
    truth = path(boggio, STARTS[0], ROUGH, 5e-3, 1e-12).position[-1]
    tolerances = [1e-5, 1e-7, 1e-9]
    errors = [np.hypot(*(path(boggio, STARTS[0], ROUGH, 5e-3, t).position[-1] - truth)) / 300e-6 for t in tolerances]
    assert errors[0] > 30 * errors[1] > 900 * errors[2]
    assert errors[2] < 1e-8


@pytest.mark.parametrize("start", STARTS)
def test_each_slip_begins_where_demand_meets_friction_and_each_rest_within_it(boggio, whole, start):
    """The events against the definition of sticking, from the surface's public fields."""
    limit, trajectory = 20.9, whole(start)

    def demand(event, shift=0.0):
        f = boggio.evaluate(event.position, event.time + shift)
        g = f.gradient[0]
        return abs(G + f.w_tt[0]) * np.sqrt(g @ g / (1 + g @ g))

    assert trajectory.events
    for event in trajectory.events:
        if event.kind is EventKind.SLIPS:
            assert demand(event) == pytest.approx(limit, rel=1e-6)
            assert demand(event, -1e-7) < limit < demand(event, 1e-7)
        elif event.kind is EventKind.STOPS:
            assert demand(event) <= limit
