"""A plate for lattices, and cases that have one."""

import pytest
from sweeps import toml

from coupling import Case, CaseError, read_case
from coupling.case import ConstantCase, DiscCase, PartCase, RunCase

FRAME = toml(
    plate={
        "shape": "rectangle",
        "width": "1 mm",
        "height": "0.8 mm",
        "youngs_modulus": "169 GPa",
        "poisson_ratio": 0.3,
        "thickness": "50 um",
    },
    part={"mass": "2e-9 kg", "position": ["10 um", "20 um"]},
    friction={"model": "constant", "limit": "1 uN"},
    run={"duration": "50 ms"},
)
PLACES = '[lattice]\nrows = 3\ncolumns = 4\npitch = ["150 um", "120 um"]\n'
DRIVE = 'stroke = "5 um"\nfrequency = "300 Hz"\n'


def read(folder, lattice) -> Case:
    file = folder / "test.toml"
    file.write_text(FRAME + lattice)
    return read_case(file)


def problems(folder, lattice):
    with pytest.raises(CaseError) as caught:
        read(folder, lattice)
    return [f"{p.line} {p.field} {p.message}" for p in caught.value.problems]


def python_case(**tables) -> Case:
    plate = DiscCase(shape="disc", radius=300e-6, youngs_modulus=169e9, poisson_ratio=0.3, thickness=5e-6)
    rest = {"part": PartCase(mass=2e-9, position=(0, 0)), "friction": ConstantCase(limit=1), "run": RunCase(duration=1)}
    return Case(plate=plate, **rest, **tables)
