"""Draws the pictures of the documentation anew: `make docs`."""

from pathlib import Path
from shutil import copy
from tempfile import TemporaryDirectory

from coupling import read_case, run_case

ROOT = Path(__file__).parent.parent

with TemporaryDirectory() as folder:
    for name in ("two_actuators",):
        run_case(read_case(ROOT / "examples" / f"{name}.toml"), output=folder)
        copy(Path(folder) / f"{name}.png", ROOT / "docs")
