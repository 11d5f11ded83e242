"""Mistakes in plates, their supports and the places on them, each named."""

from pathlib import Path

import pytest
from plate_cases import DRIVE, SHAPES, problems, read, text

WRONG = [
    (
        {"shape": 'shape = "rectangle"\nwidth = "1 mm"'},
        'plate.height is missing; it must be a length such as "150 um"',
    ),
    (
        {"shape": SHAPES["rectangle"] + '\nradius = "1 um"'},
        'plate.radius is not known; it goes with shape = "disc" or shape = "polygon" and a radius',
    ),
    ({"shape": SHAPES["disc"].replace("radius", "raduis")}, "plate.raduis is not known; did you mean radius?"),
    (
        {"shape": SHAPES["annulus"].replace('"50 um"', '"200 um"')},
        "plate.outer_radius must exceed inner_radius, 200 um; got 200 um",
    ),
    (
        {"shape": SHAPES["mesh"] + '\nradius = "1 um"'},
        'plate.radius is not known; it goes with shape = "disc" or shape = "polygon" and a radius',
    ),
    ({"shape": "mesh = 3"}, "plate.mesh must be text; got 3"),
    ({"shape": 'mesh = "nowhere.msh"'}, 'plate.mesh must be a file that can be read; got "nowhere.msh": no such file'),
    (
        {"shape": f'mesh = "{Path(__file__).as_posix()}"'},
        "plate.mesh must be a .msh file of gmsh, a .vtu or ",
    ),
    ({"shape": 'shape = "polygon"\ncorners = 3'}, "plate.corners must be three points or more, such as "),
    (
        {"shape": SHAPES["polygon"].replace('["0 um", "200 um"]', '["0 um", 200]')},
        'plate.corners[2][1] must be a length such as "150 um"; got 200, which has no unit',
    ),
    (
        {"shape": SHAPES["polygon"].replace('["0 um", "200 um"]', '["-200 um", "-200 um"]')},
        "plate.corners must differ; got corner 2 at corner 0",
    ),
    ({"shape": SHAPES["polygon"] + '\nsides = ["a"]'}, 'plate.sides must be 3 names, one a side; got ["a"]'),
    (
        {"shape": SHAPES["annulus"], "plate": 'cell_size = "76 um"'},
        'plate.cell_size must not exceed half of the plate\'s smallest width, 75 um; got "76 um"',
    ),
    # Supports
    (
        {"shape": SHAPES["disc"], "plate": 'supports = "glued"'},
        'plate.supports must be "clamped", "simply-supported" or "free"; got "glued"',
    ),
    (
        {"shape": SHAPES["rectangle"], "plate": 'supports = { left = "clampd" }'},
        'plate.supports.left must be "clamped", "simply-supported" or "free"; got "clampd"',
    ),
    (
        {"shape": SHAPES["rectangle"], "plate": 'supports = { lft = "clamped" }'},
        "plate.supports.lft is no boundary of the plate; did you mean left? It has ",
    ),
    (
        {"shape": SHAPES["rectangle"], "plate": 'supports = { left = "clampd", lft = "free" }'},
        "plate.supports.lft is no boundary of the plate; did you mean left? It has ",
    ),
    ({"shape": SHAPES["rectangle"], "plate": "supports = 3"}, 'plate.supports must be "clamped", "simply-supported"'),
    (
        {"shape": SHAPES["disc"], "plate": 'supports = "free"'},
        "plate.supports leave the plate free to move as a whole",
    ),
    (
        {
            "shape": SHAPES["rectangle"],
            "plate": 'supports = "free"',
            "places": ["-60 um,0 um", "0 um,0 um", "9 um,0 um"],
        },
        "plate.supports leave the plate free to move as a whole",
    ),
    (
        {
            "shape": SHAPES["disc"],
            "plate": 'supports = "free"',
            "places": ["-60 um, 0 um", "0 um, 0 um", "9 um, 9 um"],
            "drive": 'force = "1 uN"\nfrequency = "1 Hz"\n',
        },
        "plate.supports leave the plate free to move as a whole",
    ),
    # Theory
    (
        {"shape": SHAPES["disc"], "plate": 'theory = "karman"'},
        'plate.theory must be "linear" or "von-karman"; got "karman"; did you mean "von-karman"?',
    ),
    (
        {"shape": SHAPES["annulus"], "plate": 'in_plane_supports = "movable"'},
        'plate.in_plane_supports must not be given without theory = "von-karman"; a linear plate does not stretch',
    ),
    (
        {"shape": SHAPES["polygon"], "plate": 'theory = "linear"\nin_plane_supports = "immovable"'},
        'plate.in_plane_supports must not be given without theory = "von-karman"',
    ),
    (
        {"shape": SHAPES["disc"], "plate": 'theory = "von-karman"\ntension = "400 N/m"'},
        'plate.tension must be 0 with theory = "von-karman", whose mid-plane has no stress at rest; got 400 N/m',
    ),
    (
        {"shape": SHAPES["disc"], "plate": 'theory = "von-karman"\nin_plane_supports = "sliding"'},
        'plate.in_plane_supports must be "immovable" or "movable"; got "sliding"',
    ),
    (
        {"shape": SHAPES["rectangle"], "plate": 'theory = "von-karman"\nin_plane_supports = { lft = "movable" }'},
        "plate.in_plane_supports.lft is no boundary of the plate; did you mean left? It has ",
    ),
    # Tension
    (
        {"shape": SHAPES["annulus"], "plate": 'tension = "5 N/m"\nsupports = { outer = "clamped" }'},
        'plate.tension must be 0 where a boundary is free, as a free rim carries none; got "5 N/m", and inner is free',
    ),
    (
        {"shape": SHAPES["disc"], "plate": 'tension = "5 MPa"'},
        'plate.tension must be a force per length such as "50 N/m"; got "5 MPa", a pressure',
    ),
    # Pressure
    (
        {"shape": SHAPES["disc"], "plate": 'theory = "von-karman"\npressure = "100 Pa"'},
        'plate.pressure must be 0 with theory = "von-karman", whose reduced model knows strokes and forces',
    ),
    (
        {"shape": SHAPES["disc"], "plate": 'pressure = "100 N"'},
        'plate.pressure must be a pressure such as "100 Pa"; got "100 N"',
    ),
    # Places
    (
        {"shape": SHAPES["annulus"], "places": ["0 um, 40 um"]},
        "actuators[0].position must be inside the rim; got a point 10 um beyond it",
    ),
    (
        {"shape": SHAPES["rectangle"], "part": "0 um, 130 um"},
        "part.position must be inside the rim; got a point 30 um beyond it",
    ),
    (
        {"shape": SHAPES["mesh"], "places": ["60 um, 180 um"], "part": "260 um, 230 um"},
        "part.position must be inside the rim; got a point 30 um beyond it",
    ),
    (
        {"shape": SHAPES["ellipse"], "places": ["0 um, 200 um"]},
        "actuators[0].position must be inside the rim; got a point on it",
    ),
    # Drives
    (
        {"shape": SHAPES["disc"], "drive": 'frequency = "1 Hz"\n'},
        'actuators[0].stroke is missing; it must be a length such as "150 um", or have a force such as "1 mN"',
    ),
    (
        {"shape": SHAPES["disc"], "drive": DRIVE + 'force = "1 mN"\n'},
        "actuators[0].force must not be given with a stroke",
    ),
    (
        {"shape": SHAPES["disc"], "drive": 'force = "1 mN"\nstiffness = "1 N/m"\nfrequency = "1 Hz"\n'},
        "actuators[0].stiffness must not be given with a force",
    ),
    (
        {"shape": SHAPES["disc"], "drive": DRIVE + 'stiffness = "0 N/m"\n'},
        'actuators[0].stiffness must be greater than 0; got "0 N/m"',
    ),
    (
        {"shape": SHAPES["disc"], "drive": DRIVE + 'stiffness = "1 N"\n'},
        'actuators[0].stiffness must be a stiffness such as "1e4 N/m"; got "1 N", a force',
    ),
]


@pytest.mark.parametrize(("given", "expected"), WRONG)
def test_each_mistake_is_named(tmp_path, given, expected):
    content = text(
        given["shape"],
        *given.get("places", ()),
        **{key: given[key] for key in ("plate", "drive", "part") if key in given},
    )
    found = problems(tmp_path, content)
    assert any(line.startswith(expected) for line in found), found


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
