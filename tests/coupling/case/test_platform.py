"""Platforms in a case file: their motion by drives or from a CSV file, options of the run, and what can be wrong."""

from functools import partial

import numpy as np
import pytest
from mistakes import answered_otherwise

from coupling.case import Case, CaseError, CoulombCase, PartCase, RunCase, read_case, read_columns
from coupling.case.plates.platform import QUANTITIES
from coupling.run import build_surface

FRAME = """\
[part]
mass = "2e-9 kg"
position = ["100 um", "100 um"]
[friction]
model = "constant"
limit = "1 uN"
[run]
duration = "4 ms"
"""
PLATFORM = '[plate]\nshape = "platform"\n'
FILE = PLATFORM + 'motion = "shaker.csv"\n'
HEADER = "time [ms], x [um], z [mm]\n"
ROWS = "".join(f"{time / 2}, {time**2}, {-time}\n" for time in range(10))


def read(folder, plate, run="") -> Case:
    file = folder / "test.toml"
    file.write_text(plate + FRAME + run)
    return read_case(file)


def problems(folder, plate, run=""):
    with pytest.raises(CaseError) as caught:
        read(folder, plate, run)
    return [f"{p.line} {p.field} {p.message}" for p in caught.value.problems]


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


def test_in_python(tmp_path):
    others = {
        "part": PartCase(mass=1e-9, position=(0, 0)),
        "friction": CoulombCase(coefficient=0.3),
        "run": RunCase(duration=1e-3, gravity=(0.0, 1.0, -9.8)),
    }
    motion = {"x": {"stroke": 1e-6, "frequency": 3.0}}
    case = Case(plate={"shape": "platform", "motion": motion}, **others)
    assert case.actuators == ()
    assert Case.model_validate(case.model_dump()) == case
    assert Case.model_validate_json(case.model_dump_json()) == case


def test_options_of_the_run(tmp_path):
    text = 'gravity = ["0 m/s^2", "100 cm/s^2", "-9.8 m/s^2"]\nafter_detachment = "fly"\n'
    run = read(tmp_path, PLATFORM, text).run
    assert (run.gravity, run.after_detachment, run.scheme, run.time_step) == ((0.0, 1.0, -9.8), "fly", "events", None)
    run = read(tmp_path, PLATFORM, 'scheme = "fixed"\ntime_step = "2 us"').run
    assert (run.gravity, run.scheme, run.time_step) == (9.80665, "fixed", 2e-6)
    assert read(tmp_path, PLATFORM, "").part.squeeze == 0.0


WRONG = r"""
+ radius = "3 um" => 3 plate.radius is not known; it goes with shape = "disc" or shape = "polygon" and a radius
+ motion = 3 => 3 plate.motion must be a table, written [plate.motion]; got 3
+ motion = "nowhere.csv" => 3 plate.motion must be a file that can be read; got "nowhere.csv": no such file or directory
+ smoothing = "1 um" => 3 plate.smoothing must not be given without motion = "file.csv"
+ [plate.motion]\nx = 3 => 4 plate.motion.x must be a table, written [plate.motion.x]; got 3
+ [plate.motion]\nw = 3 => 4 plate.motion.w is not known; [plate.motion] has x, y, z
+ [plate.motion.x]\nfrequency = "1 Hz" => 3 plate.motion.x.stroke is missing; it must be a length such as "150 um", or h
+ [plate.motion.x]\nstroke = "1 um" => 3 plate.motion.x.frequency is missing
+ [plate.motion.x]\nforce = "1 N" => 4 plate.motion.x.force is not known; it belongs to [[actuators]]
+ [plate.motion.x]\ncolour = 3 => 4 plate.motion.x.colour is not known; [plate.motion.x] has stroke
+ [plate.motion.x]\nstroke = "1 um"\ntable = [["0 s", "1 m"], ["1 s", "2 m"]] => 5 plate.motion.x.table must not be give
+ [plate.motion]\ny = { segments = 3 } => 4 plate.motion.y.segments must be written [[plate.motion.y.segments]], in doub
+ [[plate.motion.x.segments]]\nstroke = "1 um"\ncolour = 1 => 5 plate.motion.x.segments[0].colour is not known; [[plate.
+ [[actuators]]\nposition = ["0 um", "0 um"]\nstroke = "1 um"\nfrequency = "1 Hz" => 3 actuators must not be given with
"""
WRONG_RUN = r"""
+ gravity = ["1 m/s^2", "2 m/s^2"] => run.gravity must be an acceleration such as "9.80665 m/s^2", or three, along x, y
+ gravity = ["1 m/s^2", "2 m", 3] => run.gravity is wrong: its y must be an acceleration such as "9.80665 m/s^2"; got "2
+ time_step = "1 us" => run.time_step must not be given with scheme = "events", which chooses its steps by the tolerance
+ scheme = "event" => run.scheme must be "events", "fixed" or "paper"; got "event"
+ scheme = "paper"\nafter_detachment = "fly" => run.after_detachment must be "stop" with scheme = "paper"; only "events"
+ after_detachment = "hop" => run.after_detachment must be "stop" or "fly"; got "hop"
"""


def test_each_mistake_is_told_with_its_line(tmp_path):
    assert answered_otherwise(WRONG, partial(problems, tmp_path), platform=PLATFORM) == []
    run = {"options": ""}
    assert answered_otherwise(WRONG_RUN, partial(problems, tmp_path, PLATFORM), **run) == []


WRONG_FILES = [
    (f"time [ms], x [um]\n0, {'5' * 200_000}\n", ["has a cell of more than 131072 characters, the most that is read"]),
    ("", ['is empty; it must begin with a header such as "time [ms], x [um], z [um]"']),
    (ROWS, ['line 1 must be a header such as "time [ms], x [um], z [um]"; got "0.0, 0, 0"']),
    (
        "time, X [um], q [um], z [s]\n",
        [
            "line 1 must give the unit of time, as in",
            "line 1 must give z in a unit of length; got [s], a time",
        ],
    ),
    (
        "x [um], x [umm]\n",
        [
            "line 1 has two columns x",
            'line 1 must give x in a unit of length; got [umm], but there is no unit "umm"; did you mean "um" or "mm"?',
            "line 1 must have a column time, as in",
        ],
    ),
    (
        HEADER.replace("z [mm]", "vy [m/s]") + ROWS,
        ["must have a column y beside vy: positions say where the motion is"],
    ),
    ("time [ms]\n1\n", ["line 1 must have a column x, y or z, as in"]),
    (HEADER + "0, 0, 0\n1, 1, 1\n", ["must have at least 6 rows below its header; got 2"]),
    (
        HEADER + "0, 0, 0\n1, abc, nan\n2, 3\n\n3, , 1\n",
        [
            'line 3 must have a finite number as x; got "abc"',
            'line 3 must have a finite number as z; got "nan"',
            "line 4 must have 3 columns; got 2",
            'line 6 must have a finite number as x; got ""',
        ],
    ),
    (
        HEADER + ROWS + "\n1, 0, 0\n1, 0, 0\n",
        [
            "line 13 must have a later time than the row before; got 0.001 s after 0.0045 s",
            "line 14 must have a later time than the row before; got 0.001 s after 0.001 s",
        ],
    ),
    (HEADER + "a, b, c\n" * 30, [*["line"] * 10, "has 80 more mistakes"]),
]


@pytest.mark.parametrize("text, expected", WRONG_FILES)
def test_every_mistake_in_a_measured_motion_is_told_with_its_line(tmp_path, text, expected):
    """Whatever else is wrong: here the mass."""
    (tmp_path / "shaker.csv").write_text(text)
    found = problems(tmp_path, FILE + "smoothing = 3\n")
    assert found.pop(-1).startswith("4 plate.smoothing must be a length")
    assert len(found) == len(expected)
    for line, start in zip(found, expected, strict=True):
        assert line.startswith(f"3 plate.motion in shaker.csv: {start}"), found


def test_a_motion_must_last_as_long_as_the_run(tmp_path):
    (tmp_path / "shaker.csv").write_text(HEADER + ROWS)
    assert read(tmp_path, FILE).run.duration == 4e-3
    (tmp_path / "shaker.csv").write_text(HEADER + "".join(ROWS.splitlines(keepends=True)[:8]))
    assert problems(tmp_path, FILE) == ["11 run.duration must not exceed the measured motion's, 0.0035 s; got 0.004 s"]


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


def test_bytes_are_no_motion(tmp_path):
    (tmp_path / "shaker.csv").write_bytes(b"\xff\xfe\x00")
    assert problems(tmp_path, FILE) == ["3 plate.motion in shaker.csv: is not text in UTF-8, UTF-16 or Windows-1252"]
