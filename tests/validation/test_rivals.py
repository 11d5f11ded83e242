"""The rivals that the integrator is timed against solve the same equations: their pieces agree with the product's."""

import numpy as np
import pytest
from rivals import with_numba, with_scipy
from rivals.problem import RADIUS, STARTS, path_of, problem, surface_of

from particle import Drive, Micropart, simulate

pytestmark = pytest.mark.slow
STEPS = 60


@pytest.fixture(scope="module")
def pair():
    return problem(2, STARTS[2], duration=1.5e-3)


@pytest.fixture(scope="module")
def rough():
    return problem(2, STARTS[2], duration=1.5e-3, rough=True)


@pytest.fixture(scope="module")
def surface(pair):
    return surface_of(pair)


def test_forces_are_those_of_the_drives(pair):
    at = np.empty((2, 3))
    for time in (0.0, 2e-4, 7e-4, 1.4e-3):
        span = np.searchsorted(pair.breakpoints[1:-1], time, side="right")
        with_numba.quintics(pair.forces[span], time - pair.breakpoints[span], at)
        drives = [
            Drive(pair.stroke, f, delay=d).evaluate(time) for f, d in zip(pair.frequencies, pair.delays, strict=True)
        ]
        expected = pair.shapes.strengths @ np.array(drives)
        assert np.abs(at - expected).max(axis=0) == pytest.approx(0, abs=1e-11 * np.abs(at).max())


def test_the_sum_is_the_moving_surface(pair, surface):
    xy, time = RADIUS * np.random.default_rng(0).uniform(-0.5, 0.5, (20, 2)), 1.2e-3
    true = surface.evaluate(xy, time)
    span = np.searchsorted(pair.breakpoints[1:-1], time, side="right")
    at = np.empty((2, 3))
    with_numba.quintics(pair.forces[span], time - pair.breakpoints[span], at)
    found = np.array([with_numba.plate(x, y, pair.points, at) for x, y in xy])
    expected = [true.w_tt, *true.gradient.T, *true.gradient_t.T, *true.hessian.reshape(-1, 4).T[[0, 1, 3]]]
    for mine, other in zip(expected, found.T, strict=True):
        assert np.abs(other - mine).max() < 1e-8 * np.abs(mine).max()


def test_shapes_at_a_place_are_those_of_the_sum(pair):
    """What scipy finds slips with, against the sum that its right side is made of."""
    place, unit = np.array([70e-6, -50e-6]), np.zeros((2, 3))
    found = with_scipy._shapes(pair, place)
    for k in range(2):
        unit[:] = np.eye(2)[:, k : k + 1]
        w_tt, g_x, g_y, *_ = with_numba.plate(*place, pair.points, unit)
        assert found[:, k] == pytest.approx([w_tt, g_x, g_y], rel=1e-12)


@pytest.mark.parametrize("contact", ["pair", "rough"])
def test_fixed_steps_are_those_of_the_scheme(contact, surface, request):
    which = request.getfixturevalue(contact)
    step = which.duration / STEPS
    data = (which.points, which.breakpoints, which.forces, which.friction.law, step, STEPS)
    compiled = np.array(with_numba.fixed_steps(*which.start, *data))
    scheme = path_of(which, surface)(scheme="fixed", time_step=step).position[-1]
    moved = np.hypot(*(compiled - which.start))
    assert moved > 1e-6
    assert np.hypot(*(scheme - compiled)) < 1e-9 * moved


@pytest.mark.parametrize("contact", ["pair", "rough"])
def test_scipy_ends_where_the_product_does(contact, surface, request):
    which = request.getfixturevalue(contact)
    path = path_of(which, surface)(tolerance=1e-11)
    assert len(path.events) > 1
    found = with_scipy.trace(which, with_scipy.rate_of(which), 1e-9)
    assert np.hypot(*(found.place - path.position[-1])) < 1e-7 * path.distance


def test_a_part_that_is_held_stays(pair, surface):
    glued = problem(2, (280e-6, 0.0), duration=1.5e-3)
    found = with_scipy.trace(glued, with_scipy.rate_of(glued), 1e-6)
    path = simulate(surface, Micropart(2e-9, glued.start), glued.friction, glued.duration)
    assert not path.events
    assert found.evaluations == 0 and tuple(found.place) == glued.start


@pytest.mark.parametrize(("count", "tolerance"), [(25, 1e-6), (100, 1e-9)])
def test_a_breakpoint_of_many_drives_costs_few_evaluations(count, tolerance):
    """About one step of the pair of order 5 each, as the surface at its end serves the next."""
    many = problem(count, STARTS[count], duration=5e-3)
    path = path_of(many, surface_of(many))(tolerance=tolerance)
    assert len(path.events) > 0
    assert path.evaluations < 8.5 * (len(many.breakpoints) - 1)
