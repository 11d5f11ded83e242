"""The plates of a case: every shape, crystals, and what holds them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from case_files import DRIVE, MESH, plate, python_case, read, text

from coupling.case import (
    AnnulusCase,
    Case,
    DiscCase,
    EllipseCase,
    InputError,
    MeshCase,
    PolygonCase,
    RectangleCase,
    RegularPolygonCase,
)
from coupling.report import device
from coupling.scene import build_plate, section_of
from fem_plate import AnisotropicSection

MATERIAL = {"youngs_modulus": 1.0, "poisson_ratio": 0.3, "thickness": 1.0}
STRETCHING = 'theory = "von-karman"'


@pytest.mark.parametrize(
    ("shape", "model", "area", "names"),
    [
        ("disc", DiscCase, math.pi * 4e-8, ["rim"]),
        ("rectangle", RectangleCase, 8e-8, ["bottom", "left", "right", "top"]),
        ("annulus", AnnulusCase, math.pi * 3.75e-8, ["inner", "outer"]),
        ("ellipse", EllipseCase, math.pi * 2e-8, ["rim"]),
        ("polygon", PolygonCase, 8e-8, ["rim"]),
        ("regular", RegularPolygonCase, 6e-8 * math.sqrt(3), ["rim"]),
        ("mesh", MeshCase, 12e-8 - math.pi * 25e-10, ["hole", "outer"]),
    ],
)
def test_every_shape_is_read_and_meshed(tmp_path, shape, model, area, names):
    places = ("200 um, 60 um", "60 um, 200 um") if shape == "mesh" else ("0 um, 99 um", "60 um, -60 um")
    plate = read(tmp_path, text(shape, places[0], part=places[1])).plate
    assert type(plate) is model
    mesh = plate.build_mesh()
    a, b, c = np.moveaxis(mesh.points[mesh.triangles], 1, 0)
    (x, y), (u, v) = (b - a).T, (c - a).T
    assert (x * v - y * u).sum() / 2 == pytest.approx(area, rel=0.05)
    assert sorted(mesh.boundaries) == names
    if shape != "mesh":
        assert plate.measures[1] == pytest.approx(area)
        assert 100 < len(mesh.triangles) < 2000


def test_a_cell_size_sets_the_cells_and_says_so():
    fine = RectangleCase(shape="rectangle", width=4.0, height=2.0, cell_size=0.1, **MATERIAL)
    free = RectangleCase(shape="rectangle", width=4.0, height=2.0, **MATERIAL)
    assert fine.cell_size_given and not free.cell_size_given
    assert len(fine.build_mesh().triangles) > 2 * len(free.build_mesh().triangles)
    assert not MeshCase(mesh=str(MESH), **MATERIAL).cell_size_given
    disc = DiscCase(shape="disc", radius=3e-4, **MATERIAL).build_mesh()
    assert len(disc.triangles) == 6 * 8**2  # eight rings


def test_a_mesh_lies_beside_its_case(tmp_path):
    (tmp_path / "plates").mkdir()
    (tmp_path / "plates" / "l.msh").write_bytes(MESH.read_bytes())
    shape = 'mesh = "plates/l.msh"\nmesh_unit = "2 um"'
    case = read(tmp_path, text(shape, "400 um, 120 um", part="120 um, 400 um"))
    assert case.plate.mesh == str(tmp_path / "plates" / "l.msh")
    assert case.plate.build_mesh().outline.box.max() == pytest.approx(800e-6)
    assert case.plate.coarse_mesh is Case(**dict(case)).plate.coarse_mesh


@pytest.mark.parametrize("sides", [3, 4, 5, 6, 12])
def test_a_regular_polygon_is_a_plate(sides):
    plate = RegularPolygonCase(shape="polygon", sides=sides, radius=200e-6, rotation="20 deg", **MATERIAL)
    mesh = plate.build_mesh()
    assert plate.measures[1] == pytest.approx(sides / 2 * 4e-8 * math.sin(2 * math.pi / sides))
    corners = mesh.points[np.hypot(*mesh.points.T) > 200e-6 * (1 - 1e-12)]
    assert len(corners) == sides
    assert np.hypot(*(corners - 200e-6 * np.array([math.cos(math.pi / 9), math.sin(math.pi / 9)])).T).min() < 1e-17
    # The smallest width: between parallel sides, or from a side to the corner opposite.
    angle = np.linspace(0, math.pi, 3601)
    widths = np.ptp(corners @ np.stack([np.cos(angle), np.sin(angle)]), axis=0)
    assert plate.measures[0] == pytest.approx(widths.min(), rel=1e-5)


def test_a_polygon_may_name_its_sides(tmp_path):
    plate = 'sides = ["foot", "rest", "rest"]\nsupports = { foot = "clamped" }'
    case = read(tmp_path, text("polygon", plate=plate, part="0 um, 60 um"))
    assert isinstance(case.plate, PolygonCase)
    assert sorted(case.plate.coarse_mesh.boundaries) == ["foot", "rest"]


def test_boundaries_left_out_are_free():
    radii = {"inner_radius": 1.0, "outer_radius": 2.0}
    plate = AnnulusCase(shape="annulus", **radii, supports={"outer": "clamped"}, **MATERIAL)
    assert plate.supports_of(["inner", "outer"]) == {"inner": "free", "outer": "clamped"}


def test_a_plate_may_be_held_in_its_plane_by_boundary(tmp_path):
    plate = STRETCHING + '\nin_plane_supports = { left = "immovable", right = "movable" }'
    case = read(tmp_path, text("rectangle", plate=plate))
    assert case.plate.in_plane_supports == {"left": "immovable", "right": "movable"}
    assert read(tmp_path, text("disc", plate=STRETCHING) + 'scheme = "fixed"\n').run.scheme == "fixed"


FREE = 'supports = "free"'
FORCE = 'force = "1 uN"\nfrequency = "1 Hz"\n'


@pytest.mark.parametrize(
    ("places", "plate", "drive", "held"),
    [
        (["60 um, -60 um"], 'supports = { left = "simply-supported" }', DRIVE, True),
        (["60 um, -60 um"], 'supports = { left = "simply-supported" }', FORCE, False),
        (["-60 um, 0 um", "0 um, 0 um", "9 um, 9 um"], FREE, DRIVE, True),
        (["-60 um, 0 um", "0 um, 0 um", "9 um, 0 um"], FREE, DRIVE, False),
        (["-60 um, 0 um", "0 um, 0 um", "9 um, 9 um"], FREE, FORCE, False),
        (["60 um, -60 um"], FREE + '\nfoundation = "1e9 N/m^3"', FORCE, True),
        (["60 um, -60 um"], FREE + '\nfoundation = "-1e9 N/m^3"', FORCE, False),
        (["0 um, 0 um", "9 um, 9 um", "9 um, 0 um", "0 um, 9 um"], f"{FREE}\n{STRETCHING}", DRIVE, True),
    ],
)
def test_what_holds_a_plate(tmp_path, places, plate, drive, held):
    content = text("rectangle", *places, plate=plate, drive=drive)
    if held:
        assert len(read(tmp_path, content).actuators) == len(places)
    else:
        with pytest.raises(ValueError, match="plate.supports must not leave the plate free to move as a whole"):
            read(tmp_path, content)


def test_a_case_of_any_shape_is_built_in_python():
    plate = {"shape": "rectangle", "width": "1 mm", "height": 5e-4, "supports": {"left": "clamped"}}
    material = {"youngs_modulus": 1e9, "poisson_ratio": 0.3, "thickness": 1e-6}
    assert python_case(plate=plate | material).plate == RectangleCase(**plate, **material)
    with pytest.raises(InputError, match="free to move"):
        python_case(plate=plate | material | {"supports": "free"})


def test_200_actuators_may_stretch():
    lattice = {"pitch": "9 um", "rows": 20, "columns": 10, "stroke": "1 um", "frequency": "1 Hz"}
    assert len(python_case(plate=plate(theory="von-karman"), lattice=lattice).actuators) == 200
    lattice |= {"rows": 19, "columns": 11}
    with pytest.raises(InputError, match='plate.theory of Case must be "linear" with more than 200 actuators'):
        python_case(plate=plate(theory="von-karman"), lattice=lattice)


def test_a_tension_is_read_and_makes_another_plate(tmp_path):
    plain = read(tmp_path, text("disc")).plate
    pulled = read(tmp_path, text("disc", plate='tension = "0.05 N/mm"')).plate
    pressed = read(tmp_path, text("disc", plate='tension = "-50 N/m"')).plate
    assert (plain.tension, pulled.tension, pressed.tension) == (0.0, 50.0, -50.0)
    assert len({plate.model_dump_json() for plate in (plain, pulled, pressed)}) == 3  # what sweeps know plates by
    heights = [build_plate(plate).pressure(1e3).evaluate([[0.0, 0.0]])[0][0] for plate in (pulled, plain, pressed)]
    assert heights[0] < 0.97 * heights[1] < 0.97**2 * heights[2]


def test_a_plate_that_would_buckle_is_refused_with_its_load(tmp_path):
    case = read(tmp_path, text("disc", plate='tension = "-1000 N/m"'))
    with pytest.raises(ValueError, match=r"Input tension of Plate must exceed -710\.\d+ N/m, at which it buckles"):
        build_plate(case.plate)


CELLS = {"shape": "disc", "radius": 300e-6, "thickness": 5e-6, "density": 2330.0, "cell_size": 60e-6}


def test_a_wafer_is_silicon_unless_its_constants_are_given():
    case = python_case(plate=CELLS | {"wafer": "110", "wafer_angle": "90 deg"})
    silicon = AnisotropicSection.cubic((165.7e9, 63.9e9, 79.6e9), 5e-6, 2330.0, "110", np.pi / 2)
    assert section_of(case.plate) == silicon and "cut from a (110) wafer" in device(case)
    germanium = {"wafer": "100", "c11": "128.9 GPa", "c12": "48.3 GPa", "c44": "67.1 GPa"}
    section = section_of(python_case(plate=CELLS | germanium).plate)
    assert section == AnisotropicSection.cubic((128.9e9, 48.3e9, 67.1e9), 5e-6, 2330.0)


def test_a_foundation_shifts_the_frequencies_of_the_plate_and_holds_it():
    isotropic = CELLS | {"youngs_modulus": 169e9, "poisson_ratio": 0.3}
    plates = [DiscCase(**isotropic, foundation=modulus) for modulus in (0.0, "1e10 N/m^3")]
    first, shifted = (build_plate(plate).frequencies(1)[0] for plate in plates)
    assert shifted**2 - first**2 == pytest.approx(1e10 / (2330.0 * 5e-6) / (2 * np.pi) ** 2, rel=1e-8)
    assert not build_plate(DiscCase(**isotropic, supports="free", foundation=1e9)).model().rigid.size
