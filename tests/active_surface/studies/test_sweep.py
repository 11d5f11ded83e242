"""Sweeps: the same bits as single runs, for any number of threads and after any interruption."""

import json

import numpy as np
import pytest
import xarray
from click.testing import CliRunner
from sweeps import LATTICE, PLATE, PLATFORM, SHAKEN, same, written

from active_surface.cli.program import main
from active_surface.studies import Engine, lines, read_study, run_study
from active_surface.studies.columns import COLUMNS, KIND, OUTCOMES, new_records
from coupling import batch, read_case
from coupling.case import CaseError
from coupling.run import build_friction, build_surface, follow_part

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
            marks=[pytest.mark.compiled, pytest.mark.slow],
        ),
        pytest.param(
            LATTICE,
            '[[axes]]\nfield = "lattice.stroke"\nvalues = ["50 um", "70 um"]\n',
            [('stroke = "5 * (1 + column) um"', 'stroke = "{} m"')],
            marks=[pytest.mark.compiled, pytest.mark.slow],
        ),
    ],
    ids=["platform", "plate", "lattice"],
)
def test_each_path_has_the_bits_of_a_run_of_a_file_with_its_values(tmp_path, text, axes, lines):
    study = read_study(written(tmp_path, axes, text))
    records = run_study(study).dataset
    for k, values in enumerate(study.points.values(range(len(study.points)))):
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
    ("axes", "case"), [(SHAKEN, PLATFORM), pytest.param(STROKES, PLATE, marks=[pytest.mark.compiled, pytest.mark.slow])]
)
def test_the_bits_do_not_depend_on_the_number_of_threads(tmp_path, axes, case):
    study = read_study(written(tmp_path, axes, case))
    assert same(run_study(study, threads=1).dataset, run_study(study, threads=3).dataset)


def test_few_trajectories_are_held_at_a_time_and_the_bits_do_not_depend_on_it(tmp_path, monkeypatch):
    study = read_study(written(tmp_path, SHAKEN, PLATFORM))
    whole, counts, many = run_study(study).dataset, [], batch.simulate_many

    def counted(surface, parts, *rest):
        counts.append(len(parts))
        return many(surface, parts, *rest)

    monkeypatch.setattr(batch, "simulate_many", counted)
    monkeypatch.setattr(batch, "AT_ONCE", 1)
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
    wrong = "friction.static_coefficient must be at least coefficient, 0.2; got 0.1"
    assert sweep.first_refused == [wrong]
    said = f"2 of 4 paths, the first at part.squeeze = 0 N, friction.static_coefficient = 0.1: {wrong}"
    assert ("refused", said) in lines(sweep)


@pytest.mark.slow
@pytest.mark.compiled
@pytest.mark.parametrize("case", [PLATE, PLATFORM], ids=["plate", "platform"])
def test_a_point_with_cycles_without_end_is_refused(tmp_path, case, monkeypatch):
    checked: list[float] = []

    def noted(engine, case):
        checked.append(case.actuators[0].frequency)
        return scene(engine, case)

    scene = Engine.scene
    monkeypatch.setattr(Engine, "scene", noted)
    field = "plate.motion.x.frequency" if case is PLATFORM else "actuators.0.frequency"
    axes = f'[[axes]]\nfield = "{field}"\nvalues = ["400 Hz", "1e12 Hz"]\n'
    sweep = run_study(read_study(written(tmp_path, axes, case)))
    assert sweep.dataset["mistakes"].values.tolist() == [0, 1]
    assert checked == ([] if case is PLATFORM else [checked[0], 400.0])  # nor is the model checked where it is refused
    (said,) = sweep.first_refused
    assert said.startswith("run.duration must have at most 100000 cycles, or points, of each drive; got ")
    axes = axes.replace('"400 Hz"', '"1e11 Hz"')
    with pytest.raises(CaseError, match="at every point: run.duration must have at most 100000 cycles, or points"):
        run_study(read_study(written(tmp_path, axes, case)))


@pytest.mark.slow
@pytest.mark.compiled
def test_a_start_off_the_plate_is_refused_where_it_is_off(tmp_path):
    axes = '[[axes]]\nfield = "part.position.0"\nvalues = ["0 um", "290 um", "300 um", "1 m"]\n'
    found = run_study(read_study(written(tmp_path, axes))).dataset
    assert found["mistakes"].values.tolist() == [0, 0, 1, 1] and np.isnan(found["start_x"].values[-1])
    axes = 'repeats = 60\njitter = "30 um"\n' + axes
    found = run_study(read_study(written(tmp_path, axes))).dataset
    assert 0 < found["mistakes"].sel({"part.position.0": 290e-6}).sum() < 60


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
    assert done.exit_code == 2 and "axes[0].field" in done.output and "Traceback" not in done.output
    assert not (tmp_path / "out").exists()


def test_records_have_the_kinds_of_their_columns():
    assert KIND.names == tuple(COLUMNS) and new_records(2)["outcome"].tolist() == [len(OUTCOMES) - 1] * 2
