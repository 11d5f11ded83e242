"""The command line: exit codes, messages, and what is left behind when a case is refused."""

import json
import os
import re
import signal
import subprocess
import sys
import threading
from functools import reduce
from pathlib import Path

import pytest
from click.testing import CliRunner
from sweeps import toml

from active_surface.cli import command, ctrl_c, program
from active_surface.cli.program import main
from coupling import progress
from fem_plate import verification

EXAMPLES = Path(__file__).parents[3] / "examples"
LATEST = 600.0  # s after Ctrl-C: a command that has not ended on the busiest machine is stuck
MARCHING = """
import sys
import particle.simulation as simulation
plain, paths = simulation.find_path, []
def find_path(*arguments):
    paths.append(arguments)
    if len(paths) == 2:  # the run's and the tighter one
        print("marching", flush=True)
    return plain(*arguments)
simulation.find_path = find_path
from active_surface.cli.program import main
sys.argv[1:] = {words!r}
main()
"""
BROKEN = toml(
    plate={"shape": "disc", "radius": "300 um", "youngs_modulus": "169 GPa", "poisson_ratio": 0.6, "thicknes": "5 um"},
    actuators=[{"position": ["400 um", "0 um"], "stroke": 150, "frequency": "300 Hz"}],
    part={"mass": "2e-9 kg", "position": ["100 um", "100 um"]},
    run={"duration": "50 ms"},
)


@pytest.fixture
def broken(tmp_path):
    path = tmp_path / "broken.toml"
    path.write_text(BROKEN)
    return path


@pytest.mark.parametrize("command", ["run", "check"])
def test_bad_case_exits_2_with_every_mistake_and_leaves_nothing(command, broken, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(main, [command, str(broken)])
    assert done.exit_code == 2
    for word in ("plate.poisson_ratio", "plate.thicknes", "actuators[0].stroke", "friction"):
        assert word in done.output
    assert "Traceback" not in done.output
    assert list(tmp_path.iterdir()) == [broken]


@pytest.mark.compiled
@pytest.mark.skipif(sys.platform == "win32", reason="needs signals")
def test_ctrl_c_ends_a_command_that_compiles(tmp_path):
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    words = ["run", str(EXAMPLES / "two_actuators.toml"), "--output", str(tmp_path / "out")]
    command, pipe = [sys.executable, "-m", "active_surface", *words], subprocess.PIPE
    with subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True, env=environment) as process:
        line = process.stderr.readline()
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=LATEST)
    assert line == "Compiling what this case needs for the first time (only once; it may take a few minutes)\n"
    assert (process.returncode, output, errors) == (130, "", "interrupted\n")
    assert ctrl_c.PATIENCE < 3 and not (tmp_path / "out").exists()


@pytest.mark.slow
@pytest.mark.compiled
@pytest.mark.skipif(sys.platform == "win32", reason="needs signals")
def test_ctrl_c_ends_a_run_in_the_middle(tmp_path):
    text = (EXAMPLES / "one_actuator.toml").read_text()
    case = tmp_path / "long.toml"
    case.write_text(re.sub('duration = "[^"]*"', 'duration = "200 s"', text))
    code = MARCHING.format(words=["run", str(case), "--output", str(tmp_path / "out")])
    pipe = subprocess.PIPE
    with subprocess.Popen([sys.executable, "-c", code], stdout=pipe, stderr=pipe, text=True) as run:
        assert run.stdout.readline() == "marching\n"
        run.send_signal(signal.SIGINT)
        output, errors = run.communicate(timeout=LATEST)
    assert (run.returncode, output) == (130, "") and errors.endswith("interrupted\n") and "Traceback" not in errors
    assert not (tmp_path / "out").exists()


def test_json_has_the_warnings_of_libraries(capsys, monkeypatch):
    monkeypatch.setattr(command, "from_libraries", said := [])
    monkeypatch.setattr(program, "from_libraries", said)
    program._show(UserWarning("it is a polygon"))
    command.Answer({"outcome": "stuck"}, warnings=["too fast"]).show(False, True)
    captured = capsys.readouterr()
    assert json.loads(captured.out)["warnings"] == ["it is a polygon", "too fast"]
    assert captured.err == "warning     it is a polygon\n"


def test_verify_passes_and_writes_every_figure(tmp_path):
    file = tmp_path / "figures" / "checks.json"
    done = CliRunner().invoke(main, ["verify", "--json", str(file)])
    assert done.exit_code == 0
    checks = json.loads(file.read_text())
    assert [check["passed"] for check in checks] == [True, True]
    for check in checks:
        for figure in check["errors"]["hessian"]:
            assert f"{figure:.2e}" in done.output


def test_verify_exits_1_when_a_bound_fails(monkeypatch):
    monkeypatch.setattr(verification, "ERROR_BOUNDS", (1e-12, 1e-5, 1e-3))
    done = CliRunner().invoke(main, ["verify"])
    assert done.exit_code == 1
    assert "FAILED" in done.output


def test_without_a_terminal_verify_says_what_it_does_unless_quiet(monkeypatch):
    written, clock = threading.Event(), progress._clock
    monkeypatch.setattr(progress, "PERIOD", 0.01)
    monkeypatch.setattr(progress, "_clock", lambda seconds: written.set() or clock(seconds))
    monkeypatch.setattr(verification, "verify", lambda: [] if written.wait(0.5) else [])
    assert CliRunner().invoke(main, ["verify", "--quiet"]).stderr == ""
    assert "0 of 1 stages done; Checking the plate\n" in CliRunner().invoke(main, ["verify"]).stderr


SHAKEN = """\
[plate]
shape = "platform"

[plate.motion.x]
stroke = "200 um"
frequency = "100 Hz"
cycle = "sine"

[part]
mass = "2 ug"
position = ["0 um", "0 um"]

[friction]
model = "coulomb"
coefficient = 0.2

[run]
duration = "25 ms"
"""


@pytest.mark.slow
@pytest.mark.compiled
def test_advise_writes_a_case_which_moves(tmp_path):
    file = tmp_path / "still.toml"
    mends = {"0.6": "0.3", "thicknes ": "thickness ", "400 um": "0 um", "150": '"5 um"', "50 ms": "3 ms"}
    text = reduce(lambda whole, pair: whole.replace(*pair), mends.items(), BROKEN)
    file.write_text(f'{text}\n[friction]\nmodel = "coulomb"\ncoefficient = 0.2\nadhesion = "200 nN"\n')
    new, arguments = tmp_path / "still_advised.toml", ["--output", str(tmp_path), "--json"]
    done = CliRunner().invoke(main, ["advise", str(file), *arguments])
    still = json.loads(done.stdout)
    assert done.exit_code == 0 and still["files"] == [str(new)] and still["thresholds"]["slips_from"] > 1
    kept, written = file.read_text().splitlines(), new.read_text().splitlines()
    assert len([line for line in written[2:] if line in kept]) > len(kept) / 2
    again = CliRunner().invoke(main, ["advise", str(file), *arguments])
    assert again.exit_code == 2 and f"which has {new.name}: --overwrite replaces it" in again.output
    moved = json.loads(CliRunner().invoke(main, ["run", str(new), *arguments]).stdout)
    assert moved["distance"] == pytest.approx(still["trials"][0]["distance"], rel=1e-3)


@pytest.mark.compiled
def test_nothing_is_advised_where_the_part_moves_already(tmp_path):
    file = tmp_path / "moves.toml"
    file.write_text(SHAKEN)
    done = CliRunner().invoke(main, ["advise", str(file), "--output", str(tmp_path)])
    assert done.exit_code == 0 and list(tmp_path.iterdir()) == [file]
    assert "advice      The part moves already, and stays on.\n" in done.output


def test_help_loads_no_solver():
    code = "import sys, active_surface.cli.program as p; p.main(['--help'], standalone_mode=False); print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    said = set(done.stdout.split())
    assert {"run", "check", "sweep", "aim", "plan", "verify", "schema", "completion"} <= said
    assert not said & {"numba", "numpy", "scipy", "matplotlib", "h5py", "pydantic", "xarray", "h5netcdf", "pyvista"}
