"""Waves in case files: phases with their units and formulas, ramps, hexagonal lattices, and what is wrong with them."""

import math

import numpy as np
import pytest
from lattice_cases import python_case
from plate_cases import problems as plate_problems
from plate_cases import read as read_plate
from plate_cases import text

from coupling.case import (
    ActuatorCase,
    Case,
    InputError,
    LatticeCase,
    Quantity,
    RegularPolygonCase,
    read_case,
    write_case,
)
from coupling.run import build_drives
from particle import Drive
from particle.drives import drive_table

WAVE = {"stroke": "5 um", "frequency": "300 Hz", "cycle": "sine"}
PLACE = {"position": (0.0, 0.0)}


@pytest.mark.parametrize(
    ("angle", "value"),
    [
        ("90 deg", math.pi / 2),
        ("-0.25 turn", -math.pi / 2),
        ("1.5 rad", 1.5),
        ("360 deg", 2 * math.pi),
        ("90°", math.pi / 2),
        ("1 grad", math.pi / 200),
        ("500 mrad", 0.5),
    ],
)
def test_angles_have_units(angle, value):
    assert Quantity("rad", "").parse(angle) == pytest.approx(value, rel=2e-16)
    assert ActuatorCase(**PLACE, **WAVE, phase=angle).phase == Quantity("rad", "").parse(angle)


def test_a_phase_and_a_ramp_reach_the_drive():
    actuator = {**PLACE, **WAVE, "phase": "90 deg", "ramp": 2.5, "cycles": 5, "delay": "1 ms"}
    (drive,) = build_drives(python_case(actuators=[actuator]))
    assert drive == Drive(5e-6, 300.0, "sine", 5, 1e-3, phase=math.pi / 2, ramp=2.5)
    (drive,) = build_drives(python_case(actuators=[{**PLACE, "stroke": 1e-6, "frequency": 300, "phase": "180 deg"}]))
    assert drive == Drive(1e-6, 300.0, phase=math.pi)
    assert drive.evaluate(0.0)[0] == pytest.approx(1e-6)


MISTAKES = [
    (
        {"phase": 1.0, "cycle": "up"},
        'phase of ActuatorCase must not be given with cycle = "up"; it is where in a cycle',
    ),
    ({"phase": "90"}, 'phase of ActuatorCase must be an angle such as "90 deg"; got "90", which has no unit'),
    ({"phase": "9 um"}, 'phase of ActuatorCase must be an angle such as "90 deg"; got "9 um", a length'),
    ({"phase": "9 dge"}, 'got "9 dge", but there is no unit "dge"; did you mean "9 deg"?'),
    (
        {"ramp": 3, "cycle": "up-down"},
        'ramp of ActuatorCase must not be given with cycle = "up-down"; only a "sine" and a "cosine" grow',
    ),
    ({"ramp": -1}, "ramp of ActuatorCase must be 0, or a number of cycles from 0.01 to 1000; got -1.0"),
    ({"ramp": 0.001}, "ramp of ActuatorCase must be 0, or a number of cycles from 0.01 to 1000; got 0.001"),
    ({"ramp": 1001}, "ramp of ActuatorCase must be 0, or a number of cycles from 0.01 to 1000; got 1001.0"),
    ({"ramp": "3"}, 'ramp of ActuatorCase must be a number; got "3", in quotes'),
    (
        {"ramp": 3, "cycles": 5},
        "ramp of ActuatorCase must be at most half of cycles, 2.5: the wave grows over the first cycles and decays "
        "over the last; got 3",
    ),
]


@pytest.mark.parametrize(("keys", "expected"), MISTAKES)
def test_each_mistake_is_named(keys, expected):
    with pytest.raises(InputError) as caught:
        ActuatorCase(**(PLACE | WAVE | keys))
    assert expected in str(caught.value)
    assert len(caught.value.problems) == 1


def test_they_do_not_go_with_a_table():
    with pytest.raises(InputError) as caught:
        ActuatorCase(**PLACE, table=[[0, 0], [1, 1e-6]], phase=1.0, ramp=2)
    assert [field for field, _ in caught.value.problems] == ["phase", "ramp"]


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


@pytest.mark.parametrize(
    ("phase", "expected"),
    [
        ("360 deg * x / 400 um", 'the unit must come once, at the end, as in "(5 if row > 2 else 3) deg"'),
        (
            "90 * column",
            'must be an angle such as "90 deg" or "2 * (row + column) deg"; got "90 * column", which has no',
        ),
        ("90 * column um", 'got "90 * column um", a length'),
        ("t rad", "there is no t: an expression is constant in time, one value for each actuator"),
    ],
)
def test_a_wrong_formula_of_phases_is_named(phase, expected):
    with pytest.raises(InputError, match="Input phase of LatticeCase must be ") as caught:
        LatticeCase(rows=1, columns=2, pitch=1e-4, **WAVE, phase=phase)
    assert expected in str(caught.value)


def test_a_formula_without_a_value_is_named_with_its_place():
    with pytest.raises(InputError, match='an angle for each actuator; "1 / x rad" divides by zero at row 0, column 1'):
        python_case(lattice={"rows": 1, "columns": 3, "pitch": "100 um", **WAVE, "phase": "1 / x rad"})


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


def test_a_hexagonal_lattice_has_one_pitch():
    with pytest.raises(InputError) as caught:
        LatticeCase(rows=2, columns=2, pitch=(1e-4, 2e-4), kind="hexagonal", **WAVE)
    assert str(caught.value) == (
        'Input pitch of LatticeCase must be one length with kind = "hexagonal", '
        "in which all neighbours are as far apart"
    )


@pytest.mark.parametrize("sides", [3, 4, 5, 6, 12])
def test_a_regular_polygon_is_a_plate(tmp_path, sides):
    shape = f'shape = "polygon"\nsides = {sides}\nradius = "200 um"\nrotation = "20 deg"'
    plate = read_plate(tmp_path, text(shape, part="10 um, 20 um")).plate
    assert isinstance(plate, RegularPolygonCase)
    mesh = plate.build_mesh()
    assert plate.measures[1] == pytest.approx(sides / 2 * 4e-8 * math.sin(2 * math.pi / sides))
    corners = mesh.points[np.hypot(*mesh.points.T) > 200e-6 * (1 - 1e-12)]
    assert len(corners) == sides
    assert np.hypot(*(corners - 200e-6 * np.array([math.cos(math.pi / 9), math.sin(math.pi / 9)])).T).min() < 1e-17
    # The smallest width: between parallel sides, or from a side to the corner opposite.
    angle = np.linspace(0, math.pi, 3601)
    widths = np.ptp(corners @ np.stack([np.cos(angle), np.sin(angle)]), axis=0)
    assert plate.measures[0] == pytest.approx(widths.min(), rel=1e-5)


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        ('sides = 2\nradius = "1 mm"', "plate.sides must be at least 3; got 2"),
        ("sides = 6", 'plate.radius is missing; it must be a length such as "150 um"'),
        ('radius = "1 mm"', "plate.sides is missing; it must be a whole number"),
        (
            "",
            "plate.corners is missing; it must be three points or more, such as "
            '[["0 um", "0 um"], ["2 um", "0 um"], ["0 um", "1 um"]], '
            "or have a number of sides and a radius in their place",
        ),
        ('sides = 6\nradius = "1 mm"\nwidth = "1 m"', 'plate.width is not known; it goes with shape = "rectangle"'),
    ],
)
def test_what_a_regular_polygon_lacks_is_named(tmp_path, shape, expected):
    (found,) = plate_problems(tmp_path, text(f'shape = "polygon"\n{shape}'))
    assert found.startswith(expected)
