"""Small cases for tests, and studies of them written into a folder."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from xarray import Dataset

from coupling import read_case
from coupling.case import Case

PLATFORM = """\
[plate]
shape = "platform"

[plate.motion.x]
stroke = "20 um"
frequency = "200 Hz"

[part]
mass = "2e-9 kg"
position = ["0 um", "0 um"]

[friction]
model = "constant"
limit = "20 nN"

[run]
duration = "2 ms"
"""

DISC_PLATE = """\
[plate]
shape = "disc"
radius = "300 um"
youngs_modulus = "169 GPa"
poisson_ratio = 0.3
thickness = "5 um"
"""
"""The plate of these cases, whose table may go on."""

PLATE = (
    DISC_PLATE
    + """\
cell_size = "80 um"

[[actuators]]
position = ["-75 um", "0 um"]
stroke = "60 um"
frequency = "400 Hz"

[[actuators]]
position = ["75 um", "0 um"]
stroke = "60 um"
frequency = "300 Hz"

[part]
mass = "2e-9 kg"
position = ["-140 um", "20 um"]

[friction]
model = "constant"
limit = "40 nN"

[run]
duration = "5 ms"
"""
)

LATTICE = (
    PLATE[: PLATE.index("[[actuators]]")]
    + """\
[[actuators]]
position = ["0 um", "200 um"]
stroke = "1 um"
frequency = "400 Hz"

[lattice]
rows = 1
columns = 3
pitch = "100 um"
stroke = "5 * (1 + column) um"
frequency = "400 Hz"

"""
    + PLATE[PLATE.index("[part]") :]
)

DISC = {"shape": "disc", "radius": 300e-6, "youngs_modulus": 169e9, "poisson_ratio": 0.3, "thickness": 5e-6}
"""That plate for cases made in Python."""

SHAKEN = """\
[[axes]]
field = "plate.motion.x.stroke"
name = "stroke"
values = ["5 um", "20 um", "40 um"]
[[axes]]
field = "friction.limit"
values = ["10 nN", "1 uN"]
"""


def toml(**tables: Any) -> str:
    """The text of tables, and of lists of tables, whose values JSON and TOML write alike."""
    text = ""
    for name, found in tables.items():
        for one in found if isinstance(found, list) else [found]:
            text += f"[[{name}]]\n" if isinstance(found, list) else f"[{name}]\n"
            text += "".join(f"{key} = {json.dumps(value, ensure_ascii=False)}\n" for key, value in one.items()) + "\n"
    return text


def altered(case: str, *changes: tuple[str, str]) -> str:
    """A case with each old text replaced, wherever it stands."""
    for old, new in changes:
        assert old in case
        case = case.replace(old, new)
    return case


def read_text(folder: Path, text: str) -> Case:
    """The case of a text, written into a folder."""
    file = folder / "base.toml"
    file.write_text(text)
    return read_case(file)


def written(folder: Path, study: str, case: str = PLATE) -> Path:
    """The path of a study's file, beside that of its case."""
    (folder / "base.toml").write_text(case)
    path = folder / "study.toml"
    path.write_text(study if "[study]" in study else f'[study]\ncase = "base.toml"\n{study}')
    return path


def same(one: Dataset, other: Dataset) -> bool:
    """Whether two data sets have the same bits."""
    return set(one.variables) == set(other.variables) and all(
        one[name].dims == other[name].dims and one[name].values.tobytes() == other[name].values.tobytes()
        for name in one.variables
    )
