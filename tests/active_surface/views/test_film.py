"""What a film shows: heights, where from, how fast, when, how large, and what lies on the present surface."""

from dataclasses import replace

import numpy as np
import pytest
from made_runs import SIDE, grid, hill, made_run

from active_surface.views.film import scene as scenes
from active_surface.views.film.layout import (
    BESIDE_AXIS,
    BOTTOM,
    CAMERAS,
    LEFT,
    RIGHT,
    TOP,
    camera_of,
    layout_of,
    size_of,
)
from active_surface.views.film.pace import MAX_FRAMES, MIN_FRAMES_PER_CYCLE, pace_of, warnings_of
from active_surface.views.film.scene import scene_of, shapes_of
from active_surface.views.geometry import spots_of
from particle import State

LONG = np.stack([np.linspace(-4e-4, 4e-4, 5), np.zeros(5)], axis=1)  # a path across the plate
RANDOM = SIDE * (np.random.default_rng(1).random((300, 2)) - 0.5)


def test_a_camera_is_a_name_or_two_angles():
    assert camera_of(" Top ") == CAMERAS["top"] == camera_of((-90, 90))
    assert camera_of("-60, 30") == (-60.0, 30.0)
    for text in ("bottom", "30", "30,91", "nan,3", "1,2,3", "inf,3", "", None, 3, (1, 2, 3)):
        with pytest.raises(ValueError, match="Input camera must be iso, top, front, side, or azimuth,elevation"):
            camera_of(text)


@pytest.mark.parametrize("camera", [*CAMERAS.values(), (200.0, -90.0), (-17.0, 45.0)])
def test_right_up_and_towards_are_at_right_angles(camera):
    axes = layout_of(scene_of(rising()), camera, (640, 360), 1.0).axes
    assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-12) and np.linalg.det(axes) == pytest.approx(1)
    assert axes[0, 2] == 0
    if camera == CAMERAS["top"]:
        assert axes == pytest.approx(np.eye(3), abs=1e-12)


def test_a_film_without_a_wish_lasts_about_eight_seconds():
    for duration in (3e-9, 1e-3, 0.02, 0.05, 0.6, 4.0, 70.0, 1e5):
        pace = pace_of(np.array([0.0, duration]), 30.0, None)
        assert 6.5 < pace.lasts < 9.5
        assert pace.times[0] == 0 and pace.times[-1] == duration
        assert pace.lasts == pytest.approx(duration * pace.slow_motion, abs=2 / 30)


def test_the_pace_is_said_in_words():
    words = [pace_of(np.array([0.0, d]), 10.0, s).words for d, s in ((0.1, 50.0), (1.0, 1.0), (100.0, 0.04))]
    assert words == ["50 times slower", "in real time", "25 times faster"]


def test_one_step_is_one_frame_and_a_short_film_has_two():
    assert pace_of(np.array([0.2]), 30.0, None).times.tolist() == [0.2]
    assert pace_of(np.array([0.0, 1e-6]), 30.0, 1.0).times.tolist() == [0.0, 1e-6]


@pytest.mark.parametrize(("duration", "slower"), [(0.05, 1.0), (0.049, 10.0), (1.0, 0.37), (0.1, 3.0)])
def test_a_film_is_as_fast_as_it_says_up_to_the_frame_of_the_end(duration, slower):
    times = pace_of(np.array([0.0, duration]), 30.0, slower).times
    assert np.diff(times)[:-1] * slower == pytest.approx(1 / 30) and times[-1] == duration
    assert 0 < np.diff(times)[-1] * slower <= (1 + 1e-6) / 30


def test_a_run_that_is_shorter_than_a_frame_is_said_to_be():
    time = np.array([0.0, 1e-6])
    assert "shorter than a frame" in warnings_of(pace_of(time, 30.0, 1.0), time, None)[0]
    assert not any("shorter" in said for said in warnings_of(pace_of(time, 30.0, None), time, None))


def test_films_of_too_many_frames_are_refused():
    with pytest.raises(ValueError, match=f"at most {MAX_FRAMES} frames"):
        pace_of(np.array([0.0, 1.0]), 30.0, 1e9)


def test_what_a_film_does_not_show_is_said():
    time = np.linspace(0, 1, 11)
    assert warnings_of(pace_of(time, 10.0, 2.0), time, 0.5) == []
    said = warnings_of(pace_of(time, 10.0, 6.0), time, 0.05)
    assert "6 frames to each stored step" in said[0] and "3 frames per cycle" in said[1]
    assert MIN_FRAMES_PER_CYCLE > 3 and warnings_of(pace_of(time[:1], 10.0, 6.0), time[:1], 0.05) == []


def rising():
    """A plate that rises by 1 um in each step, with a hill that goes from left to right."""
    points = grid()[0]
    heights = [1e-6 * k + hill(points, 2e-5, (x, 0.0)) for k, x in enumerate(np.linspace(-4e-4, 4e-4, 5))]
    return made_run(LONG, np.stack(heights), state=[0, 0, 1, 1, 0])


def surface_of(scene, moment):
    return shapes_of(scene.surface) @ moment.amplitudes


def test_heights_and_places_are_linear_between_stored_steps_and_the_state_is_that_of_the_step_before():
    scene = scene_of(rising())
    moments = scene.moments(np.array([0.0, 1.25e-3, 2e-3, 4e-3]))
    stored = [surface_of(scene, moment) for moment in scene.moments(scene.run.time)]
    assert surface_of(scene, moments[1]) == pytest.approx(0.75 * stored[1] + 0.25 * stored[2], abs=1e-15)
    assert surface_of(scene, moments[3]) == pytest.approx(stored[4], abs=1e-15)
    assert moments[1].part[0] == pytest.approx(-1.5e-4)
    assert [moment.state for moment in moments] == [State.STICK, State.STICK, State.SLIP, State.STICK]


@pytest.mark.parametrize("together", [64, 7])
def test_the_surface_is_that_of_the_run(monkeypatch, together):
    monkeypatch.setattr(scenes, "BATCH", together)
    points = grid()[0]
    run = made_run(
        np.linspace([-4e-4, 0], [4e-4, 0], 40), np.stack([hill(points, 1e-6 * np.sin(k)) for k in range(40)])
    )
    scene = scene_of(run)
    places = (scene.surface.points[:, :2]) * scene.size + scene.frame.mean(axis=0)
    for k in (0, 3, 39):
        (moment,) = scene.moments(run.time[[k]])
        assert surface_of(scene, moment) == pytest.approx(hill(places, 1e-6 * np.sin(k)), abs=2e-8)
        assert moment.under == pytest.approx(hill(moment.part[None, :2], 1e-6 * np.sin(k))[0], abs=2e-8)


def test_what_happens_in_a_few_of_many_steps_is_shown():
    """Of two actuators one moves all the time, the other in three steps."""
    points, step = grid()[0], np.arange(2000)
    pulse = np.isin(step, (1001, 1002, 1003))
    heights = np.outer(np.sin(step) ** 2, hill(points, 1e-5)) + np.outer(pulse, hill(points, 1e-5, (3e-4, 3e-4)))
    scene = scene_of(made_run(np.zeros((2000, 2)), heights))
    (moment,) = scene.moments(scene.run.time[[1002]])
    assert surface_of(scene, moment).max() == pytest.approx(heights[1002].max(), rel=0.01)
    assert scene.range[1] == pytest.approx(heights.max(), rel=0.01)


def test_drawn_heights_are_nearer_to_a_hill_than_the_stored_triangles_are():
    run = made_run(LONG, lambda points: hill(points, 1.0))
    scene = scene_of(run)
    flat = (run.heights[0][(spots := spots_of(run.points, run.triangles, RANDOM)).corners] * spots.weights).sum(axis=1)
    drawn = scene.shapes_at(RANDOM) @ scene.amplitudes[0]
    assert np.abs(drawn - hill(RANDOM, 1.0)).max() < 0.4 * np.abs(flat - hill(RANDOM, 1.0)).max()


def test_light_follows_the_slopes_of_the_surface():
    scene = scene_of(rising())
    points = scene.surface.points[:, :2] * scene.size
    (moment,) = scene.moments(np.array([2e-3]))
    slopes = scene.slopes @ moment.amplitudes
    expected = -2 * points.T / 2e-4**2 * hill(points, 2e-5)
    assert np.abs(slopes - expected).max() < 0.1 * np.abs(expected).max()


def test_the_trail_ends_at_the_path_and_is_dense():
    scene = scene_of(rising())
    trail, then = scene.trail
    assert (trail[[0, -1]] == LONG[[0, -1]]).all() and then[[0, -1]].tolist() == [0.0, 4e-3]
    assert np.hypot(*np.diff(trail, axis=0).T).max() < 1e-2 * scene.size
    assert trail[:, 0] == pytest.approx(np.interp(then, scene.run.time, LONG[:, 0]))


def test_the_part_and_its_trail_are_where_the_integrator_found_it_between_stored_steps():
    run = made_run(LONG[[0, 4]], lambda points: hill(points, 1e-5), time=[0.0, 4e-3], state=1)
    bent = LONG + np.array([[0, 0], [0, 1e-4], [0, 2e-4], [0, 1e-4], [0, 0]])
    state = np.array([0, 1, 2, 1, 0])
    rows = run.rows._replace(time=1e-3 * np.arange(5), position=bent, state=state)
    scene = scene_of(replace(run, rows=rows))
    assert scene.trail[0][:, 1].max() == pytest.approx(2e-4, rel=0.02)
    (moment,) = scene.moments(np.array([2.5e-3]))
    assert moment.part[:2] == pytest.approx([1e-4, 1.5e-4]) and moment.state is State.FLIGHT
    half = scene_of(replace(run, rows=rows, time=np.array([0.0, 2e-3])))
    assert half.trail[1].max() <= 2e-3


def test_the_path_has_the_stored_steps_where_rows_are_far_apart():
    run = made_run(LONG + np.array([[0, 0], [0, 1e-4], [0, 2e-4], [0, 1e-4], [0, 0]]), lambda p: hill(p, 1e-5))
    few = run.rows._replace(**{name: getattr(run.rows, name)[[0, 4]] for name in ("time", "position", "state")})
    scene = scene_of(replace(run, rows=few))
    assert (scene.path == run.position[:, :2]).all() and (scene.path_time == run.time).all()


def test_further_parts_are_in_the_frame_and_stay_where_they_were_lost():
    run = made_run(LONG / 20 + 1e-4, lambda points: hill(points, 1e-5))
    other = made_run((LONG / 20 - 3e-5)[:3], lambda points: hill(points, 1e-5))
    scene = scene_of(run, [other])
    (beside,) = scene.others
    assert scene.colour and beside.colour and scene.colour != beside.colour
    for path in (run.position, other.position):
        assert ((path[:, :2] > scene.frame[0]) & (path[:, :2] < scene.frame[1])).all()
    now, late = beside.moments(np.array([1e-3, 3.5e-3]))
    assert now.part[:2] == pytest.approx(other.position[1, :2]) and late.part[:2] == pytest.approx(
        other.position[2, :2]
    )
    assert late.amplitudes == pytest.approx(scene.moments(np.array([3.5e-3]))[0].amplitudes)


def test_flight_is_counted_from_the_surface():
    scene = scene_of(made_run(LONG, lambda points: np.full(len(points), 1e-6), state=2, above=5e-6))
    (moment,) = scene.moments(np.array([1e-3]))
    assert moment.flight == pytest.approx(4e-6)


@pytest.mark.parametrize(
    ("camera", "size"), [*zip(CAMERAS, [(1280, 720), (330, 500), (320, 320), (330, 500)], strict=True)]
)
def test_the_surface_fills_its_part_of_the_picture_at_all_times(camera, size):
    scene = scene_of(rising())
    layout = layout_of(scene, CAMERAS[camera], size, 10.0)
    points = scene.surface.points[:, :2] * scene.size + scene.frame.mean(axis=0)
    moments = scene.moments(scene.run.time)
    seen = np.concatenate([layout.pixels(layout.places(points, surface_of(scene, moment))) for moment in moments])
    left = BESIDE_AXIS if layout.level else LEFT
    room = np.array([[left, BOTTOM], [RIGHT, TOP]]) * size
    assert (seen >= room[0] - 1).all() and (seen <= room[1] + 1).all()
    assert (np.ptp(seen, axis=0) / np.ptp(room, axis=0)).max() > 0.9


def test_a_size_is_two_numbers_of_pixels():
    assert size_of("1280x720") == (1280, 720) == size_of(" 1280 × 720 ")
    for text in ("1280", "0x0", "100x720", "20000x720", "-3x5", "axb", None, 5):
        with pytest.raises(ValueError, match="Input size must be"):
            size_of(text)
    with pytest.raises(ValueError, match="got 10x20"):
        size_of((10, 20))


def test_a_short_path_is_shown_in_a_window_and_a_part_at_rest_on_the_whole_plate():
    short = scene_of(made_run(LONG / 20 + 1e-4, lambda points: hill(points, 1e-5)))
    assert short.window and short.size < 0.4 * SIDE and len(short.trail[0])
    assert np.abs(short.surface.points[:, :2]).max() == pytest.approx(0.5)
    assert short.shapes_at(np.array([[1e-4, 1e-4]])) @ short.amplitudes[0] == pytest.approx(
        hill(np.array([[1e-4, 1e-4]]), 1e-5), rel=1e-2
    )
    rest = scene_of(made_run(np.zeros((5, 2)), lambda points: hill(points, 1e-5), state=0))
    assert not rest.window and len(rest.trail[0]) == 0


def test_a_window_over_a_hole_ends_at_its_rim():
    holes = {(i, j) for i in range(10, 13) for j in range(10, 13)}
    scene = scene_of(made_run(LONG / 20 - 3e-5, lambda points: hill(points, 1e-5), holes=holes))
    centres = scene.surface.cell_centers().points[:, :2] * scene.size + scene.frame.mean(axis=0)
    x, y = centres.T
    assert scene.window and not ((x > 5e-6) & (x < 1.45e-4) & (y > 5e-6) & (y < 1.45e-4)).any()
    assert scene.rim.n_cells


def test_lines_of_the_net_are_round_places():
    scene = scene_of(rising())
    places = scene.net.points[:, :2] * scene.size + scene.frame.mean(axis=0)
    apart = np.abs(places / scene.mesh_width - np.rint(places / scene.mesh_width)).min(axis=1)
    assert scene.mesh_width == pytest.approx(1e-4) and apart.max() < 1e-6


def test_crowded_actuators_are_not_marked(monkeypatch):
    def marks(count):
        return len(scene_of(made_run(LONG, lambda points: hill(points, 1e-5), actuators=count)).actuators)

    assert marks(1) == 1 and marks(100) == 100
    monkeypatch.setattr(scenes, "CROWDED", 0.1)
    assert marks(100) == 0
