"""Mistakes of the surface's cells that were found and mended."""

import copy
import pickle

import numpy as np
import pytest

import meshes
from coupling import surface_motion
from coupling.surface.cells import PlateCells
from fem_plate import Plate, PlateSection
from fem_plate.analytic import DiscShapes
from particle import ConstantFriction, CoulombAdhesion, Drive, HermiteDrive, Micropart, simulate, simulate_many

RADIUS, MASS = 300e-6, 2e-9
LAW = ConstantFriction(4e-9)
SECTION = PlateSection(169e9, 0.22, 2330.0, 5e-6)


def thirteen_points():
    x = np.linspace(-0.5, 0.5, 4)
    return np.concatenate([np.stack(np.meshgrid(x[:3], x), -1).reshape(-1, 2), [[0.62, 0.1]]]) * RADIUS


def thirteen_drives():
    rng = np.random.default_rng(0)
    return [Drive(10e-6, float(f), delay=float(d)) for f, d in rng.uniform([800, 0], [1200, 1e-3], (13, 2))]


@pytest.mark.compiled
def test_a_breakpoint_at_a_cells_edge_is_no_jump_though_some_drive_has_one():
    """The cells' velocities differ by more than a jump that counts; six of these sixty parts were thrown off by it."""
    jumping = HermiteDrive([0, 1e-3], [0, 1e-16], [0, 2e-13], [0, 0])
    calm = surface_motion(DiscShapes(thirteen_points(), RADIUS), [*thirteen_drives()[:12], Drive(1e-16, 500.0)])
    restless = calm.driven_by([*thirteen_drives()[:12], jumping])
    parts = [Micropart(MASS, (x, y)) for x, y in np.random.default_rng(0).uniform(-0.4, 0.4, (60, 2)) * RADIUS]
    law = CoulombAdhesion(0.001, 3e-6)
    pairs = [simulate_many(surface, parts, law, 10e-3, tolerance=1e-6) for surface in (calm, restless)]
    for one, other in zip(*pairs, strict=True):
        assert one.outcome == other.outcome
        # Nearly without friction some paths magnify what differs by rounding.
        assert np.abs(one.position[-1] - other.position[-1]).max() < 1e-3 * RADIUS


@pytest.mark.parametrize("count", [2, 13])
def test_a_surface_and_its_paths_are_copied_and_pickled(count):
    surface = surface_motion(DiscShapes(thirteen_points()[:count], RADIUS), thirteen_drives()[:count])
    path = simulate(surface, Micropart(MASS, (60e-6, 20e-6)), LAW, 1e-3, tolerance=1e-4)
    points = np.array([[60e-6, 20e-6], [-100e-6, 90e-6]])
    for other in (pickle.loads(pickle.dumps(surface)), copy.deepcopy(surface)):
        for a, b in zip(surface.evaluate(points, 4e-4), other.evaluate(points, 4e-4), strict=True):
            assert np.array_equal(a, b)
    again = pickle.loads(pickle.dumps(path))
    assert np.array_equal(again.position, path.position)
    assert np.array_equal(again.at([3.3e-4]).position, path.at([3.3e-4]).position)


@pytest.mark.compiled  # nothing marches here and in the next
@pytest.mark.parametrize("gap", [pytest.param(10e-6, marks=pytest.mark.slow), 2e-7])
def test_actuators_at_the_rim_do_not_make_cells_without_end(gap):
    """What the plate itself is off by cannot be fitted better in smaller cells; these took minutes to hours."""
    points = [[RADIUS - gap, 0.0], [-150e-6, 0.0]]
    shapes = Plate(meshes.disc(RADIUS, 60e-6), SECTION).influence(points)
    cells = PlateCells(shapes, 1e-8)
    assert len(cells.cells.cell) < 1500
    assert cells.error > 1e-6  # and this is said


@pytest.mark.slow
@pytest.mark.compiled
def test_roughness_of_the_shapes_is_not_divided_for_ever():
    """What finite elements are off by does not become less in smaller cells."""

    class Rough(DiscShapes):
        def nonzero_values(self, points):
            rows, values = super().nonzero_values(points)
            x, y = 1e3 * points.T / RADIUS
            return rows, values + 1e-6 * self.own_heights()[rows] * np.sin(7 * x + np.cos(3 * y))[:, None]

    points = RADIUS * np.random.default_rng(0).uniform(-0.7, 0.7, (300, 2))
    smooth, rough = (PlateCells(shapes(thirteen_points(), RADIUS), 1e-8) for shapes in (DiscShapes, Rough))
    for cells in (smooth, rough):
        cells.build(points)
    assert smooth.error < 1e-8 and 5e-7 < rough.error < 2e-6
    assert len(rough.cells.cell) < 3.5 * len(smooth.cells.cell)
