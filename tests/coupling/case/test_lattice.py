"""Lattices of a case file: where their actuators stand, and the waves that drive them."""

import math

import numpy as np
import pytest
from case_files import DRIVE, FRAME, PLACES, python_case
from case_files import read as read_text

from coupling import build_drives
from coupling.case import ActuatorCase, Case, CaseError, InputError, LatticeCase, read_case, write_case
from particle import Drive
from particle.drives import drive_table

WAVE = {"stroke": "5 um", "frequency": "300 Hz", "cycle": "sine"}
PLACE = {"position": (0.0, 0.0)}


def read(folder, lattice):
    return read_text(folder, FRAME + lattice)


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


def test_a_phase_and_a_ramp_reach_the_drive():
    actuator = {**PLACE, **WAVE, "phase": "90 deg", "ramp": 2.5, "cycles": 5, "delay": "1 ms"}
    (drive,) = build_drives(python_case(actuators=[actuator]))
    assert drive == Drive(5e-6, 300.0, "sine", 5, 1e-3, phase=math.pi / 2, ramp=2.5)
    (drive,) = build_drives(python_case(actuators=[{**PLACE, "stroke": 1e-6, "frequency": 300, "phase": "180 deg"}]))
    assert drive == Drive(1e-6, 300.0, phase=math.pi)
    assert drive.evaluate(0.0)[0] == pytest.approx(1e-6)


def test_phases_of_a_lattice_make_travelling_and_rotating_waves():
    row = {"rows": 1, "columns": 5, "pitch": "100 um", **WAVE, "phase": "360 * x / 400e-6 deg", "ramp": 3}
    case = python_case(lattice=row)
    assert [a.phase for a in case.actuators] == pytest.approx(np.array([-2, -1, 0, 1, 2]) * math.pi / 2)
    assert {a.ramp for a in case.actuators} == {3.0}
    square = {"rows": 3, "columns": 3, "pitch": "100 um", **WAVE, "where": "row != 1 or column != 1"}
    case = python_case(lattice=square | {"phase": "-atan2(y, x) rad"})
    angles = [math.atan2(*a.position[::-1]) for a in case.actuators]
    assert len(angles) == 8
    assert [a.phase for a in case.actuators] == pytest.approx([-angle for angle in angles])
    # The wave is the same everywhere but for a turn about the centre and the time that this takes.
    heights = np.array([drive.evaluate(0.7e-3)[0] for drive in build_drives(case)])
    assert heights == pytest.approx(5e-6 * np.sin(2 * math.pi * 0.21 - np.array(angles)), abs=1e-17)


def test_a_steady_wave_over_a_lattice_has_no_jumps_and_a_late_one_has():
    keys = {"rows": 1, "columns": 5, "pitch": "100 um", **WAVE, "phase": "50 * column deg"}
    assert not drive_table(build_drives(python_case(lattice=keys))).jump.any()
    assert (drive_table(build_drives(python_case(lattice=keys | {"delay": "1 ms"}))).jump[:, 0] > 0).all()
    assert not drive_table(build_drives(python_case(lattice=keys | {"delay": "1 ms", "ramp": 0.5}))).jump.any()


def test_a_wave_is_written_and_read_again_to_the_bit(tmp_path):
    keys = {"rows": 2, "columns": 3, "pitch": "100 um", "kind": "hexagonal", **WAVE, "phase": "x / 1e-4 rad", "ramp": 3}
    case = python_case(lattice=keys)
    assert read_case(write_case(case, tmp_path / "wave.toml")).actuators == case.actuators
    assert Case(**case.model_dump()).actuators == case.actuators


def hexagon(rows, columns, **keys):
    lattice = {"rows": rows, "columns": columns, "pitch": "20 um", "kind": "hexagonal", **WAVE}
    return np.array([a.position for a in python_case(lattice=lattice | keys).actuators])


@pytest.mark.parametrize(("rows", "columns"), [(1, 3), (2, 2), (3, 3), (4, 5), (7, 7)])
def test_neighbours_in_a_hexagonal_lattice_are_one_pitch_apart(rows, columns):
    places = hexagon(rows, columns)
    assert len(places) == rows * columns
    apart = np.hypot(*(places[:, None] - places).transpose(2, 0, 1)) / 20e-6
    assert apart[~np.eye(len(places), dtype=bool)].min() == pytest.approx(1)
    inside = (np.abs(apart - 1) < 1e-9).sum(axis=1)
    assert inside.max() == (6 if min(rows, columns) > 2 else inside.max())
    # Bonds along the rows, and two from each actuator to the row above but where that ends.
    bonds = rows * (columns - 1) + (rows - 1) * (2 * columns - 1)
    assert inside.sum() == 2 * bonds
    assert np.ptp(places[:, 1]) == pytest.approx((rows - 1) * math.sqrt(3) / 2 * 20e-6)


def test_a_hexagonal_lattice_has_an_actuator_at_its_centre_and_can_be_cut():
    assert np.hypot(*hexagon(7, 7).T).min() == 0
    assert np.hypot(*(hexagon(7, 7, centre=("30 um", "0 um")) - (30e-6, 0)).T).min() < 1e-18
    cut = "max(2 * abs(y) / sqrt(3), abs(x) + abs(y) / sqrt(3)) < 3.5 * 20e-6"
    places = hexagon(7, 7, where=cut)
    assert len(places) == 37
    turned = places @ np.array([[0.5, math.sqrt(0.75)], [-math.sqrt(0.75), 0.5]])
    assert np.hypot(*(turned[:, None] - places).transpose(2, 0, 1)).min(axis=1).max() < 1e-18  # turned by 60 degrees
    assert len(hexagon(7, 7, where="hypot(x, y) < 2.1 * 20e-6")) == 19
