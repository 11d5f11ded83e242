"""The example on a platform runs as the paper's figure 4; its files are read back by VTK's own reader."""

from pathlib import Path

import numpy as np
import pytest
import pyvista

from coupling import read_case, report, run_case
from particle import EventKind

EXAMPLE = Path(__file__).parents[2] / "examples" / "shaker.toml"
pytestmark = pytest.mark.compiled


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    return run_case(read_case(EXAMPLE), output=tmp_path_factory.mktemp("results"))


def test_writes_one_file_of_each_kind_and_nothing_partial(result):
    names = {file.name for file in result.files[0].parent.iterdir()}
    assert names == {"shaker.plate.vtkhdf", "shaker.part.vtkhdf", "shaker.png"}


def test_slips_and_sticks_when_the_paper_says(result):
    slip, stop, again = result.trajectory.events
    assert (slip.kind, stop.kind, again.kind) == (EventKind.SLIPS, EventKind.STOPS, EventKind.SLIPS)
    assert (slip.time, stop.time) == pytest.approx((2.41, 2.86), abs=5e-3)


def test_slips_and_stops_at_the_times_of_the_exact_motion(result):
    """The file has positions at 1000 moments only: friction on x = t sin(3.2 t) itself gives these times."""
    slip, stop, _ = (event.time for event in result.trajectory.events)
    acceleration = 6.4 * np.cos(3.2 * slip) - 10.24 * slip * np.sin(3.2 * slip)
    assert acceleration == pytest.approx(-23.524, abs=1e-5)
    before, after = (np.sin(3.2 * t) + 3.2 * t * np.cos(3.2 * t) for t in (slip, stop))
    assert before - 23.524 * (stop - slip) == pytest.approx(after, abs=1e-6)


def test_the_part_stays_on_the_square_at_every_step(result):
    plate, part = (pyvista.get_reader(str(file)).reader for file in result.files[:2])
    plate.UpdateInformation()
    part.UpdateInformation()
    assert part.GetNumberOfSteps() == plate.GetNumberOfSteps() >= 100
    plate.Update()
    square = pyvista.wrap(plate.GetOutputDataObject(0))
    assert square.n_cells == 2
    left, right, bottom, top, *_ = square.bounds
    for step in range(part.GetNumberOfSteps()):
        part.SetStep(step)
        part.Update()
        x, y, z = pyvista.wrap(part.GetOutputDataObject(0)).points[0]
        assert left < x < right and bottom < y < top and z == 0.0
    assert part.GetTimeValue() == pytest.approx(4.0)


def test_the_summary_says_how_closely_the_measurement_is_followed_and_warns_of_nothing(result):
    text = " ".join(text for _, text in report.lines(result.summary, verbose=True))
    assert "measured x followed to" in text and "counted from the platform" in text
    assert not report.warnings(result.summary)
