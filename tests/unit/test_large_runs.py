"""What keeps runs of large arrays small: few frames, and pictures of the part of the plate where the path is."""

from types import SimpleNamespace

import numpy as np

from coupling.drives import FRAMES, MOST_HEIGHTS, frame_times, stroke_heights
from coupling.pictures import path_window
from coupling.progress import silent
from particle import Drive


def test_many_drives_bound_the_frames_unless_more_are_wanted():
    few, many = [Drive(1e-6, 1e5)], [Drive(1e-6, 1e5, delay=1e-6 * k) for k in range(10_000)]
    assert len(frame_times(None, few, 0.1)) == FRAMES[1]
    assert len(frame_times(None, many, 0.1)) == MOST_HEIGHTS // 10_000
    assert len(frame_times(None, many * 10, 0.1)) == FRAMES[0]
    assert len(frame_times(1234, many, 0.1)) == 1234


def test_equal_drives_have_equal_heights_in_their_own_columns():
    drives = [Drive(1e-6, 400), Drive(2e-6, 300), Drive(1e-6, 400)]
    times = np.linspace(0, 1e-2, 7)
    heights = stroke_heights(drives, times)
    assert np.array_equal(heights, np.stack([drive.evaluate(times)[0] for drive in drives], axis=1))


def test_a_tiny_path_is_shown_with_its_neighbourhood_and_a_long_one_on_the_whole_plate():
    side = np.arange(100.0)
    shapes = SimpleNamespace(points=np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2), size=50.0)
    window = path_window(shapes, np.array([[10.0, 10.0], [10.5, 10.2]]))
    assert np.allclose(window.mean(axis=0), [10.25, 10.1]) and np.allclose(np.ptp(window, axis=0), 4.5)
    assert path_window(shapes, np.array([[10.0, 10.0], [30.0, 10.2]])) is None
    shapes.points = shapes.points[:1]
    assert path_window(shapes, np.zeros((2, 2))) is None


def test_no_progress_takes_any_count():
    with silent("stage") as tell:
        tell(1, 2)
