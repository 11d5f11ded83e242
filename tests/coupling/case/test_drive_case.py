"""The actuators of a case file: sines, rests, tables and schedules, and what does not go together."""

from functools import partial

import numpy as np
import pytest
from mistakes import answered_otherwise
from sweeps import toml

from coupling.case import ActuatorCase, Case, CaseError, SegmentCase, amplitude, read_case
from coupling.run import build_drives
from particle import Drive, Segment, SegmentDrive, TableDrive

FRAME = toml(
    plate={"shape": "disc", "radius": "300 um", "youngs_modulus": "169 GPa", "poisson_ratio": 0.3, "thickness": "5 um"},
    part={"mass": "2e-9 kg", "position": ["100 um", "100 um"]},
    friction={"model": "constant", "limit": "1 uN"},
    run={"duration": "50 ms"},
    actuators=[{"position": ["0 um", "0 um"]}],
)
FIRST = 1 + FRAME.count("\n")  # the line of the drive
CYCLE = 'stroke = "5 um"\nfrequency = "300 Hz"\n'
TABLE = 'table = [["0 ms", "1 um"], ["1 ms", "-50 um"], ["3 ms", "1 um"]]\n'
SEGMENTS = """\
delay = "2 ms"
repeats = "endless"
[[actuators.segments]]
stroke = "5 um"
frequency = "300 Hz"
cycles = 3
dwell = "0.1 ms"
[[actuators.segments]]
cycle = "hold"
dwell = "1 ms"
[[actuators.segments]]
stroke = "-2 um"
frequency = "1 kHz"
cycle = "up"
[[actuators.segments]]
stroke = "1 um"
frequency = "500 Hz"
cycle = "up"
cycles = 2
"""


def read(folder, drive) -> Case:
    file = folder / "test.toml"
    file.write_text(FRAME + drive)
    return read_case(file)


def problems(folder, drive):
    """The mistakes, each with its line counted from that of the first line of the drive."""
    with pytest.raises(CaseError) as caught:
        read(folder, drive)
    return [f"{p.line - FIRST} {p.field.removeprefix('actuators[0].')} {p.message}" for p in caught.value.problems]


@pytest.mark.parametrize(
    "text, expected",
    [
        (CYCLE + 'dwell = "0.1 ms"\ncycles = 2', Drive(5e-6, 300, cycles=2, dwell=1e-4)),
        (CYCLE + 'cycle = "sine"\ndelay = "1 ms"', Drive(5e-6, 300, "sine", delay=1e-3)),
        (CYCLE + 'cycle = "cosine"\ncycles = 4', Drive(5e-6, 300, "cosine", 4)),
        ('force = "2 uN"\nfrequency = "300 Hz"\ncycle = "sine"', Drive(2e-6, 300, "sine")),
        (
            SEGMENTS,
            SegmentDrive(
                [
                    Segment(5e-6, 300, cycles=3, dwell=1e-4),
                    Segment(cycle="hold", dwell=1e-3),
                    Segment(-2e-6, 1000, "up"),
                    Segment(1e-6, 500, "up", 2),
                ],
                None,
                2e-3,
            ),
        ),
    ],
)
def test_drives_of_a_file(tmp_path, text, expected):
    assert build_drives(read(tmp_path, text)) == [expected]


@pytest.mark.parametrize("text, repeats", [("", 1), ("repeats = 3\n", 3), ('repeats = "endless"\n', None)])
def test_a_table_of_a_file(tmp_path, text, repeats):
    (drive,) = build_drives(read(tmp_path, TABLE + text))
    assert isinstance(drive, TableDrive)
    assert (drive.times.tolist(), drive.heights.tolist()) == ([0, 1e-3, 3e-3], [1e-6, -50e-6, 1e-6])
    assert drive.repeats == repeats


def test_the_amplitude_is_the_height_furthest_from_0(tmp_path):
    for text, furthest in ((CYCLE, 5e-6), (TABLE, -50e-6), (SEGMENTS, 5e-6)):
        (actuator,) = read(tmp_path, text).actuators
        heights = build_drives(read(tmp_path, text))[0].evaluate(np.linspace(0, 30e-3, 6001))[0]
        assert amplitude(actuator) == furthest
        assert np.abs(heights).max() == pytest.approx(abs(furthest), rel=1e-3)
    down = [SegmentCase(stroke=-2e-6, frequency=1.0, cycle="up", cycles=3)]
    assert amplitude(ActuatorCase(position=(0, 0), segments=down)) == pytest.approx(-6e-6)


@pytest.mark.parametrize("text", [CYCLE, TABLE, SEGMENTS])
def test_a_case_that_was_written_down_is_read_again(tmp_path, text):
    case = read(tmp_path, text)
    assert Case.model_validate(case.model_dump()) == case
    assert Case.model_validate_json(case.model_dump_json()) == case


WRONG = r"""
table | + cycle => 0 table must not be given with a stroke; an actuator is driven by one of stroke, force, table and
table | + frequency = "1 Hz" => 1 frequency must not be given with a table, whose points have their own times
table | + cycles = 3 => 1 cycles must not be given with a table
table | + force = "1 N" => 0 table must not be given with a force
table | + segments => 3 segments must not be given with a table; an actuator is driven by one of
+ cycle = "up" | + segments => 0 cycle must not be given with segments, which have their own
+ dwell = "1 s" | + segments => 0 dwell must not be given with segments, which have their own
+ stroke = "1 um" | + segments => 3 segments must not be given with a stroke
cycle | + repeats = 2 => 2 repeats must not be given without a table or segments; cycles counts
cycle | + cycle = "sine"\ndwell = "1 s" => 3 dwell must not be given with cycle = "sine"; it is the rest after
cycle | + cycle = "up"\ndwell = "1 s" => 3 dwell must not be given with cycle = "up"
cycle | + cycle = "up"\ncycles = 1 => 3 cycles must not be given with cycle = "up"
+ stroke = "1 um" => -3 frequency is missing; it must be a frequency such as "300 Hz"
+ frequency = "1 Hz" => -3 stroke is missing; it must be a length such as "150 um", or have a force such as
cycle | + dwell = "-1 s" => 2 dwell must be at least 0; got "-1 s"
cycle | + dwel = "1 s" => 2 dwel is not known; did you mean dwell?
table | + repeats = "ever" => 1 repeats must be a whole number of at least 1, or "endless"; got "ever"
table | + repeats = true => 1 repeats must be a whole number of at least 1, or "endless"; got true
table | + repeats = 0 => 1 repeats must be a whole number of at least 1, or "endless"; got 0
+ table = 3 => 0 table must be two or more points, each a time and a height, such as [["0 ms", "0 um"], 
+ table = [["0 s", "1 m"]] => 0 table must be two or more points
+ table = [["0 s", "1 m"], ["1 s"]] => 0 table must be two or more points
+ table = [["0 s", "1 m"],\n["1 s", "1 s"]] => 0 table[1][1] must be a length such as "150 um"; got "1 s", a time
+ table = [["0 s", "1 m"], [1, "1 m"]] => 0 table[1][0] must be a time such as "50 ms"; got 1, which has no unit
+ table = [["1 s", "1 m"], ["2 s", "1 m"]] => 0 table must begin at the time 0; got "1 s"; a delay is a key of its
+ table = [["0 s", "1 m"], ["0 s", "1 m"]] => 0 table must have increasing times; got "0 s" after "0 s"
+ table = [["0 s", "1 m"], ["1 s", "2 m"]]\nrepeats = 2 => 1 repeats must not be given with a table whose last height is
+ segments = [] => 0 segments must be at least one table, written [[actuators.segments]]; got none
+ segments = 3 => 0 segments must be written [[actuators.segments]], in double brackets, once for each segment; got 3
+ segments = [3] => 0 segments[0] must be a table, written [[actuators.segments]]; got 3
+ [actuators.segments] | + cycle => 0 segments must be written [[actuators.segments]], in double brackets, once for each
segments | + strok = 3 => 19 segments[3].strok is not known; stroke is given already; leave out one of the two
segments | + colour = 3 => 19 segments[3].colour is not known; [[actuators.segments]] has stroke, frequency, cycle,
segments | cycles = 2 -> cycles = 1 => 1 repeats must not be given with segments which do not end at height 0
segments | cycles = 3 -> cycles = 1_000_001 => 5 segments[0].cycles must be at most 1e+06; got 1000001
segments | dwell = "1 ms" ->  => 7 segments[1].dwell is missing; with cycle = "hold" it must be the time
segments | dwell = "1 ms" -> dwell = "0 ms" => 9 segments[1].dwell must be greater than 0 with cycle = "hold"; got 0 s
segments | cycle = "hold" -> cycle = "sine" => 8 segments[1].cycle must be "up-down", "up" or "hold"; got "sine"
segments | cycle = "hold" ++ stroke = "1 m" => 9 segments[1].stroke must not be given with cycle = "hold"
segments | stroke = "-2 um" ->  => 10 segments[2].stroke is missing; it must be a length such as
segments | frequency = "1 kHz" ->  => 10 segments[2].frequency is missing; it must be a frequency such
"""


def test_each_mistake_is_named_with_its_line(tmp_path):
    texts = {"nothing": "", "cycle": CYCLE, "table": TABLE, "segments": SEGMENTS}
    assert answered_otherwise(WRONG, partial(problems, tmp_path), **texts) == []


@pytest.mark.parametrize(
    "text",
    [
        CYCLE + 'dwell = "-1 s"',
        TABLE.replace("table", "tabel"),
        CYCLE.replace("stroke", "strok"),
        CYCLE.replace("frequency", "frequncy"),
        SEGMENTS.replace("[actuators.segments]", "[actuators.segment]").replace('repeats = "endless"', ""),
        SEGMENTS.replace('"hold"', '"holt"'),
        "segments = 3",
    ],
)
def test_one_mistake_is_told_once(tmp_path, text):
    assert len(problems(tmp_path, text)) == 1


def test_all_mistakes_come_at_once(tmp_path):
    text = (
        TABLE.replace("1 um", "1 Hz")
        + CYCLE
        + "colour = 1\nrepeats = 0\n"
        + SEGMENTS.replace('repeats = "endless"', "")
    )
    found = problems(tmp_path, text.replace("cycles = 3", "cycles = 0").replace('"hold"', '"hold"\nfrequency = "1 Hz"'))
    assert [" ".join(line.split()[:2]) for line in found] == [
        *("0 table[0][1]", "0 table[2][1]", "0 table", "3 colour", "4 repeats", "7 segments", "10 segments[0].cycles"),
        "14 segments[1].frequency",
    ]
