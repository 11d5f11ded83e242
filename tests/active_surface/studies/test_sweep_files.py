"""Files of sweeps: nothing is lost or replaced unasked, and nothing of another sweep is taken."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray
from click.testing import CliRunner
from sweeps import PLATFORM, written

from active_surface.cli.program import main
from active_surface.studies import read_study, run_study, sweep_file
from active_surface.studies.columns import COLUMNS, new_records
from active_surface.studies.engine import Engine
from active_surface.studies.sweep_file import keys_of
from active_surface.studies.sweep_table import sweep_table
from coupling import environment as versions
from coupling.progress import Bar

pytestmark = pytest.mark.usefixtures("without_pictures")

MASS = """\
[[axes]]
field = "part.mass"
name = "mass"
range = ["1e-9 kg", "9e-9 kg"]
count = 9
"""


def swept(tmp_path, text=MASS, *options):
    path = written(tmp_path, text, PLATFORM)
    return CliRunner().invoke(main, ["sweep", str(path), "-o", str(tmp_path / "out"), *options])


def names(tmp_path):
    return sorted(file.relative_to(tmp_path / "out").as_posix() for file in (tmp_path / "out").rglob("*"))


def test_a_file_of_another_kind_is_not_replaced(tmp_path):
    (tmp_path / "study.nc").write_text("mine")
    done = CliRunner().invoke(main, ["sweep", str(written(tmp_path, MASS, PLATFORM)), "-o", str(tmp_path)])
    assert done.exit_code == 2 and "whose study.nc is no sweep" in done.output
    assert (tmp_path / "study.nc").read_text() == "mine"


def test_finished_paths_are_used_whichever_they_are(tmp_path, monkeypatch):
    made = read_study(written(tmp_path, MASS, PLATFORM))
    expected = run_study(made).dataset["distance"].values
    assert len(set(expected)) == 9
    whole = Engine(made).records(range(9))
    with sweep_table(tmp_path / "out" / "study.sweep") as table:
        table.ask(keys_of(made))
        table.add(np.array([2, 6, 8]), whole[[2, 6, 8]])
    monkeypatch.setattr(Engine, "_chunk_length", lambda engine: 4)
    computed, records = [], Engine.records
    monkeypatch.setattr(
        Engine, "records", lambda self, numbers: computed.append(numbers.tolist()) or records(self, numbers)
    )
    found = run_study(made, tmp_path / "out").dataset["distance"].values
    assert found.tobytes() == expected.tobytes()
    assert computed == [[0, 1, 3, 4], [5, 7]]


def test_results_of_other_sources_are_not_taken_for_those_of_these(tmp_path, monkeypatch):
    path = written(tmp_path, MASS, PLATFORM)
    keys = {read_study(path).key}
    monkeypatch.setattr(versions, "_sources", lambda packages: "0" * 12)
    assert read_study(path).key not in keys


def test_the_sources_are_hashed_with_their_places(tmp_path, monkeypatch):
    found = set()
    for name, content in (("a", "1"), ("a", "2"), ("b", "2")):
        shutil.rmtree(tmp_path / "particle", ignore_errors=True)
        (tmp_path / "particle").mkdir()
        (tmp_path / "particle" / f"{name}.py").write_text(content)
        monkeypatch.setattr(versions, "__file__", str(tmp_path / "coupling" / "environment.py"))
        found.add(versions._sources.__wrapped__(("particle",)))
    assert len(found) == 3


def test_the_picture_of_a_run_is_not_replaced(tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "study.png").write_text("mine")
    assert swept(tmp_path).exit_code == 0
    assert names(tmp_path) == ["study.nc", "study.png", "study.sweep.png"]
    assert (tmp_path / "out" / "study.png").read_text() == "mine"


def test_the_table_goes_only_when_all_results_are_on_disk(tmp_path, monkeypatch):
    synced, fsync = [], os.fsync

    def noted(descriptor):
        fsync(descriptor)
        there = [(tmp_path / "out" / name).exists() for name in ("study.sweep", "study.nc")]
        synced.append((Path(os.readlink(f"/proc/self/fd/{descriptor}")).name, *there))

    monkeypatch.setattr(os, "fsync", noted)
    run_study(read_study(written(tmp_path, MASS, PLATFORM)), tmp_path / "out")
    assert synced == [("study.partial.nc", True, False), ("out", True, True)]
    assert names(tmp_path) == ["study.nc", "study.sweep.png"]


IN_USE = """\
import pathlib, sys
from active_surface.studies.sweep_table import sweep_table
with sweep_table(pathlib.Path(sys.argv[1])):
    print("in use", flush=True)
    sys.stdin.readline()
"""


def test_two_sweeps_at_once_do_not_meet(tmp_path):
    table = tmp_path / "out" / "study.sweep"
    arguments = [sys.executable, "-c", IN_USE, str(table)]
    for end in ("line", "kill"):
        with subprocess.Popen(arguments, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as other:
            assert other.stdout.readline() == "in use\n"
            done = swept(tmp_path)
            assert done.exit_code == 2
            assert done.output == f"main sweep: another sweep of this name is running in {tmp_path / 'out'}\n"
            if end == "kill":
                other.kill()
            else:
                other.communicate("\n")
    assert table.exists()  # of the one that was killed
    assert swept(tmp_path).exit_code == 0
    assert names(tmp_path) == ["study.nc", "study.sweep.png"]


def test_an_empty_table_leaves_no_folder_that_was_made_for_it(tmp_path):
    (tmp_path / "mine").mkdir()
    with sweep_table(tmp_path / "mine" / "a" / "b" / "study.sweep"):
        pass
    assert list((tmp_path / "mine").iterdir()) == []


def test_a_full_disk_is_named_before_the_results_are_written_and_finished_paths_are_kept(tmp_path, monkeypatch):
    usage = shutil.disk_usage(tmp_path)
    with monkeypatch.context() as patch:
        patch.setattr(shutil, "disk_usage", lambda folder: usage._replace(free=1000))
        done = swept(tmp_path)
    assert done.exit_code == 2
    assert f"{tmp_path / 'out'}: the results take 3.1 MB, and 0.0 MB are free; finished paths are kept" in done.output
    assert names(tmp_path) == ["study.sweep"]
    monkeypatch.setattr(Engine, "records", None)
    assert swept(tmp_path).exit_code == 0


def test_a_disk_that_is_full_while_paths_are_kept_is_named(tmp_path):
    file = tmp_path / "study.sweep"
    full = f"^{file}: database or disk is full; finished paths are kept there"
    with pytest.raises(OSError, match=full), sweep_table(file) as table:
        table.ask(bytes([number]) * 16 for number in range(200))
        table.add(np.arange(2), new_records(2))
        table._database.execute("PRAGMA max_page_count = 1")
        table.add(np.arange(2, 200), new_records(198))
    with sweep_table(file) as table:
        table.ask(bytes([number]) * 16 for number in range(200))
        assert table.missing().tolist() == list(range(2, 200))


def test_results_that_cannot_be_written_leave_no_part(tmp_path, monkeypatch):
    def broken(*_):
        raise OSError("broken")

    monkeypatch.setattr(sweep_file, "_write_axes", broken)
    assert swept(tmp_path).exit_code == 2
    assert not list((tmp_path / "out").glob("*.nc"))


def test_what_stands_in_the_place_of_the_table_stays(tmp_path):
    (tmp_path / "out").mkdir()
    table = tmp_path / "out" / "study.sweep"
    table.write_text("mine")
    done = swept(tmp_path)
    assert done.exit_code == 2 and "is damaged, or no file of finished paths; move it away" in done.output
    assert table.read_text() == "mine"
    table.unlink()
    table.mkdir()
    done = swept(tmp_path)
    assert done.exit_code == 2 and f"remove the folder {table}" in done.output and table.is_dir()


@pytest.mark.parametrize("sampling", ["", 'sampling = "list"\n', 'sampling = "random"\npoints = 3\n'])
def test_plain_xarray_knows_the_coordinates(tmp_path, sampling):
    text = MASS if not sampling else sampling + '[[axes]]\nfield = "part.mass"\nvalues = ["1e-9 kg", "2e-9 kg"]\n'
    sweep = run_study(read_study(written(tmp_path, text, PLATFORM)), tmp_path / "out")
    with xarray.open_dataset(sweep.files[0], engine="h5netcdf") as plain:
        (axis,) = sweep.study.points.axes
        assert list(plain.coords) == [axis.name] and set(plain.data_vars) == set(COLUMNS)
    sweep.dataset.close()


def test_the_rate_of_a_resumed_sweep_leaves_out_what_was_there(monkeypatch):
    clock = [0.0]
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    counted = Bar()
    monkeypatch.setattr(counted._bar, "get_time", lambda: clock[0])
    with counted as bar, bar("paths") as tell:
        for second, done in enumerate((900, 910, 920, 930)):
            clock[0] = float(second)
            tell(done, 1000)
        assert counted.task.description == "paths, 10/s" and counted.task.time_remaining == 7
        tell(1000, 1000)
        assert counted.task.description == "paths; writing all"
