"""Fixed steps over cells that are not built yet."""

from types import SimpleNamespace

import numpy as np
import pytest

from coupling.surface.motion import surface_motion
from fem_plate.analytic import DiscShapes
from particle import ConstantFriction, Drive, Micropart, SurfaceMotion, simulate
from particle.drives import monomial_table
from particle.surface.cells import NOWHERE, CellFit, CellPool

RADIUS, MASS = 300e-6, 2e-9
SCHEMES = pytest.mark.parametrize("scheme", ["fixed", "paper"])


@pytest.fixture
def surface():
    """Thirteen actuators, so that cells are built where parts come to."""
    x = np.linspace(-0.5, 0.5, 4)
    points = np.concatenate([np.stack(np.meshgrid(x[:3], x), -1).reshape(-1, 2), [[0.62, 0.1]]]) * RADIUS
    return surface_motion(DiscShapes(points, RADIUS), [Drive(6e-6, 1000.0)] * 13)


def samples(path, times):
    sampled = path.at(times)
    assert (sampled.time == times).all()
    return np.column_stack([sampled.position, sampled.velocity, sampled.height, sampled.normal_force])


@SCHEMES
def test_the_first_row_needs_a_cell_even_where_the_first_step_has_one(surface, scheme):
    """Within the first step the part goes from a cell that is not built into one that is."""
    side, middle = 0.0, 0.25 * RADIUS
    surface.store.build(np.array([[side + 1e-6, middle]]))
    cells = len(surface.store.cells.cell)
    part, run = Micropart(MASS, (side - 1e-10, middle), (0.3, 0.0)), {"scheme": scheme, "time_step": 1e-8}
    first = simulate(surface, part, ConstantFriction(1e-9), 2e-7, **run)
    again = simulate(surface, part, ConstantFriction(1e-9), 2e-7, **run)
    assert np.isfinite(first.height).all() and np.isfinite(first.normal_force).all()
    assert np.array_equal(first.height, again.height) and np.array_equal(first.energy.work, again.energy.work)
    assert first.energy.balance < 1
    assert len(surface.store.cells.cell) > cells


@SCHEMES
def test_samples_are_of_their_time_where_one_step_has_jumped_cells(surface, scheme):
    """A step's half is longer than what is built at a time: between its ends there is no cell yet."""
    part, duration = Micropart(MASS, (-0.55 * RADIUS, 0.1 * RADIUS), (1.1 * RADIUS / 1e-4, 0.0)), 1e-4
    surface.store.build(np.array([part.position]))
    path = simulate(surface, part, ConstantFriction(1e-12), duration, scheme=scheme, time_step=duration)
    times = np.linspace(0, duration, 21)
    cells = len(surface.store.cells.cell)
    found = samples(path, times)
    assert len(surface.store.cells.cell) > cells
    assert (np.diff(found[:, 0]) > 0).all()
    assert found[:, 4] == pytest.approx(
        [surface.evaluate(xy, time).w[0] for xy, time in zip(found[:, :2], times, strict=True)], rel=1e-9
    )


@SCHEMES
def test_samples_over_a_hole_that_one_step_has_jumped_keep_the_surface_before_it(scheme):
    """A square 1 m high, one that is not there, and two 2 m high."""
    pool, none = CellPool(np.zeros(2), np.ones(2), np.full((4, 1), NOWHERE)), np.zeros(0, dtype=np.int64)
    for i, height in ((0, 1.0), (2, 2.0), (3, 2.0)):
        fit = CellFit(0, np.zeros(1, dtype=np.int64), np.ones(1), none, np.array([[height]]), 0.0)
        pool.roots[i, 0] = pool.add(np.array([i + 0.5, 0.5]), np.full(2, 0.5), fit)
    surface = SurfaceMotion(monomial_table(1), SimpleNamespace(cells=pool.cells(), error=0.0), np.zeros((0, 2)), 1.0)
    part, friction = Micropart(1.0, (0.75, 0.5), (3.0, 0.0)), ConstantFriction(0.0)
    path = simulate(surface, part, friction, 1.0, scheme=scheme, time_step=1.0)
    times = np.array([0.0, 0.05, 0.2, 0.4, 0.5, 1.0])
    found = samples(path, times)
    assert found[:, 0] == pytest.approx(0.75 + 3 * times) and found[:, 2] == pytest.approx(3.0)
    assert found[:, 4].tolist() == [1, 1, 1, 1, 2, 2]
