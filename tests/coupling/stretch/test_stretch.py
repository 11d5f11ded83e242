"""A plate that stretches under the drives of a run: its reduced model beside full solutions, and kept on disk."""

import os

import numpy as np
import pytest

from coupling.case import MAX_STRETCHING
from coupling.drives import stroke_heights
from coupling.stretch import Stretch, make_model
from coupling.stretch.model import reached, training
from coupling.stretch.store import FOLDER
from fem_plate import Plate, PlateSection
from meshes import disc
from particle import Drive

RADIUS, THICKNESS, END = 500e-6, 5e-6, 10e-3
PLATE = Plate(disc(RADIUS, RADIUS / 4), PlateSection(169e9, 0.3, THICKNESS))
POINTS = RADIUS * np.array([[0.3, 0.1], [-0.25, -0.35]])
DRIVES = [Drive(THICKNESS, 300.0, "up-down"), Drive(-0.6 * THICKNESS, 400.0, "up-down")]


def model_of(large, drives=DRIVES, tell=lambda done, of: None):
    return make_model(large, [drives], END, tell)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(FOLDER, str(tmp_path_factory.mktemp("plates")))
        yield


@pytest.fixture(scope="module")
def large():
    return PLATE.large_deflection(POINTS)


@pytest.fixture(scope="module")
def model(folder, large):
    return model_of(large)


@pytest.fixture(scope="module")
def stretch(model):
    return Stretch.under(model, DRIVES, END)


@pytest.mark.parametrize("time", [0.7e-3, 1.6e-3, 4.4e-3])
def test_surface_is_that_of_a_full_solution(large, stretch, time):
    surface = stretch.surface(1e-8, 0.0)
    xy = RADIUS * np.array([[0.0, 0.0], [0.31, 0.12], [-0.5, 0.4], [0.1, -0.9]])
    full = large.solve(stroke_heights(DRIVES, np.array([time]))[0])
    state = surface.evaluate(xy, time)
    w, gradient, _ = full.evaluate(xy)
    assert np.abs(state.w - w).max() < 3e-6 * THICKNESS
    assert np.abs(state.gradient - gradient).max() < 3e-5 * np.abs(gradient).max()
    u = full.in_plane(xy)
    assert np.abs(state.u - u).max() < 2e-3 * np.abs(u).max()


def test_rates_are_those_of_differences(stretch):
    surface, time, step = stretch.surface(1e-8, 0.0), 2.1e-3, 1e-6
    xy = RADIUS * np.array([[0.1, 0.2]])
    before, now, after = (surface.evaluate(xy, time + k * step) for k in (-1, 0, 1))
    assert (after.u - before.u) / (2 * step) == pytest.approx(now.u_t, rel=1e-4)
    assert (after.w - 2 * now.w + before.w) / step**2 == pytest.approx(now.w_tt, rel=1e-3)


def test_errors_are_stated(stretch):
    assert stretch.mesh_error < 1e-5
    assert stretch.reduction_error < 1e-5
    assert stretch.piece_error <= 1e-5
    assert stretch.solutions >= 5


def test_a_stretching_plate_corrects_the_linear_one(large, stretch):
    time = 1.25e-3
    heights = stroke_heights(stretch.moving_drives, np.array([time]))[0]
    xy = RADIUS * np.array([[0.0, 0.5]])
    linear = stretch.shapes.values(xy)[:, :2] @ heights[:2]
    full = large.solve(heights[:2]).evaluate(xy)[0]
    assert abs(linear - full)[0] > 1e-3 * THICKNESS
    assert stretch.shapes.values(xy) @ heights == pytest.approx(full, abs=3e-6 * THICKNESS)


def test_extremes_are_those_of_states(stretch, large):
    largest = stretch.extremes
    assert largest.deflection == pytest.approx(large.solve([THICKNESS, -0.6 * THICKNESS]).largest, rel=0.05)
    assert 0 < largest.strain < 0.01
    assert 0 < largest.slope < 0.1


def test_a_model_is_read_from_disk_and_gives_the_same(model, large, monkeypatch):
    monkeypatch.setattr("coupling.stretch.model.reduce", lambda *_: pytest.fail("the plate is solved again"))
    again = model_of(large)
    assert again.mesh_error == model.mesh_error
    xy = RADIUS * np.array([[0.2, -0.3]])
    assert np.array_equal(again.shapes.values(xy), model.shapes.values(xy))


def test_a_model_serves_other_frequencies_and_delays_of_the_same_strokes(model, large, monkeypatch):
    monkeypatch.setattr("coupling.stretch.model.reduce", lambda *_: pytest.fail("the plate is solved again"))
    others = [Drive(THICKNESS, 700.0, "up-down", delay=1e-3), Drive(-0.6 * THICKNESS, 250.0, "up-down")]
    model_of(large, others)


def test_a_folder_that_cannot_be_written_to_is_no_hindrance(model, large, tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv(FOLDER, str(tmp_path / "file"))
    monkeypatch.setattr("coupling.stretch.model.reduce", lambda *_: model.reduction)
    assert model_of(large).reduction is model.reduction


@pytest.mark.slow
def test_a_broken_file_and_one_of_something_else_are_made_anew(model, large, tmp_path, monkeypatch):
    monkeypatch.setenv(FOLDER, str(tmp_path))
    made = []
    monkeypatch.setattr("coupling.stretch.model.reduce", lambda *_: made.append(1) or model.reduction)
    model_of(large)
    (kept,) = tmp_path.glob("*.npz")
    kept.write_bytes(kept.read_bytes()[:1000])
    model_of(large)
    np.savez(kept, stiffness=np.eye(2))
    model_of(large)
    assert len(made) == 3 and model_of(large).mesh_error == model.mesh_error and len(made) == 3


@pytest.mark.slow
def test_an_interrupted_or_killed_write_leaves_no_model(model, large, tmp_path, monkeypatch):
    monkeypatch.setenv(FOLDER, str(tmp_path))
    monkeypatch.setattr("coupling.stretch.model.reduce", lambda *_: model.reduction)

    def interrupted(file, **arrays):
        file.write(b"half")
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr("coupling.stretch.store.np.savez", interrupted)
        with pytest.raises(KeyboardInterrupt):
            model_of(large)
    assert not list(tmp_path.iterdir())
    killed, writing = tmp_path / "a.1.partial.npz", tmp_path / "b.2.partial.npz"
    for path in (killed, writing):
        path.write_bytes(b"half")
    os.utime(killed, (0, 0))
    model_of(large)
    assert not killed.exists() and writing.exists() and len(list(tmp_path.iterdir())) == 2


def test_bars_read_what_is_being_done(model, large, tmp_path, monkeypatch):
    def solved(discrete, strokes, tolerance, solve, tell):
        tell(7, 2e-4)
        return model.reduction

    monkeypatch.setenv(FOLDER, str(tmp_path))
    monkeypatch.setattr("coupling.stretch.model.reduce", solved)
    heard = []
    monkeypatch.setattr("coupling.stretch.model.doing", lambda text, share=0.0: heard.append((text, share)))
    model_of(large)
    assert heard == [
        ("stretching plate: choosing its cells", 0.0),
        ("stretching plate: 7 full solutions, error 2e-4", 0.0),
    ]


def test_training_fills_the_box_of_few_drives():
    heights = training(reached([DRIVES, [Drive(2 * THICKNESS, 300.0, "up-down"), DRIVES[1]]], END))
    assert heights.min(axis=0) == pytest.approx([0.0, -0.6 * THICKNESS])
    assert heights.max(axis=0) == pytest.approx([2 * THICKNESS, 0.0])


def test_training_follows_many_drives():
    drives = [Drive(THICKNESS, 100.0 * (k + 1), "up-down") for k in range(5)]
    heights = training(reached([drives], END))
    times = END * np.linspace(0, 1, len(heights))
    assert np.array_equal(heights, stroke_heights(drives, times))


def test_too_many_actuators_are_refused():
    x = np.linspace(-0.6, 0.6, 15) * RADIUS
    points = np.stack(np.meshgrid(x, x), axis=-1).reshape(-1, 2)
    points = points[np.hypot(*points.T) < 0.95 * RADIUS]
    large = PLATE.large_deflection(points)
    with pytest.raises(ValueError, match=f"more than {MAX_STRETCHING} actuators"):
        make_model(large, [[DRIVES[0]] * len(points)], END, lambda done, of: None)


def test_drives_that_never_move_are_refused(large):
    with pytest.raises(ValueError, match="must move it"):
        model_of(large, [Drive(0.0, 300.0, "up-down")] * 2)
