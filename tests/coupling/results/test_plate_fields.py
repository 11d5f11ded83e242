"""The fields of the plate in a result: how fast it moves, how it is bent, what drives it."""

import json

import h5py
import numpy as np
import pytest

from coupling import Case, read_run, run_case
from coupling.case import ConstantCase, PartCase, RunCase
from coupling.drives import stroke_heights
from fem_plate import Plate, PlateSection
from fem_plate.analytic import DiscShapes
from fem_plate.arrays import patches
from meshes import disc, rectangle

RADIUS = 300e-6
PLACES = ((-75e-6, 30e-6), (90e-6, 0.0))


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    """Two actuators, the second of which pushes with a force, for less than a cycle."""
    plate = {"shape": "disc", "radius": RADIUS, "youngs_modulus": 169e9, "poisson_ratio": 0.3, "thickness": 5e-6}
    case = Case(
        plate=plate | {"cell_size": 60e-6},
        actuators=(
            {"position": PLACES[0], "stroke": 4e-6, "frequency": 300.0},
            {"position": PLACES[1], "force": 2e-4, "frequency": 430.0},
        ),
        part=PartCase(mass=2e-9, position=(10e-6, 20e-6)),
        friction=ConstantCase(limit=1.0),
        run=RunCase(duration=1.1e-3, frames=9),
        name="two",
    )
    folder = tmp_path_factory.mktemp("fields")
    return run_case(case, folder), read_run(folder / "two")


def test_the_drive_is_at_the_actuators_alone(ran):
    result, saved = ran
    drive = saved.plate_field("drive")
    np.testing.assert_array_equal(saved.actuators, PLACES)
    heights = stroke_heights(result.scene.lifts, saved.time)
    np.testing.assert_array_equal(drive[:, :2], heights.astype(np.float32))
    assert np.ptp(heights, axis=0).min() > 1e-6 and not drive[:, 2:].any()
    np.testing.assert_allclose(saved.plate_field("deflection")[:, 0], heights[:, 0], rtol=0, atol=1e-12)


def test_velocity_and_curvature_are_those_of_the_surface_under_the_part(ran):
    """Also at the actuators themselves, where the curvature is bounded."""
    result, saved = ran
    inside = result.shapes.outline.gap(saved.points) > 1e-9 * RADIUS
    assert inside[:2].all() and inside.sum() > 1000
    velocity, curvature = saved.plate_field("velocity"), saved.plate_field("curvature")
    assert velocity.dtype == curvature.dtype == np.float32 and np.isfinite(curvature).all()
    for k in (2, 7):
        state = result.surface.evaluate(saved.points[inside], saved.time[k])
        np.testing.assert_allclose(velocity[k, inside], state.w_t, rtol=0, atol=1e-6 * np.abs(state.w_t).max())
        bent = np.trace(state.hessian, axis1=1, axis2=2)
        np.testing.assert_allclose(curvature[k, inside], bent, rtol=1e-5, atol=1e-5 * np.abs(bent).max())
        assert (curvature[k, :2] < 0).all()  # the top of a hill is a dome


def test_the_curvature_is_that_of_exact_shapes():
    points, floor = np.array(PLACES), 1e-6 * RADIUS
    exact = DiscShapes(points, RADIUS)

    shapes = Plate(disc(RADIUS, 20e-6), PlateSection(169e9, 0.3, 5e-6)).influence(points)
    x = np.random.default_rng(3).uniform(-0.6, 0.6, (200, 2)) * RADIUS
    expected = np.trace(exact.evaluate(x)[2], axis1=-2, axis2=-1)
    np.testing.assert_allclose(shapes.laplacians(x, floor), expected, rtol=0, atol=1e-6 * np.abs(expected).max())


def test_patches_bend_as_the_whole_plate_and_leave_out_what_is_small(monkeypatch, section):
    monkeypatch.setattr(patches, "TILE", 4)
    pitch, floor = 25e-6, 1e-9
    plate = Plate(rectangle(25 * pitch, 4 * pitch, pitch), section)
    points = np.stack([(np.arange(24) - 11.5) * pitch, np.zeros(24)], axis=1)
    spots = np.concatenate([points, np.random.default_rng(1).uniform(-1, 1, (300, 2)) * [12 * pitch, 1.9 * pitch]])
    whole = plate.influence(points).laplacians(spots, floor)
    shapes = plate.influence(points, truncation=1e-6)
    assert len({id(tile.patch) for tile in shapes.tiles}) > 1
    largest = np.abs(whole).max(axis=0)
    every, some = shapes.laplacians(spots, floor), shapes.laplacians(spots, floor, 1e-4)
    assert np.abs((every - whole) / largest).max() < 2e-3  # a patch has cells as wide as the pitch
    bent = np.trace(shapes.evaluate(spots[24:])[2], axis1=-2, axis2=-1)
    assert np.abs((every[24:] - bent) / largest).max() < 1e-12
    left_out = np.abs((every - some).toarray()) / np.abs(np.diag(every[:24].toarray()))
    assert 0 < left_out.max() <= 1e-4 and some.nnz < 0.8 * every.nnz


def test_each_field_says_what_it_is(ran):
    result, saved = ran
    assert saved.plate_fields == ("curvature", "deflection", "drive", "velocity")
    assert {*saved.plate_fields, "state", "normal_force", "friction_force"} < saved.units.keys()
    with h5py.File(result.files[0]) as file:
        assert "like a bowl" in json.loads(file["active_surface"].attrs["units"])["curvature"]
