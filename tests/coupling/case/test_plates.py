"""The case file's plates: every shape, supports by boundary, springs and forces, and places on any outline."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from coupling.case.any_plate import PLATES
from coupling.case.case import ActuatorCase, Case, CaseError, ConstantCase, PartCase, RunCase, read_case
from coupling.case.input_error import InputError
from coupling.case.plate import AnnulusCase, DiscCase, MeshCase, PolygonCase, RectangleCase

MESH = Path(__file__).parents[2] / "data" / "l_with_hole.msh"
MATERIAL = """\
youngs_modulus = "169 GPa"
poisson_ratio = 0.3
thickness = "5 um"
"""
DRIVE = 'stroke = "1 um"\nfrequency = "300 Hz"\n'
REST = """\
[friction]
model = "constant"
limit = "1 uN"
[run]
duration = "5 ms"
"""
SHAPES = {
    "disc": 'shape = "disc"\nradius = "200 um"',
    "rectangle": 'shape = "rectangle"\nwidth = "400 um"\nheight = "200 um"',
    "annulus": 'shape = "annulus"\ninner_radius = "50 um"\nouter_radius = "200 um"',
    "ellipse": 'shape = "ellipse"\nsemi_axis_x = "100 um"\nsemi_axis_y = "200 um"',
    "polygon": 'shape = "polygon"\ncorners = [["-200 um", "-200 um"], ["200 um", "-200 um"], ["0 um", "200 um"]]',
    "mesh": f'mesh = "{MESH}"\nmesh_unit = "1 um"',
}


def text(shape: str, *places: str, plate: str = "", drive: str = DRIVE, part: str = "60 um, 60 um") -> str:
    def point(place: str) -> str:
        return "[" + ", ".join(f'"{length.strip()}"' for length in place.split(",")) + "]"

    actuators = "".join(f"[[actuators]]\nposition = {point(place)}\n{drive}" for place in places or ("60 um, -60 um",))
    head = f"[plate]\n{shape}\n{MATERIAL}{plate}\n"
    return head + actuators + f'[part]\nmass = "1 ng"\nposition = {point(part)}\n' + REST


def read(folder: Path, content: str) -> Case:
    (folder / "test.toml").write_text(content)
    return read_case(folder / "test.toml")


def problems(folder: Path, content: str) -> list[str]:
    with pytest.raises(CaseError) as caught:
        read(folder, content)
    return [f"{problem.field} {problem.message}" for problem in caught.value.problems]


@pytest.mark.parametrize(
    ("shape", "model", "area", "names"),
    [
        ("disc", "DiscCase", math.pi * 4e-8, ["rim"]),
        ("rectangle", "RectangleCase", 8e-8, ["bottom", "left", "right", "top"]),
        ("annulus", "AnnulusCase", math.pi * 3.75e-8, ["inner", "outer"]),
        ("ellipse", "EllipseCase", math.pi * 2e-8, ["rim"]),
        ("polygon", "PolygonCase", 8e-8, ["rim"]),
        ("mesh", "MeshCase", 12e-8 - math.pi * 25e-10, ["hole", "outer"]),
    ],
)
def test_every_shape_is_read_and_meshed(tmp_path, shape, model, area, names):
    part = "60 um, -60 um" if shape != "mesh" else "60 um, 200 um"
    plate = read(tmp_path, text(SHAPES[shape], "0 um, 99 um" if shape != "mesh" else "200 um, 60 um", part=part)).plate
    assert type(plate).__name__ == model
    mesh = plate.build_mesh()
    a, b, c = np.moveaxis(mesh.points[mesh.triangles], 1, 0)
    (x, y), (u, v) = (b - a).T, (c - a).T
    assert (x * v - y * u).sum() / 2 == pytest.approx(area, rel=0.05)
    assert sorted(mesh.boundaries) == names
    if shape != "mesh":
        assert plate.measures[1] == pytest.approx(area)
        assert 100 < len(mesh.triangles) < 2000


def test_a_cell_size_sets_the_cells_and_says_so():
    material = {"youngs_modulus": 1.0, "poisson_ratio": 0.3, "thickness": 1.0}
    fine = RectangleCase(shape="rectangle", width=4.0, height=2.0, cell_size=0.1, **material)
    free = RectangleCase(shape="rectangle", width=4.0, height=2.0, **material)
    assert fine.cell_size_given and not free.cell_size_given
    assert len(fine.build_mesh().triangles) > 2 * len(free.build_mesh().triangles)
    assert not MeshCase(mesh=str(MESH), **material).cell_size_given
    disc = DiscCase(shape="disc", radius=3e-4, **material).build_mesh()
    assert len(disc.triangles) == 6 * 8**2  # eight rings


def test_a_mesh_lies_beside_its_case(tmp_path):
    (tmp_path / "plates").mkdir()
    (tmp_path / "plates" / "l.msh").write_bytes(MESH.read_bytes())
    shape = 'mesh = "plates/l.msh"\nmesh_unit = "2 um"'
    case = read(tmp_path, text(shape, "400 um, 120 um", part="120 um, 400 um"))
    assert case.plate.mesh == str(tmp_path / "plates" / "l.msh")
    assert case.plate.build_mesh().outline.box.max() == pytest.approx(800e-6)
    assert case.plate.coarse_mesh is Case(**dict(case)).plate.coarse_mesh


WRONG = [
    (
        {"shape": 'shape = "rectangle"\nwidth = "1 mm"'},
        'plate.height is missing; it must be a length such as "150 um"',
    ),
    (
        {"shape": SHAPES["rectangle"] + '\nradius = "1 um"'},
        'plate.radius is not known; [plate] with shape = "rectangle" has ',
    ),
    ({"shape": SHAPES["disc"].replace("radius", "raduis")}, "plate.raduis is not known; did you mean radius?"),
    (
        {"shape": SHAPES["annulus"].replace('"50 um"', '"200 um"')},
        "plate.outer_radius must exceed inner_radius, 200 um; got 200 um",
    ),
    ({"shape": SHAPES["mesh"] + '\nradius = "1 um"'}, "plate.radius is not known; [plate] with a mesh has "),
    ({"shape": "mesh = 3"}, "plate.mesh must be text; got 3"),
    ({"shape": 'mesh = "nowhere.msh"'}, "plate.mesh "),
    ({"shape": 'shape = "polygon"\ncorners = 3'}, "plate.corners must be three points or more, such as "),
    (
        {"shape": SHAPES["polygon"].replace('["0 um", "200 um"]', '["0 um", 200]')},
        'plate.corners[3][2] must be a length such as "150 um"; got 200, which has no unit',
    ),
    (
        {"shape": SHAPES["polygon"].replace('["0 um", "200 um"]', '["-200 um", "-200 um"]')},
        "plate.corners must differ; got corner 3 at corner 1",
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
    # Places
    (
        {"shape": SHAPES["annulus"], "places": ["0 um, 40 um"]},
        "actuators[1].position must be inside the rim; got a point 10 um beyond it",
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
        "actuators[1].position must be inside the rim; got a point on it",
    ),
    # Drives
    (
        {"shape": SHAPES["disc"], "drive": 'frequency = "1 Hz"\n'},
        'actuators[1].stroke is missing; it must be a length such as "150 um", or have a force such as "1 mN"',
    ),
    (
        {"shape": SHAPES["disc"], "drive": DRIVE + 'force = "1 mN"\n'},
        "actuators[1].force must not be given with a stroke",
    ),
    (
        {"shape": SHAPES["disc"], "drive": 'force = "1 mN"\nstiffness = "1 N/m"\nfrequency = "1 Hz"\n'},
        "actuators[1].stiffness must not be given with a force",
    ),
    (
        {"shape": SHAPES["disc"], "drive": DRIVE + 'stiffness = "0 N/m"\n'},
        'actuators[1].stiffness must be greater than 0; got "0 N/m"',
    ),
    (
        {"shape": SHAPES["disc"], "drive": DRIVE + 'stiffness = "1 N"\n'},
        'actuators[1].stiffness must be a stiffness such as "1e4 N/m"; got "1 N", a force',
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


@pytest.mark.parametrize("force", [False, True])
def test_one_side_that_is_held_up_and_an_actuator_off_it_hold_the_plate(tmp_path, force):
    drive = 'force = "1 uN"\nfrequency = "1 Hz"\n' if force else DRIVE
    content = text(SHAPES["rectangle"], plate='supports = { left = "simply-supported" }', drive=drive)
    if force:
        assert problems(tmp_path, content)[0].startswith("plate.supports leave the plate free to move as a whole")
    else:
        read(tmp_path, content)


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
        "actuators[1].position",
        "actuators[1].frequency",
        "actuators[2].frequency",
        "part.position",
    ]


def test_a_misspelt_stroke_is_not_missing_as_well(tmp_path):
    found = problems(tmp_path, text(SHAPES["disc"], drive='strok = "1 um"\nfrequency = "1 Hz"\n'))
    assert found == ["actuators[1].strok is not known; did you mean stroke?"]


def test_boundaries_left_out_are_free():
    plate = AnnulusCase(
        shape="annulus",
        inner_radius=1.0,
        outer_radius=2.0,
        supports={"outer": "clamped"},
        youngs_modulus=1.0,
        poisson_ratio=0.3,
        thickness=1.0,
    )
    assert plate.supports_of(["inner", "outer"]) == {"inner": "free", "outer": "clamped"}


def test_a_polygon_may_name_its_sides(tmp_path):
    plate = 'sides = ["foot", "rest", "rest"]\nsupports = { foot = "clamped" }'
    case = read(tmp_path, text(SHAPES["polygon"], plate=plate, part="0 um, 60 um"))
    assert isinstance(case.plate, PolygonCase)
    assert sorted(case.plate.coarse_mesh.boundaries) == ["foot", "rest"]


def test_a_case_of_any_shape_is_built_in_python():
    plate = {"shape": "rectangle", "width": "1 mm", "height": 5e-4, "supports": {"left": "clamped"}}
    material = {"youngs_modulus": 1e9, "poisson_ratio": 0.3, "thickness": 1e-6}
    others = {
        "actuators": [ActuatorCase(position=(1e-4, 0.0), force="1 uN", frequency=1.0)],
        "part": PartCase(mass=1e-9, position=(0.0, 0.0)),
        "friction": ConstantCase(limit=1.0),
        "run": RunCase(duration=1.0),
    }
    assert Case(plate=plate | material, **others).plate == RectangleCase(**plate, **material)
    with pytest.raises(InputError, match="free to move"):
        Case(plate=plate | material | {"supports": "free"}, **others)


def test_the_models_are_named_as_in_the_discriminated_union():
    assert {model.__name__ for model in PLATES.values()} == {
        *("DiscCase", "RectangleCase", "AnnulusCase", "EllipseCase", "PolygonCase", "PlatformCase"),
        *("MeshCase", "ShapelessCase"),
    }
