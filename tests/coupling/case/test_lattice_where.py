"""Formulas that leave out actuators of a lattice, and mistakes in them."""

import numpy as np
import pytest
from lattice_cases import DRIVE, PLACES, problems, python_case, read

from coupling.case import LatticeCase


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


@pytest.mark.parametrize(
    ("where", "expected"),
    [
        ('"row > 5"', 'lattice.where must be true for one actuator or more; "row > 5" is true for none'),
        ('"column"', 'true or false for each actuator; "column" is a number and not a comparison at row 0, column 0'),
        ('"1 / column > 2"', '"1 / column > 2" divides by zero at row 0, column 0'),
        (
            '"rwo > 2"',
            'must be an expression that is true or false; got "rwo > 2": there is no rwo; did you mean row?',
        ),
        ('"x > 10 um"', '"um" is too much; it has no unit'),
        ('""', "lattice.where must be an expression that is true or false, such as"),
        ("true", "lattice.where must be an expression that is true or false, such as"),
    ],
)
def test_mistakes_in_where(tmp_path, where, expected):
    found = problems(tmp_path, PLACES + f"where = {where}\n" + DRIVE)
    assert len(found) == 1 and expected in found[0], found
