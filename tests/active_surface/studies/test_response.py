"""The command `response`: its points and frequencies, its files, and its picture."""

import json

import matplotlib.image
import numpy as np
import pytest
import xarray
from click.testing import CliRunner
from sweeps import DISC_PLATE, toml

from active_surface.cli.options import place_of
from active_surface.cli.program import main
from active_surface.studies.response import response
from active_surface.studies.response.pictures import _wrapped, draw_response
from coupling import read_case

CASE = (
    DISC_PLATE
    + 'density = "2330 kg/m^3"\ncell_size = "100 um"\n\n'
    + toml(
        actuators=[
            {"position": ["90 um", "30 um"], "stroke": "1 um", "frequency": "20 kHz"},
            {"position": ["-75 um", "-105 um"], "stroke": "1 um", "frequency": "20 kHz"},
        ],
        part={"mass": "2e-9 kg", "position": ["100 um", "0 um"]},
        friction={"model": "constant", "limit": "10 nN"},
        run={"duration": "0.1 ms"},
    )
)
POINTS = ["200 um, 100 um", "-200um,100um"]
TAB = {"blue": (31, 119, 180), "orange": (255, 127, 14), "green": (44, 160, 44), "red": (214, 39, 40)}


@pytest.fixture
def case(tmp_path):
    path = tmp_path / "plate.toml"
    path.write_text(CASE)
    return path


def invoke(case, *options):
    return CliRunner().invoke(main, ["response", str(case), "-o", str(case.parent / "out"), *options])


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """What the command prints as JSON, and its folder."""
    path = tmp_path_factory.mktemp("response") / "plate.toml"
    path.write_text(CASE)
    given = [word for point in POINTS for word in ("--point", point)]
    result = invoke(path, *given, "--lowest", "50 kHz", "--highest", "2 MHz", "--json", "--quiet")
    assert result.exit_code == 0, result.output
    return json.loads(result.output), path.parent


def test_files_hold_the_response(done):
    figures, folder = done
    assert figures["points"] == [
        [pytest.approx(2e-4), pytest.approx(1e-4)],
        [pytest.approx(-2e-4), pytest.approx(1e-4)],
    ]
    assert figures["frequencies"] == pytest.approx([50e3, 2e6])
    found = response(read_case(folder / "plate.toml"), figures["points"], lowest=50e3, highest=2e6)
    with xarray.open_dataset(folder / "out" / "plate.response.nc", engine="h5netcdf") as data:
        assert data["amplitude"].dims == ("point", "actuator", "frequency")
        assert data["amplitude"].values == pytest.approx(np.abs(found.values), rel=1e-9)
        turned = data["amplitude"].values * np.exp(1j * np.radians(data["phase"].values))
        assert turned == pytest.approx(found.values, rel=1e-9)
        assert data["resonance"].values == pytest.approx(found.resonances)
        assert float(data["amplitude"].max()) == pytest.approx(figures["largest_amplitude"])


def test_its_picture_shows_the_curves(done):
    """Both diagrams have four curves of their own colours, that of phases across all of it, and there are marks."""
    _, folder = done
    picture = np.rint(255 * matplotlib.image.imread(folder / "out" / "plate.response.png")[:, :, :3]).astype(int)
    height, width = picture.shape[:2]
    left, right = picture[:, : width * 2 // 3], picture[:, width * 2 // 3 :]
    upper, lower = left[: height * 55 // 100], left[height * 55 // 100 :]
    for colour in TAB.values():
        assert all((np.abs(half - colour).max(axis=2) < 12).sum() > 200 for half in (upper, lower))
    assert (right.max(axis=2) < 60).sum() > 1000  # the rim and its marks
    rows = np.flatnonzero((np.abs(lower - TAB["orange"]).max(axis=2) < 12).any(axis=1))
    assert np.ptp(rows) > 0.4 * len(lower)


def test_its_labels_and_keys_are_clear_of_each_other_and_of_curves(done):
    _, folder = done
    found = response(read_case(folder / "plate.toml"), [(2e-4, 1e-4), (2.05e-4, 1e-4)], lowest=50e3, highest=2e6)
    figure = draw_response(found)
    figure.draw_without_rendering()
    boxes = [text.get_window_extent() for axes in figure.axes for text in axes.texts]
    boxes += [legend.get_window_extent() for legend in figure.legends]
    assert len(boxes) == len(found.actuators) + 3 and not any(axes.get_legend() for axes in figure.axes)
    assert not any(box.count_overlaps(boxes[:k]) for k, box in enumerate(boxes))


def test_the_phase_breaks_where_it_leaps_by_a_turn():
    angles = np.array([100.0, 170.0, 190.0, 260.0, 350.0, 10.0, -170.0, -190.0])
    across, phase = _wrapped(np.arange(8.0), 0.3 * np.exp(1j * np.radians(angles)))
    nan = np.nan
    assert phase == pytest.approx([100, 170, nan, -170, -100, -10, 10, -170, nan, 170], nan_ok=True)
    assert across.tolist() == [0, 1, 2, 2, 3, 4, 5, 6, 7, 7]


@pytest.mark.parametrize(
    "text, point", [("100 um, 50 um", (1e-4, 5e-5)), ("0 m,-0.2 mm", (0.0, -2e-4)), ("1e-4 m , 3nm", (1e-4, 3e-9))]
)
def test_points_are_two_lengths(text, point):
    assert place_of(text, "--point") == pytest.approx(point)


@pytest.mark.parametrize(
    "options, message",
    [
        (["--point", "3 um"], '--point must be two lengths, x and y, such as "100 um, 50 um"; got "3 um"'),
        (["--point", "1 um, 2 um, 3 um"], "--point must be two lengths"),
        (["--point", "1 um, 2"], '--point must be a length such as "100 um"; got "2", which has no unit'),
        (["--point", "1 um, 2 Hz"], "--point must be a length"),
        (["--point", "400 um, 0 um", "--point", "0 um, 0 um"], "--point must lie on the plate; got (400, 0) um"),
        (["--lowest", "5 um"], "--lowest must be a frequency"),
        (
            ["--lowest", "3 kHz", "--highest", "2 kHz"],
            "--lowest must be positive and below the highest, 2 kHz; got 3 kHz",
        ),
        (["--lowest", "1 GHz"], "--lowest must be positive and below the highest, by default five times the first"),
        (["--lowest", "-1 Hz"], "--lowest must be positive"),
        (["--highest", "1 Hz"], "--highest must be above the lowest, by default 1/20 of the first resonance"),
    ],
)
def test_it_refuses_what_makes_no_sense(case, options, message):
    result = invoke(case, *options)
    assert result.exit_code == 2 and f"  {message}" in result.output
    assert not (case.parent / "out").exists()


def test_points_on_the_rim_stand_still_and_those_beyond_are_refused(case):
    """The rim of a clamped plate does not move."""
    on_rim = 300e-6 * np.array([[1, 0], [0, -1], [0.6, 0.8]])
    found = response(read_case(case), on_rim, np.array([50e3, 300e3]))
    assert np.abs(found.values).max() < 2e-6
    with pytest.raises(
        ValueError, match=r"must lie on the plate; got \(303, 0\) um, \(0, -303\) um, \(181.8, 242.4\) um"
    ):
        response(read_case(case), 1.01 * on_rim)


def test_points_at_actuators_follow_their_own_alone(case):
    found = response(read_case(case), [[90e-6, 30e-6], [-75e-6, -105e-6]], np.array([50e3, 1e6]))
    assert found.values == pytest.approx(np.repeat(np.eye(2)[:, :, None], 2, axis=2), abs=2e-6)
