"""Mistakes in plates, their supports and the places on them, each named."""

from functools import partial
from pathlib import Path

import pytest
from mistakes import answered_otherwise
from plate_cases import DRIVE, SHAPES, problems, read, text

WRONG = r"""
plate | [plate] ++ shape = "rectangle"\nwidth = "1 mm" => plate.height is missing; it must be a length such as "150 um"
rectangle | height = "200 um" ++ radius = "1 um" => plate.radius is not known; it goes with shape = "disc" or shape = "p
plate | [plate] ++ shape = "disc"\nraduis = "200 um" => plate.raduis is not known; did you mean radius?
annulus | "50 um" -> "200 um" => plate.outer_radius must exceed inner_radius, 200 um; got 200 um
mesh | mesh_unit = "1 um" ++ radius = "1 um" => plate.radius is not known; it goes with shape = "disc" or shape = "polyg
plate | [plate] ++ mesh = 3 => plate.mesh must be text; got 3
plate | [plate] ++ mesh = "nowhere.msh" => plate.mesh must be a file that can be read; got "nowhere.msh": no such file
plate | [plate] ++ shape = "polygon"\ncorners = 3 => plate.corners must be three points or more, such as 
polygon | "200 um"]] -> 200]] => plate.corners[2][1] must be a length such as "150 um"; got 200, which has no unit
polygon | ["0 um", "200 um"]] -> ["-200 um", "-200 um"]] => plate.corners must differ; got corner 2 at corner 0
polygon | corners ++ sides = ["a"] => plate.sides must be 3 names, one a side; got ["a"]
annulus | # -> cell_size = "76 um" => plate.cell_size must not exceed half of the plate's smallest width, 75 um; got "76
# -> supports = "glued" => plate.supports must be "clamped", "simply-supported" or "free"; got "glued"
rectangle | # -> supports = { left = "clampd" } => plate.supports.left must be "clamped", "simply-supported" or "free";
rectangle | # -> supports = { lft = "clamped" } => plate.supports.lft is no boundary of the plate; did you mean left? It
rectangle | # -> supports = { left = "clampd", lft = "free" } => plate.supports.lft is no boundary of the plate; did you
rectangle | # -> supports = 3 => plate.supports must be "clamped", "simply-supported"
# -> supports = "free" => plate.supports leave the plate free to move as a whole
# -> theory = "karman" => plate.theory must be "linear" or "von-karman"; got "karman"; did you mean "von-karman"?
annulus | # -> in_plane_supports = "movable" => plate.in_plane_supports must not be given without theory = "von-karman";
polygon | # -> theory = "linear"\nin_plane_supports = "immovable" => plate.in_plane_supports must not be given without t
# -> theory = "von-karman"\ntension = "400 N/m" => plate.tension must be 0 with theory = "von-karman", whose mid-plane h
# -> theory = "von-karman"\nin_plane_supports = "sliding" => plate.in_plane_supports must be "immovable" or "movable"; g
rectangle | # -> theory = "von-karman"\nin_plane_supports = { lft = "movable" } => plate.in_plane_supports.lft is no bou
annulus | # -> tension = "5 N/m"\nsupports = { outer = "clamped" } => plate.tension must be 0 where a boundary is free,
# -> tension = "5 MPa" => plate.tension must be a force per length such as "50 N/m"; got "5 MPa", a pressure
# -> theory = "von-karman"\npressure = "100 Pa" => plate.pressure must be 0 with theory = "von-karman", whose reduced mo
# -> pressure = "100 N" => plate.pressure must be a pressure such as "100 Pa"; got "100 N"
annulus | ["60 um", "-60 um"] -> ["0 um", "40 um"] => actuators[0].position must be inside the rim; got a point 10 um be
rectangle | ["60 um", "60 um"] -> ["0 um", "130 um"] => part.position must be inside the rim; got a point 30 um beyond i
mesh | "-60 um" -> "180 um" | ["60 um", "60 um"] -> ["260 um", "230 um"] => part.position must be inside the rim
ellipse | ["60 um", "-60 um"] -> ["0 um", "200 um"] => actuators[0].position must be inside the rim; got a point on it
stroke = "1 um"\n ->  => actuators[0].stroke is missing; it must be a length such
frequency = "300 Hz" ++ force = "1 mN" => actuators[0].force must not be given with a stroke
stroke = "1 um" -> force = "1 mN"\nstiffness = "1 N/m" => actuators[0].stiffness must not be given with a force
frequency = "300 Hz" ++ stiffness = "0 N/m" => actuators[0].stiffness must be greater than 0; got "0 N/m"
frequency = "300 Hz" ++ stiffness = "1 N" => actuators[0].stiffness must be a stiffness such as "1e4 N/m"; got "1 N", a
"""
THREE = "-60 um,0 um", "0 um,0 um", "9 um,0 um"


def test_each_mistake_is_named(tmp_path):
    texts = {name: text(shape, plate="#") for name, shape in (SHAPES | {"plate": ""}).items()}
    assert answered_otherwise(WRONG, partial(problems, tmp_path), **texts) == []
    no_mesh = text(f'mesh = "{Path(__file__).as_posix()}"')
    assert problems(tmp_path, no_mesh)[0].startswith("plate.mesh must be a .msh file of gmsh, a .vtu or ")


@pytest.mark.parametrize("drive", [DRIVE, 'force = "1 uN"\nfrequency = "1 Hz"\n'])
def test_three_actuators_on_a_line_or_forces_do_not_hold_a_free_plate(tmp_path, drive):
    places = THREE if drive == DRIVE else [*THREE[:2], "9 um,9 um"]
    found = problems(tmp_path, text(SHAPES["rectangle"], *places, plate='supports = "free"', drive=drive))
    assert found[0].startswith("plate.supports leave the plate free to move as a whole")


def test_mistakes_in_the_outline_and_elsewhere_come_together(tmp_path):
    content = text(
        SHAPES["annulus"],
        "0 um, 40 um",
        "60 um, -60 um",
        plate='supports = { iner = "free", outer = "held" }\ndensity = 3\ncell_size = "1 m"',
        drive='stroke = "1 um"\nfrequency = "-1 Hz"\n',
        part="1 mm, 0 um",
    )
    assert [line.split()[0] for line in problems(tmp_path, content)] == [
        "plate.supports.outer",
        "plate.supports.iner",
        "plate.density",
        "plate.cell_size",
        "actuators[0].position",
        "actuators[0].frequency",
        "actuators[1].frequency",
        "part.position",
    ]


def test_a_misspelt_stroke_is_not_missing_as_well(tmp_path):
    found = problems(tmp_path, text(SHAPES["disc"], drive='strok = "1 um"\nfrequency = "1 Hz"\n'))
    assert found == ["actuators[0].strok is not known; did you mean stroke?"]


STRETCHING = 'theory = "von-karman"'


@pytest.mark.parametrize("rows", [10, 11])
def test_more_than_200_actuators_cannot_stretch(tmp_path, rows):
    places = [f"{x} um, {10 * y} um" for x in range(-95, 100, 10) for y in range(rows)]
    content = text(SHAPES["rectangle"].replace('"200 um"', '"400 um"'), *places, plate=STRETCHING, part="1 um, 1 um")
    if rows == 10:
        assert len(read(tmp_path, content).actuators) == 200
        return
    (found,) = problems(tmp_path, content)
    assert found.startswith('plate.theory must be "linear" with more than 200 actuators, as ')
    assert "got 220; a piece of the array with 200 can stretch" in found


def test_those_of_a_lattice_count_too(tmp_path):
    lattice = '[lattice]\npitch = "9 um"\nrows = 15\ncolumns = 15\n' + DRIVE
    (found,) = problems(tmp_path, text(SHAPES["disc"], "100 um, 0 um", plate=STRETCHING) + lattice)
    assert found.startswith('plate.theory must be "linear" with more than 200 actuators')
    assert "got 226" in found


def test_the_papers_scheme_does_not_follow_a_plate_that_stretches(tmp_path):
    content = text(SHAPES["disc"], plate=STRETCHING)
    assert read(tmp_path, content + 'scheme = "fixed"\n').plate.theory == "von-karman"
    (found,) = problems(tmp_path, content + 'scheme = "paper"\n')
    assert found.startswith('run.scheme must be "events" or "fixed" with theory = "von-karman"')


def test_a_plate_may_be_held_in_its_plane_by_boundary(tmp_path):
    plate = STRETCHING + '\nin_plane_supports = { left = "immovable", right = "movable" }'
    case = read(tmp_path, text(SHAPES["rectangle"], plate=plate))
    assert case.plate.in_plane_supports == {"left": "immovable", "right": "movable"}
    assert read(tmp_path, text(SHAPES["rectangle"])).plate.theory == "linear"
