"""Fuzzes for so many seconds or inputs: in tests/abuse, python -m fuzz [--seconds S] [--count N] [--seed SEED].

Inputs follow from the seed and their number, so that the same command tries the same inputs, and `--first N --count 1`
tries one again. Processes of their own try them, with bounds on time and memory. The exit code is 1 if any was wrong.
"""

from __future__ import annotations

import argparse
import gc
import json
import os
import resource
import select
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from contextlib import suppress
from pathlib import Path
from typing import Final

from fuzz import seeds
from fuzz.trial import SLOWER, WAITING, Finding, ended, trial

BATCH: Final = 400  # inputs of a process
MEMORY: Final = 4 * 2**30  # bytes that an input may take
ADDRESSES: Final = 8 * 2**30  # bytes that may be asked for, more than are used
SILENT: Final = WAITING * SLOWER + 15  # s until a process that says nothing is ended


def batch(seed: int, first: int, count: int, made: Path, folder: Path, pipe: int) -> None:
    """Try inputs and write what came of each to a pipe as a line."""
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES))
    null = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(null, stream)
    for number in range(first, first + count):
        try:
            kind, finding, code = trial(seed, number, made, folder)
        except BaseException as error:  # of the fuzzer itself
            kind, code = "?", ""
            finding = Finding(number, kind, f"no trial: {type(error).__name__} {error}"[:300], [])
        used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
        if used > MEMORY and finding is None:
            finding = Finding(number, kind, f"{used / 2**30:.1f} GB of memory", [])
        line = json.dumps([number, kind, finding, code]) + "\n"
        os.write(pipe, line.encode())
        if used > MEMORY:
            break


def tried(seed: int, first: int, count: int, made: Path, folder: Path) -> list[tuple[int, str, Finding | None, str]]:
    """What came of inputs in a process of their own; at least of the first."""
    receiver, sender = os.pipe()
    child = os.fork()
    if child == 0:
        os.setpgid(0, 0)
        os.close(receiver)
        code = 1
        try:
            batch(seed, first, count, made, folder, sender)
            code = 0
        finally:
            os._exit(code)
    os.close(sender)
    text = b""
    hung = False
    while True:
        try:
            ready, _, _ = select.select([receiver], [], [], SILENT)
        except KeyboardInterrupt:  # which only this process gets
            with suppress(ProcessLookupError):
                os.killpg(child, signal.SIGKILL)
            raise
        if not ready:
            hung = True
            with suppress(ProcessLookupError):  # with its own children, who hold the pipe, too
                os.killpg(child, signal.SIGKILL)
        piece = os.read(receiver, 65536)
        if not piece:
            break
        text += piece
    os.close(receiver)
    _, status = os.waitpid(child, 0)
    results = []
    for line in text.decode().splitlines():
        number, kind, finding, code = json.loads(line)
        results.append((number, kind, Finding(*finding) if finding else None, code))
    if status != 0 and len(results) < count:
        number = first + len(results)
        what = f"over {SILENT} s, deaf to signals" if hung else f"the process ended by signal {status & 127}"
        results.append((number, "?", Finding(number, "?", what, []), ""))
    return results


def main() -> None:
    parser = argparse.ArgumentParser(description="Fuzz the program.")
    parser.add_argument("--seconds", type=float, default=float("inf"))
    parser.add_argument("--count", type=int, default=10**9)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    given = parser.parse_args()
    made = seeds.ROOT / "build" / "fuzz" / "seeds"
    seeds.make(made)
    load(made)
    begun, number, end = time.monotonic(), given.first, given.first + given.count
    counts: Counter[str] = Counter()
    codes: Counter[str] = Counter()
    findings: dict[str, list[Finding]] = {}
    with tempfile.TemporaryDirectory(prefix="fuzz-") as folder:
        while number < end and time.monotonic() - begun < given.seconds:
            results = tried(given.seed, number, min(BATCH, end - number), made, Path(folder, "at"))
            number += len(results)
            for _, kind, finding, code in results:
                counts[kind] += 1
                codes[code] += 1
                if finding:
                    alike = findings.setdefault(f"{kind}: {finding.what}", [])
                    alike.append(finding)
                    if len(alike) == 1:
                        print(
                            f"{finding.number}  {kind}: {finding.what}  {' '.join(finding.command)[:150]}", flush=True
                        )
    seconds = time.monotonic() - begun
    print(f"seed {given.seed}: {sum(counts.values())} inputs in {seconds:.0f} s, {dict(sorted(counts.items()))}")
    wrong = f"{sum(map(len, findings.values()))} wrong of {len(findings)} kinds"
    print(f"accepted {codes['0']}, refused {codes['2']}; {wrong}")
    for what, alike in sorted(findings.items()):
        print(f"  {len(alike)} times {what}: inputs {[one.number for one in alike[:5]]}")
    sys.exit(1 if findings else 0)


def load(made: Path) -> None:
    """Load what the processes need once, before they are forked: by right inputs of all kinds."""
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for path in made.iterdir():
            shutil.copy(path, path.name)
        Path("points.csv").write_text(seeds.FRICTION)
        Path("motion.csv").write_text(seeds.MOTION)
        meshes = {f"{ending}.toml": seeds.case_with("mesh", ending=ending) for ending in ("msh", "vtu", "xdmf")}
        texts = meshes | {"friction.toml": seeds.case_with("friction"), "platform.toml": seeds.PLATFORM}
        texts |= {"lattice.toml": seeds.lattice_case(), "aim.toml": seeds.AIM}
        for name, text in texts.items():
            Path(name).write_text(text.replace("plate.", "a."))
        commands = [["check", name, "--json"] for name in (*texts, "study.toml")]
        commands += [["reading", "quick"], ["reading", "study.nc"], ["export", "quick", "--format", "csv", "-o", "out"]]
        commands += [["plot", "study.nc", "--format", "svg", "-o", "out"], ["run", "quick.toml", "--json", "-o", "out"]]
        for command in commands:
            what, code, output = ended(command)
            assert not what and code == 0, f"{command}: {what} {output}"
        os.chdir(made)
    gc.freeze()


if __name__ == "__main__":
    main()
