"""The case file's plates: every shape, supports by boundary, springs and forces, and places on any outline."""

from __future__ import annotations

import math

import numpy as np
import pytest
from plate_cases import DRIVE, MESH, SHAPES, problems, read, text

from coupling.case import (
    ActuatorCase,
    AnnulusCase,
    Case,
    ConstantCase,
    DiscCase,
    InputError,
    MeshCase,
    PartCase,
    PolygonCase,
    RectangleCase,
    RunCase,
)
from coupling.case.plates.any_plate import PLATES


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


def test_all_that_is_wrong_with_a_mesh_is_one_mistake(tmp_path):
    nodes, cells = "3\n1 0 0 0\n2 400 0 0\n3 0 400 9\n", "1\n1 2 2 0 1 1 2 3\n"
    (tmp_path / "mesh.msh").write_text(
        f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{nodes}$EndNodes\n$Elements\n{cells}$EndElements\n"
    )
    (problem,) = problems(tmp_path, text('mesh = "mesh.msh"\nmesh_unit = "1 um"', "200 um, 60 um"))
    wanted = f"plate.mesh must be a plane mesh of triangles with named boundaries; {tmp_path / 'mesh.msh'} has "
    off, rim = problem.removeprefix(wanted).split("; ", 1)
    assert off == "1 point off the plane of the others, at (0, 400, 9)"
    assert rim.startswith("an unnamed boundary: 3 edges, ")


def test_a_misspelt_mesh_leads_to_the_one_that_is_meant(tmp_path):
    (tmp_path / "l.msh").write_bytes(MESH.read_bytes())
    (tmp_path / "d.msh").mkdir()
    wanted = 'plate.mesh must be a file that can be read; got "{}": no such file or directory'
    for name, hint in (("ll.msh", '; did you mean "l.msh"?'), ("other.msh", ""), ("none\\u0000.msh", "")):
        (problem,) = problems(tmp_path, text(f'mesh = "{name}"', "200 um, 60 um"))
        assert problem == wanted.format(name) + hint
    assert problems(tmp_path, text('mesh = "d.msh"', "200 um, 60 um"))[0].endswith("d.msh is a folder")


@pytest.mark.parametrize("force", [False, True])
def test_one_side_that_is_held_up_and_an_actuator_off_it_hold_the_plate(tmp_path, force):
    drive = 'force = "1 uN"\nfrequency = "1 Hz"\n' if force else DRIVE
    content = text(SHAPES["rectangle"], plate='supports = { left = "simply-supported" }', drive=drive)
    if force:
        assert problems(tmp_path, content)[0].startswith("plate.supports leave the plate free to move as a whole")
    else:
        read(tmp_path, content)


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
        *(
            "DiscCase",
            "RectangleCase",
            "AnnulusCase",
            "EllipseCase",
            "PolygonCase",
            "PlatformCase",
            "RegularPolygonCase",
        ),
        *("MeshCase", "ShapelessCase"),
    }


def test_a_tension_is_read_and_makes_another_plate(tmp_path):
    from coupling.scene.plate import build_plate

    plain = read(tmp_path, text(SHAPES["disc"])).plate
    pulled = read(tmp_path, text(SHAPES["disc"], plate='tension = "0.05 N/mm"')).plate
    pressed = read(tmp_path, text(SHAPES["disc"], plate='tension = "-50 N/m"')).plate
    assert (plain.tension, pulled.tension, pressed.tension) == (0.0, 50.0, -50.0)
    assert len({plate.model_dump_json() for plate in (plain, pulled, pressed)}) == 3  # what sweeps know plates by
    heights = [build_plate(plate).pressure(1e3).evaluate([[0.0, 0.0]])[0][0] for plate in (pulled, plain, pressed)]
    assert heights[0] < 0.97 * heights[1] < 0.97**2 * heights[2]


def test_a_plate_that_would_buckle_is_refused_with_its_load(tmp_path):
    from coupling.scene.plate import build_plate

    case = read(tmp_path, text(SHAPES["disc"], plate='tension = "-1000 N/m"'))
    with pytest.raises(ValueError, match=r"Input tension of Plate must exceed -710\.\d+ N/m, at which it buckles"):
        build_plate(case.plate)
