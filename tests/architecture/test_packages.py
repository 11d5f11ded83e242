"""The packages: ours and not their namesakes on the package index, and `particle` pure numerics."""

import importlib
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PHYSICS = ["meshes", "fem_plate", "particle", "coupling", "coupling.scene", "coupling.display", "coupling.run"]


def test_packages_are_those_in_this_repository():
    for name in ("common", "meshes", "fem_plate", "particle", "coupling", "active_surface"):
        assert Path(importlib.import_module(name).__file__).resolve() == ROOT / name / "__init__.py"


def loaded_by(*names: str) -> set[str]:
    """The top-level modules that importing `names` and all that they make public loads, in a fresh interpreter."""
    code = "".join(f"import {name}; from {name} import *\n" for name in names)
    code += "import sys; print(*{m.partition('.')[0] for m in sys.modules})"
    run = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    return set(run.stdout.split())


def test_particle_loads_neither_finite_elements_nor_file_formats_nor_our_other_packages():
    loaded = loaded_by("particle")
    assert {"particle", "numpy", "numba"} <= loaded
    assert not loaded & {"skfem", "meshio", "h5py", "pyvista", "vtkmodules", "matplotlib"}
    assert not loaded & {"meshes", "fem_plate", "coupling", "active_surface"}


def test_meshes_loads_none_of_our_other_packages():
    assert not loaded_by("meshes") & {"fem_plate", "particle", "coupling", "skfem"}


def test_fem_plate_does_not_load_particle_or_coupling():
    assert not loaded_by("fem_plate") & {"particle", "coupling"}


def test_physics_loads_nothing_that_draws():
    """Not even where every public name is loaded; pictures load matplotlib when they are drawn."""
    loaded = loaded_by(*PHYSICS)
    assert {name.partition(".")[0] for name in PHYSICS} <= loaded
    assert not loaded & {"matplotlib", "plotly", "pyvista", "vtkmodules", "PIL"}
