"""Sweeps: the same bits as single runs, for any number of threads and after any interruption."""

import json
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray
from click.testing import CliRunner
from sweeps import LATTICE, PLATE, PLATFORM, written

from active_surface.cli.program import main
from active_surface.studies import engine, read_study, run_study
from active_surface.studies.chunk_store import ChunkStore
from active_surface.studies.dataset import read_dataset
from active_surface.studies.engine import Engine
from active_surface.studies.record import COLUMNS, KIND, OUTCOMES, new_records
from coupling import read_case
from coupling.run import build_friction, build_surface, follow_part

SHAKEN = """\
[[axes]]
field = "plate.motion.x.stroke"
name = "stroke"
values = ["5 um", "20 um", "40 um"]
[[axes]]
field = "friction.limit"
values = ["10 nN", "1 uN"]
"""
PLATES = """\
sampling = "random"
points = 12
repeats = 2
jitter = "1 um"
[[axes]]
field = "plate.thickness"
range = ["5 um", "6 um"]
[[axes]]
field = "actuators.*.frequency"
range = ["350 Hz", "500 Hz"]
"""
STROKES = """\
sampling = "random"
points = 24
[[axes]]
field = "actuators.*.stroke"
range = ["40 um", "70 um"]
[[axes]]
field = "actuators.0.frequency"
range = ["350 Hz", "500 Hz"]
"""


def same(one, other):
    """Whether two data sets have the same bits."""
    return set(one.variables) == set(other.variables) and all(
        one[name].dims == other[name].dims and one[name].values.tobytes() == other[name].values.tobytes()
        for name in one.variables
    )


def test_a_platform_is_swept_in_memory_and_its_axes_are_labelled(tmp_path):
    sweep = run_study(read_study(written(tmp_path, SHAKEN, PLATFORM)))
    found = sweep.dataset
    assert found.sizes == {"stroke": 3, "friction.limit": 2}
    assert found["stroke"].values.tolist() == [5e-6, 2e-5, 4e-5]
    assert found["stroke"].attrs == {"field": "plate.motion.x.stroke", "units": "m"}
    assert {name: found[name].attrs.get("units", "") for name in COLUMNS} == {
        name: column.unit for name, column in COLUMNS.items()
    }
    held = found.sel({"friction.limit": 1e-6})
    assert (held["distance"] == 0).all() and (held["last_motion"] == 0).all() and (held["outcome"] == 0).all()
    assert (found["distance"].sel({"friction.limit": 1e-8})[1:] > 1e-6).all()
    assert sweep.files == () and sum(sweep.outcomes.values()) == 6
    assert found["outcome"].attrs["flag_meanings"].split()[3] == "left_the_plate"


@pytest.mark.parametrize(
    ("text", "axes", "lines"),
    [
        (PLATFORM, SHAKEN, [('stroke = "20 um"', 'stroke = "{} m"'), ('limit = "20 nN"', 'limit = "{} N"')]),
        pytest.param(
            PLATE,
            '[[axes]]\nfield = "plate.radius"\nvalues = ["300 um", "310 um"]\n'
            '[[axes]]\nfield = "actuators.0.stroke"\nvalues = ["50 um", "70 um"]\n'
            '[[axes]]\nfield = "part.velocity.0"\nvalues = ["0 m/s", "10 mm/s"]\n'
            '[[axes]]\nfield = "run.duration"\nvalues = ["4 ms", "5 ms"]\n',
            [
                ('radius = "300 um"', 'radius = "{} m"'),
                ('stroke = "60 um"', 'stroke = "{} m"'),
                ("[friction]", 'velocity = ["{} m/s", "0 m/s"]\n[friction]'),
                ('duration = "5 ms"', 'duration = "{} s"'),
            ],
            marks=pytest.mark.compiled,
        ),
        pytest.param(
            LATTICE,
            '[[axes]]\nfield = "lattice.stroke"\nvalues = ["50 um", "70 um"]\n',
            [('stroke = "5 * (1 + column) um"', 'stroke = "{} m"')],
            marks=pytest.mark.compiled,
        ),
    ],
    ids=["platform", "plate", "lattice"],
)
def test_each_path_has_the_bits_of_a_run_of_a_file_with_its_values(tmp_path, text, axes, lines):
    study = read_study(written(tmp_path, axes, text))
    records = run_study(study).dataset
    for k, values in enumerate(study.points.values(0, len(study.points))):
        changed = text
        for value, (old, new) in zip(values, lines, strict=True):
            changed = changed.replace(old, new.format(value), 1)
        (tmp_path / "changed.toml").write_text(changed)
        case = read_case(tmp_path / "changed.toml")
        path = follow_part(case, build_surface(case), build_friction(case))
        found = {name: records[name].values.ravel()[k] for name in COLUMNS}
        assert (found["end_x"], found["end_y"]) == tuple(path.position[-1])
        assert (found["distance"], found["path_length"]) == (path.distance, path.path_length)
        assert (found["end_time"], found["largest_load"]) == (path.time[-1], path.normal_force.max())
        assert OUTCOMES[found["outcome"]] == path.outcome and found["evaluations"] == path.evaluations
        assert found["last_motion"] == (path.time[-1] if path.at_rest_since is None else path.at_rest_since)


@pytest.mark.parametrize(
    ("axes", "case"), [(SHAKEN, PLATFORM), pytest.param(STROKES, PLATE, marks=pytest.mark.compiled)]
)
def test_the_bits_do_not_depend_on_the_number_of_threads(tmp_path, axes, case):
    study = read_study(written(tmp_path, axes, case))
    assert same(run_study(study, threads=1).dataset, run_study(study, threads=3).dataset)


def test_few_trajectories_are_held_at_a_time_and_the_bits_do_not_depend_on_it(tmp_path, monkeypatch):
    study = read_study(written(tmp_path, SHAKEN, PLATFORM))
    whole, counts, many = run_study(study).dataset, [], engine.simulate_many

    def counted(surface, parts, *rest):
        counts.append(len(parts))
        return many(surface, parts, *rest)

    monkeypatch.setattr(engine, "simulate_many", counted)
    monkeypatch.setattr(engine, "HELD", 1)
    assert same(whole, run_study(study).dataset) and counts == [1] * 6


def test_a_point_that_cannot_be_run_is_refused_and_told(tmp_path):
    study = read_study(
        written(
            tmp_path,
            '[[axes]]\nfield = "part.squeeze"\nvalues = ["0 N", "1 uN"]\n'
            '[[axes]]\nfield = "friction.static_coefficient"\nvalues = [0.1, 0.4]\n',
            PLATFORM.replace('"constant"\nlimit = "20 nN"', '"coulomb"\ncoefficient = 0.2'),
        )
    )
    sweep = run_study(study)
    assert sweep.dataset["mistakes"].values.tolist() == [[1, 0], [1, 0]]
    assert sweep.outcomes["refused"] == 2 and OUTCOMES[int(sweep.dataset["outcome"][0, 0])] == "refused"
    assert np.isnan(sweep.dataset["end_x"].values[:, 0]).all() and (sweep.dataset["evaluations"][:, 0] == 0).all()
    assert sweep.first_refused == ["friction.static_coefficient must be at least coefficient, 0.2; got 0.1"]


@pytest.mark.compiled
def test_a_start_off_the_plate_is_refused_where_it_is_off(tmp_path):
    axes = '[[axes]]\nfield = "part.position.0"\nvalues = ["0 um", "290 um", "300 um", "1 m"]\n'
    found = run_study(read_study(written(tmp_path, axes))).dataset
    assert found["mistakes"].values.tolist() == [0, 0, 1, 1]
    axes = 'repeats = 60\njitter = "30 um"\n' + axes
    found = run_study(read_study(written(tmp_path, axes))).dataset
    assert 0 < found["mistakes"].sel({"part.position.0": 290e-6}).sum() < 60


@pytest.mark.parametrize(("case", "field"), [(PLATFORM, "part.mass"), (PLATE, "actuators.0.stroke")])
def test_chunks_are_as_long_as_the_cycles_that_their_paths_take(tmp_path, case, field):
    unit = "kg" if field == "part.mass" else "m"
    axes = f'[[axes]]\nfield = "{field}"\nrange = ["1e-9 {unit}", "1e-8 {unit}"]\ncount = 5000\n'
    lengths = []
    for duration in ("20 us", "2 ms", "200 ms"):
        case = re.sub(r'duration = ".*"', f'duration = "{duration}"', case)
        lengths.append(Engine(read_study(written(tmp_path, axes, case))).chunk_length)
    assert lengths[0] > 1500 and lengths[0] > lengths[1] > 1.2 * lengths[2] and lengths[2] < 100


def test_a_chunk_that_is_foreign_torn_or_of_another_length_counts_as_none(tmp_path):
    store = ChunkStore(tmp_path / "chunks", "ab" * 32)
    assert store.load(0, 3) is None
    records = new_records(3)
    records["end_x"] = [1.0, 2.0, np.nan]
    store.save(0, records)
    assert store.load(0, 3).tobytes() == records.tobytes()
    assert store.load(0, 4) is None and store.load(1, 3) is None
    assert ChunkStore(tmp_path / "chunks", "ac" * 32).load(0, 3) is None
    (file,) = (tmp_path / "chunks").iterdir()
    whole = file.read_bytes()
    for torn in (b"", whole[:10], whole[:-1], whole[:-9] + bytes([whole[-9] ^ 1]) + whole[-8:]):
        file.write_bytes(torn)
        assert store.load(0, 3) is None
    store.clear()
    assert list(tmp_path.iterdir()) == []


def test_finished_chunks_are_not_found_again_and_other_ones_are(tmp_path, monkeypatch):
    monkeypatch.setattr(Engine, "_chunk_length", lambda engine: 2)
    study = read_study(written(tmp_path, SHAKEN, PLATFORM))
    whole = run_study(study).dataset
    asked = []
    records = Engine.records

    def counted(self, start, stop):
        if len(asked) == 2:
            raise KeyboardInterrupt
        asked.append(start // 2)
        return records(self, start, stop)

    monkeypatch.setattr(Engine, "records", counted)
    with pytest.raises(KeyboardInterrupt):
        run_study(study, tmp_path / "out")
    assert sorted(file.name for file in (tmp_path / "out").rglob("*.chunk")) == [
        "0000000000-0000000002.chunk",
        "0000000002-0000000004.chunk",
    ]
    asked.clear()
    told = []
    sweep = run_study(study, tmp_path / "out", tell=lambda done, of: told.append((done, of)))
    assert asked == [2] and told == [(4, 6), (6, 6)]
    assert same(whole, sweep.dataset)
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == ["study.nc", "study.sweep.png"]
    asked.clear()
    assert same(whole, run_study(study, tmp_path / "out").dataset) and asked == []
    changed = read_study(written(tmp_path, SHAKEN.replace("40 um", "41 um"), PLATFORM))
    with pytest.raises(KeyboardInterrupt):  # it begins anew, and is stopped after two chunks
        run_study(changed, tmp_path / "out", overwrite=True)
    assert asked == [0, 1] and same(whole, read_dataset(tmp_path / "out" / "study.nc").load())


def test_the_key_is_that_of_what_the_results_depend_on(tmp_path):
    def key(study=SHAKEN, case=PLATFORM):
        return read_study(written(tmp_path, study, case)).key

    assert key() == key("# a remark\n" + SHAKEN, PLATFORM + "# another one\n")
    others = [
        key(SHAKEN.replace("40 um", "41 um")),
        key(SHAKEN.replace('"stroke"\n', '"Stroke"\n')),
        key('repeats = 2\njitter = "1 um"\n' + SHAKEN),
        key('repeats = 2\njitter = "1 um"\nseed = 1\n' + SHAKEN),
        key(case=PLATFORM.replace('"2e-9 kg"', '"3e-9 kg"')),
    ]
    assert len({key(), *others}) == 6


def test_the_key_knows_the_content_of_a_measured_motion(tmp_path):
    motion = tmp_path / "motion.csv"
    case = re.sub(r"\[plate\.motion\.x\].*?\n\n", "", PLATFORM, flags=re.S)
    case = case.replace('"platform"', '"platform"\nmotion = "motion.csv"')
    keys = set()
    for size in (1, 2):
        rows = [f"{time},{size * np.sin(time)}" for time in range(8)]
        motion.write_text("time [ms], x [um]\n" + "\n".join(rows) + "\n")
        keys.add(read_study(written(tmp_path, '[[axes]]\nfield = "part.mass"\nvalues = ["1e-9 kg"]\n', case)).key)
    assert len(keys) == 2


def test_the_command_says_what_it_found(tmp_path):
    path = written(tmp_path, SHAKEN, PLATFORM)
    done = CliRunner().invoke(main, ["sweep", str(path), "-o", str(tmp_path / "out")])
    assert done.exit_code == 0
    assert done.stdout.splitlines()[0] == "paths       6: 3 stroke x 2 friction.limit"
    done = CliRunner().invoke(main, ["sweep", str(path), "-o", str(tmp_path / "out"), "--json", "--threads", "1"])
    assert json.loads(done.stdout)["dimensions"] == {"stroke": 3, "friction.limit": 2}
    done = CliRunner().invoke(main, ["sweep", str(path), "-o", str(tmp_path / "out"), "--quiet"])
    assert (done.exit_code, done.output) == (0, "")
    assert xarray.open_dataset(tmp_path / "out" / "study.nc", engine="h5netcdf")["end_x"].attrs["units"] == "m"


def test_a_study_with_mistakes_leaves_nothing_behind(tmp_path):
    path = written(tmp_path, SHAKEN.replace("plate.motion", "plate.motio"), PLATFORM)
    done = CliRunner().invoke(main, ["sweep", str(path), "-o", str(tmp_path / "out")])
    assert done.exit_code == 2 and "axes[1].field" in done.output and "Traceback" not in done.output
    assert not (tmp_path / "out").exists()


def command(path, folder):
    return [sys.executable, "-m", "active_surface", "sweep", str(path), "--output", str(folder), "--quiet"]


def stopped_after(chunks, path, folder, number):
    """The exit code of a sweep that got a signal when it had so many chunks; its errors."""
    with subprocess.Popen(command(path, folder), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        while len(list(Path(folder).rglob("*.chunk"))) < chunks:
            assert process.poll() is None
            time.sleep(0.002)
        process.send_signal(number)
        _, errors = process.communicate(timeout=60)
    return process.returncode, errors


@pytest.mark.compiled
@pytest.mark.skipif(sys.platform == "win32", reason="needs signals")
def test_a_sweep_that_is_killed_and_resumed_has_the_bits_of_one_that_was_not(tmp_path):
    path, folder = written(tmp_path, PLATES), tmp_path / "out"
    whole = run_study(read_study(path)).dataset
    for chunks in (1, 3, 6):
        assert stopped_after(chunks, path, folder, signal.SIGKILL)[0] == -signal.SIGKILL
        assert len(list(folder.rglob("*.chunk"))) >= chunks and not (folder / "study.nc").exists()
    kept = {file: file.read_bytes() for file in folder.rglob("*.chunk")}
    code, errors = stopped_after(len(kept) + 1, path, folder, signal.SIGINT)
    assert (code, errors) == (130, "interrupted; the same command goes on where this one stopped\n")
    assert all(file.read_bytes() == content for file, content in kept.items())
    subprocess.run(command(path, folder), check=True)
    assert same(whole, read_dataset(folder / "study.nc").load())
    assert sorted(file.name for file in folder.iterdir()) == ["study.nc", "study.sweep.png"]


def test_records_have_the_kinds_of_their_columns():
    assert KIND.names == tuple(COLUMNS) and new_records(2)["outcome"].tolist() == [len(OUTCOMES) - 1] * 2
