"""Over many actuators breakpoints are bridged: ends stay within the tolerance, at far fewer evaluations."""

import numpy as np
import pytest
from rivals.problem import MASS, RADIUS, STARTS, problem, surface_of

from particle import Micropart, simulate

COUNT, START, DURATION = 100, STARTS[100], 6e-3


@pytest.fixture(scope="module")
def run():
    many = problem(COUNT, START, duration=DURATION)
    surface = surface_of(many)

    def path(tolerance):
        return simulate(surface, Micropart(MASS, START), many.friction, DURATION, tolerance=tolerance)

    return path, len(many.breakpoints) - 1


@pytest.mark.compiled
@pytest.mark.parametrize(("tolerance", "evaluations"), [(1e-5, 2), (1e-6, 3), (1e-8, 8)])
def test_ends_and_loads_are_as_good_as_the_tolerance(run, tolerance, evaluations):
    path, breakpoints = run
    truth, found = path(1e-11), path(tolerance)
    assert found.outcome is truth.outcome and len(found.events) == len(truth.events) > 2
    way = np.hypot(*np.diff(truth.position, axis=0).T).sum()
    assert way > 0.01 * RADIUS
    assert np.hypot(*(found.position[-1] - truth.position[-1])) < 5 * tolerance * RADIUS
    moments = np.random.default_rng(0).uniform(0, DURATION, 50)
    samples, true = found.at(moments), truth.at(moments)
    assert np.hypot(*(samples.position - true.position).T).max() < 50 * tolerance * RADIUS
    times = [one.time - other.time for one, other in zip(found.events, truth.events, strict=True)]
    assert np.abs(times).max() < 300 * tolerance * DURATION
    assert found.energy.balance < 30 * tolerance
    assert found.evaluations < evaluations * breakpoints
