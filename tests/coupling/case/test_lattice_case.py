"""Lattices of a case file: where their actuators stand, how they are driven, and what can be wrong, told once."""

import numpy as np
import pytest
from lattice_cases import DRIVE, FRAME, PLACES, problems, python_case, read
from mistakes import answered_otherwise

from coupling.case import ActuatorCase, Case, CaseError, InputError, LatticeCase, read_case
from coupling.run import build_drives
from particle.drives import drive_table


def test_rows_run_along_y_and_columns_along_x_around_the_centre(tmp_path):
    case = read(tmp_path, PLACES + 'centre = ["20 um", "-10 um"]\n' + DRIVE + 'delay = "row + 0.1 * column ms"\n')
    assert case.lattice is None
    found = np.array([actuator.position for actuator in case.actuators]).reshape(3, 4, 2)
    assert found[0, 0] == pytest.approx((20e-6 - 225e-6, -10e-6 - 120e-6))
    assert np.diff(found[..., 0], axis=1) == pytest.approx(150e-6)
    assert np.diff(found[..., 1], axis=0) == pytest.approx(120e-6)
    delays = np.array([actuator.delay for actuator in case.actuators]).reshape(3, 4)
    assert delays == pytest.approx(1e-3 * (np.arange(3)[:, None] + 0.1 * np.arange(4)))


def test_its_actuators_are_what_they_would_be_one_by_one(tmp_path):
    keys = 'stiffness = "1e4 N/m"\ncycle = "sine"\ncycles = 3\n'
    of_lattice = read(tmp_path, '[lattice]\nrows = 1\ncolumns = 1\npitch = "1 um"\n' + DRIVE + keys)
    alone = read(tmp_path, '[[actuators]]\nposition = ["0 um", "0 um"]\n' + DRIVE + keys)
    assert of_lattice.actuators == alone.actuators
    assert of_lattice.actuators[0].model_dump() == alone.actuators[0].model_dump()


def test_it_comes_after_the_actuators_given_one_by_one(tmp_path):
    one = '[[actuators]]\nposition = ["0 um", "0 um"]\nforce = "1 mN"\nfrequency = "1 Hz"\n'
    case = read(tmp_path, one + '[lattice]\nrows = 2\ncolumns = 2\npitch = "90 um"\n' + DRIVE)
    assert [actuator.force for actuator in case.actuators] == [1e-3, None, None, None, None]


def test_a_table_or_schedule_is_the_same_for_all_with_delays_of_their_own(tmp_path):
    table = 'table = [["0 ms", "0 um"], ["1 ms", "5 um"], ["2 ms", "0 um"]]\nrepeats = "endless"\ndelay = "row ms"\n'
    assert [a.delay for a in read(tmp_path, PLACES + table).actuators][::4] == [0, 1e-3, 2e-3]
    segments = "[[lattice.segments]]\n" + DRIVE
    assert {len(a.segments) for a in read(tmp_path, PLACES + segments).actuators} == {1}


def test_a_margin_leaves_out_what_is_near_the_rim_and_formulas_need_a_value_only_on_the_plate():
    lattice = {"rows": 7, "columns": 7, "pitch": 100e-6, "frequency": 300}
    dome = "5 * sqrt(1 - (hypot(x, y) / 300e-6) ** 2) um"
    case = python_case(lattice=LatticeCase(**lattice, margin=1e-6, stroke=dome))
    far = [np.hypot(*actuator.position) for actuator in case.actuators]
    assert len(far) == 25 and max(far) < 299e-6
    assert [a.stroke for a in case.actuators] == pytest.approx([5e-6 * np.sqrt(1 - (r / 3e-4) ** 2) for r in far])
    assert len(python_case(lattice=lattice | {"margin": 0.0, "stroke": 0.0}).actuators) == 25
    assert len(python_case(lattice=lattice | {"margin": "100 um", "stroke": 0.0}).actuators) == 13


def test_a_case_with_a_lattice_is_read_again_as_it_was_written_down(tmp_path):
    case = read(tmp_path, PLACES + DRIVE + 'delay = "row * 0.1 ms"\n')
    assert Case(**case.model_dump()) == case
    assert Case.model_validate_json(case.model_dump_json()) == case


WRONG = r"""
nothing => lattice.stroke is missing; it must be a length such as "150 um", or have a force
+ stroke = "5 um" => lattice.frequency is missing
drive | + stifness = 3 => 26 lattice.stifness is not known; did you mean stiffness?
drive | + hue = 3 => 26 lattice.hue is not known; [lattice] has rows, columns, pitch, centre
drive | + delay = "1 / row ms" => lattice.delay must be a time for each actuator; "1 / row ms" divides by zero
drive | + delay = "log(row) ms" => "log(row) ms" has no real value at row 0, column 0
drive | + delay = "10 ** (400 * max(0, column - 1)) ms" => is too large at row 0, column 2
drive | + delay = "9 ** 9 ** 9 ** 9 ms" => is too large at row 0, column 0
drive | + delay = "1e300 * 1e300 * (column + 1) ms" => is not finite at row 0, column 0
drive | + delay = "row > 1 ms" => is a comparison and not a number at row 0, column 0
drive | + delay = "row - column ms" => must be at least 0 for each actuator; "row - column ms" is -1 ms at row 0, column
+ frequency = "row * 300 Hz"\nstroke = "5 um" => must be greater than 0 for each actuator
+ frequency = "0 Hz"\nstroke = "5 um" => lattice.frequency must be greater than 0; got "0 Hz"
drive | + delay = "row * column" => "row * column", which has no unit
drive | + delay = "row * column um" => "row * column um", a length
drive | + delay = 3 => got 3, which has no unit
drive | + delay = "colum ms" => lattice.delay must be an expression and its unit; got "colum ms": there is no colum; did
drive | + delay = "2 row ms" => an operator such as * is missing before "row ms"
drive | + delay = "row.real ms" => an operator such as * is missing before ".real ms"
drive | + delay = "open(1) ms" => there is no function open; there are sqrt, sin, cos, tan, asin, acos, atan, exp, floor
drive | + cycle = "up"\ncycles = 3 => lattice.cycles must not be given with cycle = "up"
drive | + force = "row uN" => lattice.force must not be given with a stroke; an actuator is driven by one of
+ force = "1 uN"\nfrequency = "1 Hz"\nstiffness = "row N/m" => lattice.stiffness must not be given with a force
+ [[lattice.segments]] | + drive | + hue = 3 => lattice.segments[0].hue is not known; [[lattice.segments]] has stroke
drive | + margin = "1 mm" => lattice.margin leaves no actuator on the plate
drive | + centre = ["300 um", "0 um"] => lattice must have all its actuators inside the rim; row 0, column 3 is 25 um be
drive | + [[actuators]]\nposition = ["75 um", "0 um"] | + drive => actuators[0].position must differ from that of row 1,
"""
WRONG_PLACES = r"""
+ rows = 3\ncolumns = 4\npitch = "-1 um" => lattice.pitch must be greater than 0; got "-1 um"
+ rows = 3\ncolumns = 4\npitch = ["1 um"] => lattice.pitch must be a length such as
+ rows = 3\ncolumns = 4\npitch = "1e-9 um" => lattice.pitch must keep the actuators apart; row 0, column 1
+ rows = 0\ncolumns = 4\npitch = "1 um" => lattice.rows must be at least 1; got 0
+ rows = 1.5\ncolumns = 4\npitch = "1 um" => lattice.rows must be a whole number; got 1.5
+ rows = 40000\ncolumns = 40000\npitch = "1 nm" => lattice.rows must make at most 100000 actuators with columns = 40000;
+ rows = 1\ncolumns = 1000000\npitch = "1 nm" => lattice.columns must make at most 100000 actuators with rows = 1;
+ rows = 3\npitch = "1 um" => lattice.columns is missing; it must be a whole number
"""


def test_each_mistake_is_told_once(tmp_path):
    def answers(text):
        found = problems(tmp_path, PLACES + text)
        return found if len(found) == 1 or not text else [f"also {found}"]

    assert answered_otherwise(WRONG, answers, nothing="", drive=DRIVE) == []
    assert answered_otherwise(WRONG_PLACES, lambda text: problems(tmp_path, text + DRIVE), lattice="[lattice]\n") == []


def test_all_mistakes_at_once_whatever_else_is_wrong(tmp_path):
    lattice = PLACES + 'stroke = "rwo um"\nfrequency = "1 / row Hz"\ndelay = "-1 s"\n'
    text = FRAME.replace('limit = "1 uN"', 'limit = "1 um"') + lattice
    (tmp_path / "test.toml").write_text(text)
    with pytest.raises(CaseError) as caught:
        read_case(tmp_path / "test.toml")
    wrong = ["friction.limit", "lattice.stroke", "lattice.frequency", "lattice.delay"]
    assert [p.field for p in caught.value.problems] == wrong
    assert [line.split()[1] for line in problems(tmp_path, lattice)] == wrong[1:]


FIVE = 'rows = 5\ncolumns = 5\npitch = "5 mm"\n'
PARTLY_RIGHT = [
    (
        FIVE + 'stroke = "sqrt(row - 2) um"\nfrequency = "sinn(row) Hz"\ndelay = "1/row ms"\n',
        "row 0, column 0 is 13.5059 mm beyond it, and 23 more",
        '"sqrt(row - 2) um" has no real value',
        "there is no function sinn",
        '"1/row ms" divides by zero',
    ),
    # What needs a wrong or missing key is not judged; all else is.
    (
        'rows = 5\npitch = "1 m"\nstroke = "1 / row um"\nfrequency = "1 / column Hz"\n',
        "lattice.columns is missing",
        "1 / row",
    ),
    (FIVE.replace("5 mm", "1") + 'stroke = "1 / x um"\nfrequency = "1 / row Hz"\n', "lattice.pitch", "1 / row"),
    (FIVE + 'magrin = "1 m"\nstroke = "1 / row um"\nfrequency = "0 Hz"\n', "magrin", "0 Hz"),
    (FIVE + 'where = "rwo > 1"\nstroke = "1 / row um"\nfrequency = "-1 Hz"\n', "rwo", "-1 Hz"),
    (FIVE + 'margin = 0\nstroke = "1 / row um"\nfrequency = "1 Hz"\n', "lattice.margin"),
    ('rows = 200000\npitch = "1 m"\nstroke = "log(row) um"\nfrequency = "1 Hz"\n', "columns is missing", "got 200000"),
    (
        FIVE + 'stroke = "5 um"\nforce = "x N"\nfrequency = "1 Hz"\nstiffness = "row N/m"\n',
        "13.5059 mm",
        "with a stroke",
        "with a force",
    ),
]


@pytest.mark.parametrize(("keys", "expected"), [(keys, expected) for keys, *expected in PARTLY_RIGHT])
def test_every_key_is_judged_as_far_as_it_can_be(tmp_path, keys, expected):
    found = problems(tmp_path, "[lattice]\n" + keys)
    assert len(found) == len(expected), found
    assert all(sum(part in line for line in found) == 1 for part in expected), found


def test_lengths_in_messages_have_the_units_that_were_written(tmp_path):
    for pitch, beyond in (('"5 mm"', "7 mm"), ('"5000 um"', "7000 um"), ('["0.5 cm", "0.1 um"]', "0.7 cm")):
        keys = f"rows = 1\ncolumns = 4\npitch = {pitch}\n"
        (found,) = problems(tmp_path, "[lattice]\n" + keys + DRIVE)
        assert f"is {beyond} beyond it, and 3 more" in found


def test_a_misspelt_lattice_is_one_mistake(tmp_path):
    (found,) = problems(tmp_path, PLACES.replace("[lattice]", "[latice]") + DRIVE)
    assert found.endswith("latice is not known; did you mean lattice?")
    file = tmp_path / "free.toml"
    file.write_text(FRAME.replace("[part]", 'supports = "free"\n[part]') + PLACES.replace("lattice", "latice") + DRIVE)
    with pytest.raises(CaseError, match="1 mistake\n"):
        read_case(file)


def test_double_brackets_and_platforms(tmp_path):
    doubled = PLACES.replace("[lattice]", "[[lattice]]")
    assert "lattice must be a table, written [lattice]" in problems(tmp_path, doubled)[0]
    file = tmp_path / "platform.toml"
    file.write_text('[plate]\nshape = "platform"\n' + FRAME[FRAME.index("[part]") :] + PLACES + DRIVE)
    with pytest.raises(CaseError, match='lattice must not be given with shape = "platform"'):
        read_case(file)


def test_a_free_plate_may_rest_on_a_lattice(tmp_path):
    free = FRAME.replace("[part]", 'supports = "free"\n[part]')
    file = tmp_path / "free.toml"
    file.write_text(free + PLACES + DRIVE)
    assert len(read_case(file).actuators) == 12
    file.write_text(free + PLACES.replace("rows = 3", "rows = 1") + DRIVE)
    with pytest.raises(CaseError, match="leave the plate free to move as a whole"):
        read_case(file)


def test_in_python_text_and_numbers_do():
    lattice = LatticeCase(rows=2, columns=2, pitch=1e-4, stroke="row um", frequency=300, delay=1e-3)
    case = python_case(lattice=lattice, actuators=[ActuatorCase(position=(0, 0), stroke=0, frequency=1)])
    assert [a.stroke for a in case.actuators] == pytest.approx([0, 0, 0, 1e-6, 1e-6])
    with pytest.raises(InputError, match="divides by zero at row 0, column 0"):
        python_case(lattice=lattice.model_dump() | {"stroke": "1 / row um"})


def test_ten_thousand_actuators_are_read(tmp_path):
    text = FRAME.replace('"1 mm"', '"15.3 mm"').replace('"0.8 mm"', '"15.3 mm"')
    file = tmp_path / "large.toml"
    lattice = '[lattice]\nrows = 100\ncolumns = 100\npitch = "150 um"\n' + DRIVE
    file.write_text(text + lattice + 'delay = "0.05 * (row + column) % 8 ms"\n')
    table = drive_table(build_drives(read_case(file)))
    assert len(table.delay) == 10_000


def test_where_leaves_out(tmp_path):
    near = 'where = "not (row == 1 and column == 2) and hypot(x, y) < 200e-6"\n'
    case = read(tmp_path, PLACES + near + DRIVE)
    assert len(case.actuators) == 5
    assert all(np.hypot(*a.position) < 200e-6 and a.position != pytest.approx((75e-6, 0)) for a in case.actuators)
    # Formulas need a value only where there is an actuator, and only an actuator must be on the plate.
    delay = 'delay = "0.1 / abs(column - 1) ms"\n'
    assert len(read(tmp_path, PLACES + 'where = "column != 1"\n' + DRIVE + delay).actuators) == 9
    wide = '[lattice]\nrows = 9\ncolumns = 9\npitch = "0.3 mm"\nwhere = "x*x + y*y < 1e-7"\n'
    assert len(read(tmp_path, wide + DRIVE).actuators) == 5
    lattice = LatticeCase(rows=3, columns=3, pitch=9e-5, where="row > 0", stroke=0, frequency=1)
    assert len(python_case(lattice=lattice).actuators) == 6


def test_where_and_margin_leave_out_together(tmp_path):
    places = '[lattice]\nrows = 21\ncolumns = 21\npitch = "100 um"\nmargin = "50 um"\n'
    case = read(tmp_path, places + 'where = "sqrt(4.6e-4 - abs(x)) > 0 and row != 10"\n' + DRIVE)
    assert len(case.actuators) == 9 * 6
    assert all(abs(a.position[0]) < 450e-6 and 0 < abs(a.position[1]) < 350e-6 for a in case.actuators)


WRONG_WHERE = r"""
+ where = "row > 5" => lattice.where must be true for one actuator or more; "row > 5" is true for none
+ where = "column" => true or false for each actuator; "column" is a number and not a comparison at row 0, column 0
+ where = "1 / column > 2" => "1 / column > 2" divides by zero at row 0, column 0
+ where = "rwo > 2" => that is true or false; got "rwo > 2": there is no rwo; did you mean row?
+ where = "x > 10 um" => "um" is too much; it has no unit
+ where = "" => lattice.where must be an expression that is true or false, such as
+ where = true => lattice.where must be an expression that is true or false, such as
"""


def test_mistakes_in_where(tmp_path):
    assert answered_otherwise(WRONG_WHERE, lambda text: problems(tmp_path, text), lattice=PLACES + DRIVE) == []
