"""Measured numbers of a case: platforms that move as a CSV file or drives say, and friction at measured points."""

import numpy as np
import pytest
from case_files import PLATFORM, POINTS, REST, answered_otherwise, changed, problems, python_case
from case_files import read as read_text

import particle
from coupling.case import Case, KogutEtsionCase, TableCase, has_known_law, read_case, read_columns
from coupling.case.plates.platform import QUANTITIES
from coupling.part import build_friction, friction_law
from coupling.run import build_surface

FRAME = REST.replace("50 ms", "4 ms")
FILE = PLATFORM + 'motion = "shaker.csv"\n'
HEADER = "time [ms], x [um], z [mm]\n"
ROWS = "".join(f"{time / 2}, {time**2}, {-time}\n" for time in range(10))


def read(folder, plate):
    return read_text(folder, plate + FRAME)


def test_drives_of_its_axes(tmp_path):
    plate = """\
[plate]
shape = "platform"
[plate.motion.x]
stroke = "20 um"
frequency = "400 Hz"
cycle = "sine"
delay = "1 ms"
[plate.motion.z]
table = [["0 ms", "0 um"], ["2 ms", "5 um"]]
[[plate.motion.y.segments]]
stroke = "3 um"
frequency = "1 kHz"
"""
    surface = build_surface(read(tmp_path, plate))
    assert surface.evaluate([[1.0, 1.0]], 1e-3).w[0] == pytest.approx(2.5e-6)
    assert surface.moving_base and surface.size == pytest.approx(40e-6)
    assert (surface.drives.repeats == [1, np.inf, 1]).all()  # z, x, y
    assert (surface.drives.delay == [0, 1e-3, 0]).all()


def test_a_measured_motion_counts_time_from_its_first_row(tmp_path):
    rows = "".join(f"{3 + time}, {time**2 / 1e3}\n" for time in range(10))
    (tmp_path / "shaker.csv").write_text("# measured\n\ntime [ms] , z [mm]\n" + rows)
    surface = build_surface(read(tmp_path, FILE))
    state = surface.evaluate([[0.0, 0.0]], 3.5e-3)
    assert state.w[0] == pytest.approx(3.5**2 * 1e-6)
    assert state.w_tt[0] == pytest.approx(2.0)
    assert surface.size == pytest.approx(81e-6)


def test_a_platform_may_stand_still(tmp_path):
    for plate in (PLATFORM, PLATFORM + "[plate.motion]\n"):
        surface = build_surface(read(tmp_path, plate))
        assert surface.evaluate([[0.0, 0.0]], 1e-3).w[0] == 0.0


def test_a_platform_in_python():
    run = {"duration": 1e-3, "gravity": (0.0, 1.0, -9.8)}
    case = python_case(plate={"shape": "platform", "motion": {"x": {"stroke": 1e-6, "frequency": 3.0}}}, run=run)
    assert case.actuators == ()
    assert Case.model_validate(case.model_dump()) == case
    assert Case.model_validate_json(case.model_dump_json()) == case


WRONG_MOTIONS = r"""
empty => is empty; it must begin with a header such as "time [ms], x [um], z [um]"
empty | + rows => line 1 must be a header such as "time [ms], x [um], z [um]"; got "0.0, 0, 0"
empty | + time, q, z [s] => line 1 must give time in a unit of time, as in "time [ms]" && must give z in ... got [s]
empty | + x [um], x [umm] => has two columns x && must give x in a unit ... got [umm] && must have a column time, as in
empty | + time [ms], x [um], vy [m/s] | + rows => must have a column y beside vy: positions say where the motion is
empty | + time [ms]\n1 => line 1 must have a column x, y or z, as in
empty | + time [ms], X [um], position [um]\n1, 1, 1 => must have at least 6 rows below its header; got 1
+ 0, abc, nan => line 2 must have a finite number as x; got "abc" && line 2 must have a finite number as z; got "nan"
+ 0, 0, 0\n2, 3\n\n3, , 1 => line 3 must have 3 columns; got 2 && line 5 must have a finite number as x; got ""
+ rows | + \n1, 0, 0\n1, 0, 0 => line 13 must have a later time ... got 0.001 s after 0.0045 s && line 14 must have
+ rows | + long => has a cell of more than 131072 characters, the most that is read
"""


def test_every_mistake_in_a_measured_motion_is_reported_with_its_line(tmp_path):
    def answers(text):
        (tmp_path / "shaker.csv").write_text(text)
        found = problems(tmp_path, FILE + FRAME)
        assert all(line.startswith("3 plate.motion in shaker.csv: ") for line in found)
        return found

    texts = {"header": HEADER, "rows": ROWS, "empty": "", "long": f"0, {'5' * 200_000}\n"}
    assert answered_otherwise(WRONG_MOTIONS, answers, **texts) == []
    assert answers(HEADER + "a, b, c\n" * 30)[10:] == ["3 plate.motion in shaker.csv: has 80 more mistakes"]
    (tmp_path / "shaker.csv").write_bytes(b"\xff\xfe\x00")
    wrong = "3 plate.motion in shaker.csv: is not text in UTF-8, UTF-16 or Windows-1252"
    assert problems(tmp_path, FILE + FRAME) == [wrong]
    with (tmp_path / "shaker.csv").open("wb") as file:
        file.truncate(64 * 2**20 + 1)
    assert "it has more than 64 MiB" in problems(tmp_path, FILE + FRAME)[0]


def test_a_motion_must_last_as_long_as_the_run(tmp_path):
    (tmp_path / "shaker.csv").write_text(HEADER + ROWS)
    assert read(tmp_path, FILE).run.duration == 4e-3
    (tmp_path / "shaker.csv").write_text(HEADER + "".join(ROWS.splitlines(keepends=True)[:8]))
    assert problems(tmp_path, FILE + FRAME) == [
        "12 run.duration must not exceed the measured motion's, 0.0035 s; got 0.004 s"
    ]


def test_columns_of_other_names_are_ignored(tmp_path):
    rows = "".join(f"{time}, -, {time**2}, {2 * time}, {2 * time}\n" for time in range(10))
    (tmp_path / "shaker.csv").write_text("time [ms], note, x [um], vx [mm/s], temperature [K]\n" + rows)
    motion, _ = read(tmp_path, FILE).plate.read_motion
    assert motion.ignored == ("note", "temperature [K]") and set(motion.columns) == {"x", "vx"}
    assert motion.columns["vx"][3] == pytest.approx(6e-3)


DIALECTS = {
    "semicolons": "time [ms];x [um]\n0;0\n1;2.5\n",
    "decimal commas": "time [ms];x [um]\n0,0;0\n1,0;2,5\n",
    "tabs": "time [ms]\tx [um]\n0\t0\n1\t2,5e0\n",
    "parentheses": "Time (ms), X (um)\n0, 0\n1, 2.5\n",
    "a row of units": "time,x\nms,um\n0,0\n1,2.5\n",
    "Windows-1252": "time [ms], x [\xb5m]\n0, 0\n1, 2.5\n".encode("cp1252"),
    "UTF-16": "time [ms], x [\xb5m]\n0, 0\n1, 2.5\n".encode("utf-16"),
    "TrackMate": "LABEL,POSITION_X,POSITION_T\nLabel,X,T\n,(micron),(sec)\nID0,0,0\nID1,2.5,0.001\n",
    "lost frames": "time [ms], x [um]\n0, 0\n0.4, \n0.6, NaN\n1, 2.5\n",
}


@pytest.mark.parametrize("name", DIALECTS)
def test_files_of_instruments_and_trackers_are_read(tmp_path, name):
    content, file = DIALECTS[name], tmp_path / "shaker.csv"
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    found = read_columns(file, QUANTITIES, [["time"], ["x"]], HEADER)
    assert found.mistakes == [] and found.lost == (2 if name == "lost frames" else 0)
    assert found.columns["time"] == pytest.approx([0, 1e-3]) and found.columns["x"] == pytest.approx([0, 2.5e-6])


def test_what_is_ambiguous_is_refused(tmp_path):
    for content, said in {
        "time [ms], x [um]\n0,0, 1,5\n": "line 2 must have 2 columns; got 4",
        ",y,x,frame\n0,1,2,0\n": "line 1 must have a column time",
        "scorer,m,m\ncoords,x,y\n0,1,2\n": 'got "scorer, m, m"',
    }.items():
        (tmp_path / "shaker.csv").write_text(content)
        found = read_columns(tmp_path / "shaker.csv", QUANTITIES, [["time"], ["x"]], HEADER)
        assert any(said in mistake for mistake in found.mistakes), found.mistakes


LAW = 'model = "kogut-etsion"'
BY_FILE = 'model = "table"\nfile = "friction.csv"'
CSV = "load [uN], limit [nN]\n-1, 10\n0, 20\n5, 50\n"
MEASURED = TableCase(loads=(-1e-6, 0.0, 5e-6), limits=(1e-8, 2e-8, 5e-8))


def test_points_in_the_case_file(tmp_path):
    case = read_text(tmp_path, changed((LAW, POINTS + "\nstatic_ratio = 1.2")))
    assert case.friction == MEASURED.model_copy(update={"static_ratio": 1.2})
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
def test_points_in_a_file_beside_the_case(points, tmp_path, monkeypatch):
    (tmp_path / "friction.csv").write_text(points)
    (tmp_path / "case.toml").write_text(changed((LAW, BY_FILE)))
    monkeypatch.chdir("/")
    case = read_case(tmp_path / "case.toml")
    assert case.friction == MEASURED
    assert TableCase(**case.friction.model_dump()) == case.friction
    assert type(case)(**case.model_dump()).friction == case.friction


WRONG_POINTS = r"""
+ -1 \xb5 => line 2 must have 2 columns; got 1
empty => is empty; it must begin with a header such as "load [uN], limit [nN]"
empty | + load; limit\n1; 2 => line 1 must give load in a unit of force && line 1 must give limit in a unit of force
[uN] -> [uN], load [N] => line 1 has two columns load
limit -> lmit => line 1 has a column "lmit [nN]" that is not known; did you mean limit? && line 1 must have a
[nN] -> [nm] => line 1 must give limit in a unit of force, as in "limit [uN]"; got [nm]
+ -1, 10\n0, 20 => has too few points; loads must be 3 forces in N or more; got 2
+ 1, 10\n0, abc\n4, 8, 9 => line 3 must have a finite number as limit; got "abc" && line 4 must have 2 columns; got 3
+ 1, 10\n\n5, 1\n6, 2 => line 2 load must be minus ... got 1e-06 N && line 4 limit must not be less ... got 1e-09 N
+ -1, 10\n5, 20\n3, -3 => line 4 load must be greater than the one before && line 4 limit must be 0 or positive
"""


def test_everything_wrong_with_points_in_a_file_is_reported_at_once_with_its_lines(tmp_path):
    def answers(text):
        (tmp_path / "friction.csv").write_bytes(text.encode("cp1252"))
        found = problems(tmp_path, changed((LAW, BY_FILE)))
        assert all(line.startswith("29 friction.file in friction.csv: ") for line in found)
        return found

    assert answered_otherwise(WRONG_POINTS, answers, header="load [uN], limit [nN]\n", empty="") == []


@pytest.mark.parametrize("preset", [None, "paper"])
def test_the_default_numbers_have_a_law_that_check_need_not_make(preset):
    standard = KogutEtsionCase(preset=preset)
    assert has_known_law(standard) and friction_law(standard).law
    for key, value in {"roughness": 21e-9, "plasticity_index": 3.0, "coefficients": "unrounded"}.items():
        assert not has_known_law(standard.model_copy(update={key: value}))


def test_defaults_and_preset_of_the_case_file_are_those_of_the_contact():
    assert particle.KogutEtsion(**KogutEtsionCase().model_dump(exclude={"model", "preset"})) == particle.KogutEtsion()
    read = KogutEtsionCase(preset="paper")
    assert particle.KogutEtsion(**read.model_dump(exclude={"model", "preset"})) == particle.KogutEtsion.paper()
