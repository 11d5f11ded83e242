"""Cells of a lattice that share one fit."""

import numpy as np
import pytest

from coupling.surface import surface_motion
from coupling.translates import lattice_of
from fem_plate import Plate
from meshes import disc, rectangle
from particle import Drive

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


def test_cells_a_pitch_apart_deep_in_a_lattice_have_the_same_polynomials_and_their_own_drives(surface):
    surface.evaluate(inside(50), 0.0)
    cells = surface.store.cells
    leaves = np.flatnonzero(cells.first_row >= 0)
    shared = [c for c in leaves if (cells.first_row[leaves] == cells.first_row[c]).sum() > 1]
    assert len(shared) > 20
    one = shared[0]
    for other in shared[1:]:
        if cells.first_row[other] == cells.first_row[one]:
            pitches = np.round((cells.centre[other] - cells.centre[one]) / PITCH)
            assert cells.centre[other] - cells.centre[one] == pytest.approx(pitches * PITCH, abs=1e-9 * PITCH)
            a, b = (cells.drive[cells.first_drive[c] : cells.first_drive[c + 1]] for c in (one, other))
            assert surface.sources[b] - surface.sources[a] == pytest.approx(
                np.tile(pitches * PITCH, (len(a), 1)), abs=1e-9 * PITCH
            )


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


@pytest.mark.parametrize("change", ["one moved", "one missing in the middle", "springs", "few", "round plate"])
def test_what_is_no_lattice_with_an_inside_shares_nothing(change, section):
    points, springs, mesh = lattice(11, 11), np.full(121, np.inf), rectangle(12 * PITCH, 12 * PITCH, PITCH)
    if change == "one moved":
        points[60] += 0.1 * PITCH
    if change == "one missing in the middle":
        points, springs = np.delete(points, 60, axis=0), springs[1:]
    if change == "springs":
        springs[3] = 10.0
    if change == "few":
        points, springs = points[:90], springs[:90]
    if change == "round plate":
        mesh = disc(9 * PITCH, PITCH)
    shapes = Plate(mesh, section).influence(points, springs, truncation=TRUNCATION)
    assert lattice_of(shapes, 1e-8) is None
