"""The public API: one module with all names, known to editors, loaded when they are used."""

import importlib
import subprocess
import sys
from pathlib import Path

import pytest

import active_surface

ROOMS = ["studies", "steering", "views", "identification"]
PACKAGES = ["fem_plate", "particle", "coupling", *(f"active_surface.{room}" for room in ROOMS)]
MODULES = {"meshes", "paper", *ROOMS}


def test_api_has_the_public_names_of_all_packages_and_no_others():
    public = [name for package in PACKAGES for name in importlib.import_module(package).__all__]
    assert len(public) == len(set(public))
    assert set(active_surface.__all__) == {*public, *MODULES} <= set(dir(active_surface))


def test_names_of_the_api_are_those_of_the_packages():
    for door in map(importlib.import_module, PACKAGES):
        assert [name for name in door.__all__ if getattr(active_surface, name) is not getattr(door, name)] == []


def test_a_name_that_does_not_exist_is_refused_as_in_any_module():
    with pytest.raises(AttributeError, match="^module 'active_surface' has no attribute 'run_everything'"):
        _ = active_surface.run_everything


def test_the_api_starts_at_once():
    code = (
        "import sys, time; start = time.process_time(); import active_surface; took = time.process_time() - start;"
        "assert not {'numpy', 'scipy', 'numba', 'pydantic', 'matplotlib'} & set(sys.modules); print(took)"
    )
    runs = [subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True) for _ in range(3)]
    assert min(float(run.stdout) for run in runs) < 0.05


ROOT = Path(__file__).resolve().parents[2]
SCRIPT = """\
import active_surface
from active_surface import Plate, aim, read_study
from coupling import run_case
from particle import simulate

reveal_type(active_surface.run_case)
reveal_type(active_surface.meshes.disc)
reveal_type(Plate)
reveal_type(aim)
reveal_type(read_study)
reveal_type(run_case)
reveal_type(simulate)
"""


@pytest.mark.slow
def test_editors_know_the_types_of_a_user(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(SCRIPT)
    # With the settings and the cache of `make lint`, which it need not check anew.
    options = ["--config-file", ROOT / "pyproject.toml", "--cache-dir", ROOT / ".mypy_cache", "--no-error-summary"]
    run = subprocess.run([sys.executable, "-m", "mypy", *options, script], cwd=tmp_path, capture_output=True, text=True)
    types = [line.partition("Revealed type is ")[2] for line in run.stdout.splitlines() if "Revealed type" in line]
    assert run.returncode == 0, run.stdout
    assert len(types) == SCRIPT.count("reveal_type")
    assert all(kind.startswith('"def (') and not kind.endswith('Any"') for kind in types), types
