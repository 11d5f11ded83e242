"""The actuators of a case: sines, rests, tables and schedules, and where they may stand."""

import numpy as np
import pytest
from case_files import DRIVE, ONE, SEGMENTS, TABLE, python_case, read

from coupling import build_drives
from coupling.case import ActuatorCase, Case, InputError, SegmentCase, amplitude
from particle import Drive, Segment, SegmentDrive, TableDrive

SCHEDULE = SegmentDrive(
    [
        Segment(5e-6, 300, cycles=3, dwell=1e-4),
        Segment(cycle="hold", dwell=1e-3),
        Segment(-2e-6, 1000, "up"),
        Segment(1e-6, 500, "up", 2),
    ],
    None,
    2e-3,
)


@pytest.mark.parametrize(
    "text, expected",
    [
        (DRIVE + 'dwell = "0.1 ms"\ncycles = 2', Drive(5e-6, 300, cycles=2, dwell=1e-4)),
        (DRIVE + 'cycle = "sine"\ndelay = "1 ms"', Drive(5e-6, 300, "sine", delay=1e-3)),
        (DRIVE + 'cycle = "cosine"\ncycles = 4', Drive(5e-6, 300, "cosine", 4)),
        (
            DRIVE + 'cycle = "sine"\nphase = "90 deg"\nramp = 2.5\ncycles = 5\ndelay = "1 ms"',
            Drive(5e-6, 300, "sine", 5, 1e-3, phase=np.pi / 2, ramp=2.5),
        ),
        ('force = "2 uN"\nfrequency = "300 Hz"\ncycle = "sine"', Drive(2e-6, 300, "sine")),
        (SEGMENTS, SCHEDULE),
    ],
)
def test_drives_of_a_file(tmp_path, text, expected):
    assert build_drives(read(tmp_path, ONE + text)) == [expected]


@pytest.mark.parametrize("text, repeats", [("", 1), ("repeats = 3\n", 3), ('repeats = "endless"\n', None)])
def test_a_table_of_a_file(tmp_path, text, repeats):
    (drive,) = build_drives(read(tmp_path, ONE + TABLE + text))
    assert isinstance(drive, TableDrive)
    assert (drive.times.tolist(), drive.heights.tolist()) == ([0, 1e-3, 3e-3], [1e-6, -50e-6, 1e-6])
    assert drive.repeats == repeats


def test_the_amplitude_is_the_height_furthest_from_0(tmp_path):
    for text, furthest in ((DRIVE, 5e-6), (TABLE, -50e-6), (SEGMENTS, 5e-6)):
        (actuator,) = read(tmp_path, ONE + text).actuators
        heights = build_drives(read(tmp_path, ONE + text))[0].evaluate(np.linspace(0, 30e-3, 6001))[0]
        assert amplitude(actuator) == furthest
        assert np.abs(heights).max() == pytest.approx(abs(furthest), rel=1e-3)
    down = [SegmentCase(stroke=-2e-6, frequency=1.0, cycle="up", cycles=3)]
    assert amplitude(ActuatorCase(position=(0, 0), segments=down)) == pytest.approx(-6e-6)


@pytest.mark.parametrize("text", [DRIVE, TABLE, SEGMENTS])
def test_a_case_that_was_written_down_is_read_again(tmp_path, text):
    case = read(tmp_path, ONE + text)
    assert Case.model_validate(case.model_dump()) == case
    assert Case.model_validate_json(case.model_dump_json()) == case


def test_defaults_may_be_stated_in_python_beside_a_drive_that_does_not_take_them():
    stated = {"cycle": "up-down", "cycles": None, "dwell": 0.0, "phase": 0.0, "ramp": 0.0, "repeats": 1}
    table = [[0, 0], [1e-3, 1e-6]]
    assert ActuatorCase(position=(0, 0), table=table, **stated) == ActuatorCase(position=(0, 0), table=table)
    with pytest.raises(InputError, match="cycle of ActuatorCase must not be given with a table"):
        ActuatorCase(position=(0, 0), table=table, cycle="up")


LONG = '[[actuators.segments]]\nstroke = "1 um"\nfrequency = "{}"\ncycles = {}\n'


@pytest.mark.parametrize(
    "drive",
    [
        LONG.format("300 Hz", 200_000),
        'repeats = "endless"\n' + LONG.format("3 Hz", 3) + LONG.format("1 GHz", 200_000),
        "table = [" + ", ".join(f'["{k} ms", "{k % 7} um"]' for k in range(110_000)) + "]",
        'stroke = "1 um"\nfrequency = "1e12 Hz"\ncycles = 1000',
    ],
    ids=["segment", "pass", "table", "ends"],
)
def test_what_comes_after_the_end_of_a_run_does_not_count(tmp_path, drive):
    """Nor do drives that end in time: only what is followed is bounded."""
    assert read(tmp_path, ONE + drive).run.duration == 50e-3


@pytest.mark.parametrize(
    ("what", "gap", "inside"),
    [
        *(("part", 7e-4, True), ("part", 5e-4, False), ("part", 0, False)),  # a run refuses it there
        *(("actuator", 7e-4, True), ("actuator", 5e-4, False), ("actuator", 0, False)),
    ],
)
def test_the_rim_itself_is_outside(what, gap, inside):
    place = (0.6 * 300e-6 * (1 - gap), -0.8 * 300e-6 * (1 - gap))

    def build():
        if what == "part":
            return python_case(part={"mass": 2e-9, "position": place})
        return python_case(actuators=[{"position": place, "stroke": 0, "frequency": 1}])

    if inside:
        build()
    else:
        with pytest.raises(InputError, match="inside the rim"):
            build()


@pytest.mark.parametrize(("apart", "distinct"), [(1e-6, True), (3e-12, True), (1e-13, False), (0, False)])
def test_actuators_need_points_of_their_own(apart, distinct):
    actuators = [ActuatorCase(position=(x, 0), stroke=0, frequency=1) for x in (0, apart, 1e-4)]
    if distinct:
        python_case(actuators=actuators)
    else:
        with pytest.raises(InputError, match="must differ from"):
            python_case(actuators=actuators)
