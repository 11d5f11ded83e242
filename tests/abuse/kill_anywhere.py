"""Kills commands (SIGKILL) at random moments: nothing unfinished passes as finished, and the next run works.

    python tests/abuse/kill_anywhere.py [--count 29] [--seed 1]

So many kills of each of run, sweep, aim, export, animate, view and app, at moments spread over all that each does.
Then a disk that is full, a folder that vanishes, and two processes in one folder.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import random
import resource
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from fuzz import seeds
from fuzz.__main__ import load
from PIL import Image
from tornado.httpclient import HTTPRequest
from tornado.websocket import websocket_connect

from coupling import read_case, read_run

AIM = seeds.AIM.replace("paths = 20", "paths = 100").replace("scatter = 5", "scatter = 10")
STUDY = seeds.STUDY.replace("repeats = 2", "repeats = 5")
COMMANDS: dict[str, list[str]] = {
    "run": ["run", "quick.toml", "--csv", "-o", "out", "--quiet"],
    "sweep": ["sweep", "study.toml", "-o", "out", "--quiet", "--threads", "1"],
    "aim": ["aim", "aim.toml", "-o", "out", "--quiet", "--threads", "1", "--overwrite"],
    "export": ["export", "made/quick", "--format", "pvd", "-o", "out", "--quiet"],
    "animate": [
        *("animate", "made/quick", "-o", "out/film.gif", "--size", "320x240"),
        *("--fps", "4", "--quiet"),
    ],
    "view": ["view", "made/quick", "-o", "out/page.html", "--quiet"],
    "app": ["app", "out/mine.toml"],
}
SAVED = 12  # cases, by the app


def started(command: list[str], before: Callable[[], None] = lambda: None) -> int:
    """The id of a process that runs a command in the current folder."""
    child = os.fork()
    if child:
        return child
    code = 99
    try:
        null = os.open(os.devnull, os.O_RDWR)
        for stream in (0, 1, 2):
            os.dup2(null, stream)
        before()
        if command[0] == "app":
            code = saving(Path(command[1]))
        else:
            from active_surface.cli import main

            main(command, prog_name="active-surface")
            code = 0
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else 1
    finally:
        os._exit(code)


def saving(case: Path) -> int:
    """Serve a case to a page that changes and saves it, in one process; it ends with 1 where one is not saved."""
    from active_surface.app import Server, open_case

    server, refused = Server(lambda: open_case(case)), []

    async def page() -> None:
        address = server.address.replace("http", "ws") + "socket"
        origin = {"Origin": f"http://127.0.0.1:{server.port}"}
        socket = await websocket_connect(HTTPRequest(address, headers=origin))
        for k in range(1, 1 + SAVED):
            name = f"saved{k}.toml"
            await socket.write_message(json.dumps({"do": "set", "changes": {"actuators.0.stroke": f"{0.1 * k:g} um"}}))
            await socket.write_message(json.dumps({"do": "save", "name": name, "replace": True}))
            kind = ""
            while kind not in ("note", "refused", "trouble"):
                answer = await socket.read_message()
                kind = "trouble" if answer is None else json.loads(answer)["kind"]
            refused.extend([name] if kind != "note" else [])
        os._exit(1 if refused else 0)

    server.run(lambda: asyncio.get_running_loop().create_task(page()))
    return 0


def ended(child: int) -> int:
    """The exit code of a process; minus the signal that ended it."""
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def prepare(folder: Path, made: Path) -> None:
    """A folder with all inputs and no results, which becomes the current one."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    os.chdir(folder)
    Path("out").mkdir()
    for name, text in (("quick", seeds.QUICK), ("study", STUDY), ("aim", AIM)):
        Path(f"{name}.toml").write_text(text)
    os.symlink(made, "made")
    Path("out", "mine.toml").write_text(seeds.QUICK)


def finished() -> dict[str, object]:
    """What is finished among the results in the current folder, by its name; raises where it is not whole."""
    there: dict[str, object] = {}
    for path in sorted(Path("out").rglob("*")):
        unfinished = ".partial" in path.name or path.suffix.startswith(".sweep")
        if path.is_dir() or unfinished or path.name == "mine.toml":
            continue
        name = path.relative_to("out").as_posix()
        if path.suffix in (".png", ".gif"):
            with Image.open(path) as picture:
                frames = getattr(picture, "n_frames", 1)
                picture.seek(frames - 1)
                picture.load()
                there[name] = (picture.size, frames)
        elif path.suffix == ".toml":
            there[name] = [(one.stroke, one.frequency) for one in read_case(path).actuators]
        elif path.suffix == ".vtkhdf":
            continue
        elif path.suffix == ".html":
            text = path.read_text(encoding="utf-8")
            assert text.rstrip().endswith("</html>"), name
            there[name] = len(text)
        elif path.suffix in (".csv", ".nc"):
            there[name] = path.read_bytes()
        elif path.suffix == ".pvd":
            there[name] = sorted((file.name, file.stat().st_size) for file in path.with_suffix("").glob("*.vtu"))
    if Path("out/quick.part.vtkhdf").exists() and Path("out/quick.plate.vtkhdf").exists():
        run = read_run("out/quick")
        if run.complete:
            there["quick"] = (run.time.tobytes(), run.position.tobytes(), run.rows.position.tobytes())
            assert all(np.isfinite(run.plate_field(name)).all() for name in run.plate_fields)
    return there


def whole_run(name: str, folder: Path, made: Path) -> tuple[dict[str, object], float]:
    """The results of a command that nothing disturbs, and how long it takes [s]."""
    prepare(folder, made)
    begun = time.monotonic()
    assert ended(started(COMMANDS[name])) in (0, 1), name
    duration, expected = time.monotonic() - begun, finished()
    assert expected, name
    return expected, duration


def kill(
    name: str, expected: dict[str, object], duration: float, count: int, seed: int, folder: Path, made: Path
) -> list[str]:
    """What was wrong after kills of one command, which takes a duration [s]."""
    chance, wrong, late = random.Random(f"{seed}/{name}"), [], 0
    for k in range(count):
        prepare(folder, made)
        delay = chance.uniform(0, 1.05 * duration)
        child = started(COMMANDS[name])
        time.sleep(delay)
        os.kill(child, signal.SIGKILL)
        if ended(child) != -signal.SIGKILL:
            late += 1
        try:
            if other := differing(expected):
                wrong.append(f"{name} {k}: after {delay:.2f} s {other} differ from those of a whole run")
            if (code := ended(started(COMMANDS[name]))) not in (0, 1) or finished() != expected:
                wrong.append(f"{name} {k}: the next run ends with {code}, or has other results")
        except Exception as error:  # whatever it is, a file is not whole
            wrong.append(f"{name} {k}: after {delay:.2f} s {type(error).__name__}: {error}")
    print(f"{name:8} {count} kills within {duration:.2f} s, {late} of them too late; {len(wrong)} wrong", flush=True)
    return wrong


def differing(expected: dict[str, object]) -> list[str]:
    """The finished results that differ from those of a whole run."""
    return [name for name, what in finished().items() if what != expected.get(name)]


def full_disk(name: str, expected: dict[str, object], folder: Path, made: Path) -> list[str]:
    """What is wrong where files may have so many bytes only."""
    wrong, codes = [], []
    for most in (0, 512, 4096, 30_000, 100_000):

        def limit(most: int = most) -> None:
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))

        prepare(folder, made)
        codes.append(ended(started(COMMANDS[name], limit)))
        if codes[-1] not in (0, 1, 2):
            wrong.append(f"{name}: with {most} bytes a file it ends with {codes[-1]}")
        try:
            other = differing(expected)
        except Exception as error:
            other = [f"{type(error).__name__}: {error}"]
        if other:
            wrong.append(f"{name}: with {most} bytes a file {other} are there")
        if (code := ended(started(COMMANDS[name]))) not in (0, 1) or finished() != expected:
            wrong.append(f"{name}: with room again it ends with {code}, or has other results")
    print(f"{name:8} on a full disk ends with {codes}; {len(wrong)} wrong", flush=True)
    return wrong


def vanished(name: str, folder: Path, made: Path, seed: int) -> list[str]:
    """What is wrong where the folder of the results goes while they are made."""
    chance, wrong, codes = random.Random(f"{seed}/gone/{name}"), [], []
    for _ in range(5):
        prepare(folder, made)
        child = started(COMMANDS[name])
        time.sleep(chance.uniform(0, 1.0))
        shutil.rmtree("out", ignore_errors=True)
        codes.append(ended(child))
    if not {*codes} <= {0, 1, 2}:
        wrong.append(f"{name}: where its folder vanishes it ends with {codes}")
    print(f"{name:8} in a folder that vanishes ends with {codes}; {len(wrong)} wrong", flush=True)
    return wrong


def together(name: str, expected: dict[str, object], folder: Path, made: Path) -> list[str]:
    """What is wrong where two processes make the same results at a time."""
    prepare(folder, made)
    children = [started(COMMANDS[name]) for _ in range(2)]
    codes = [ended(child) for child in children]
    wrong = [] if {*codes} <= {0, 1, 2} and min(codes) < 2 else [f"{name}: two at a time end with {codes}"]
    if finished() != expected:
        wrong.append(f"{name}: two at a time leave other results")
    print(f"{name:8} twice at a time ends with {codes}; {len(wrong)} wrong", flush=True)
    return wrong


def main() -> None:
    parser = argparse.ArgumentParser(description="Kill commands at random moments.")
    parser.add_argument("--count", type=int, default=29)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", choices=list(COMMANDS))
    asked = parser.parse_args()
    made = seeds.ROOT / "build" / "fuzz" / "seeds"
    seeds.make(made)
    load(made)  # once, before processes are forked
    names = [asked.only] if asked.only else list(COMMANDS)
    wrong: list[str] = []
    with tempfile.TemporaryDirectory(prefix="kills-") as folder:
        at = Path(folder, "at")
        for name in names:
            expected, duration = whole_run(name, at, made)
            wrong += kill(name, expected, duration, asked.count, asked.seed, at, made)
            wrong += full_disk(name, expected, at, made)
            wrong += vanished(name, at, made, asked.seed)
            wrong += together(name, expected, at, made)
        os.chdir(made)
    print("\n".join(wrong))
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
