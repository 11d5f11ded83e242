"""Points of a study from a file: the same as a list in the study, mistakes by their lines, sweeps over them."""

import csv

import numpy as np
import pytest
from click.testing import CliRunner
from sweeps import LATTICE, PLATFORM, written

from active_surface.cli.program import main
from active_surface.studies import read_study, run_study
from active_surface.studies.read import read_sweep
from coupling.case import CaseError

STUDY = 'points = "points.csv"\n'
NAMED = STUDY + '[[axes]]\nfield = "plate.motion.x.frequency"\nname = "frequency"\n'
ROWS = """\
# two columns that the study does not list, and one that it gives a name
frequency [kHz], part.mass, plate.motion.x.cycle

0.2, 2e-9, up-down
.3, 3 ug, "sine"
"""
LISTED = """\
sampling = "list"
[[axes]]
field = "plate.motion.x.frequency"
name = "frequency"
values = ["0.2 kHz", "0.3 kHz"]
[[axes]]
field = "part.mass"
values = ["2e-9 kg", "3 ug"]
[[axes]]
field = "plate.motion.x.cycle"
values = ["up-down", "sine"]
"""


def study(tmp_path, text, rows, case=PLATFORM):
    (tmp_path / "points.csv").write_text(rows)
    return read_study(written(tmp_path, text, case))


def mistakes(tmp_path, text, rows, case=PLATFORM):
    with pytest.raises(CaseError) as caught:
        study(tmp_path, text, rows, case)
    return [f"{problem.field} {problem.message}" for problem in caught.value.problems]


def test_points_of_a_file_are_those_of_a_list_with_the_same_values(tmp_path):
    read = study(tmp_path, NAMED, ROWS)
    listed = read_study(written(tmp_path, LISTED, PLATFORM))
    assert read.points == listed.points and read.key == listed.key
    assert read.points.values(range(2)) == [(200.0, "up-down", 2e-9), (300.0, "sine", 3e-9)]


def test_whole_numbers_and_truths_may_be_written_as_tables_have_them(tmp_path):
    rows = "lattice.columns,plate.top_face,lattice.pitch\n2.0,False,90e-6\n3,TRUE,100 um\n"
    read = study(tmp_path, STUDY, rows, LATTICE)
    assert read.points.values(range(2)) == [(2, "false", 9e-05), (3, "true", 1e-4)]


@pytest.mark.parametrize(
    ("text", "rows", "expected"),
    [
        (NAMED, "", ["is empty; it must begin with a header such as"]),
        (NAMED, "frequency\n", ["has no points below its header"]),
        (NAMED, "part.mass\n1\n", ["axes[0].field must be a column of points.csv, which has part.mass"]),
        (NAMED, "frequency,part.mas\n1,1\n", ['column "part.mas" must be a field of the case; part has no mas']),
        (NAMED, "frequncy\n1\n", ["axes[0].field must be", 'column "frequncy" is not known; did you mean frequency?']),
        (NAMED, ",frequency\n0,1\n", ["line 1 has a column without a name"]),
        (NAMED, "frequency,frequency\n1,2\n", ['line 1 has two columns "frequency"']),
        (STUDY, "friction.model\ncoulomb\n", ['column "friction.model" cannot be varied']),
        (STUDY, "part.mass [um]\n1\n", ['line 2 part.mass must be a mass such as "2e-9 kg"; got "1 um", a length']),
        (STUDY, "part.mass [kg]\n1 kg\n", ["line 2 part.mass must be a number, as the column is in kg"]),
        (
            STUDY,
            "part.mass,plate.motion.x.cycles\n1e-9,\n\n2e-9,2.5\nnan,2\n1 um,many\n1\n1,2,3\ninf,\n",
            [
                "line 2 plate.motion.x.cycles must not be empty",
                "line 4 plate.motion.x.cycles must be a whole number; got 2.5",
                'line 5 part.mass must be a finite number; got "nan"',
                'line 6 part.mass must be a mass such as "2e-9 kg"; got "1 um", a length',
                'line 6 plate.motion.x.cycles must be a whole number; got "many"',
                "line 7 must have 2 columns; got 1",
                "line 8 must have 2 columns; got 3",
                'line 9 part.mass must be a finite number; got "inf"',
                "line 9 plate.motion.x.cycles must not be empty",
            ],
        ),
        (
            STUDY,
            "part.mass\n" + "x\n" * 12,
            [*[f"line {k} part.mass must" for k in range(2, 12)], "has 2 more mistakes"],
        ),
    ],
)  # fmt: skip
def test_all_mistakes_of_a_file_are_reported_with_their_lines(tmp_path, text, rows, expected):
    found = mistakes(tmp_path, text, rows)
    assert len(found) == len(expected)
    assert all(any(part in message for message in found) for part in expected), found


def test_a_file_of_points_leaves_no_room_for_other_ways_to_choose_them(tmp_path):
    found = mistakes(tmp_path, 'sampling = "sobol"\n' + NAMED, "frequency\n100\n")
    found += mistakes(tmp_path, NAMED + 'values = ["1 Hz"]\n', "frequency\n100\n")
    assert 'study.sampling must be "list" or left out with a file of points; got "sobol"' in found
    assert "axes[0].values must not be given with a file of points, which has the values" in found
    assert mistakes(tmp_path, 'points = "points.txt"\n' + LISTED[LISTED.index("[[") :], "")[0].startswith(
        'study.points must be a whole number from 1 to 1000000000, or a file of points such as "points.csv"; got'
    )
    (tmp_path / "points.csv").unlink()
    with pytest.raises(CaseError, match='study.points must be a file that can be read; got "points.csv": no such file'):
        read_study(written(tmp_path, STUDY, PLATFORM))


def test_a_sweep_over_a_file_grows_with_it_and_is_read_back_without_it(tmp_path):
    study(tmp_path, NAMED, ROWS)
    command = ["sweep", str(tmp_path / "study.toml"), "-o", str(tmp_path / "out")]
    assert CliRunner().invoke(main, command).exit_code == 0
    with (tmp_path / "points.csv").open("a") as file:
        file.write("250 Hz, 1 ug, up\n")  # without a unit of its own the column's is kHz
    done = CliRunner().invoke(main, command)
    assert done.exit_code == 2 and "line 6 frequency must be a number, as the column is in kHz" in done.output
    (tmp_path / "points.csv").write_text(ROWS + ".25, 1 ug, up\n")
    done = CliRunner().invoke(main, command)
    assert "kept        2 of these paths from an earlier sweep; 1 is new\n" in done.output
    expected = read_study(tmp_path / "study.toml")
    (tmp_path / "points.csv").unlink()
    read, dataset = read_sweep(tmp_path / "out" / "study.nc")
    with dataset:
        assert read.key == expected.key and dataset.sizes == {"point": 3}


def test_a_parquet_file_is_read_like_a_table(tmp_path):
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow", reason="needs the extra parquet")
    table = pandas.DataFrame({"part.mass": [1e-9, 2e-9], "plate.motion.x.frequency": ["200 Hz", "0.3 kHz"]})
    table.to_parquet(tmp_path / "points.parquet")
    read = read_study(written(tmp_path, STUDY.replace("csv", "parquet"), PLATFORM))
    assert read.points.values(range(2)) == [(200.0, 1e-9), (300.0, 2e-9)]
    table.loc[1, "part.mass"] = np.nan
    table.to_parquet(tmp_path / "points.parquet")
    with pytest.raises(CaseError, match="in points.parquet: row 2 part.mass must not be empty"):
        read_study(tmp_path / "study.toml")
    (tmp_path / "points.parquet").write_text("part.mass\n1\n")
    with pytest.raises(CaseError, match=r'got "points.parquet": it is no parquet file'):
        read_study(tmp_path / "study.toml")


def test_sensitivities_by_salib(tmp_path):
    """As on the page on sweeps: points by SALib, indices of what the sweep found."""
    sample = pytest.importorskip("SALib.sample.sobol")
    analyze = pytest.importorskip("SALib.analyze.sobol")
    fields = ["plate.motion.x.stroke", "plate.motion.x.frequency", "friction.limit"]
    problem = {"num_vars": 3, "names": fields, "bounds": [[10e-6, 30e-6], [150.0, 250.0], [10e-9, 30e-9]]}
    points = sample.sample(problem, 8, calc_second_order=False, seed=1)
    with (tmp_path / "points.csv").open("w", newline="") as file:
        csv.writer(file).writerows([fields, *points.tolist()])
    swept = run_study(read_study(written(tmp_path, STUDY, PLATFORM))).dataset
    assert [swept[field].values.tolist() for field in fields] == points.T.tolist()
    indices = analyze.analyze(problem, swept["path_length"].values, calc_second_order=False, seed=1)
    assert np.isfinite(indices["ST"]).all() and indices["ST"][1] > 0.1
