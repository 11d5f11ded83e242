"""What actuators can do: strokes and forces beyond it are mistakes, and reactions beyond it are warned of."""

import numpy as np
import pytest
from case_files import answered_otherwise, plate, python_case
from click.testing import CliRunner
from sweeps import DISC_PLATE, toml

from active_surface.cli.program import main
from coupling.case import CaseError, InputError, read_case
from coupling.outlook import case_warnings, frequency_warnings, largest_forces, limit_warnings
from coupling.scene import build_plate

PLATE = DISC_PLATE + 'cell_size = "75 um"\n\n'
REST = toml(
    part={"mass": "2e-9 kg", "position": ["10 um", "0 um"]},
    friction={"model": "constant", "limit": "1 uN"},
    run={"duration": "4 ms"},
)
ONE = '[[actuators]]\nposition = ["0 um", "0 um"]\n'
STROKE = 'stroke = "-2 um"\nfrequency = "300 Hz"\n'
LATTICE = '[lattice]\nrows = 1\ncolumns = 3\npitch = "100 um"\nfrequency = "300 Hz"\n'
RIGIDITY = 169e9 * 5e-6**3 / 12 / (1 - 0.3**2)
TAKEN = 16 * np.pi * RIGIDITY / 300e-6**2 * 2e-6  # N, of a central stroke of 2 um


def file_with(folder, actuators):
    path = folder / "case.toml"
    path.write_text(PLATE + actuators + "\n" + REST)
    return path


BEYOND = r"""
one | + stroke = "-2 um"\nfrequency = "300 Hz"\nmax_stroke = "1.5 um" => [0].stroke must be at most max_stroke, 1.5 um
one | + table = [["0 ms", "0 um"], ["1 ms", "4 um"]]\nmax_stroke = "3 um" => actuators[0].table must have heights of at
one | + max_stroke = "3 um" | + twice => must have heights of at most max_stroke, 3 um, up or down; got 4 um
force | + max_force = "1 uN" => actuators[0].force must be at most max_force, 1e-06 N, up or down; got 2e-06 N
force | + max_stroke = "1 um" => max_stroke must not be given with a force
lattice | + stroke = "2 * column um"\nmax_stroke = "3 um" => 3 um, up or down; got 4 um at row 0, column 2
lattice | + stroke = "1 um"\nmax_stroke = "0 um" => lattice.max_stroke must be greater than 0
"""


def test_a_drive_beyond_what_its_actuator_can_do_is_a_mistake(tmp_path):
    def answers(actuators):
        with pytest.raises(CaseError) as error:
            read_case(file_with(tmp_path, actuators))
        assert "1 mistake" in str(error.value)
        return [str(error.value)]

    twice = '[[actuators.segments]]\nstroke = "2 um"\nfrequency = "9 Hz"\ncycle = "up"\ncycles = 2\n'
    force = ONE + 'force = "2 uN"\nfrequency = "300 Hz"\n'
    assert answered_otherwise(BEYOND, answers, one=ONE, force=force, lattice=LATTICE, twice=twice) == []


def test_limits_that_are_just_met_are_fine_and_hold_for_changes(tmp_path):
    case = read_case(file_with(tmp_path, ONE + STROKE + 'max_stroke = "2 um"'))
    with pytest.raises(InputError, match="must be at most max_stroke, 2 um, up or down; got 3 um"):
        case.vary({"actuators.0.stroke": "3 um"})
    assert case.vary({"actuators.0.stroke": "1 um"}).actuators[0].max_stroke == pytest.approx(2e-6)
    lattice = read_case(file_with(tmp_path, LATTICE + 'stroke = "2 * column um"\nmax_stroke = "4 um"'))
    assert [actuator.max_stroke for actuator in lattice.actuators] == pytest.approx([4e-6] * 3)


def test_the_force_of_a_central_stroke_is_that_of_the_closed_form(tmp_path):
    for spring, expected in (("", TAKEN), ('stiffness = "500 N/m"', TAKEN / (1 + TAKEN / 2e-6 / 500))):
        case = read_case(file_with(tmp_path, ONE + STROKE + spring))
        assert largest_forces(case) == pytest.approx([expected], rel=1e-4) and limit_warnings(case) == []


@pytest.mark.parametrize(("share", "warned"), [(0.99, True), (1.01, False)])
def test_check_warns_of_strokes_that_take_too_much_force(tmp_path, share, warned):
    path = file_with(tmp_path, ONE + STROKE + f'max_force = "{share * TAKEN:.9e} N"')
    done = CliRunner().invoke(main, ["check", str(path)])
    assert done.exit_code == 0 and "fine; 1 actuator" in done.output
    assert ("Actuator 0 takes more than max_force: 2.16 mN of 2.14 mN, by linear theory" in done.output) == warned


def test_of_several_the_worst_is_named(tmp_path):
    case = read_case(file_with(tmp_path, LATTICE + 'stroke = "2 if column == 1 else 1 um"\nmax_force = "1 uN"'))
    (text,) = limit_warnings(case)
    assert text.startswith("3 actuators take more than max_force, actuator 1 most: ") and "of 1 µN" in text


@pytest.mark.parametrize(
    ("changes", "warned"),
    [
        (
            {"part": {"mass": "1 g", "size": "75 um"}},
            ["The part has 2.4e+09 kg/m^3 if it is as high as wide;"],
        ),
        ({"part": {"mass": "9.6 ug", "size": "75 um"}}, []),
        (
            {"part": {"mass": "10 ug", "size": "100 um", "centre_height": "10 um"}},
            ["The part has 5e+04 kg/m^3; no"],
        ),
        ({"drive": {"cycles": 200}}, ["The drive of actuator 0 takes 200 ms, and the run ends after 50 ms: the rest"]),
        ({"drive": {"cycles": 50}}, []),
        ({"drive": {"cycles": 45, "dwell": "0.1 ms"}}, ["The drive of actuator 0 takes 54 ms"]),
        ({"plate": {"thickness": "400 um"}}, ["The plate is 400 µm thick, 600 µm wide and 600 µm long; plate theory"]),
        (
            {"drive": {"frequency": "400 kHz"}},
            ["The fastest drive is at 0.43 of the plate's first frequency, or more;"],
        ),
        ({"drive": {"frequency": "400 kHz"}, "plate": {"inertia": True}}, []),
    ],
)
def test_check_warns_of_what_needs_no_solution(changes, warned, tmp_path):
    tables = {
        "plate": {"density": "2330 kg/m^3", **changes.get("plate", {})},
        "part": {"mass": "2e-9 kg", "position": ["10 um", "0 um"], **changes.get("part", {})},
    }
    drive = {"stroke": "1 um", "frequency": "1 kHz", **changes.get("drive", {})}
    case = python_case(
        plate=plate(**tables["plate"]),
        part=tables["part"],
        actuators=[{"position": ("0 um", "0 um"), **drive}],
        friction={"model": "constant", "limit": "1 uN"},
    )
    found = [*case_warnings(case), *frequency_warnings(case)]
    assert len(found) == len(warned) and all(one.startswith(start) for one, start in zip(found, warned, strict=True))


def test_the_first_frequency_of_the_warning_is_a_bound(tmp_path):
    """The disc around the widest gap, clamped, is a trial shape of the plate."""
    for where in (
        [("0 um", "0 um")],
        [("100 um", "0 um")],
        [("100 um", "0 um"), ("-100 um", "50 um"), ("0 um", "-150 um")],
    ):
        case = python_case(
            plate=plate(density="2330 kg/m^3"),
            actuators=[
                {"position": at, "stroke": "1 um", "frequency": "400 kHz"} for at in where or [("0 um", "0 um")]
            ],
        )
        points = [actuator.position for actuator in case.actuators]
        (text,) = frequency_warnings(case)
        bound = 400e3 / float(text.split(" at ")[1].split(" ")[0])
        assert 0.3 * bound < build_plate(case.plate).frequencies(1, points)[0] < 1.05 * bound  # its two digits


def test_check_refuses_a_plate_that_buckles(tmp_path):
    path = file_with(tmp_path, ONE + STROKE)
    soft = 'supports = "simply-supported"\nfoundation = "-1e10 N/m^3"'
    path.write_text(path.read_text().replace('cell_size = "75 um"', soft))
    done = CliRunner().invoke(main, ["check", str(path)])
    assert done.exit_code == 2 and "at which it buckles without actuators; got -10000000000" in done.output
