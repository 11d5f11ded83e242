"""What damaged, foreign or unfinished files of a run lack is told with the file, in one line, by every command."""

import json
import shutil
from contextlib import ExitStack
from pathlib import Path

import h5py
import numpy as np
import pytest
from click.testing import CliRunner

from active_surface.cli.program import main
from active_surface.cli.refusal import refusal_of
from coupling import Case, read_run, run_case
from coupling.case import CoulombCase, PartCase, RunCase
from coupling.environment import versions

CASE = Case(
    plate={"shape": "platform", "motion": {"x": {"stroke": 20e-6, "frequency": 400.0, "cycle": "sine"}}},
    part=PartCase(mass=2e-9, position=(1e-4, 0.0)),
    friction=CoulombCase(coefficient=0.3),
    run=RunCase(duration=6e-4, frames=11),
    name="run",
)
READERS = (["view"], ["plot"], ["rerun", "--quiet"], ["export", "--format", "pvd"])


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    folder = tmp_path_factory.mktemp("ran")
    run_case(CASE, folder)
    return folder


@pytest.fixture
def folder(ran, tmp_path):
    """A copy of the results."""
    return Path(shutil.copytree(ran, tmp_path / "results"))


def put(file, place, values):
    """A dataset in place of another."""
    del file[place]
    file[place] = values


def summary_without(key):
    def change(file):
        attributes = file["active_surface"].attrs
        summary = json.loads(attributes["summary"])
        del summary[key]
        attributes["summary"] = json.dumps(summary)

    return change


def thresholds_without_a_field(file):
    attributes = file["active_surface"].attrs
    summary = json.loads(attributes["summary"])
    summary["thresholds"] = {"knob": "stroke"}
    attributes["summary"] = json.dumps(summary)


def with_summary(text):
    return lambda file: file["active_surface"].attrs.modify("summary", text)


def height_that_is_no_number(file):
    file["VTKHDF/PointData/deflection"][5] = np.nan


def chunk_that_cannot_be_read(file):
    data = file["VTKHDF/PointData/deflection"]
    values = data[()]
    del file["VTKHDF/PointData/deflection"]
    data = file.create_dataset("VTKHDF/PointData/deflection", data=values, chunks=(4,), compression="gzip")
    data.id.write_direct_chunk((8,), b"no gzip")


def with_steps(count):
    return lambda file: file["VTKHDF/Steps"].attrs.__setitem__("NSteps", count)


def with_time(name, value):
    def change(file):
        file[f"active_surface/{name}"][1] = value

    return change


def with_actuators(count):
    return lambda file: file["active_surface"].attrs.__setitem__("actuators", count)


def cells(values):
    return lambda file: put(file, "VTKHDF/Connectivity", values)


def rows_that_are_not_there(file):
    del file["active_surface/rows/time"]
    file.create_dataset("active_surface/rows/time", (10**12,), "f8", chunks=(1000,))


DAMAGES = [
    ("part", summary_without("squeeze"), "the summary has no valid squeeze, as that of another version may"),
    ("part", with_summary('{"some": 1}'), "which is damaged: the summary has no valid "),
    ("part", thresholds_without_a_field, "which is damaged: the summary has no valid thresholds"),
    ("part", with_summary("text"), "which is damaged: Expecting value"),
    ("part", lambda file: file.__delitem__("active_surface/events"), "which is damaged: it has no events"),
    ("part", lambda file: file.__delitem__("active_surface/margins"), "which is damaged: it has no margins"),
    ("part", lambda file: file["active_surface"].attrs.__delitem__("units"), "which is damaged: it has no units"),
    ("part", lambda file: put(file, "active_surface/events/kind", [99]), "99 is not a valid EventKind"),
    ("part", lambda file: put(file, "VTKHDF/Points", np.zeros((3, 3))), "position of the shape (3, 3), not (11, 3)"),
    ("part", lambda file: put(file, "VTKHDF/Points", np.full((11, 3), np.nan)), "position has a number that is not"),
    ("part", lambda file: put(file, "active_surface/rows/height", [0.0]), "rows has height of the shape"),
    ("part", with_time("rows/time", np.nan), "time has a number that is not finite"),
    ("part", with_time("rows/time", -1.0), "a time is not later than the one before"),
    ("part", lambda file: put(file, "active_surface/margins/slip", [0.0]), "margins has slip of the shape"),
    ("part", lambda file: put(file, "VTKHDF/PointData/state", np.full(11, 9)), "a state is none of the part's"),
    ("part", lambda file: put(file, "VTKHDF/PointData/velocity", np.zeros(11)), "velocity of the shape (11,)"),
    ("part", rows_that_are_not_there, "rows/time says that it has 8000000000000 bytes, of which 0 are there"),
    ("part", lambda file: put(file, "active_surface/rows", h5py.ExternalLink("/etc/passwd", "/")), "rows is a link"),
    ("plate", cells([0, 1, 99]), "a corner that is none of the 4 points"),
]
NUMBERS = [
    *(("part", with_actuators(n), f"actuators must be a whole number, from 0 to 4; got {n}") for n in (-1, 10**9)),
    *((kind, with_steps(-1), "NSteps must be a whole number, not negative; got -1") for kind in ("plate", "part")),
    ("plate", with_steps(np.nan), "NSteps must be a whole number, not negative; got nan"),
    ("plate", with_steps([3, 4]), "NSteps must be a whole number, not negative"),
    *(
        ("plate", cells(values), "Connectivity must be whole numbers, three a triangle")
        for values in (np.zeros(0, int), [0, 1, 2, 3], [[0, 1, 2]], [0.0, 1.0, 2.0], [0j, 1j, 2j])
    ),
    ("plate", lambda file: put(file, "VTKHDF/Points", np.zeros(12)), "Points of the shape (12,), not (12, 3)"),
    ("plate", lambda file: put(file, "VTKHDF/Points", np.zeros((4, 3), complex)), "Points must be real numbers"),
]
DAMAGES_BESIDE = [
    ("part", lambda file: file.__delitem__("active_surface/case"), ("view", "plot", "rerun"), "whose case is damaged"),
    ("part", lambda file: file.__delitem__("active_surface/files"), ("view", "plot", "rerun"), "whose case is damaged"),
    ("plate", lambda file: put(file, "VTKHDF/PointData/deflection", np.zeros(7)), ("view", "plot", "export"), "field"),
    ("plate", height_that_is_no_number, ("view", "plot", "export"), "deflection has a number that is not finite"),
    ("plate", chunk_that_cannot_be_read, ("view", "plot", "export"), "whose field deflection is damaged"),
]


def damaged(folder, kind, change):
    with h5py.File(folder / f"run.{kind}.vtkhdf", "r+") as file:
        change(file)


def refused(command, folder):
    """What a command says of the run in a folder."""
    done = CliRunner().invoke(main, [*command, str(folder / "run"), "-o", str(folder / "new.html")])
    assert isinstance(done.exception, SystemExit) and done.exit_code == 2, done.exception
    head, said = done.stderr.splitlines()
    assert head.endswith(": 1 mistake") and said.startswith("  RESULT")
    assert f" must be a result of `active-surface run`; got {folder}" in said
    return said


@pytest.mark.slow
def test_damage_and_numbers_that_no_run_writes_are_told_with_their_file(ran, tmp_path):
    for k, (kind, change, said) in enumerate([*DAMAGES, *NUMBERS]):
        folder = Path(shutil.copytree(ran, tmp_path / str(k)))
        damaged(folder, kind, change)
        with pytest.raises(ValueError) as error:
            read_run(folder / "run")
        assert f"run.{kind}.vtkhdf, " in str(error.value) and said in str(error.value), said


def test_every_command_tells_of_damage_before_anything_else(folder):
    kind, change, said = DAMAGES[0]
    damaged(folder, kind, change)
    for command in READERS:
        assert said in refused(command, folder)


def test_a_result_of_another_version_is_told_with_both(folder):
    """In words of the program, not of HDF5; a result that this version can read is none of them."""

    def older(file):
        attributes = file["active_surface"].attrs
        attributes["versions"] = json.dumps(json.loads(attributes["versions"]) | {"active-surface": "0.0.1+abc"})

    damaged(folder, "part", older)
    assert read_run(folder / "run").versions["active-surface"] == "0.0.1+abc"
    damaged(folder, "part", lambda file: file.__delitem__("active_surface/margins"))
    now = versions()["active-surface"]
    wanted = f"which is damaged: it has no margins; version 0.0.1+abc wrote it, and this is {now}: run its case again"
    for command in (*READERS, ["animate", "--format", "png"]):
        told = refused(command, folder)
        assert told.endswith(wanted) and "synchronously" not in told


@pytest.mark.parametrize(
    ("kind", "change", "commands", "said"), DAMAGES_BESIDE, ids=[change.__name__ for _, change, *_ in DAMAGES_BESIDE]
)
def test_damage_of_what_is_read_later_is_told_as_well(folder, kind, change, commands, said):
    damaged(folder, kind, change)
    for command in READERS:
        if command[0] in commands:
            told = refused(command, folder)
            assert said in told and f"run.{kind}.vtkhdf" in told


@pytest.fixture
def written(folder):
    """The same while another process writes it."""
    fcntl = pytest.importorskip("fcntl", reason="files are locked otherwise here")
    with ExitStack() as files:
        for kind in ("plate", "part"):
            path = (folder / f"run.{kind}.vtkhdf").rename(folder / f"run.partial.{kind}.vtkhdf")
            fcntl.flock(files.enter_context(path.open("rb+")), fcntl.LOCK_EX)
        yield folder


def test_a_run_that_is_being_written_is_not_called_damaged(written):
    for command in (*READERS, ["animate", "--format", "png"]):
        said = refused(command, written)
        assert said.endswith("run.partial.plate.vtkhdf, which is being written: its run has not ended")


def test_two_runs_do_not_write_the_same_file(written):
    partial = written / "run.partial.plate.vtkhdf"
    with pytest.raises(BlockingIOError, match="another run is writing it") as error:
        run_case(CASE, written)
    assert error.value.filename == str(partial)
    assert refusal_of(error.value, "run", False, {}).message == f"run: {partial}: another run is writing it"
