"""Every step and field of a run is read back by VTK from each format that it is exported to."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
import pyvista as pv
from click.testing import CliRunner
from vtkmodules.vtkIOHDF import vtkHDFReader

from active_surface.cli.program import main
from coupling import Case, read_run, run_case
from coupling.case import ConstantCase, PartCase, RunCase
from coupling.results.export import export_run
from coupling.results.saved import OF_PART

PLATE = {"shape": "disc", "radius": 300e-6, "youngs_modulus": 169e9, "poisson_ratio": 0.3, "thickness": 5e-6}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    case = Case(
        plate=PLATE | {"cell_size": 100e-6},
        actuators=({"position": (0.0, 30e-6), "stroke": 4e-6, "frequency": 300.0},),
        part=PartCase(mass=2e-9, position=(10e-6, 20e-6)),
        friction=ConstantCase(limit=1e-12),
        run=RunCase(duration=4e-4, frames=9, tolerance=1e-5),
        name="one",
    )
    folder = tmp_path_factory.mktemp("ran")
    run_case(case, folder)
    return folder


def steps(path: Path) -> list[tuple[float, pv.DataSet]]:
    """What VTK reads at each time."""
    reader = pv.get_reader(path)
    if path.suffix == ".vtkhdf":
        plain = vtkHDFReader()
        plain.SetFileName(str(path))
        found = []
        with h5py.File(path) as file:
            times = file["VTKHDF/Steps/Values"][()].tolist()
        for k, time in enumerate(times):
            reader.reader.SetStep(k)
            found.append((time, reader.read()))
        return found
    found = []
    for time in reader.time_values:
        reader.set_active_time_value(time)
        data = reader.read()
        found.append((time, data[0] if isinstance(data, pv.MultiBlock) else data))
    return found


def assert_same(saved, folder, form):
    plate, part = (steps(folder / f"one.{kind}.{form}") for kind in ("plate", "part"))
    times = [time for time, _ in plate]
    assert times == [time for time, _ in part] and times == saved.time.tolist()
    for k, ((_, surface), (_, point)) in enumerate(zip(plate, part, strict=True)):
        np.testing.assert_array_equal(surface.points, np.pad(saved.points, ((0, 0), (0, 1))))
        np.testing.assert_array_equal(surface.cells_dict[pv.CellType.TRIANGLE], saved.triangles)
        assert set(surface.point_data) == set(saved.plate_fields) == {"deflection", "velocity", "curvature", "drive"}
        for name in saved.plate_fields:
            np.testing.assert_array_equal(surface[name], saved.plate_field(name, k))
        np.testing.assert_array_equal(point.points, saved.position[k : k + 1])
        assert point.n_cells == 1 and set(point.point_data) == set(OF_PART)
        for name in OF_PART:
            np.testing.assert_array_equal(point[name], getattr(saved, name)[k : k + 1])


@pytest.mark.parametrize("form", ["pvd", "xdmf", "vtkhdf"])
def test_every_step_and_field_comes_back(folder, tmp_path, form):
    saved = read_run(folder / "one")
    assert np.ptp(saved.position[:, 0]) > 0 and len(saved.time) == 9
    files = export_run(saved, tmp_path, form)
    assert [file.name for file in files] == [f"one.plate.{form}", f"one.part.{form}"]
    assert_same(saved, tmp_path, form)


@pytest.mark.parametrize("form", ["pvd", "xdmf"])
def test_an_export_that_fails_leaves_nothing_that_mixes_runs(folder, tmp_path, form):
    saved = read_run(folder / "one")
    files = export_run(saved, tmp_path, form)
    before = {file: file.read_bytes() for file in files}
    short = replace(saved, time=saved.time[:4])
    export_run(short, tmp_path, form)
    assert_same(short, tmp_path, form)
    if form == "pvd":
        assert [len(list((tmp_path / f"one.{kind}").iterdir())) for kind in ("plate", "part")] == [4, 4]

    def fails(done, of):
        if done == 2:
            raise OSError("full")

    export_run(saved, tmp_path, form)
    there = {file for file in tmp_path.iterdir() if file != files[0]}
    with pytest.raises(OSError, match="full"):
        export_run(short, tmp_path, form, fails)
    assert {file for file in tmp_path.iterdir() if file != files[0]} == there
    assert not files[0].exists() if form == "pvd" else files[0].read_bytes() == before[files[0]]


@pytest.mark.slow
def test_an_interrupted_run_is_exported_with_the_steps_that_it_has_and_stays_partial(folder, tmp_path):
    for kind in ("plate", "part"):
        shutil.copy(folder / f"one.{kind}.vtkhdf", tmp_path / f"one.partial.{kind}.vtkhdf")
    with h5py.File(tmp_path / "one.partial.plate.vtkhdf", "r+") as file:
        file["VTKHDF/Steps"].attrs.modify("NSteps", 4)
        file["VTKHDF/Steps/Values"].resize(4, axis=0)
    command = ["export", str(tmp_path / "one"), "--format", "vtkhdf", "--output", str(tmp_path / "out")]
    done = CliRunner().invoke(main, command)
    assert done.exit_code == 0 and "these are its first 4 steps" in done.output
    partial, whole = read_run(tmp_path / "one"), read_run(tmp_path / "out" / "one")
    assert not whole.complete and len(whole.time) == 4
    assert_same(partial, tmp_path / "out", "vtkhdf")
    assert whole.case == read_run(folder / "one").case and whole.events == partial.events
    assert (whole.summary, whole.versions, whole.units) == (partial.summary, partial.versions, partial.units)
    said = CliRunner().invoke(main, ["view", str(tmp_path / "out" / "one.plate.vtkhdf")])
    assert said.exit_code == 0 and "The results are partial" in said.output
    for form, ending in (("pvd", "pvd"), ("xdmf", "xdmf")):
        assert export_run(partial, tmp_path / form, form)[1].name == f"one.partial.part.{ending}"
    csv = CliRunner().invoke(main, ["export", str(tmp_path / "one"), "--format", "csv", "-o", str(tmp_path / "csv")])
    assert "The run stopped while it was written: the path is whole." in csv.output
    (tmp_path / "csv/other.csv").write_text("mine")
    (tmp_path / "csv/one.csv").rename(tmp_path / "csv/kept.csv")
    (tmp_path / "csv/other.csv").rename(tmp_path / "csv/one.csv")
    taken = CliRunner().invoke(main, ["export", str(tmp_path / "one"), "--format", "csv", "-o", str(tmp_path / "csv")])
    assert taken.exit_code == 2 and "--output must be a folder in which one.csv is free or a trajectory" in taken.output
    assert (tmp_path / "csv/kept.csv").read_text() == _csv(folder, tmp_path / "first").read_text()


def _csv(folder: Path, into: Path) -> Path:
    return export_run(read_run(folder / "one"), into, "csv")[0]


def test_a_run_that_lacks_but_the_last_renaming_is_finished_by_its_export(folder, tmp_path):
    for kind in ("plate", "part"):
        shutil.copy(folder / f"one.{kind}.vtkhdf", tmp_path / f"one.partial.{kind}.vtkhdf")
    export_run(read_run(tmp_path / "one"), tmp_path / "out", "vtkhdf")
    assert not read_run(tmp_path / "one").complete and read_run(tmp_path / "out" / "one").complete


def test_an_export_is_told_as_json_or_not_at_all(folder, tmp_path):
    command = ["export", str(folder / "one"), "--format", "xdmf", "--output", str(tmp_path)]
    told = json.loads(CliRunner().invoke(main, [*command, "--json"]).stdout)
    files = [str(tmp_path / f"one.{kind}.xdmf") for kind in ("plate", "part")]
    assert told == {"complete": True, "steps": 9, "files": files}
    done = CliRunner().invoke(main, [*command, "--quiet"])
    assert done.exit_code == 0 and not done.output


def test_a_run_is_not_written_over_itself(folder):
    before = {file: file.read_bytes() for file in folder.iterdir()}
    command = ["export", str(folder / "one"), "--format", "vtkhdf", "--output", f"{folder}/../{folder.name}"]
    done = CliRunner().invoke(main, command)
    assert done.exit_code == 2 and "--output must be another folder than that of the run's own files" in done.output
    assert {file: file.read_bytes() for file in folder.iterdir()} == before


@pytest.mark.parametrize("command", [["export", "--format", "pvd"], ["rerun"]])
def test_what_is_no_result_is_told(tmp_path, command):
    (tmp_path / "case.toml").write_text("[plate]\n")
    output = tmp_path / "out"
    done = CliRunner().invoke(main, [*command, str(tmp_path / "case.toml"), "--output", str(output)])
    assert done.exit_code == 2 and not output.exists()
    title, line = done.output.splitlines()
    assert title.endswith(f" {command[0]}: 1 mistake")
    assert line.startswith("  RESULT must be a result of `active-surface run`; got ")
    with pytest.raises(ValueError, match="must be one of pvd, xdmf, vtkhdf, csv; got 'txt'"):
        export_run(None, output, "txt")
