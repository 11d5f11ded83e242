"""Friction in a case file: measured points there or in a file beside it, and laws that have no answer."""

from pathlib import Path

import pytest
from click.testing import CliRunner

import particle
from active_surface.cli.program import main
from coupling.case import CaseError, KogutEtsionCase, TableCase, has_known_law, read_case
from coupling.part import build_friction, friction_law

EXAMPLE = (Path(__file__).parents[3] / "examples" / "one_actuator.toml").read_text()
BEFORE, REST = EXAMPLE.split("[friction]")
AFTER = REST[REST.index("[run]") :]
LINE = BEFORE.count("\n") + 2  # of the first line in [friction]

LISTS = 'model = "table"\nloads = ["-1 uN", "0 N", "5 uN"]\nlimits = ["10 nN", "20 nN", "50 nN"]'
FILE = 'model = "table"\nfile = "friction.csv"'
CSV = "load [uN], limit [nN]\n-1, 10\n0, 20\n5, 50\n"
POINTS = TableCase(loads=(-1e-6, 0.0, 5e-6), limits=(1e-8, 2e-8, 5e-8))


@pytest.fixture
def write(tmp_path):
    def case(friction, points=None):
        file = tmp_path / "case.toml"
        file.write_text(f"{BEFORE}[friction]\n{friction}\n\n{AFTER}")
        if points is not None:
            (tmp_path / "friction.csv").write_bytes(points.encode() if isinstance(points, str) else points)
        return file

    return case


def mistakes(file):
    with pytest.raises(CaseError) as caught:
        read_case(file)
    return [(p.line - LINE + 1 if p.line else None, f"{p.field} {p.message}") for p in caught.value.problems]


def test_points_in_the_case_file(write):
    case = read_case(write(LISTS + "\nstatic_ratio = 1.2"))
    assert case.friction == POINTS.model_copy(update={"static_ratio": 1.2})
    assert build_friction(case) == particle.FrictionTable((-1e-6, 0.0, 5e-6), (1e-8, 2e-8, 5e-8), 1.2)


@pytest.mark.parametrize(
    "points",
    [
        CSV,
        "\ufeff" + CSV.replace("\n", "\r\n"),
        "# measured\n\nspread [nN], limit [uN], load [N]\n1, 0.010, -1e-6\n\n# again\n1, 0.020, 0\n2, 0.050, 5e-6",
    ],
    ids=["plain", "windows", "other columns and units"],
)
def test_points_in_a_file_beside_the_case(write, points, tmp_path, monkeypatch):
    file = write(FILE, points)
    monkeypatch.chdir("/")
    assert read_case(file).friction == POINTS


def test_a_table_keeps_its_points_through_a_dump(write):
    case = read_case(write(FILE, CSV))
    assert TableCase(**case.friction.model_dump()) == case.friction
    assert type(case)(**case.model_dump()).friction == case.friction


MANY = """load [uN], limit [nN]
1, 10
0, abc
5, 1
4, 8, 9
3, -3
"""
BAD_FILES = [
    (None, ['must be a file that can be read; got "friction.csv": no such file or directory']),
    (b"load [uN], limit [nN]\n-1 \xb5", ["line 2 must have 2 columns; got 1"]),
    ("# nothing\n", ['is empty; it must begin with a header such as "load [uN], limit [nN]"']),
    ("load; limit\n1; 2\n", ['line 1 must name one column "load"', 'line 1 must name one column "limit"']),
    ("load [uN], load [N], limit [nN]\n", ['line 1 must name one column "load"']),
    (CSV.replace("nN", "nm"), ["line 1 must give the limit in a unit of force, such as uN; got [nm]"]),
    ("load [uN], limit [nN]\n-1, 10\n0, 20", ["has too few points; loads must be 3 forces in N or more; got 2"]),
    (
        MANY,
        [
            "line 2 load must be minus the pull-off force, so 0 or negative; got 1e-06 N",
            'line 3 limit must be a force such as "2 uN"; got "abc nN", which is not a number and a unit',
            "line 4 limit must not be less than the one before, 1e-08 N; got 1e-09 N",
            "line 5 must have 2 columns; got 3",
            "line 6 load must be greater than the one before, 5e-06 N; got 3e-06 N",
            "line 6 limit must be 0 or positive; got -3e-09 N",
        ],
    ),
]


def test_everything_wrong_with_a_file_is_told_at_once_with_its_lines(write):
    for points, says in BAD_FILES:
        found = mistakes(write(FILE, points))
        assert len(found) == len(says)
        for (line, message), said in zip(found, says, strict=True):
            where = "" if said.startswith("must be a file") else "in friction.csv: "
            assert line == 2 and message.startswith(f"friction.file {where}{said}")


MISSING = 'friction.loads is missing; it must be forces such as ["-1 uN", "0 N", "5 uN"], or have file = "friction.csv"'


@pytest.mark.parametrize(
    "fields, says",
    [
        ("", [(0, MISSING)]),
        ('load = ["-1 uN"]', [(2, 'friction.load is not known; write loads = ["-1 uN"]')]),
        (
            'limits = ["-1 uN", "0 N", "1 N"]',
            [(0, MISSING), (2, "friction.limits[0] must be 0 or positive; got -1e-06 N")],
        ),
        (
            'loads = ["-1 uN", "0 N", "1 N"]',
            [(0, "friction.limits is missing; it must be as many forces as the loads")],
        ),
        (
            'loads = ["1 uN", "0 N"]\nlimits = 3',
            [
                (2, "friction.loads[0] must be minus the pull-off force, so 0 or negative; got 1e-06 N"),
                (2, "friction.loads[1] must be greater than the one before, 1e-06 N; got 0.0 N"),
                (3, 'friction.limits must be a list of forces such as ["-1 uN", "0 N", "5 uN"]; got 3'),
            ],
        ),
        (
            'loads = ["-1 uN", "0 N", "5 Hz"]\nlimits = [\n  "10 nN", "2 nN",\n  1]\nstatic_ratio = 0.5',
            [
                (2, 'friction.loads[2] must be a force such as "2 uN"; got "5 Hz", a frequency'),
                (3, 'friction.limits[2] must be a force such as "2 uN"; got 1, which has no unit'),
                (6, "friction.static_ratio must be at least 1; got 0.5"),
            ],
        ),
        (
            'loads = ["-1 uN", "1 N"]\nlimits = ["1 N"]',
            [
                (2, "friction.loads must be 3 forces in N or more; got 2"),
                (3, "friction.limits must be as many as the loads, 2; got 1"),
            ],
        ),
        (
            'file = 3\nloads = ["1 N"]\nlimits = 1',
            [
                (2, "friction.file must be text; got 3"),
                (3, "friction.loads must not be given with a file, which holds the points"),
                (4, "friction.limits must be a list of forces such as"),
                (4, "friction.limits must not be given with a file, which holds the points"),
            ],
        ),
    ],
)
def test_everything_wrong_with_points_is_told_at_once(write, fields, says):
    found = mistakes(write('model = "table"\n' + fields))
    assert len(found) == len(says)
    for (line, message), (at, said) in zip(found, says, strict=True):
        assert line == at and message.startswith(said)


REFUSED = [
    ('model = "kogut-etsion"\nroughness = "-20 nm"', 'friction.roughness must be greater than 0; got "-20 nm"'),
    ('model = "kogut-etsion"\nadhesion_energy = "1e3 J/m^2"', "Inputs of KogutEtsion must give a pull-off force"),
    ('model = "kogut-etsion"\nplasticity_index = 50.0', "Inputs of KogutEtsion must give a pull-off force"),
    ('model = "constant"\nlimit = "-1 N"', 'friction.limit must be at least 0; got "-1 N"'),
    ('model = "coulomb"\ncoefficient = -0.1', "friction.coefficient must be at least 0; got -0.1"),
    ('model = "coulomb"\ncoefficient = 0.1\nadhesion = "-1 N"', 'friction.adhesion must be at least 0; got "-1 N"'),
    ('model = "coulomb"\ncoefficient = 0.0\nstatic_coefficient = 0.5', "friction.static_coefficient must not"),
    (LISTS.replace('"20 nN"', '"2 nN"'), "friction.limits[1] must not be less than the one before"),
    (FILE, "friction.file must be a file that can be read"),
]


def test_a_refused_law_exits_2_and_leaves_nothing(write, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for k, (friction, says) in enumerate(REFUSED):
        file = write(friction)
        done = CliRunner().invoke(main, ["run" if k % 3 == 1 else "check", str(file)])
        assert done.exit_code == 2 and isinstance(done.exception, SystemExit)
        assert says in done.output and "Traceback" not in done.output
        assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize("friction", [LISTS, FILE])
def test_a_case_with_a_table_is_fine(write, friction):
    done = CliRunner().invoke(main, ["check", str(write(friction, CSV))])
    assert done.exit_code == 0 and "fine" in done.output


@pytest.mark.parametrize("preset", [None, "paper"])
def test_the_default_numbers_have_a_law_that_check_need_not_make(preset):
    standard = KogutEtsionCase(preset=preset)
    assert has_known_law(standard) and friction_law(standard).law
    for key, value in {"roughness": 21e-9, "plasticity_index": 3.0, "coefficients": "unrounded"}.items():
        assert not has_known_law(standard.model_copy(update={key: value}))


def test_defaults_of_the_case_file_are_those_of_the_contact():
    assert particle.KogutEtsion(**KogutEtsionCase().model_dump(exclude={"model", "preset"})) == particle.KogutEtsion()


def test_preset_of_the_case_file_is_that_of_the_contact():
    read = KogutEtsionCase(preset="paper")
    assert particle.KogutEtsion(**read.model_dump(exclude={"model", "preset"})) == particle.KogutEtsion.paper()
