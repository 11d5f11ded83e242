"""Surfaces of more shapes than actuators, and of shapes in the plane: fits, their scales, and what is refused."""

import numpy as np
import pytest

from coupling import read_surface, surface_motion, write_surface
from coupling.surface.cells import PlateCells
from fem_plate.analytic import DiscShapes
from fem_plate.elements import point_value
from particle import ConstantFriction, Drive, Micropart, simulate

RADIUS = 300e-6
POINTS = [[90e-6, 40e-6], [-60e-6, 120e-6]]
FURTHER = 6


class Corrected(DiscShapes):
    """A clamped disc with further shapes, every other one with logarithms, and motions in its plane.

    Like corrections of a plate that stretches they have r^4 ln r at the actuators.  heights: (FURTHER,), their scales.
    """

    def __init__(self, heights=1.0, truncation_error=0.0):
        super().__init__(POINTS, RADIUS)
        self.heights, self.truncation_error = np.broadcast_to(heights, FURTHER), truncation_error
        rng = np.random.default_rng(0)
        self.weights, self.planar = rng.normal(size=(FURTHER, 2)), rng.normal(size=(3, 2, 6))
        forces = 0.3 * rng.normal(size=(2, FURTHER)) * (np.arange(FURTHER) % 2)
        self.strengths = np.hstack([self.strengths, forces])

    def own_heights(self):
        return np.concatenate([np.ones(2), self.heights])

    def nonzero_values(self, xy):
        x, sources = xy / RADIUS, self.points / RADIUS
        square = ((x[:, None] - sources) ** 2).sum(axis=2)
        rim = (1 - (x**2).sum(axis=1)) ** 2
        kinks = square**2 * np.log(np.maximum(square, 1e-40)) * rim[:, None]
        values = DiscShapes(POINTS, RADIUS).nonzero_values(xy)[1]
        more = kinks @ self.weights.T + point_value(x, sources) @ self.strengths[:, 2:]
        return np.arange(2 + FURTHER), np.hstack([values, more])

    def in_plane_values(self, xy):
        x, y = (xy / RADIUS).T
        rim = 1 - x * x - y * y
        terms = np.stack([rim, rim * x, rim * y, rim * np.exp(x), rim * np.sin(3 * y), rim * x * y], axis=1)
        return np.einsum("nk,mck->nmc", terms, self.planar)

    def in_plane_heights(self):
        return np.ones(3)


DRIVES = [Drive(10e-6, 300.0 + 30 * k, delay=1e-5 * k) for k in range(2 + FURTHER)]
PLANAR = [Drive(1e-7, 600.0), Drive(-5e-8, 450.0), Drive(2e-8, 300.0, delay=2e-4)]


@pytest.fixture(scope="module")
def surface():
    return surface_motion(Corrected(), DRIVES, half_thickness=5e-6, in_plane_drives=PLANAR)


def test_points_at_times_of_their_own_are_those_at_one_time_each(surface):
    xy = np.random.default_rng(1).uniform(-0.6 * RADIUS, 0.6 * RADIUS, (20, 2))
    times = np.linspace(0.0, 9e-3, 20)
    along = surface.evaluate_along(xy, times)
    for k, time in enumerate(times.tolist()):
        for values, value in zip(along, surface.evaluate(xy[k], time), strict=True):
            assert values[k] == pytest.approx(value[0], rel=1e-11, abs=1e-13 * np.abs(values).max())
    with pytest.raises(ValueError, match="Input xy of evaluate must lie on the surface"):
        surface.evaluate_along(np.array([[0.0, 0.0], [2 * RADIUS, 0.0]]), np.zeros(2))


@pytest.fixture(scope="module")
def places():
    """Places (n, 2) all over the disc, up to its rim."""
    rng = np.random.default_rng(1)
    r, angle = np.sqrt(rng.uniform(0, 1, 400)), rng.uniform(0, 2 * np.pi, 400)
    return (1 - 1e-9) * RADIUS * np.column_stack([r * np.cos(angle), r * np.sin(angle)])


def test_the_surface_is_the_sum_of_all_its_shapes(surface, places):
    time, shapes = 1.1e-3, Corrected()
    rates = np.array([drive.evaluate(time) for drive in DRIVES])
    planar = np.array([drive.evaluate(time) for drive in PLANAR])
    state, values, in_plane = (
        surface.evaluate(places, time),
        shapes.nonzero_values(places)[1],
        shapes.in_plane_values(places),
    )
    assert surface.error < 1e-6
    for found, rate in zip((state.w, state.w_t, state.w_tt), rates.T[:3], strict=True):
        assert np.abs(found - values @ rate).max() < 2 * surface.error * np.abs(rate).sum()
    for found, rate in zip((state.u, state.u_t, state.u_tt), planar.T[:3], strict=True):
        assert np.abs(found - np.einsum("nmc,m->nc", in_plane, rate)).max() < 2 * surface.error * np.abs(rate).sum()


def test_the_gradient_is_that_of_the_material(surface, places):
    inner, h = places[np.hypot(*places.T) < 0.9 * RADIUS], 1e-9
    state = surface.evaluate(inner, 1.1e-3)
    for axis, shift in enumerate(h * np.eye(2)):
        ahead, behind = surface.evaluate(inner + shift, 1.1e-3), surface.evaluate(inner - shift, 1.1e-3)
        slope = (ahead.w - behind.w) / (2 * h)
        assert np.median(np.abs(slope - state.gradient[:, axis])) < 1e-6 * np.abs(slope).max()


def test_shapes_that_are_hardly_driven_take_fewer_cells(places):
    exact = PlateCells(Corrected(), 1e-8)
    scaled, cut = PlateCells(Corrected(heights=1e3), 1e-8), PlateCells(Corrected(truncation_error=1e-5), 1e-8)
    counts = [len(cells.cells.cell) for cells in (exact, scaled, cut)]
    assert counts[1] < 0.7 * counts[0] and counts[2] < 0.7 * counts[0]
    assert scaled.error < 2e-8 and cut.error < 1e-5


def test_what_is_not_one_a_shape_is_refused(surface):
    shapes = Corrected()
    with pytest.raises(
        ValueError, match="Input drives must be one a shape, 8; got 2; Input in_plane_drives must be one a"
    ):
        surface_motion(shapes, DRIVES[:2])
    with pytest.raises(ValueError, match="Input in_plane_drives must be one a shape in the plane, 0; got 3"):
        surface_motion(DiscShapes(POINTS, RADIUS), DRIVES[:2], in_plane_drives=PLANAR)
    with pytest.raises(ValueError, match="Input drives must be one a shape, 8; got 2"):
        surface.driven_by(DRIVES[:2], PLANAR)


def test_a_file_has_the_motion_in_the_plane_too(surface, tmp_path):
    part, law = Micropart(2e-9, (60e-6, 20e-6), centre_height=3e-6), ConstantFriction(4e-8)
    again = read_surface(write_surface(surface, tmp_path / "some.h5"))
    assert (again.in_plane_count, again.shape_count) == (3, 8)
    one, other = (simulate(each, part, law, 2e-3, tolerance=1e-6) for each in (surface, again))
    assert np.array_equal(one.time, other.time) and np.array_equal(one.position, other.position)
    still = [Drive(0.0, 300.0)] * 3
    one, other = (each.driven_by(DRIVES, still) for each in (surface, again))
    assert np.array_equal(one.evaluate(part.position, 1e-3).w_tt, other.evaluate(part.position, 1e-3).w_tt)
