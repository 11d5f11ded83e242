"""Kills runs while they write their results: every partial file opens in VTK and holds the steps that were flushed.

    python tests/abuse/kills.py [--count 10]

Runs the command itself in a process of its own, which reports each flush, and kills it (SIGKILL) at a random moment
between the first flush and the end of writing.
"""

from __future__ import annotations

import argparse
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyvista
from fuzz import seeds
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOHDF import vtkHDFReader

from coupling import SavedRun, read_run

ROOT = Path(__file__).parents[2]
KINDS = ("plate", "part")
LONGEST = 0.5  # s of steps that a kill may lose
# What the command runs, with a line for each write and flush: the kind of file, its steps, what it was, and when.
SPY = """
import os, time
from coupling.results import vtkhdf
def spied(name):
    plain = getattr(vtkhdf.StepsFile, name)
    def call(self, *arguments, **fields):
        begun = time.monotonic()
        plain(self, *arguments, **fields)
        kind, when = self._file.filename.split(".")[-2], begun if name == "append" else time.monotonic()
        os.write(1, f"{kind} {self.count} {name} {when}\\n".encode())
    setattr(vtkhdf.StepsFile, name, call)
spied("flush")
spied("append")
from active_surface.cli.program import main
main()
"""
CASE = seeds.QUICK.replace("frames = 3", "frames = {frames}")


class Report(NamedTuple):
    """What the command says of a write or flush."""

    kind: str
    steps: int  # in the file from then on
    what: str
    when: float  # s, on the clock that processes share

    @classmethod
    def of(cls, line: str) -> Report:
        kind, steps, what, when = line.split()
        return cls(kind, int(steps), what, float(when))

    def is_lost(self, kind: str, found: dict[str, int]) -> bool:
        """Whether it is of a write of steps that a file of this kind lacks."""
        return self.kind == kind and self.what == "append" and self.steps > found[kind]


class Kill(NamedTuple):
    """What a killed run left."""

    flushed: dict[str, int]  # steps that it had reported as flushed
    found: dict[str, int]  # steps that VTK reads, all of them right
    lost: dict[str, float]  # s, between the write of the first step that is lost and the kill


def started(folder: Path, frames: int) -> subprocess.Popen:
    """The command, running the case into a folder."""
    (folder / "killed.toml").write_text(CASE.format(frames=frames))
    command = [sys.executable, "-c", SPY, "run", str(folder / "killed.toml"), "--output", str(folder), "--quiet"]
    path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=os.environ | {"PYTHONPATH": path})


def whole_run(folder: Path, frames: int) -> tuple[SavedRun, float]:
    """The run without a kill, and how long it wrote [s]."""
    with started(folder, frames) as child:
        assert child.stdout is not None
        times = [time.perf_counter() for line in child.stdout if line.split()[0] in KINDS]
    return read_run(folder / "killed"), times[-1] - times[0]


def killed(folder: Path, frames: int, delay: float, expected: SavedRun) -> Kill:
    """Kill a run some time [s] after its first flush; raises AssertionError if a file is not what it should be."""
    with started(folder, frames) as child:
        assert child.stdout is not None
        lines = [child.stdout.readline()]
        time.sleep(delay)
        os.kill(child.pid, signal.SIGKILL)
        end = time.monotonic()
        lines += child.stdout.readlines()
    reported = [Report.of(line) for line in lines if line.endswith("\n")]
    flushed = {
        kind: max((one.steps for one in reported if (one.kind, one.what) == (kind, "flush")), default=0)
        for kind in KINDS
    }
    found = {kind: read_by_vtk(folder, kind, expected) for kind in KINDS if flushed[kind]}
    for kind, steps in found.items():
        assert steps >= flushed[kind], f"{kind}: {steps} steps of {flushed[kind]}"
    if all(flushed.values()):
        saved = read_run(folder / "killed")
        assert len(saved.time) == min(found.values())
        assert saved.case == expected.case
    lost = {kind: max((end - one.when for one in reported if one.is_lost(kind, found)), default=0.0) for kind in found}
    return Kill(flushed, found, lost)


def read_by_vtk(folder: Path, kind: str, expected: SavedRun) -> int:
    """How many steps VTK reads from a file; AssertionError unless each is that of the whole run."""
    path = next(p for p in (folder / f"killed.partial.{kind}.vtkhdf", folder / f"killed.{kind}.vtkhdf") if p.exists())
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    times = reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    np.testing.assert_array_equal(times, expected.time[: len(times)])
    steps = pyvista.get_reader(path)
    for k in range(len(times)):
        steps.reader.SetStep(k)
        data = steps.read()
        if kind == "plate":
            for name in expected.plate_fields:
                np.testing.assert_array_equal(data[name], expected.plate_field(name, k))
        else:
            np.testing.assert_array_equal(data.points, expected.position[k : k + 1])
            for name in ("velocity", "state", "normal_force", "friction_force"):
                np.testing.assert_array_equal(data[name], getattr(expected, name)[k : k + 1])
    return len(times)


def kills(count: int, frames: int, seed: int = 1) -> Iterator[Kill]:
    """Yield what so many kills leave, each at a random moment of writing."""
    chance = random.Random(seed)
    with tempfile.TemporaryDirectory() as folder:
        expected, duration = whole_run(Path(folder), frames)
        for _ in range(count):
            with tempfile.TemporaryDirectory() as own:
                yield killed(Path(own), frames, chance.uniform(0, 0.9 * duration), expected)


def main() -> None:
    parser = argparse.ArgumentParser(description="Kill runs while they write.")
    parser.add_argument("--count", type=int, default=10)
    parser.add_argument("--frames", type=int, default=20_000)
    given = parser.parse_args()
    for k, kill in enumerate(kills(given.count, given.frames), 1):
        told = ", ".join(f"{kind} {kill.found[kind]} steps read, {kill.lost[kind]:.2f} s lost" for kind in kill.found)
        print(f"kill {k}: {told}", flush=True)
        for kind, seconds in kill.lost.items():
            assert seconds <= LONGEST, f"{kind}: {seconds:.2f} s of steps are lost"


if __name__ == "__main__":
    main()
