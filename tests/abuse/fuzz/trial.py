"""Trial: one input run through the program in this process, and what was wrong with how it ended."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import sys
import traceback
from pathlib import Path
from typing import Any, Final, NamedTuple

from click.testing import CliRunner

from fuzz.inputs import make
from fuzz.page import taken

LONGEST: Final = 20  # s of processors
WAITING: Final = 60  # s, in which it may also wait
SLOWER: Final = 3  # times these for messages to the app, which may open examples that take long
ELSEWHERE: Final = ("/tmp/out.toml",)  # that messages name, in vain
RAW: Final = re.compile(
    r"recursion depth|[Ss]ingular matrix|Triangulation is invalid|phony_dim|Link iteration|NoneType|has no attribute|"
    r"broadcast|out of bounds for|unhashable|not subscriptable|unexpected keyword|could not convert|invalid literal|"
    r"unsupported operand|list index|not enough values|too many values|synchronously|\bdtype\b|Traceback|KeyError|"
    r"IndexError|Errno|numpy|h5py|pydantic|pint|codec can"
)
"""Words of libraries, which no refusal may have."""


class Finding(NamedTuple):
    """What was wrong with how an input ended."""

    number: int
    kind: str
    what: str  # the same for inputs that end alike
    command: list[str]


class _HangError(BaseException):
    """That a trial took too long."""


def trial(seed: int, number: int, made: Path, folder: Path) -> tuple[str, Finding | None, str]:
    """The kind of an input, what was wrong, if anything, and how it ended; its files are in a folder made anew."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    os.chdir(folder)
    os.mkfifo("pipe")
    os.symlink("loop", "loop")
    kind, command = make(seed, number, made)
    before = _files(folder)
    what, code, output = ended(command)
    if not what and (raw := RAW.search(output)):
        what = f"words of a library: {raw[0]}"
    if not what and code == 0 and "--json" in command and not {"--help", "--version"} & {*command} and output.strip():
        what = _json_fault(output)
    if not what and (strange := [name for name in _files(folder) - before if not _named(name, command)]):
        what = f"wrote {strange[0]}"
    return kind, Finding(number, kind, what, command) if what else None, f"{code}"


def _files(folder: Path) -> set[str]:
    beside = [f"../{path.name}" for path in folder.parent.iterdir() if path.name != folder.name]
    return {*(path.name for path in folder.iterdir()), *beside, *(name for name in ELSEWHERE if Path(name).exists())}


def _named(name: str, command: list[str]) -> bool:
    """Whether a command named a file or folder that it made, or it is the usual one."""
    words = () if command[0] == "messages" else [word for word in command if word.strip("./")]
    if name in ("results", "out") or any(name.startswith(word) for word in words):
        return True
    endings = (".html", ".toml", ".pdf", ".svg", ".png", ".csv", ".vtkhdf", ".pvd", ".xdmf", ".h5")
    return "/" not in name and name.endswith(endings)


def ended(command: list[str]) -> tuple[str, int | None, str]:
    """What was wrong with how a command ended, its exit code, and its output."""

    def alarm(*_: Any) -> None:
        raise _HangError

    times = SLOWER if command[0] == "messages" else 1
    _limit(alarm, LONGEST * times, WAITING * times)
    try:
        if command[0] == "reading":
            return _read(command[1])
        if command[0] == "messages":
            return taken(*command[1:])
        from active_surface.cli import main

        done = CliRunner().invoke(main, command)
        _limit(alarm, 0, 0)
        if done.exception is not None and not isinstance(done.exception, SystemExit):
            return _place(done.exc_info), None, done.output
        if done.exit_code not in (0, 1, 2):
            return f"exit code {done.exit_code}", done.exit_code, done.output
        return "", done.exit_code, done.output
    except _HangError:
        return f"over {times * LONGEST} s", None, ""
    except BaseException:  # whatever it is, it is a finding
        return _place(sys.exc_info()), None, ""
    finally:
        _limit(alarm, 0, 0)


def _limit(alarm: Any, busy: float, waiting: float) -> None:
    """Call `alarm` after so many seconds of work, or of time; 0: never."""
    for number, timer, seconds in (
        (signal.SIGPROF, signal.ITIMER_PROF, busy),
        (signal.SIGALRM, signal.ITIMER_REAL, waiting),
    ):
        signal.signal(number, alarm)
        signal.setitimer(timer, seconds)


def _read(name: str) -> tuple[str, int, str]:
    """Read a result from Python, all that it has."""
    try:
        if name.endswith(".nc"):
            from active_surface.studies.pictures import Selection, read_findings

            with read_findings(Path(name)) as findings:
                Selection.of(findings)
        else:
            from coupling import read_run

            run = read_run(name)
            assert run.case and len(run.to_dataframe()) == len(run.rows.time) and run.loss in (None, *run.events)
            for field in run.plate_fields:
                run.plate_field(field, 0)
    except ValueError as error:
        if type(error).__module__ == "builtins" or type(error).__name__ in ("CaseError", "InputError"):
            return (
                ("", 2, str(error)) if "Input" in str(error) or ": " in str(error) else (_place(sys.exc_info()), 2, "")
            )
        return _place(sys.exc_info()), 2, ""
    return "", 0, ""


def _place(info: Any) -> str:
    kind, error, trace = info
    frames = [frame for frame in traceback.extract_tb(trace) if "site-packages" not in frame.filename]
    last = frames[-1] if frames else None
    return f"{kind.__name__} in {Path(last.filename).name}:{last.name}" if last else kind.__name__


def _json_fault(output: str) -> str:
    def constant(name: str) -> None:
        raise ValueError(name)

    try:
        json.loads(output, parse_constant=constant)
    except ValueError:
        return "its output is no JSON"
    return ""
