"""The surface on plates of any outline: cells over the plate's box, cut by rims, holes and corners."""

import math

import numpy as np
import pytest

from coupling.surface.motion import surface_motion
from fem_plate import Plate, Shapes
from meshes import Outline, annulus, rectangle
from particle import Drive


def on_plate(outline, count=4000):
    low, high = outline.box
    xy = np.random.default_rng(5).uniform(low, high, (count, 2))
    return xy[outline.gap(xy) >= 0]


class Bumps(Shapes):
    """One shape without logarithms, given as a function of x and y."""

    def __init__(self, outline, function):
        xy = on_plate(outline)
        self.points, self.size, self.outline = xy[[np.argmax(outline.gap(xy))]], 1.0, outline
        self.strengths, self.function = np.zeros((1, 1)), function

    def derivatives(self, x, weights):
        value = self.function(*x.T)[:, None]
        return value, np.zeros((len(x), 1, 2)), np.zeros((len(x), 1, 2, 2))

    def nonzero_values(self, xy):
        return np.arange(1), self.derivatives(xy, None)[0]

    def own_heights(self):
        return np.abs(self.derivatives(self.points, None)[0][:, 0])


def ripples(x, y):
    return np.exp(0.5 * x) * np.cos(2 * y + 1)


def edges(*corners):
    start = np.array(corners, dtype=float)
    end = np.roll(start, -1, axis=0)
    return np.stack([start, (start + end) / 2, end], axis=1)


L_SHAPE = edges((-1, -1), (1, -1), (1, 0), (0, 0), (0, 1), (-1, 1))
OUTLINES = {
    "two by one": Outline(edges=edges((-1, -0.5), (1, -0.5), (1, 0.5), (-1, 0.5))),
    "off the origin": Outline(np.array([[0.4, 0.5, 0.6, 0.6]])),
    "annulus": Outline(np.array([[0, 0, 1.0, 1.0], [0, 0, 0.37, 0.37]])),
    "a hole smaller than a cell": Outline(np.array([[0, 0, 1.0, 1.0], [0.11, 0.02, 0.05, 0.05]])),
    "upright ellipse": Outline(np.array([[0, 0, 0.2, 1.0]])),
    "L with a hole": Outline(np.array([[-0.5, -0.5, 0.2, 0.2]]), L_SHAPE),
}
UP = [Drive(1.0, 1.0, cycle="up")]


@pytest.mark.parametrize("name", OUTLINES)
def test_the_whole_plate_is_covered_to_the_stated_error(name):
    outline = OUTLINES[name]
    surface = surface_motion(Bumps(outline, ripples), UP)
    xy = np.concatenate([on_plate(outline), outline.project(on_plate(outline, 200))])
    wrong = np.abs(surface.evaluate(xy, 2.0).w - ripples(*xy.T)).max()
    assert surface.error <= 1e-8
    assert wrong < 20 * surface.error + 1e-12


def test_cells_are_square_and_as_many_as_the_box_is_long():
    surface = surface_motion(Bumps(OUTLINES["two by one"], ripples), UP)
    cells = surface.store.cells
    nx, ny = cells.roots.shape
    assert (nx, ny) == (nx, nx // 2)
    grid = cells.grid[0]
    assert (grid.width_x, grid.width_y) == pytest.approx((2 / nx, 2 / nx))
    assert (grid.x, grid.y) == pytest.approx((-1.0, -0.5))
    assert (cells.roots >= 0).all()


def test_cells_in_a_hole_are_dropped_and_points_there_refused():
    outline = Outline(np.array([[0, 0, 1.0, 1.0], [0, 0, 0.6, 0.6]]))
    surface = surface_motion(Bumps(outline, ripples), UP)
    assert surface.store.cells.roots[4, 4] == -1
    with pytest.raises(ValueError, match="must lie on the surface"):
        surface.evaluate([[0.0, 0.59]], 0.0)
    surface.evaluate([[0.0, 0.61]], 0.0)


def test_at_a_reentrant_corner_the_fit_ends_and_says_how_far_it_came():
    """r^1.54, as a clamped plate bends there: smaller cells gain a factor 3 each, without end."""
    outline = Outline(edges=L_SHAPE)

    def notch(x, y):
        return np.hypot(x, y) ** 1.54 * np.cos(1.54 * (np.arctan2(x - y, -x - y) + 0.3))

    shapes = Bumps(outline, notch)
    surface = surface_motion(shapes, UP)
    assert surface.store.cells.cell["half_x"].min() >= 2 / 8 / 2**6 / 2
    assert 1e-6 < surface.error < 1e-2
    xy = on_plate(outline)
    wrong = np.abs(surface.evaluate(xy, 2.0).w - notch(*xy.T)) / abs(notch(*shapes.points[0]))
    assert wrong.max() < 5 * surface.error
    assert wrong[np.hypot(*xy.T) > 0.2].max() < 2e-8


def test_a_shape_driven_by_a_force_counts_by_its_own_height():
    """The same shape in micrometres per newton is as well fitted."""
    whole, small = (
        surface_motion(Bumps(OUTLINES["annulus"], lambda x, y, f=f: f * ripples(x, y)), UP) for f in (1.0, 1e-6)
    )
    assert small.store.cells.cell.shape == whole.store.cells.cell.shape
    assert small.error == pytest.approx(whole.error, rel=1e-3)


@pytest.mark.parametrize(
    "mesh, supports",
    [
        (rectangle(2.0, 1.2, 0.25), "simply-supported"),
        (annulus(0.4, 1.0, 0.25), {"outer": "clamped", "inner": "free"}),
    ],
    ids=["rectangle", "annulus"],
)
def test_the_surface_of_a_plate_is_its_shapes(mesh, supports, section):
    points = np.array([[0.6, 0.2], [-0.5, -0.35]])
    shapes = Plate(mesh, section, supports).influence(points, [np.inf, 0.0])
    surface = surface_motion(shapes, [UP[0], Drive(0.5, 1.0, cycle="up")], surface_tolerance=1e-5)
    xy = on_plate(mesh.outline, 500)
    expected = shapes.evaluate(xy, [1.0, 0.5])[0]
    height = max(1.0, 0.5 * abs(shapes.evaluate(points)[0][1, 1]))
    assert np.abs(surface.evaluate(xy, 2.0).w - expected).max() < 10 * surface.error * height
    assert surface.error < 1e-5
    assert math.isfinite(surface.evaluate([[0.6, 0.2]], 2.0).hessian[0, 0, 0])
