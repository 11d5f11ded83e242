"""What keeps runs of large arrays small: few frames, and drives that are alike worked out once."""

import numpy as np

from coupling.drives import FRAMES, MAX_HEIGHTS, frame_times, stroke_heights
from coupling.progress import silent
from particle import Drive


def test_many_drives_bound_the_frames_unless_more_are_wanted():
    few, many = [Drive(1e-6, 1e5)], [Drive(1e-6, 1e5, delay=1e-6 * k) for k in range(10_000)]
    assert len(frame_times(None, few, 0.1)) == FRAMES[1]
    assert len(frame_times(None, many, 0.1)) == MAX_HEIGHTS // 10_000
    assert len(frame_times(None, many * 10, 0.1)) == FRAMES[0]
    assert len(frame_times(1234, many, 0.1)) == 1234


def test_equal_drives_have_equal_heights_in_their_own_columns():
    drives = [Drive(1e-6, 400), Drive(2e-6, 300), Drive(1e-6, 400)]
    times = np.linspace(0, 1e-2, 7)
    heights = stroke_heights(drives, times)
    assert np.array_equal(heights, np.stack([drive.evaluate(times)[0] for drive in drives], axis=1))


def test_no_progress_takes_any_count():
    with silent("stage") as tell:
        tell(1, 2)
