"""The fitted surface against the exact sum of Boggio's functions, everywhere down to 0.002 a from an actuator."""

import numpy as np
import pytest

from coupling.surface.motion import surface_motion
from fem_plate.analytic import DiscShapes
from particle import ConstantFriction, Drive, Micropart, simulate

RADIUS, MASS = 300e-6, 2e-9


def sunflower(count):
    k = np.arange(count) + 0.5
    return 0.8 * RADIUS * np.sqrt(k / count)[:, None] * np.stack([np.cos(2.4 * k), np.sin(2.4 * k)], axis=1)


def drives(count, stroke):
    rng = np.random.default_rng(count)
    return [Drive(stroke, float(f), delay=float(d)) for f, d in rng.uniform([250, 0], [400, 2e-3], (count, 2))]


def places(points):
    rng = np.random.default_rng(0)
    angle = rng.uniform(0, 2 * np.pi, (2, 1500))
    spread = 0.999 * RADIUS * np.sqrt(rng.uniform(0, 1, 1500)) * np.array([np.cos(angle[0]), np.sin(angle[0])])
    near = RADIUS * 10 ** rng.uniform(np.log10(0.002), -1, 1500) * np.array([np.cos(angle[1]), np.sin(angle[1])])
    xy = np.concatenate([spread.T, points[rng.integers(len(points), size=1500)] + near.T])
    apart = np.min(np.linalg.norm(xy[:, None] - points, axis=2), axis=1)
    return xy[(np.hypot(*xy.T) < RADIUS) & (apart >= 0.002 * RADIUS)]


@pytest.mark.parametrize("count", [1, 9, pytest.param(36, marks=pytest.mark.slow)])
def test_height_slope_and_curvature_are_those_of_the_exact_sum(count):
    points, time = sunflower(count), 3.3e-3
    shapes, lifts = DiscShapes(points, RADIUS), drives(count, 1e-6)
    surface = surface_motion(shapes, lifts, surface_tolerance=1e-10)
    xy = places(points)
    found = surface.evaluate(xy, time)
    w, gradient, hessian = shapes.evaluate(xy, [lift.evaluate(time)[0] for lift in lifts])
    assert surface.error <= 1e-10
    assert np.abs(found.w - w).max() <= 1e-9 * 1e-6
    assert np.abs(found.gradient - gradient).max() <= 1e-7 * np.abs(gradient).max()
    assert np.abs(found.hessian - hessian).max() <= 1e-5 * np.abs(hessian).max()
    rate = shapes.evaluate(xy, [lift.evaluate(time)[1] for lift in lifts])[:2]
    assert np.abs(found.w_t - rate[0]).max() <= 1e-9 * np.abs(rate[0]).max() + 1e-9 * 1e-6 * 2 * 400 * 2
    assert np.abs(found.gradient_t - rate[1]).max() <= 1e-7 * np.abs(rate[1]).max()


@pytest.mark.compiled
@pytest.mark.parametrize("count", [1, 9, pytest.param(25, marks=pytest.mark.slow)])
def test_ends_of_paths_hardly_change_with_the_fit(count):
    """In the median over a few starts, each by one stroke or two: longer paths magnify any difference."""
    shapes, lifts = DiscShapes(sunflower(count), RADIUS), drives(count, 120e-6 / count**0.25)
    fitted, exact = (surface_motion(shapes, lifts, tolerance) for tolerance in (1e-10, 1e-12))
    changes = []
    for x, y in np.random.default_rng(3).uniform(-0.5, 0.5, (9, 2)) * RADIUS:
        one, other = (
            simulate(s, Micropart(MASS, (x, y)), ConstantFriction(8.0 * MASS), 6e-3, tolerance=1e-11)
            for s in (fitted, exact)
        )
        way = np.linalg.norm(np.diff(one.position, axis=0), axis=1).sum()
        if way > 0.01 * RADIUS:
            changes.append(np.linalg.norm(one.position[-1] - other.position[-1]) / way)
    assert len(changes) > 3
    assert np.median(changes) <= 1e-7
