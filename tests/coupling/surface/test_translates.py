"""Cells of a lattice that share one fit."""

from copy import copy

import numpy as np
import pytest

from coupling.surface.motion import surface_motion
from coupling.surface.translates import lattice_of
from fem_plate import Plate
from meshes import disc, rectangle
from particle import Drive
from particle.surface.cells import CellFit

PITCH, ACROSS = 150e-6, 16
TRUNCATION = 1e-2


def lattice(nx, ny):
    x, y = (PITCH * (np.arange(n) - (n - 1) / 2) for n in (nx, ny))
    return np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)


@pytest.fixture(scope="module")
def shapes(section):
    mesh = rectangle((ACROSS + 1) * PITCH, (ACROSS + 1) * PITCH, PITCH)
    return Plate(mesh, section).influence(lattice(ACROSS, ACROSS), truncation=TRUNCATION)


@pytest.fixture(scope="module")
def surface(shapes):
    rng = np.random.default_rng(0)
    return surface_motion(shapes, [Drive(1e-6, 300.0, delay=float(d)) for d in rng.uniform(0, 2e-3, ACROSS**2)])


def inside(count):
    return np.random.default_rng(1).uniform(-2.4 * PITCH, 2.4 * PITCH, (count, 2))


@pytest.mark.slow
def test_cells_a_pitch_apart_deep_in_a_lattice_have_the_same_polynomials_and_their_own_drives(surface):
    surface.evaluate(inside(50), 0.0)
    cells = surface.store.cells
    leaves = cells.cell[cells.cell["first_row"] >= 0]
    shared = [cell for cell in leaves if (leaves["first_row"] == cell.first_row).sum() > 1]
    assert len(shared) > 20
    one = shared[0]
    for other in shared[1:]:
        if other.first_row == one.first_row:
            way = np.array([other.x - one.x, other.y - one.y])
            pitches = np.round(way / PITCH)
            assert way == pytest.approx(pitches * PITCH, abs=1e-9 * PITCH)
            a, b = (cells.drive[cell.first_drive : cell.first_drive + cell.drives] for cell in (one, other))
            assert surface.sources[b] - surface.sources[a] == pytest.approx(
                np.tile(pitches * PITCH, (len(a), 1)), abs=1e-9 * PITCH
            )


@pytest.mark.slow
def test_a_shared_fit_is_as_good_as_the_cut_off_shapes_and_says_so(surface, shapes):
    xy, time = inside(300), 1.7e-3
    strokes = [drive.evaluate(time)[0] for drive in map(lambda d: Drive(1e-6, 300.0, delay=d), surface.drives.delay)]
    found, (w, gradient, hessian) = surface.evaluate(xy, time), shapes.evaluate(xy, strokes)
    assert np.abs(found.w - w).max() < surface.error * 1e-6
    assert surface.error < 3 * TRUNCATION
    assert np.abs(found.gradient - gradient).max() < 2 * TRUNCATION * np.abs(gradient).max()
    assert np.abs(found.hessian - hessian).max() < 2 * TRUNCATION * np.abs(hessian).max()


def test_near_the_ends_of_a_lattice_cells_are_their_own(surface, shapes):
    xy = (ACROSS / 2 - 0.3) * PITCH + np.random.default_rng(2).uniform(-0.4, 0.4, (100, 2)) * PITCH
    time = 1.7e-3
    strokes = [Drive(1e-6, 300.0, delay=d).evaluate(time)[0] for d in surface.drives.delay]
    assert np.abs(surface.evaluate(xy, time).w - shapes.evaluate(xy, strokes)[0]).max() < TRUNCATION * 1e-6


LATTICES = {
    "very soft": ((14, 14), (PITCH, PITCH), 1e-2),
    "narrow and soft": ((14, 40), (PITCH, PITCH / 3), 100.0),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", LATTICES)
def test_fits_are_shared_only_where_that_is_as_good_as_the_tolerance(name, section):
    counts, pitch, stiffness = LATTICES[name]
    points = lattice(*counts) / PITCH * pitch
    low = points.min(axis=0)
    mesh = rectangle(*(-2 * low + 2 * np.array(pitch)), max(pitch))
    shapes = Plate(mesh, section).influence(points, stiffness)
    surface = surface_motion(shapes, [Drive(1e-6, 300.0)] * len(points), surface_tolerance=1e-3)
    xy = np.random.default_rng(3).uniform(-1, 1, (40, 2)) * pitch
    strokes = np.random.default_rng(4).uniform(-1, 1, len(points))
    drives = [Drive(float(stroke), 300.0, cycle="up") for stroke in strokes]
    found, (w, _, hessian) = surface.driven_by(drives).evaluate(xy, 1.0), shapes.evaluate(xy, strokes)
    assert 0 < surface.error < 1e-3
    assert np.abs(found.w - w).max() < 1e-3 * shapes.own_heights().max()
    assert np.abs(found.hessian - hessian).max() < 2e-3 * np.abs(hessian).max()


@pytest.mark.slow
def test_a_block_is_moved_only_to_where_all_that_its_fits_use_is(section):
    points = np.delete(lattice(16, 12), 5, axis=0)  # at the left, five up
    shapes = Plate(rectangle(18 * PITCH, 14 * PITCH, PITCH), section).influence(points, truncation=TRUNCATION)
    grid = lattice_of(shapes)
    at = {tuple(site): row for row, site in enumerate(np.round((points - points.min(axis=0)) / PITCH).astype(int))}
    i, j = grid.middle.tolist()
    used = [at[i - 3, j], at[i + 4, j + 1], at[i, j - 2], at[i, j + 3]]
    fit = CellFit(2, np.array(used), np.ones(len(used)), np.array(used[:1]), np.zeros((4, 7)), 0.0)
    outermost = grid.spread([fit], 0)
    assert (i, j) == (7, 5) and outermost.min(axis=0).tolist() == [-4, -3] and outermost.max(axis=0).tolist() == [4, 3]
    for place in np.ndindex(40, 40):
        pitches = grid.pitches(np.array(place) - 4)
        x, y = ((np.array(place) - 4) // 2).tolist()
        there = [(x + a, y + b) in at for a in range(-3, 5) for b in range(-2, 4)]
        assert (pitches is not None) == all(there)
        if pitches is not None:
            moved = grid.moved(fit, pitches, 1e-6)
            assert points[moved.drive] - points[fit.drive] == pytest.approx(np.tile(pitches * PITCH, (4, 1)), abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("change", ["one missing in the middle", "round plate"])
def test_a_lattice_without_an_inside_shares_nothing(change, section):
    points, mesh = lattice(11, 11), rectangle(12 * PITCH, 12 * PITCH, PITCH)
    if change == "round plate":
        mesh = disc(9 * PITCH, PITCH)
    else:
        points = np.delete(points, 60, axis=0)
    shapes = Plate(mesh, section).influence(points, truncation=TRUNCATION)
    surface = surface_motion(shapes, [Drive(1e-6, 300.0)] * len(points))
    surface.evaluate(np.random.default_rng(5).uniform(-1, 1, (20, 2)) * PITCH, 0.0)
    first_row = surface.store.cells.cell["first_row"]
    leaves = first_row[first_row >= 0]
    assert len(np.unique(leaves)) == len(leaves)


def test_few_actuators_and_those_off_the_lattice_or_held_otherwise_are_none(shapes):
    moved, springs = shapes.points.copy(), shapes.springs.copy()
    moved[60] += 0.1 * PITCH
    springs[3] = 10.0
    assert lattice_of(shapes) is not None
    for changes in ({"points": moved}, {"springs": springs}, {"points": shapes.points[:90]}):
        other = copy(shapes)
        for name, values in changes.items():
            object.__setattr__(other, name, values)
        assert lattice_of(other) is None
