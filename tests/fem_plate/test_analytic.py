"""The closed forms for the clamped disc: symmetry, rim, derivatives, equation (2) at the centre (Boggio, 1905)."""

import numpy as np
import pytest

from fem_plate.analytic import DiscShapes, central_load, disc_green, smooth_part, smooth_value

RADIUS, RIGIDITY = 300e-6, 1.9e-6
SOURCES = [(0.0, 0.0), (90e-6, 40e-6), (-60e-6, 250e-6)]


@pytest.fixture
def around(spots):
    """Points on the plate away from all sources of this file."""
    distance = np.linalg.norm(spots[:, None] - np.array(SOURCES), axis=-1).min(axis=1)
    return spots[distance > 0.05 * RADIUS][:300] * 0.97


def green(xy, source):
    return disc_green(xy, source, RADIUS, RIGIDITY)


def test_shapes_of_a_disc_describe_and_draw_themselves():
    shapes = DiscShapes(SOURCES, RADIUS)
    assert repr(shapes).startswith("DiscShapes of 3 rigid actuators")
    assert shapes.plot().axes


def test_deflection_is_the_same_when_load_and_point_change_places():
    rng = np.random.default_rng(0)
    pairs = 0.6 * RADIUS * rng.uniform(-1, 1, (50, 2, 2))
    there = [green([x], y)[0][0] for x, y in pairs]
    back = [green([y], x)[0][0] for x, y in pairs]
    assert there == pytest.approx(back, rel=1e-13)


@pytest.mark.parametrize("source", SOURCES)
def test_value_and_slope_vanish_on_the_rim(source):
    angle = np.linspace(0, 2 * np.pi, 100)
    rim = RADIUS * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    w, gradient, _ = green(rim, source)
    inside = green(rim / 2, source)
    assert np.abs(w).max() < 5e-14 * np.abs(inside[0]).max()
    assert np.abs(gradient).max() < 5e-14 * np.abs(inside[1]).max()


@pytest.mark.parametrize("source", SOURCES)
def test_gradient_and_hessian_are_the_derivatives_of_the_value(around, source):
    step = 1e-3 * RADIUS

    def slope(field, axis):
        shift = step * np.eye(2)[axis]
        near, far = (field(around + k * shift) - field(around - k * shift) for k in (1, 2))
        return (8 * near - far) / (12 * step)

    _, gradient, hessian = green(around, source)
    for axis in range(2):
        by_value = slope(lambda xy: green(xy, source)[0], axis)
        by_gradient = slope(lambda xy: green(xy, source)[1], axis)
        assert np.abs(by_value - gradient[:, axis]).max() < 1e-7 * np.abs(gradient).max()
        assert np.abs(by_gradient - hessian[:, axis]).max() < 1e-7 * np.abs(hessian).max()


@pytest.mark.parametrize("source", SOURCES)
def test_no_load_acts_away_from_the_source(around, source):
    """The Laplacian of the Hessian's trace is 0: measured by differences of order four, against curvature / a^2."""
    step = 2e-3 * RADIUS

    def trace(shift):
        return np.trace(green(around + shift, source)[2], axis1=1, axis2=2)

    sides = step * np.array([[1, 0], [-1, 0], [0, 1], [0, -1]])
    laplacian = sum(16 * trace(s) - trace(2 * s) for s in sides) - 60 * trace(np.zeros(2))
    assert np.abs(laplacian / (12 * step**2)).max() * RADIUS**2 < 1e-3 * np.abs(trace(np.zeros(2))).max()


def test_shear_around_the_source_carries_the_unit_force():
    """D times the flux of grad(laplace w) through a circle around the source is the force, 1 N."""
    source, r, step = np.array([90e-6, 40e-6]), 20e-6, 0.1e-6
    angle = 2 * np.pi * np.arange(64) / 64
    normal = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    outer, inner = (np.trace(green(source + (r + s) * normal, source)[2], axis1=1, axis2=2) for s in (step, -step))
    flux = RIGIDITY * ((outer - inner) / (2 * step)).mean() * 2 * np.pi * r
    assert flux == pytest.approx(1.0, rel=1e-5)


def test_a_load_at_the_centre_gives_equation_2():
    r = np.linspace(0, RADIUS, 200)
    w = green(np.stack([0.6 * r, -0.8 * r], axis=1), (0.0, 0.0))[0]
    assert np.abs(2.5 * w - central_load(r, RADIUS, RIGIDITY, 2.5)).max() < 1e-15 * 2.5 * w.max()


def test_equation_2_at_the_centre_is_force_a2_over_16_pi_d():
    assert central_load(0.0, 2.0, 3.0, 5.0) == pytest.approx(5 * 4 / (48 * np.pi), rel=1e-15)
    assert central_load(np.array([[2.0]]), 2.0, 3.0, 5.0).shape == (1, 1)


@pytest.mark.parametrize("source", [(RADIUS, 0.0), (0.0, -2 * RADIUS), (float("nan"), 0.0)])
def test_a_source_that_is_not_inside_is_refused(source):
    with pytest.raises(ValueError, match="^Input source of disc_green must lie inside the radius 0.0003 m; got"):
        green([[0.0, 0.0]], source)


def test_the_hessian_at_the_source_is_infinite():
    w, gradient, hessian = green([SOURCES[1]], SOURCES[1])
    assert np.isfinite(w).all() and np.isfinite(gradient).all()
    assert hessian[0, 0, 0] == hessian[0, 1, 1] == -np.inf


def test_disc_shapes_are_the_greens_functions_that_meet_unit_heights(exact, layout, spots):
    by_force = np.stack([green(spots, p)[0] for p in layout], axis=1)
    compliance = np.stack([green(layout, p)[0] for p in layout], axis=1)
    expected = by_force @ np.linalg.inv(compliance)
    assert np.abs(exact.evaluate(spots)[0] - expected).max() < 1e-13


def test_disc_shapes_refuse_points_beyond_the_radius_and_doubled_ones():
    with pytest.raises(ValueError, match="point 1 at .* must lie inside the rim.*; points 0 and 2 must differ"):
        DiscShapes([[0.0, 0.0], [0.0, 1.1 * RADIUS], [0.0, 0.0]], RADIUS)


def test_the_smooth_value_is_that_of_the_smooth_part():
    rng = np.random.default_rng(4)
    x, sources = rng.uniform(-0.7, 0.7, (40, 2)), rng.uniform(-0.7, 0.7, (30, 2))
    for points in (x, sources):
        assert smooth_value(points, sources) == pytest.approx(smooth_part(points, sources)[0], abs=2e-16, rel=0)
