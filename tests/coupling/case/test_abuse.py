"""Cases that would take without end, or more memory than there is, are refused at once."""

import os
from functools import partial

import pytest
from mistakes import answered_otherwise

from coupling.case import CaseError, parse, read_case

PLATE = """[plate]
shape = "disc"
radius = "300 um"
youngs_modulus = "169 GPa"
poisson_ratio = 0.3
thickness = "5 um"

[[actuators]]
position = ["0 um", "30 um"]
{drive}

[part]
mass = "2e-9 kg"
position = ["30 um", "20 um"]

[friction]
model = "coulomb"
coefficient = 0.3

[run]
duration = "1 ms"
"""
STROKE = 'stroke = "1 um"\nfrequency = "300 Hz"'
PAIRS = ", ".join('["0.0 ms", "0.5 um"]' for _ in range(40))
BRACKETS = "[" * 60
POINTS = ", ".join(f'["{k} ms", "{k % 7} um"]' for k in range(3000))


def refused(tmp_path, text):
    (tmp_path / "case.toml").write_text(text)
    with pytest.raises(CaseError) as error:
        read_case(tmp_path / "case.toml")
    return [f"{problem.field} {problem.message}".strip() for problem in error.value.problems]


@pytest.mark.parametrize(
    ("drive", "count"),
    [
        ('stroke = "1 um"\nfrequency = "1e11 Hz"', "1e+08"),
        ('force = "1 uN"\nfrequency = "1e12 Hz"\ncycle = "sine"', "1e+09"),
        ('table = [["0 s", "0 um"], ["1e-11 s", "1 um"], ["2e-11 s", "0 um"]]\nrepeats = "endless"', "1.5e+08"),
        (
            '[[actuators.segments]]\nstroke = "1 um"\nfrequency = "1e12 Hz"\ncycles = 1000000\n'.replace(
                "[[", "repeats = 1000000000\n[["
            ),
            "1e+09",
        ),
    ],
)
def test_a_run_has_a_largest_number_of_cycles(tmp_path, drive, count):
    wrong = f"must hold at most 100000 cycles, or points, of each drive; got {count} in 0.001 s"
    assert refused(tmp_path, PLATE.format(drive=drive)) == [f"run.duration {wrong}"]


def test_all_drives_together_have_a_largest_number_of_cycles(tmp_path):
    lattice = '[lattice]\nrows = {}\ncolumns = 10\npitch = "11 um"\nstroke = "1 um"\nfrequency = "99 MHz"\n\n[part]'
    text = PLATE.format(drive=STROKE)
    wrong = "must hold at most 10000000 cycles, or points, of all drives together; got 1.09e+07 in 0.001 s"
    assert refused(tmp_path, text.replace("[part]", lattice.format(11))) == [f"run.duration {wrong}"]
    (tmp_path / "case.toml").write_text(text.replace("[part]", lattice.format(10)))
    assert len(read_case(tmp_path / "case.toml").actuators) == 101


SCHEDULE = '[[actuators.segments]]\nstroke = "1 um"\nfrequency = "300 Hz"\ncycles = {}\n'


@pytest.mark.parametrize(
    "drive",
    [
        SCHEDULE.format(200_000),
        'repeats = "endless"\n' + SCHEDULE.format(3) + SCHEDULE.format(200_000).replace("300 Hz", "1 GHz"),
        "table = [" + ", ".join(f'["{k} ms", "{k % 7} um"]' for k in range(110_000)) + "]",
    ],
    ids=["segment", "pass", "table"],
)
def test_what_comes_after_the_end_of_a_run_does_not_count(tmp_path, drive):
    (tmp_path / "case.toml").write_text(PLATE.format(drive=drive))
    assert read_case(tmp_path / "case.toml").run.duration == 1e-3


def test_the_cycles_of_all_segments_together_are_bounded(tmp_path):
    wrong = "actuators[0].segments must have at most 1000000 cycles together; got 1000003"
    assert refused(tmp_path, PLATE.format(drive=SCHEDULE.format(3) + SCHEDULE.format(1_000_000))) == [wrong]


def test_drives_that_end_in_time_may_be_fast(tmp_path):
    (tmp_path / "case.toml").write_text(PLATE.format(drive='stroke = "1 um"\nfrequency = "1e12 Hz"\ncycles = 1000'))
    assert read_case(tmp_path / "case.toml").actuators[0].cycles == 1000


SIZES = r"""
duration = "1 ms" -> duration = "1e300 ms" => but no time may be above 1e+06 s
"300 Hz" -> "1e300 Hz" => no frequency may be above 1e+12 Hz
"300 Hz" -> "5e-324 Hz" => no frequency may be below 1e-06 Hz
radius = "300 um" -> radius = "1e-300 um" => no length may be below 1e-15 m
radius ++ density = "5e-324 kg/m^3" => no density may be below 0.001 kg/m
duration ++ frames = 99999999999 => run.frames must be at most 1e+06
"300 Hz" -> "300 Hz"\ncycles = 99999999999 => cycles must be at most 1e+09
radius ++ cell_size = "0.1 um" => plate.cell_size must be at least
disc"\nradius = "300 um" -> rectangle"\nwidth = "600 um"\nheight = "1 nm" => 1000 times as long as wide; it is 6e+05
disc"\nradius = "300 um" -> annulus"\ninner_radius = "299.9 um"\nouter_radius = "300 um" => it is 1.885e+04 times
disc"\nradius = "300 um" -> ellipse"\nsemi_axis_x = "1 m"\nsemi_axis_y = "1e-15 m" => at most 1000 times as long as wide
"""


def test_sizes_are_those_of_plates(tmp_path):
    assert answered_otherwise(SIZES, partial(refused, tmp_path), case=PLATE.format(drive=STROKE)) == []


@pytest.mark.parametrize(
    ("text", "wrong"),
    [
        ("a = " + "[" * 5000 + "]" * 5000, "is not valid TOML: tables or lists are nested more than 20 deep"),
        (".".join("a" * 3000) + " = 1", "is not valid TOML: tables or lists are nested more than 20 deep"),
        ("[" + ".".join("a" * 3000) + "]", "is not valid TOML: tables or lists are nested more than 20 deep"),
        ("a = " + "1" * 5000, "is not valid TOML: a number has too many digits"),
        (f'table = [{POINTS}, ["3000 ms]]', "is not valid TOML: invalid character in a text"),
        (f"table = [{POINTS}$]", "is not valid TOML: unclosed array"),
    ],
    ids=["lists", "keys", "tables", "digits", "text", "list"],
)
def test_texts_that_would_take_without_end(tmp_path, text, wrong):
    (tmp_path / "case.toml").write_text(
        f"# {BRACKETS} 12\n[plate]\nb = [{PAIRS}]\n{text}\n\nc = [{PAIRS}] # {BRACKETS}"
    )
    with pytest.raises(CaseError) as error:
        parse(tmp_path / "case.toml")
    (problem,) = error.value.problems
    assert problem.message.startswith(wrong.partition(": ")[0])
    if "too" in wrong or "more than" in wrong:
        assert problem.message == wrong and problem.line == 4


def test_one_mistake_in_a_long_line_is_told_at_once(tmp_path):
    for mistake in ('["3000 ms" "1 um"]', '["3000 ms, "1 um"]', "3000 ms", "True"):
        text = PLATE.format(drive=f"table = [{POINTS}, {mistake}]")
        assert refused(tmp_path, text)[0].startswith("is not valid TOML")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes here")
def test_a_pipe_or_a_device_is_no_file(tmp_path):
    os.mkfifo(tmp_path / "pipe.csv")
    os.mkfifo(tmp_path / "pipe.toml")
    with pytest.raises(CaseError, match="it is a pipe or a device, not a file"):
        read_case(tmp_path / "pipe.toml")
    for name in ("pipe.csv", "/dev/zero"):
        platform = f'[plate]\nshape = "platform"\nmotion = "{name}"\n'
        text = platform + PLATE.partition("{drive}")[2]
        assert "it is a pipe or a device, not a file" in refused(tmp_path, text)[0]


def test_a_file_too_large_is_told_with_its_unit(tmp_path):
    for name, most in (("case.toml", 16), ("motion.csv", 64)):
        with (tmp_path / name).open("wb") as file:
            file.truncate(most * 2**20 + 1)
    with pytest.raises(CaseError, match="cannot be read: it has more than 16 MiB, the most that is read"):
        read_case(tmp_path / "case.toml")
    platform = '[plate]\nshape = "platform"\nmotion = "motion.csv"\n'
    assert "it has more than 64 MiB" in refused(tmp_path, platform + PLATE.partition("{drive}")[2])[0]
