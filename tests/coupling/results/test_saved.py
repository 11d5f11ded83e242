"""A run is read back from its files as it was, finished or not, and whatever else is there is refused."""

import json
import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest

from coupling import Case, read_parts, read_run, run_case
from coupling.case import CoulombCase, PartCase, RunCase
from coupling.display import display_surface
from coupling.results.case_record import case_of, record_of
from particle import Samples

EXAMPLES = Path(__file__).parents[3] / "examples"
FILES = [file for file in sorted(EXAMPLES.glob("*.toml")) if "100x100" not in file.name]
MOTION = {"x": {"stroke": 20e-6, "frequency": 400.0, "cycle": "sine"}, "z": {"stroke": 3e-6, "frequency": 500.0}}


def shaken(duration=6e-4, name="run"):
    return Case(
        plate={"shape": "platform", "motion": MOTION},
        part=PartCase(mass=2e-9, position=(1e-4, 0.0)),
        friction=CoulombCase(coefficient=0.3),
        run=RunCase(duration=duration, frames=11),
        name=name,
    )


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    folder = tmp_path_factory.mktemp("ran")
    return run_case(shaken(), folder), folder


@pytest.fixture
def folder(ran, tmp_path):
    """A copy of the results."""
    return Path(shutil.copytree(ran[1], tmp_path / "results"))


def test_a_name_is_no_formula(tmp_path):
    name = "q$_$s^"
    files = run_case(shaken(name=name), tmp_path).files
    assert [file.name for file in files] == [f"{name}.plate.vtkhdf", f"{name}.part.vtkhdf", f"{name}.png"]


def test_a_run_is_finished_though_its_picture_cannot_be_drawn(tmp_path, monkeypatch):
    def fails(*_):
        raise RuntimeError("no ink")

    (tmp_path / "run.png").write_text("of another run")
    monkeypatch.setattr("coupling.pictures.draw_run", fails)
    with pytest.warns(RuntimeWarning, match=r"run.png could not be drawn: no ink"):
        result = run_case(shaken(), tmp_path, csv=True)
    assert [file.name for file in result.files] == ["run.plate.vtkhdf", "run.part.vtkhdf", "run.csv"]
    assert not list(tmp_path.glob("*.png")) and read_run(tmp_path / "run").complete


def test_a_picture_is_left_out_on_request(tmp_path):
    files = run_case(shaken(), tmp_path, picture=False).files
    assert [file.name for file in files] == ["run.plate.vtkhdf", "run.part.vtkhdf"] and not [*tmp_path.glob("*.png")]


@pytest.mark.slow
def test_a_run_leaves_nothing_of_an_older_one_beside_it(tmp_path):
    run_case(shaken(), tmp_path, csv=True, save_surface=True)
    assert {file.name for file in tmp_path.iterdir()} >= {"run.csv", "run.surface.h5"}
    result = run_case(shaken(3e-4), tmp_path)
    assert set(tmp_path.iterdir()) == set(result.files)
    for name in ("run.csv", "run.surface.h5"):
        (tmp_path / name).write_text("mine")
    run_case(shaken(), tmp_path)
    assert (tmp_path / "run.csv").read_text() == (tmp_path / "run.surface.h5").read_text() == "mine"


@pytest.mark.parametrize("ending", ["", ".plate.vtkhdf", ".part.vtkhdf"])
def test_a_run_comes_back(ran, ending):
    result, folder = ran
    saved, trajectory = read_run(folder / f"run{ending}"), result.trajectory
    assert saved.name == "run" and saved.complete and saved.case == result.case
    assert saved.summary == json.loads(json.dumps(result.summary.as_dict()))
    assert saved.versions["active-surface"] and saved.units["velocity"] == "m/s"
    samples = trajectory.at(saved.time)
    assert len(saved.time) == 11 and saved.time[-1] == trajectory.time[-1]
    np.testing.assert_array_equal(saved.position, np.column_stack([samples.position, samples.height]))
    np.testing.assert_array_equal(saved.velocity, np.column_stack([samples.velocity, samples.vertical_velocity]))
    for name in ("state", "normal_force", "friction_force"):
        np.testing.assert_array_equal(getattr(saved, name), getattr(samples, name))
    assert saved.events == trajectory.events and saved.events
    for name in Samples._fields:
        np.testing.assert_array_equal(getattr(saved.rows, name), getattr(trajectory, name))
    ground = display_surface(result.scene, trajectory)
    np.testing.assert_array_equal(saved.points, ground.points)
    np.testing.assert_array_equal(saved.triangles, ground.triangles)
    assert saved.actuators.shape == (0, 2)


def test_a_field_of_the_plate_comes_at_the_steps_asked_for(ran):
    saved = read_run(ran[1] / "run")
    every = saved.plate_field("deflection")
    assert every.shape == (11, 4) and np.ptp(every) > 1e-6
    np.testing.assert_array_equal(saved.plate_field("deflection", slice(1, 9, 3)), every[1:9:3])
    np.testing.assert_array_equal(saved.plate_field("deflection", [7, 0]), every[[7, 0]])
    np.testing.assert_array_equal(saved.plate_field("deflection", -1), every[-1])
    with pytest.raises(ValueError, match="must be one of deflection, velocity; got 'speed'"):
        saved.plate_field("speed")
    with pytest.raises(IndexError):
        saved.plate_field("deflection", 11)


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_the_record_of_a_case_is_the_case_without_its_files(file, tmp_path):
    shutil.copytree(EXAMPLES, tmp_path / "examples")
    case = read_parts(tmp_path / "examples" / file.name)[0]
    record = record_of(case)
    shutil.rmtree(tmp_path / "examples")
    again = case_of(record, case.name, case.source)
    for key in ("mesh", "motion"):
        name = getattr(case.plate, key, None)
        if isinstance(name, str):
            kept = getattr(again.plate, key)
            assert Path(kept).name == Path(name).name and record.files[Path(name).name] == Path(kept).read_bytes()
            again = again.model_copy(update={"plate": again.plate.model_copy(update={key: name})})
    assert again == case


def unfinished(folder, kinds=("plate", "part")):
    for kind in kinds:
        (folder / f"run.{kind}.vtkhdf").rename(folder / f"run.partial.{kind}.vtkhdf")


@pytest.mark.parametrize("name", ["run", "run.partial.plate.vtkhdf", "run.partial.part.vtkhdf"])
def test_partial_files_have_the_steps_that_both_hold(folder, name):
    unfinished(folder)
    whole = read_run(folder / "run")
    with h5py.File(folder / "run.partial.part.vtkhdf", "r+") as file:
        file["VTKHDF/Steps"].attrs.modify("NSteps", 8)
        file["VTKHDF/Steps/Values"].resize(8, axis=0)
    saved = read_run(folder / name)
    assert not saved.complete and saved.name == "run"
    np.testing.assert_array_equal(saved.position, whole.position[:8])
    assert len(saved.time) == len(saved.plate_field("deflection")) == 8


@pytest.mark.slow
def test_files_of_one_run_find_each_other_beside_those_of_another(folder):
    """A kill between the two renamings leaves the new part with the old plate under their final names."""
    unfinished(folder, ["plate"])
    old = run_case(shaken(1e-3), folder.parent / "old").files[0]
    shutil.copy(old, folder)
    for name in ("run", "run.part.vtkhdf", "run.partial.plate.vtkhdf"):
        assert read_run(folder / name).time[-1] == 6e-4 and not read_run(folder / name).complete
    with pytest.raises(ValueError, match=r"run.plate.vtkhdf and \S+run.part.vtkhdf are of different runs"):
        read_run(folder / "run.plate.vtkhdf")


def test_exchanged_files_are_told_by_their_names(folder):
    plate, part = (folder / f"run.{kind}.vtkhdf" for kind in ("plate", "part"))
    for path in (folder / "run", plate, part):
        plate.rename(folder / "x")
        part.rename(plate)
        (folder / "x").rename(part)
        assert refused(path).endswith(f"got {plate}, which holds no plate, though its name ends in .plate.vtkhdf")
        part.rename(folder / "x")
        plate.rename(part)
        (folder / "x").rename(plate)
    shutil.copy(plate, part)
    assert refused(plate).endswith(f"got {part}, which holds no part, though its name ends in .part.vtkhdf")


def refused(path):
    with pytest.raises(ValueError) as error:
        read_run(path)
    said = str(error.value)
    assert said.startswith("Input path must be a result of `active-surface run`; got ")
    assert "\n" not in said
    return said


def test_a_missing_file_is_told(folder):
    for name in ("none", "none.plate.vtkhdf", "none.partial.part.vtkhdf", "results"):
        assert f"but there is no {folder / name}" in refused(folder / name)


def test_what_is_named_in_place_of_a_result_is_described(folder):
    assert refused(folder).endswith(f"got {folder}, a folder: name a result in it: {folder / 'run'}")
    assert refused(folder / "run.png").endswith(f"run.png, which is beside a result: name {folder / 'run'}")
    assert refused(folder / "runn").endswith(f"did you mean {folder / 'run'}?")
    (folder / "empty").mkdir()
    (folder / "x.toml").write_text("[plate]\n")
    (folder / "y.txt").write_text("mine")
    assert refused(folder / "empty").endswith("empty, a folder, in which there is no result of a run")
    assert refused(folder / "x.toml").endswith(
        "x.toml, which is input: name its result, such as results/x after `active-surface run`"
    )
    assert refused(folder / "y.txt").endswith(
        "y.txt, which is another file: those of a run end in .plate.vtkhdf and .part.vtkhdf"
    )
    for name in "abc":
        for kind in ("plate", "part"):
            shutil.copy(folder / f"run.{kind}.vtkhdf", folder / f"{name}.partial.{kind}.vtkhdf")
    some = ", ".join(str(folder / name) for name in "abc")
    assert refused(folder).endswith(f"name a result in it: {some}, ...")


@pytest.mark.parametrize(("named", "lost"), [("plate", "part"), ("part", "plate")])
def test_a_missing_other_file_is_told(folder, named, lost):
    other = folder / f"run.{lost}.vtkhdf"
    other.unlink()
    assert f"but there is no {other}, the other file of this run" in refused(folder / f"run.{named}.vtkhdf")
    assert f"but there is no {other}" in refused(folder / "run")


def test_what_is_no_hdf5_or_that_of_something_else_or_cut_off_is_told(folder):
    path = folder / "run.part.vtkhdf"
    content = path.read_bytes()
    for kept in (0.0, 0.1, 0.5, 0.99):
        path.write_bytes(content[: int(kept * len(content))])
        said = refused(folder / "run")
        assert "run.part.vtkhdf, which is " + ("damaged" if kept else "no HDF5 file") in said
    for group in ("other", "VTKHDF", "active_surface"):
        with h5py.File(path, "w") as file:
            file[f"{group}/numbers"] = [1.0]
        assert "run.part.vtkhdf, which is HDF5 but holds something else" in refused(folder / "run")


def test_a_file_without_a_step_is_told(folder):
    with h5py.File(folder / "run.plate.vtkhdf", "r+") as file:
        file["VTKHDF/Steps"].attrs.modify("NSteps", 0)
    assert f"got {folder / 'run.plate.vtkhdf'}, to which no step was written" in refused(folder / "run.part.vtkhdf")


@pytest.mark.parametrize(("key", "value"), [("mass", -1.0), ("weight", 1.0)])
def test_a_record_that_is_no_case_is_told(folder, key, value):
    with h5py.File(folder / "run.part.vtkhdf", "r+") as file:
        ours = file["active_surface/case"]
        tables = json.loads(ours["json"][()].tobytes())
        tables["part"][key] = value
        del ours["json"]
        ours["json"] = np.frombuffer(json.dumps(tables).encode(), np.uint8)
    with pytest.raises(ValueError, match=r"got \S+run.part.vtkhdf, whose case is damaged: Input part") as error:
        read_run(folder / "run").case  # noqa: B018
    assert "pydantic" not in str(error.value) and "\n" not in str(error.value)
