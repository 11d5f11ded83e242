"""What keeps the files of long runs and large arrays small, and drives that are alike worked out once."""

from dataclasses import replace

import h5py
import numpy as np
import pytest

from coupling.display.frames import FRAMES, MAX_BYTES, frame_times
from coupling.drives import stroke_heights
from coupling.progress import silent
from particle import Drive

STILL = Drive(0.0, 1.0, "up")


def counted(result, drive, end, **changes):
    """How many frames a path has that ends then [s], over the surface of a run whose first lift is another drive."""
    scene = replace(result.scene, lifts=[drive, *result.scene.lifts[1:]], **changes)
    return len(frame_times(result.case, scene, end))


@pytest.mark.parametrize("kind", ["linear", "platform"])
def test_the_frames_of_a_long_run_resolve_its_fastest_drive(ran, kind):
    assert counted(ran(kind), Drive(1e-6, 1e5), 5e-3) == 20 * 500 + 1
    assert counted(ran(kind), Drive(1e-6, 1e5), 1e-5) == FRAMES[0]
    wanted = ran(kind).case.model_copy(update={"run": ran(kind).case.run.model_copy(update={"frames": 1234})})
    assert counted(replace(ran(kind), case=wanted), Drive(1e-6, 1e5), 5e-3) == 1234


def test_a_platform_at_rest_and_a_measured_motion_have_as_many_frames_as_ever(ran):
    assert counted(ran("platform"), STILL, 1.0, base=[STILL, STILL]) == FRAMES[0]
    assert counted(ran("platform"), Drive(1e-6, 1e5), 1.0, fits=("a fit",)) == FRAMES[1]


@pytest.mark.parametrize("kind", ["linear", "stretching", "platform"])
def test_files_of_endless_runs_have_about_as_many_bytes_as_they_may(ran, kind):
    result, taken = ran(kind), 0
    for file in result.files[:2]:
        with h5py.File(file) as opened:
            steps = int(opened["VTKHDF/Steps"].attrs["NSteps"])
            fields = [*opened["VTKHDF/PointData"].values(), *opened["VTKHDF/Steps/PointDataOffsets"].values()]
            taken += sum(field.id.get_storage_size() for field in fields) / steps
    assert 0.3 * MAX_BYTES < taken * counted(result, Drive(1e-6, 1e5), 1e5) < 1.2 * MAX_BYTES


def test_equal_drives_have_equal_heights_in_their_own_columns():
    drives = [Drive(1e-6, 400), Drive(2e-6, 300), Drive(1e-6, 400)]
    times = np.linspace(0, 1e-2, 7)
    heights = stroke_heights(drives, times)
    assert np.array_equal(heights, np.stack([drive.evaluate(times)[0] for drive in drives], axis=1))


def test_no_progress_takes_any_count():
    with silent("stage") as tell:
        tell(1, 2)
