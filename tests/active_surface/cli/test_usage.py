"""The words of a command: what is said about wrong ones, colours, completion, and Ctrl-C that Python drops."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from active_surface.cli import ctrl_c
from active_surface.cli.command import Answer
from active_surface.cli.program import Group, main
from particle.interrupt import unbroken

ROOT = Path(__file__).parents[3]
MISUSES = [
    (["rnu", "x"], "No such command 'rnu'"),
    (["run"], "Missing argument 'CASE'"),
    (["run", "x", "y"], "unexpected extra argument (y)"),
    (["run", "x", "--ouput", "y"], "No such option '--ouput'. Did you mean '--output'?"),
    (["sweep", "x", "-t", "0"], "'--threads' / '-t': 0 is not in the range x>=1"),
    (["completion", "bsh"], "'bsh' is not one of 'bash', 'zsh', 'fish'"),
    (["plan", "x", "--groups", "row"], "'row' is not one of 'each', 'columns', 'rows', 'all'"),
]


@pytest.mark.parametrize(("words", "said"), MISUSES, ids=lambda value: " ".join(value) if type(value) is list else "")
def test_misuse_exits_2_with_the_usage(words, said):
    done = CliRunner().invoke(main, words, prog_name="active-surface")
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr.startswith("Usage: active-surface ") and said in done.stderr


def test_options_that_exclude_each_other_are_refused_as_inputs_are():
    done = CliRunner().invoke(main, ["sweep", "x", "-t", "1", "-s", "y"], prog_name="active-surface")
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr.startswith("active-surface sweep: 1 mistake\n  --threads must not be given with --scheduler")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is full")
@pytest.mark.parametrize("words", [["check", "CASE", "--json"], ["--help"]])
def test_an_output_that_is_full_ends_with_a_sentence(words):
    case = str(ROOT / "examples/one_actuator.toml")
    command = [sys.executable, "-m", "active_surface", *(case if word == "CASE" else word for word in words)]
    with open("/dev/full", "w") as full:
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True)
        assert subprocess.run(command, stdout=full, stderr=full).returncode == 2
    assert done.returncode == 2
    assert done.stderr == "active-surface: what it prints cannot be written: no space left on device\n"


@pytest.mark.parametrize("below", ["", "new", "new/er"])
def test_a_file_in_place_of_a_folder(below, tmp_path):
    (tmp_path / "file").touch()
    done = CliRunner().invoke(main, ["run", "x", "-o", str(tmp_path / "file" / below)])
    assert done.exit_code == 2 and f"  --output must be a folder; got {tmp_path / 'file'}" in done.stderr
    assert f"but {tmp_path / 'file'} is a file\n" in done.stderr


@pytest.mark.parametrize(
    "words", [["rnu"], ["run"], ["run", "none.toml"], ["sweep", "-t", "0"], ["check", "none.toml"]]
)
def test_refusals_are_json_where_that_is_waited_for(words):
    done = CliRunner().invoke(main, [*words, "--json"])
    assert (done.exit_code, done.stderr) == (2, "")
    mistakes = json.loads(done.stdout)["mistakes"]
    assert mistakes and all(set(mistake) == {"file", "line", "field", "message"} for mistake in mistakes)


def test_the_bare_command_shows_its_help():
    done = CliRunner().invoke(main, [])
    assert done.exit_code == 2
    assert done.output.startswith("Usage: ") and "1 mistake" not in done.output and "animate" in done.output


def test_quiet_says_nothing_of_what_is_fine():
    done = CliRunner().invoke(main, ["check", str(ROOT / "examples/one_actuator.toml"), "--quiet"])
    assert (done.exit_code, done.output) == (0, "")


@pytest.mark.parametrize(
    ("settings", "coloured"),
    [({}, True), ({"NO_COLOR": "1"}, False), ({"NO_COLOR": ""}, True), ({"TERM": "dumb"}, False)],
)
def test_colours_only_where_they_are_wanted(settings, coloured, monkeypatch):
    @click.group(cls=Group)
    def group():
        pass

    @group.command()
    def warn():
        Answer({}, warnings=["too hot"]).show(False, False)

    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    for name, value in settings.items():
        monkeypatch.setenv(name, value)
    done = CliRunner().invoke(group, ["warn"], color=True)  # as on a terminal
    assert ("\x1b[33m" in done.output) is coloured


def test_no_colours_where_there_is_no_terminal():
    command = [sys.executable, "-m", "active_surface", "check", "examples/one_actuator.toml"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, env={**os.environ, "TERM": "xterm"}, check=True)
    assert b"\x1b" not in done.stdout + done.stderr


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_a_shell_gets_a_script_that_it_can_read(shell):
    done = CliRunner().invoke(main, ["completion", shell])
    assert done.exit_code == 0 and "_ACTIVE_SURFACE_COMPLETE" in done.stdout
    if shutil.which(shell):
        subprocess.run([shell, "-n"], input=done.stdout, text=True, check=True)


def test_commands_and_options_are_completed():
    def completed(*words):
        env = {**os.environ, "COMP_WORDS": " ".join(words), "COMP_CWORD": str(len(words) - 1)}
        env["_ACTIVE_SURFACE_COMPLETE"] = "bash_complete"
        code = "from active_surface.cli.program import main; main(prog_name='active-surface')"
        return subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, env=env).stdout

    assert set(completed("active-surface", "ch").split()) == {"plain,check"}
    assert set(completed("active-surface", "run", "--js").split()) == {"plain,--json"}


DROPPED = """
import signal, time
import coupling.case
class Pressed:
    def __del__(self):
        signal.raise_signal(signal.SIGINT)
def parse(path, **_):
    victim = Pressed()
    del victim  # Python passes on no exception from a finaliser
    time.sleep(60)
coupling.case.parse = parse
from active_surface.cli.program import Group, main
main()
"""


def test_ctrl_c_that_python_drops_ends_a_command_all_the_same():
    command = [sys.executable, "-c", DROPPED, "check", "any.toml"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=50)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "interrupted\n")


class Pressed:
    """Ctrl-C arrives in its finaliser, from which Python passes on no exception."""

    def __del__(self):
        signal.raise_signal(signal.SIGINT)


def test_one_that_was_dropped_and_comes_again_where_nothing_must_be_broken_off_is_not_lost(monkeypatch):
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    monkeypatch.setattr(sys, "unraisablehook", ctrl_c._raise_again)
    victims, done = [Pressed()], []
    with pytest.raises(KeyboardInterrupt):
        victims.clear()
        with unbroken():
            time.sleep(4 * ctrl_c.SOON)
            done.append(1)
        done.append(2)
    signal.signal(signal.SIGINT, before)
    assert done == [1]


@pytest.mark.parametrize(("cause", "ending"), [(KeyboardInterrupt(), 130), (OSError(), 1), (None, 1)])
def test_ctrl_c_that_compiled_code_went_on_after_ends_a_command_as_any(cause, ending, monkeypatch):
    def read(path, **_):
        raise SystemError("<built-in function> returned a result with an exception set") from cause

    monkeypatch.setattr("coupling.case.parse", read)
    done = CliRunner().invoke(main, ["check", "any.toml"])
    assert done.exit_code == ending and (done.stderr == "interrupted\n") == (ending == 130)
