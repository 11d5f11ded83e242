"""The surface as the part sees it: polynomials, and the plate's shapes under drives."""

import math
import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.polynomial import polynomial

from coupling.surface.motion import surface_motion
from fem_plate import Plate
from fem_plate.analytic import DiscShapes
from meshes import disc
from particle import Drive, polynomial_surface
from particle.surface.at_point import surface_at
from particle.surface.cells import UNBUILT, CellPool
from particle.surface.local import new_local, within_cell
from particle.surface.span import enter

DRIVES = [Drive(150e-6, 300), Drive(-60e-6, 450, cycle="up", delay=0.2e-3)]
NAMES = ("w", "w_t", "w_tt", "gradient", "gradient_t", "hessian")
TIMES = [0.0, 0.1e-3, 1.3e-3, 1 / 600, 2.9e-3, 10e-3]


@pytest.fixture(scope="module")
def surface(exact):
    return surface_motion(exact, DRIVES)


def close(found, expected, bound):
    scale = np.abs(expected).max()
    assert np.abs(np.asarray(found) - expected).max() <= bound * scale + 1e-300


@pytest.mark.parametrize("time", [math.nan, math.inf])
def test_a_time_that_is_none_is_named(surface, time):
    with pytest.raises(ValueError, match=f"^Input time of evaluate must be a finite number of seconds; got {time}$"):
        surface.evaluate([[0.0, 0.0]], time)


def test_it_is_shown_in_a_line(exact):
    surface = surface_motion(exact, DRIVES)
    shown = r"<SurfaceMotion: drives 2, cells built [1-9]\d*, error \d\.\de-\d\d>"
    assert re.fullmatch(shown, repr(surface))
    none = CellPool(np.zeros(2), np.ones(2), np.array([[UNBUILT]])).cells()
    unbuilt = replace(surface, store=SimpleNamespace(cells=none, error=0.0))
    assert repr(unbuilt) == "<SurfaceMotion: drives 2, cells built 0, error not measured>"


@pytest.mark.parametrize("size", [1.0, 0.02])
@pytest.mark.parametrize("shape", [(1, 1), (3, 2), (2, 4, 3), (4, 3, 6)], ids=str)
def test_a_polynomial_surface_is_its_polynomial_with_all_derivatives(shape, size):
    rng = np.random.default_rng(0)
    c = rng.normal(size=shape)
    surface, xy = polynomial_surface(c, size=size), rng.uniform(-1, 1, (20, 2))
    cube = c[:, :, None] if c.ndim == 2 else c
    for time in (0.0, 0.37, 2.1):

        def derived(i, j, k, time=time):
            table = cube
            for axis, order in enumerate((i, j, k)):
                table = polynomial.polyder(table, order, axis=axis) if order else table
            return polynomial.polyval3d(*xy.T, np.full(len(xy), time), table)

        state = surface.evaluate(xy, time)
        expected = {
            "w": derived(0, 0, 0),
            "w_t": derived(0, 0, 1),
            "w_tt": derived(0, 0, 2),
            "gradient": np.stack([derived(1, 0, 0), derived(0, 1, 0)], axis=1),
            "gradient_t": np.stack([derived(1, 0, 1), derived(0, 1, 1)], axis=1),
            "hessian": np.stack(
                [derived(2, 0, 0), derived(1, 1, 0), derived(1, 1, 0), derived(0, 2, 0)], axis=1
            ).reshape(-1, 2, 2),
        }
        for name in NAMES:
            assert np.abs(getattr(state, name) - expected[name]).max() < 1e-11 * max(1, np.abs(expected[name]).max())


@pytest.mark.parametrize("shape", [(3,), (2, 2, 7), (1, 1, 1, 1), (2, 2, 0)], ids=str)
def test_a_polynomial_surface_of_another_shape_is_refused(shape):
    with pytest.raises(ValueError, match="^Input coefficients"):
        polynomial_surface(np.zeros(shape))


def test_a_polynomial_surface_has_no_rim():
    assert polynomial_surface([[1.0, 2.0]]).evaluate([[1e6, 1e6]], 0.0).w == pytest.approx(1 + 2e6)


@pytest.mark.parametrize("time", TIMES)
def test_the_surface_is_the_shapes_raised_by_their_drives(surface, exact, spots, time):
    strokes = np.array([drive.evaluate(time) for drive in DRIVES])
    state = surface.evaluate(spots, time)
    shape, slope, bend = exact.evaluate(spots)
    scale = 150e-6
    for order, (height, tilt) in enumerate([("w", "gradient"), ("w_t", "gradient_t"), ("w_tt", None)]):
        h = strokes[:, order]
        unit = scale * 300.0**order
        assert np.abs(getattr(state, height) - shape @ h).max() < 1e-8 * unit * 40**order
        if tilt:
            tilts = np.einsum("nid,i->nd", slope, h)
            assert np.abs(getattr(state, tilt) - tilts).max() < 1e-7 * np.abs(slope).max() * unit * 40**order
    bends = np.einsum("nide,i->nde", bend, strokes[:, 0])
    assert np.abs(state.hessian - bends).max() < 1e-6 * np.abs(bend).max() * scale


def test_the_fields_are_each_others_derivatives(surface, spots, radius):
    inner, time = spots[np.hypot(*spots.T) < 0.95 * radius][:300], 0.9e-3
    step, dt = 1e-4 * radius, 1e-7
    state = surface.evaluate(inner, time)
    for axis in range(2):
        shift = step * np.eye(2)[axis]
        after, before = surface.evaluate(inner + shift, time), surface.evaluate(inner - shift, time)
        for value, derivative in [("w", "gradient"), ("w_t", "gradient_t"), ("gradient", "hessian")]:
            by_steps = (getattr(after, value) - getattr(before, value)) / (2 * step)
            close(by_steps, getattr(state, derivative)[:, axis], 3e-5)
    after, before = surface.evaluate(inner, time + dt), surface.evaluate(inner, time - dt)
    for value, derivative in [("w", "w_t"), ("w_t", "w_tt"), ("gradient", "gradient_t")]:
        close((getattr(after, value) - getattr(before, value)) / (2 * dt), getattr(state, derivative), 1e-5)


def test_the_stated_error_is_that_of_the_unit_shapes(surface, exact, spots, layout):
    """Each shape alone, raised by 1 m; the worst of it within a factor 3 of what the record states."""
    held = [Drive(1.0, 1.0, cycle="up"), Drive(0.0, 1.0, cycle="up")]
    shape, worst = exact.evaluate(spots)[0], 0.0
    for i, drives in enumerate([held, held[::-1]]):
        found = surface_motion(exact, drives).evaluate(spots, 2.0).w
        worst = max(worst, np.abs(found - shape[:, i]).max())
    assert surface.error <= 1e-8
    assert surface.error / 3 < worst < 3 * surface.error


def test_a_smaller_tolerance_takes_finer_cells_and_meets_it(exact):
    coarse, fine = (surface_motion(exact, DRIVES, surface_tolerance=t) for t in (1e-6, 1e-12))
    assert len(fine.store.cells.cell) > len(coarse.store.cells.cell)
    assert fine.store.cells.cell["half_x"].min() < coarse.store.cells.cell["half_x"].min()
    assert fine.error <= 1e-12 < coarse.error <= 1e-6


def test_cells_hold_a_little_beyond_their_sides(surface, exact):
    """A step of the integrator may end up to `overhang` half widths from a cell's centre."""
    record = surface.record
    local, corners = new_local(record), np.array([[1, 1], [-1, 1], [1, -1], [-1, -1], [1, 0], [0, -1]])
    cell = enter(record, local, 0.1 * surface.size, -0.2 * surface.size, 1e-3, math.inf)
    one = record.cells.cell[cell]
    outside = (one.x, one.y) + surface.overhang * corners * (one.half_x, one.half_y)
    strokes = [drive.evaluate(1e-3)[0] for drive in DRIVES]
    for (x, y), truth in zip(outside, exact.evaluate(outside, strokes)[0], strict=True):
        assert within_cell(local, 0.999 * x, 0.999 * y) and not within_cell(local, x + surface.size, y)
        assert surface_at(local, x, y, 1e-3).w == pytest.approx(truth, abs=1e-8 * 150e-6)


def test_there_must_be_one_drive_an_actuator(exact):
    with pytest.raises(ValueError, match="^Input drives must be one an actuator, 2; got 1$"):
        surface_motion(exact, DRIVES[:1])


def test_a_point_beyond_the_rim_is_refused_and_one_on_it_is_not(surface, radius):
    surface.evaluate([[0.6 * radius, 0.8 * radius]], 1e-3)
    with pytest.raises(ValueError, match="^Input xy of evaluate must lie on the surface; got"):
        surface.evaluate([[0.0, 0.0], [0.0, 1.001 * radius]], 1e-3)


def test_the_hessian_stays_finite_at_an_actuator_and_stops_growing_at_the_floor(surface, layout):
    for shift in (0.0, 0.3, 0.99):
        state = surface.evaluate(layout + shift * np.array([surface.floor, 0.0]), 1e-3)
        assert np.isfinite(state.hessian).all()
    assert surface.floor == pytest.approx(1e-6 * surface.size)
    reach = surface.evaluate(layout[:1] + [[2 * surface.floor, 0]], 1e-3).hessian[0, 1, 1]
    top = surface.evaluate(layout[:1] + [[0.5 * surface.floor, 0]], 1e-3).hessian[0, 1, 1]
    assert abs(top) > abs(reach)


def test_finite_elements_give_the_closed_forms_surface(section, radius, layout, exact, spots, surface):
    shapes = Plate(disc(radius, radius / 8), section).influence(layout)
    found, truth = surface_motion(shapes, DRIVES).evaluate(spots, 1.1e-3), surface.evaluate(spots, 1.1e-3)
    for name, bound in zip(NAMES, (1e-7, 1e-7, 1e-7, 3e-6, 3e-6, 5e-5), strict=True):
        close(getattr(found, name), getattr(truth, name), bound)


def test_a_surface_from_finite_elements_needs_no_finer_cells_than_the_exact_one(section, radius, layout, surface):
    shapes = Plate(disc(radius, radius / 12), section).influence(layout)
    assert surface_motion(shapes, DRIVES).store.cells.cell.shape == surface.store.cells.cell.shape


def test_a_close_pair_of_actuators_is_fitted_relative_to_its_steep_shapes(radius):
    shapes = DiscShapes([[100e-6, 0.0], [110e-6, 0.0]], radius)
    assert surface_motion(shapes, DRIVES).error <= 1e-8


def test_time_may_lie_before_the_start(surface):
    assert surface.evaluate([[0.0, 0.0]], -1e-3).w == 0.0
    assert math.isfinite(surface.evaluate([[0.0, 0.0]], 1e3).w_tt[0])


def test_pairs_close_together_do_not_set_the_grid_of_the_whole_plate():
    radius, apart = 300e-6, 0.4e-6
    left = np.random.default_rng(0).uniform(-0.5, 0.5, (6, 2)) * radius
    points = np.concatenate([left, left + [apart, 0.0]])
    shapes, stroke = DiscShapes(points, radius), 1e-6
    surface = surface_motion(shapes, [Drive(stroke, 300.0, cycle="up")] * 12)
    assert surface.store.cells.roots.size <= 16 * 12 * 1.2
    xy = np.concatenate([left + [apart / 2, apart], left + [5 * apart, 0.0], left + [0.1 * radius, 0.0]])
    found, (w, gradient, _) = surface.evaluate(xy, 1.0), shapes.evaluate(xy, np.full(12, stroke))
    close(found.w, w, 1e-7)
    close(found.gradient, gradient, 1e-4)
    assert surface.error < 1e-7
