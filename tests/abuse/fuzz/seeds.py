"""Seeds: right files of every kind, which the fuzzer mutates; made once in a folder."""

from __future__ import annotations

import re
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import meshio
import numpy as np
from click.testing import CliRunner

ROOT: Final = Path(__file__).parents[3]
QUICK: Final = """\
[plate]
shape = "disc"
radius = "300 um"
youngs_modulus = "169 GPa"
poisson_ratio = 0.3
thickness = "5 um"
cell_size = "150 um"

[[actuators]]
position = ["0 um", "30 um"]
stroke = "5 um"
frequency = "3 kHz"

[part]
mass = "2e-9 kg"
position = ["30 um", "20 um"]

[friction]
model = "coulomb"
coefficient = 0.3
adhesion = "600 nN"

[run]
duration = "1 ms"
frames = 3
tolerance = 1e-5
"""
WITH_FILES: Final = {
    "mesh": (r"shape = .*\nradius = .*\n", 'mesh = "plate.{ending}"\nmesh_unit = "1 um"\n'),
    "friction": (r'model = "coulomb"\n.*\n.*\n', 'model = "table"\nfile = "points.csv"\n'),
}
PLATFORM: Final = """\
[plate]
shape = "platform"
motion = "motion.csv"

[part]
mass = "2e-9 kg"
position = ["0 um", "0 um"]

[friction]
model = "coulomb"
coefficient = 0.3

[run]
duration = "5 ms"
"""
LATTICE: Final = """\
[lattice]
rows = 3
columns = 3
pitch = "100 um"
stroke = "5 um"
frequency = "{frequency}"
delay = "{delay}"
where = "{where}"
"""
STUDY: Final = """\
[study]
case = "quick.toml"
repeats = 2
jitter = "5 um"
seed = 1

[[axes]]
field = "actuators.0.frequency"
range = ["2 kHz", "4 kHz"]
count = 3

[[axes]]
field = "actuators.0.stroke"
values = ["1 um", "5 um"]

[map]
threshold = "distance > 1 um"
"""
AIM: Final = """\
[aim]
case = "quick.toml"
target = ["60 um", "20 um"]
actuators = [0]
frequency = ["1 kHz", "5 kHz"]
stroke = ["0 um", "6 um"]
delay = ["0 ms", "0.1 ms"]
cycles = [1, 3]
seed = 3
paths = 20
tolerance = "0.5 um"
quantile = 0.9
scatter = 5

[aim.disturbances]
friction = "1 %"
"part.position" = "1 um"
"actuators.*.stroke" = "1 %"
"""
POINTS: Final = "actuators.0.frequency [kHz],part.position.0 [um]\n" + "".join(f"{k},{3 * k}\n" for k in range(1, 9))
FRICTION: Final = "load [uN], limit [nN]\n-1, 4\n0, 18\n2, 35\n5, 52\n"
MOTION: Final = "time [ms], x [um], z [um]\n" + "".join(
    f"{0.1 * k:.4f}, {10 * np.sin(0.3 * k):.6f}, {2 * np.cos(0.5 * k):.6f}\n" for k in range(80)
)


def case_with(name: str, **words: str) -> str:
    """The quick case with something in a file."""
    pattern, new = WITH_FILES[name]
    text = QUICK.replace('cell_size = "150 um"\n', "") if name == "mesh" else QUICK
    return re.sub(pattern, new.format(**words), text)


def lattice_case(**formulas: str) -> str:
    """The quick case with a lattice."""
    usual = {"frequency": "300 + 10 * column Hz", "delay": "0.05 * (row + column) ms", "where": "row + column > 0"}
    return re.sub(r"\[\[actuators\]\]\n(.+\n)+", LATTICE.format(**usual | formulas), QUICK)


def texts() -> Mapping[str, list[str]]:
    """The texts of cases, studies and aims that the repository has."""
    found: dict[str, list[str]] = {"case": [QUICK, PLATFORM, lattice_case()], "study": [STUDY], "aim": [AIM]}
    for path in sorted([*ROOT.glob("examples/**/*.toml"), *ROOT.glob("tests/*/*.toml")]):
        text = path.read_text(encoding="utf-8")
        if "\n[plate]" not in text:
            text = re.sub(r'case = "[^"]*"', 'case = "quick.toml"', text)
        found["study" if "\n[study]" in text else "aim" if "\n[aim]" in text else "case"].append(text)
    return found


def make(folder: Path) -> None:
    """Write the result of a run, that of a sweep, and meshes to a folder, unless they are there."""
    if (folder / "made").exists():
        return
    from active_surface.cli import main

    folder.mkdir(parents=True, exist_ok=True)
    (folder / "quick.toml").write_text(QUICK)
    (folder / "study.toml").write_text(STUDY)
    for words in (["run", "quick.toml", "--csv"], ["sweep", "study.toml", "--overwrite"]):
        command = [words[0], str(folder / words[1]), words[2], "-o", str(folder), "--quiet"]
        done = CliRunner().invoke(main, command)
        assert done.exit_code == 0, done.output
    from meshes import disc

    plate = disc(300.0, 100.0)
    cells = [("triangle", plate.triangles), ("line", plate.boundaries["rim"])]
    numbers = {
        "gmsh:physical": [np.ones(len(data), int) for _, data in cells],
        "gmsh:geometrical": [np.ones(len(data), int) for _, data in cells],
    }
    made = meshio.Mesh(np.pad(plate.points, ((0, 0), (0, 1))), cells, cell_data=numbers)
    written = (
        ("a.msh", {"file_format": "gmsh22", "binary": False}),
        ("c.msh", {"file_format": "gmsh22"}),
        ("a.vtu", {"binary": False}),
        ("b.vtu", {}),
        ("a.xdmf", {"data_format": "XML"}),
        ("b.xdmf", {"data_format": "HDF"}),
    )
    for name, options in written:
        made.write(folder / name, **options)
    for path in (ROOT / "tests" / "data").glob("*.msh"):
        shutil.copy(path, folder / path.name)
    (folder / "made").touch()
