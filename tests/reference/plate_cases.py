"""Case files with a plate of any shape."""

from __future__ import annotations

from pathlib import Path

import pytest

from coupling import Case, CaseError, read_case

MESH = Path(__file__).parents[1] / "data" / "l_with_hole.msh"
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
