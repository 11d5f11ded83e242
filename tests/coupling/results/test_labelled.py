"""Paths as labelled arrays, tables and CSV: the numbers of the rows, their units, and results read back."""

import numpy as np
import pandas
import pytest
from case_files import python_case
from click.testing import CliRunner

from active_surface.cli.program import main
from coupling import read_run, run_case, write_csv
from particle import State

SHAKEN = {"shape": "platform", "motion": {"x": {"stroke": "20 um", "frequency": "200 Hz"}}}


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    case = python_case(
        plate=SHAKEN,
        actuators=[],
        part={"mass": "2e-9 kg", "position": (0, 0)},
        friction={"model": "constant", "limit": "20 nN"},
        run={"duration": "12 ms", "frames": 20},
        name="shaken",
    )
    return run_case(case, folder), folder


@pytest.fixture
def path(run):
    return run[0].trajectory


def test_a_dataset_has_every_row_once_with_units(path):
    found = path.to_xarray()
    times = np.unique(path.time)
    assert np.array_equal(found["time"], times)
    last = np.searchsorted(path.time, times, side="right") - 1
    for name, column in (
        *zip("xy", path.position.T, strict=True),
        ("z", path.height),
        *zip(("vx", "vy"), path.velocity.T, strict=True),
        ("vz", path.vertical_velocity),
        ("normal_force", path.normal_force),
        ("friction_force", path.friction_force),
        ("state", path.state),
    ):
        assert np.array_equal(found[name], column[last]), name
    units = {name: found[name].attrs.get("units") for name in ("time", "x", "vz", "normal_force", "event_speed")}
    assert units == {"time": "s", "x": "m", "vz": "m/s", "normal_force": "N", "event_speed": "m/s"}
    assert found["state"].attrs["flag_meanings"].split() == [state.name.lower() for state in State]
    assert found["event_time"].values.tolist() == [event.time for event in path.events]
    assert found["event_kind"].values.tolist() == [event.kind.name.lower() for event in path.events]
    assert found["event_x"].values.tolist() == [event.position[0] for event in path.events]
    assert found.attrs == {"outcome": path.outcome.value, "sentence": path.sentence}


def test_a_dataset_survives_netcdf(path, tmp_path):
    import xarray

    path.to_xarray().to_netcdf(tmp_path / "path.nc", engine="h5netcdf")
    with xarray.open_dataset(tmp_path / "path.nc", engine="h5netcdf") as found:
        assert found.load().equals(path.to_xarray())


def test_a_table_has_the_same_numbers_and_the_state_in_words(path):
    times = [3e-3, 1e-3, 2e-3]
    table, samples = path.to_dataframe(times), path.at(sorted(times))
    assert table.index.name == "time" and table.index.tolist() == sorted(times)
    assert np.array_equal(table[["x", "y"]], samples.position) and np.array_equal(table["vx"], samples.velocity[:, 0])
    assert table["state"].tolist() == [State(state).name.lower() for state in samples.state]
    assert table.attrs["units"]["friction_force"] == "N" and table.attrs["outcome"] == path.outcome.value
    with pytest.raises(ValueError, match="must be numbers; got nan"):
        path.to_dataframe([np.nan])


def test_a_run_read_back_gives_the_same(run):
    result, folder = run
    saved = read_run(folder / "shaken")
    assert saved.to_xarray().identical(result.trajectory.to_xarray())
    pandas.testing.assert_frame_equal(saved.to_dataframe(), result.trajectory.to_dataframe())
    assert saved.to_dataframe().attrs == result.trajectory.to_dataframe().attrs


def test_export_writes_the_path_as_csv_with_the_bytes_of_write_csv(run, tmp_path):
    result, folder = run
    done = CliRunner().invoke(main, ["export", str(folder / "shaken"), "--format", "csv", "-o", str(tmp_path / "out")])
    assert done.exit_code == 0 and done.output == f"wrote       {tmp_path / 'out' / 'shaken.csv'}\n"
    write_csv(result.trajectory, tmp_path / "expected.csv")
    assert (tmp_path / "out" / "shaken.csv").read_bytes() == (tmp_path / "expected.csv").read_bytes()
    (tmp_path / "out" / "shaken.csv").write_text("time, x\n")
    again = CliRunner().invoke(main, ["export", str(folder / "shaken"), "--format", "csv", "-o", str(tmp_path / "out")])
    assert again.exit_code == 2 and "is free or a trajectory" in again.output
