"""What a film shows: smooth heights, where from, how fast, when, how large, and what lies on the present surface."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from made_runs import SIDE, grid, hill, made_run

from active_surface.views.film.camera import CAMERAS, Camera, camera_of
from active_surface.views.film.frames import frames_of
from active_surface.views.film.layout import BESIDE_AXIS, BOTTOM, LEFT, RIGHT, TOP, layout_of, size_of
from active_surface.views.film.pace import MAX_FRAMES, MIN_FRAMES_PER_CYCLE, pace_of, warnings_of
from active_surface.views.film.stage import stage_of
from active_surface.views.lines import path_points
from active_surface.views.smooth import Smooth
from particle import State

LONG = np.stack([np.linspace(-4e-4, 4e-4, 5), np.zeros(5)], axis=1)  # a path across the plate
RANDOM = SIDE * (np.random.default_rng(1).random((300, 2)) - 0.5)


def quadratic(xy):
    return 1e-6 + 2e-3 * xy[:, 0] - 3e-3 * xy[:, 1] + xy[:, 0] * xy[:, 1] + 2 * xy[:, 0] ** 2 - xy[:, 1] ** 2


def test_smooth_heights_are_exact_for_quadratics_and_at_the_points():
    smooth = Smooth(*grid())
    assert smooth.at(RANDOM) @ quadratic(smooth.points) == pytest.approx(quadratic(RANDOM), abs=1e-18)
    any_heights = np.random.default_rng(2).random(len(smooth.points))
    assert smooth.at(smooth.points) @ any_heights == pytest.approx(any_heights, abs=1e-12)


def test_smooth_heights_are_nearer_to_a_hill_than_flat_triangles_are():
    smooth, truth = Smooth(*grid()), hill(RANDOM, 1.0)
    triangle, shares, _ = smooth.locate(RANDOM)
    flat = (hill(smooth.points, 1.0)[smooth.triangles[triangle]] * shares).sum(axis=1)
    rounded = smooth.at(RANDOM) @ hill(smooth.points, 1.0)
    assert np.abs(rounded - truth).max() < 0.2 * np.abs(flat - truth).max()


def test_heights_meet_along_the_edges_of_triangles():
    smooth, heights = Smooth(*grid()), hill(grid()[0], 1.0, (1e-4, 5e-5))
    edge = smooth.points[smooth.triangles[7][:2]].mean(axis=0)
    sides = np.array([edge + 1e-12, edge - 1e-12])
    assert np.ptp(smooth.at(sides) @ heights) < 1e-6


def test_a_place_off_the_plate_is_known_to_be_and_has_the_nearest_of_the_rim():
    smooth = Smooth(*grid(holes={(5, 5)}))
    in_hole = SIDE * (5.5 / 20 - 0.5) * np.ones(2)
    triangle, shares, inside = smooth.locate(np.array([[0.0, 0.0], [0.6 * SIDE, 1e-5], in_hole]))
    assert inside.tolist() == [True, False, False]
    place = (smooth.points[smooth.triangles[triangle]] * shares[..., None]).sum(axis=1)
    assert place[1, 0] == pytest.approx(SIDE / 2) and abs(place[1, 1] - 1e-5) < SIDE / 20


def test_many_points_are_located_in_blocks_that_take_little_memory():
    smooth = Smooth(*grid())
    xy = SIDE * (np.random.default_rng(3).random((20_000, 2)) - 0.5)
    smooth.locate(xy[:1])
    tracemalloc.start()
    found = smooth.locate(xy)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 60e6 and [len(part) for part in found] == 3 * [20_000]
    for some, all_of_them in zip(smooth.locate(xy[4090:4100]), found, strict=True):
        assert (some == all_of_them[4090:4100]).all()


def test_two_triangles_have_flat_heights():
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    smooth = Smooth(corners, np.array([[0, 1, 2], [0, 2, 3]]))
    assert smooth.at(np.array([[0.3, 0.1], [0.5, 0.5]])) @ np.full(4, 2.0) == pytest.approx([2.0, 2.0])


@pytest.mark.parametrize("camera", [*CAMERAS.values(), Camera(200.0, -90.0), Camera(-17.0, 45.0)])
def test_right_up_and_towards_are_at_right_angles(camera):
    axes = np.stack([camera.right, camera.up, camera.towards])
    assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-12) and np.linalg.det(axes) == pytest.approx(1)
    assert camera.right[2] == 0


def test_from_the_top_x_points_right_and_y_up():
    assert CAMERAS["top"].flat(np.eye(3)) == pytest.approx(np.array([[1, 0], [0, 1], [0, 0]]), abs=1e-12)


def test_a_camera_is_a_name_or_two_angles():
    assert camera_of(" Top ") is CAMERAS["top"]
    assert camera_of("-60, 30") == Camera(-60.0, 30.0)
    for text in ("bottom", "30", "30,91", "nan,3", "1,2,3", "inf,3", ""):
        with pytest.raises(ValueError, match="Input camera must be iso, top, front, side, or azimuth,elevation"):
            camera_of(text)


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


def test_heights_and_places_are_linear_between_stored_steps_and_the_state_is_that_of_the_step_before():
    stage = stage_of(rising())
    frames = list(frames_of(stage, np.array([0.0, 1.25e-3, 2e-3, 4e-3])))
    assert [frame.time for frame in frames] == [0.0, 1.25e-3, 2e-3, 4e-3]
    stored = [frame.heights["surface"] for frame in frames_of(stage, stage.run.time)]
    assert frames[1].heights["surface"] == pytest.approx(0.75 * stored[1] + 0.25 * stored[2], abs=1e-15)
    assert frames[3].heights["surface"] == pytest.approx(stored[4], abs=1e-15)
    assert frames[1].part[0] == pytest.approx(-1.5e-4)
    assert [frame.state for frame in frames] == [State.STICK, State.STICK, State.SLIP, State.STICK]


def test_frames_of_many_steps_read_in_pieces_are_those_of_their_steps():
    points = grid()[0]
    run = made_run(np.linspace([-4e-4, 0], [4e-4, 0], 40), np.arange(40)[:, None] * 1e-7 * np.ones(len(points)))
    frames = list(frames_of(stage_of(run), np.linspace(0, 39e-3, 79)))
    assert [frame.under for frame in frames] == pytest.approx(1e-7 * np.arange(0, 39.5, 0.5), abs=1e-12)


def test_the_trail_lies_on_the_present_surface_and_ends_at_the_part():
    stage = stage_of(rising())
    for frame in frames_of(stage, np.array([0.0, 1.5e-3, 4e-3])):
        assert frame.trail[:, 0].max() == pytest.approx(frame.part[0])
        surface = stage.smooth.at(frame.trail) @ np.array(
            [np.interp(frame.time, stage.run.time, column) for column in stage.run.heights.T]
        )
        assert frame.heights["trail"] == pytest.approx(surface, abs=1e-12)
    assert np.ptp(frame.trail[:, 0]) == pytest.approx(8e-4)


def test_one_stored_step_is_a_frame():
    stage = stage_of(made_run([[0.0, 0.0]], lambda points: hill(points, 1e-5)))
    (frame,) = frames_of(stage, pace_of(stage.run.time, 30.0, None).times)
    assert frame.under == pytest.approx(1e-5) and len(frame.trail) == 0


def test_the_part_and_its_trail_are_where_the_integrator_found_it_between_stored_steps():
    run = made_run(LONG[[0, 4]], lambda points: hill(points, 1e-5), time=[0.0, 4e-3], state=1)
    bent = LONG + np.array([[0, 0], [0, 1e-4], [0, 2e-4], [0, 1e-4], [0, 0]])
    state = np.array([0, 1, 2, 1, 0])
    rows = run.rows._replace(time=1e-3 * np.arange(5), position=bent, state=state)
    stage = stage_of(replace(run, rows=rows))
    assert stage.trail[:, 1].max() == pytest.approx(2e-4, rel=0.02)
    (frame,) = frames_of(stage, np.array([2.5e-3]))
    assert frame.part[:2] == pytest.approx([1e-4, 1.5e-4]) and frame.state is State.FLIGHT
    half = stage_of(replace(run, rows=rows, time=np.array([0.0, 2e-3])))
    assert half.trail_time.max() <= 2e-3


def test_the_path_has_the_stored_steps_where_rows_are_far_apart():
    run = made_run(LONG + np.array([[0, 0], [0, 1e-4], [0, 2e-4], [0, 1e-4], [0, 0]]), lambda p: hill(p, 1e-5))
    few = run.rows._replace(**{name: getattr(run.rows, name)[[0, 4]] for name in ("time", "position", "state")})
    path, then = stage_of(replace(run, rows=few)).path
    assert (path == run.position[:, :2]).all() and (then == run.time).all()


def test_flight_is_counted_from_the_surface():
    stage = stage_of(made_run(LONG, lambda points: np.full(len(points), 1e-6), state=2, above=5e-6))
    (frame,) = frames_of(stage, np.array([1e-3]))
    assert frame.flight == pytest.approx(4e-6)


@pytest.mark.parametrize(
    ("camera", "size"), [*zip(CAMERAS, [(1280, 720), (330, 500), (320, 320), (330, 500)], strict=True)]
)
def test_the_surface_fills_its_part_of_the_picture_at_all_times(camera, size):
    stage = stage_of(rising())
    layout = layout_of(stage, CAMERAS[camera], size, 10.0)
    seen = np.concatenate(
        [layout.pixels(layout.scene(stage.surface, f.heights["surface"])) for f in frames_of(stage, stage.run.time)]
    )
    left = BESIDE_AXIS if CAMERAS[camera].level else LEFT
    room = np.array([[left, BOTTOM], [RIGHT, TOP]]) * size
    assert (seen >= room[0] - 0.5).all() and (seen <= room[1] + 0.5).all()
    assert (np.ptp(seen, axis=0) / np.ptp(room, axis=0)).max() > 0.9


def test_a_size_is_two_numbers_of_pixels():
    assert size_of("1280x720") == (1280, 720) == size_of(" 1280 × 720 ")
    for text in ("1280", "0x0", "100x720", "20000x720", "-3x5", "axb"):
        with pytest.raises(ValueError, match="Input size must be"):
            size_of(text)
    with pytest.raises(ValueError, match="got 10x20"):
        size_of((10, 20))


def test_heights_are_drawn_larger_by_a_round_number_only_where_they_are_small():
    def drawn(height):
        return stage_of(made_run(LONG, lambda points: hill(points, height))).exaggeration

    assert [drawn(h) for h in (1e-3, 1e-4, 1e-5, 1e-6)] == pytest.approx([1, 2, 20, 200])
    flat = stage_of(made_run(LONG, lambda points: np.zeros(len(points))))
    assert flat.flat and flat.exaggeration == 1


def test_a_short_path_is_shown_in_a_window_and_a_part_at_rest_on_the_whole_plate():
    short = stage_of(made_run(LONG / 20 + 1e-4, lambda points: hill(points, 1e-5)))
    assert short.window and short.size < 0.4 * SIDE and len(short.trail)
    assert (short.surface >= short.frame[0] - 1e-12).all() and (short.surface <= short.frame[1] + 1e-12).all()
    assert len(short.used) < len(short.run.points)
    middle = short.smooth.at(np.array([[1e-4, 1e-4]])) @ short.run.heights[0][short.used]
    assert middle == pytest.approx(hill(np.array([[1e-4, 1e-4]]), 1e-5), rel=1e-2)
    rest = stage_of(made_run(np.zeros((5, 2)), lambda points: hill(points, 1e-5), state=0))
    assert not rest.window and len(rest.trail) == 0


def test_a_window_over_a_hole_ends_at_its_rim():
    holes = {(i, j) for i in range(10, 13) for j in range(10, 13)}
    stage = stage_of(made_run(LONG / 20 - 3e-5, lambda points: hill(points, 1e-5), holes=holes))
    corners = stage.surface[stage.triangles]
    x, y = corners.mean(axis=1).T
    assert stage.window and not ((x > 5e-6) & (x < 1.45e-4) & (y > 5e-6) & (y < 1.45e-4)).any()
    assert len(stage.rim.pieces)


def test_crowded_actuators_are_not_marked():
    def marks(count):
        return len(stage_of(made_run(LONG, lambda points: hill(points, 1e-5), actuators=count)).actuators)

    assert marks(1) == 1 and marks(100) == 100
    from active_surface.views.film import stage

    crowded, stage.CROWDED = stage.CROWDED, 0.1
    assert marks(100) == 0
    stage.CROWDED = crowded


def test_a_slow_part_leaves_no_pieces_of_trail_that_are_too_short_to_be_drawn():
    time = np.linspace(0.0, 1.0, 2001)
    path = np.column_stack([1e-4 * time**4, 5e-5 * time**4])
    xy, then = path_points(path, time, 1e-6)
    pieces = np.hypot(*np.diff(xy, axis=0).T)
    assert pieces.min() >= 0.5e-6 and pieces.max() <= 1.5e-6
    assert np.hypot(*(path[-1] - xy[-1])) < 0.5e-6 and (xy[0] == path[0]).all()
    assert xy[:, 0] == pytest.approx(1e-4 * then**4, abs=1e-9) and (np.diff(then) > 0).all()
