"""The wheel, installed in a clean environment: six names, all data, and a program that runs from any folder."""

import os
import subprocess
import sys
import sysconfig
import venv
from pathlib import Path

import pytest

from particle.kernel_cache import PACKAGE, cache_folder, source_digest

ROOT = Path(__file__).resolve().parents[2]
NAMES = {"common", "meshes", "fem_plate", "particle", "coupling", "active_surface"}
SHORT = (ROOT / "examples" / "two_actuators.toml").read_text().replace('duration = "50 ms"', 'duration = "1 ms"')


def run(*command, cwd, check=True, **environment):
    """The ended process; only variables that are given here lead Python anywhere or let kernels be compiled."""
    clean = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    clean |= {"NUMBA_DISABLE_JIT": "1", "COVERAGE_PROCESS_START": ""} | environment
    done = subprocess.run([*map(str, command)], cwd=cwd, capture_output=True, text=True, env=clean)
    assert not check or done.returncode == 0, done.stderr
    return done


class Environment:
    """A virtual environment."""

    def __init__(self, folder: Path) -> None:
        venv.create(folder)
        paths = sysconfig.get_paths("venv", {"base": str(folder), "platbase": str(folder)})
        self.folder, self.packages, self._scripts = folder, Path(paths["purelib"]), Path(paths["scripts"])
        self.python, self.command = self._scripts / "python", self._scripts / "active-surface"

    def install(self, *arguments) -> None:
        run(sys.executable, "-m", "pip", "--python", self.folder, "install", "-q", *arguments, cwd=self.folder)


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    options = ["--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir", folder]
    run(sys.executable, "-m", "pip", "wheel", ROOT, *options, cwd=folder)
    (file,) = folder.iterdir()
    return file


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """An environment with the wheel, which borrows the other packages of the developer, but not their editable one."""
    made = Environment(tmp_path_factory.mktemp("environment"))
    made.install("--no-deps", "--no-index", wheel)
    assert {file.name for file in made.packages.iterdir() if file.suffix != ".dist-info"} == NAMES
    (made.packages / "borrowed.pth").write_text(sysconfig.get_paths()["purelib"])
    return made


@pytest.fixture(scope="module")
def compiled(tmp_path_factory):
    """What lets a wheel's program run with kernels, those of this checkout as far as it has compiled them."""
    mine, cache = cache_folder(PACKAGE, source_digest(PACKAGE)), tmp_path_factory.mktemp("kernels")
    (cache / "active-surface").mkdir()
    (cache / "active-surface" / mine.name).symlink_to(mine)
    return {"NUMBA_DISABLE_JIT": "0", "NUMBA_CACHE_DIR": str(cache)}


@pytest.fixture
def elsewhere(tmp_path):
    (tmp_path / "case.toml").write_text(SHORT)
    return tmp_path


def test_data_files_are_in_the_wheel(installed):
    kinds = ("*.pyi", "py.typed", "*.js", "*.css", "*.html")
    for name in NAMES:
        data = {file.relative_to(ROOT) for kind in kinds for file in (ROOT / name).rglob(kind)}
        assert Path(name, "py.typed") in data and Path(name, "__init__.pyi") in data
        assert all((installed.packages / file).read_bytes() == (ROOT / file).read_bytes() for file in data)


def test_examples_are_in_the_wheel_with_what_they_read(installed, elsewhere):
    examples = {file.relative_to(ROOT / "examples") for file in (ROOT / "examples").rglob("*") if file.is_file()}
    inside = installed.packages / "active_surface" / "examples"
    assert examples == {file.relative_to(inside) for file in inside.rglob("*") if file.is_file()}
    done = run(installed.command, "example", "l_with_hole", cwd=elsewhere)
    assert (elsewhere / "meshes" / "l_with_hole.msh").exists() and "next        active-surface run" in done.stdout
    assert run(installed.command, "check", "l_with_hole.toml", cwd=elsewhere).stdout.startswith(
        "l_with_hole.toml: fine"
    )


def test_the_main_job_runs_from_another_folder(installed, elsewhere, compiled):
    done = run(installed.command, "run", "case.toml", cwd=elsewhere, **compiled)
    assert "wrote" in done.stdout and (elsewhere / "results" / "case.png").stat().st_size > 0


def test_the_package_runs_as_a_module(installed, elsewhere):
    done = run(installed.python, "-m", "active_surface", "check", "case.toml", cwd=elsewhere)
    assert done.stdout.startswith("case.toml: fine; 2 actuators, 1 ms")


USE = """\
import {package}
print({package}.read_case("case.toml").run.duration, {package}.__file__)
"""


@pytest.mark.parametrize("package", ["active_surface", "coupling"])
def test_a_script_may_have_its_own_views_plotting_and_studies(installed, elsewhere, package):
    for name in ("views", "plotting", "studies", "steering", "cli", "paper", "shadow"):
        (elsewhere / f"{name}.py").write_text("raise RuntimeError('this module is not meant')")
    (elsewhere / "script.py").write_text(USE.format(package=package))
    duration, file = run(installed.python, "script.py", cwd=elsewhere).stdout.split()
    assert float(duration) == 0.001 and Path(file).parent == installed.packages.resolve() / package


@pytest.mark.parametrize(
    ("package", "hidden", "where"),
    [
        ("active_surface", "coupling", "{}.py"),
        ("active_surface", "meshes", "{}/__init__.py"),
        ("coupling", "particle", "{}/__init__.py"),
        ("coupling", "fem_plate", "{}.py"),
    ],
)
def test_a_module_that_hides_a_package_is_refused(installed, elsewhere, package, hidden, where):
    file = elsewhere / where.format(hidden)
    file.parent.mkdir(exist_ok=True)
    file.write_text("raise RuntimeError('this module is not meant')")
    (elsewhere / "script.py").write_text(USE.format(package=package))
    done = run(installed.python, "script.py", cwd=elsewhere, check=False)
    module = elsewhere / where.format(hidden).removesuffix("/__init__.py")
    message = f"{module} hides the package {hidden} of active-surface; rename it"
    assert done.returncode == 1 and done.stderr.splitlines()[-1] == f"ImportError: {message}"
    assert "RuntimeError" not in done.stderr and "During handling" not in done.stderr


def test_a_script_may_not_be_called_as_a_package_either(installed, elsewhere):
    (elsewhere / "particle.py").write_text(USE.format(package="active_surface"))
    done = run(installed.python, "particle.py", cwd=elsewhere, check=False)
    assert "particle.py hides the package particle of active-surface; rename it" in done.stderr


def test_commands_refuse_a_module_that_hides_a_package_in_one_line(installed, elsewhere):
    (elsewhere / "particle.py").write_text("raise RuntimeError('this module is not meant')")
    message = f"active-surface: {elsewhere / 'particle.py'} hides the package particle of active-surface; rename it\n"
    done = run(installed.python, "-m", "active_surface", "check", "case.toml", cwd=elsewhere, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (2, "", message)
    led = run(installed.command, "check", "case.toml", cwd=elsewhere, check=False, PYTHONPATH=str(elsewhere))
    assert (led.returncode, led.stdout, led.stderr) == (2, "", message)
    # By itself the command does not look for modules in the folder that it is started in.
    assert run(installed.command, "check", "case.toml", cwd=elsewhere).stdout.startswith("case.toml: fine")
