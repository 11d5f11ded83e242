"""Shapes of square lattices of actuators, pitch 150 um, on a clamped rectangle one pitch larger on every side.

`python benchmarks/arrays.py ROWS COLUMNS` solves one of them and prints its figures; `table` runs each in a process of
its own, so that the memory is its own too.
"""

from __future__ import annotations

import resource
import subprocess
import sys
from time import process_time

import numpy as np
from threadpoolctl import threadpool_limits

from fem_plate import Plate, PlateSection
from meshes import rectangle

PITCH = 150e-6
LATTICES = ((3, 3), (10, 10), (25, 40), (100, 100))
SECTION = PlateSection(youngs_modulus=169e9, poisson_ratio=0.3, thickness=5e-6)
HELD = 1e-4  # of the largest stroke: how well the shapes must hold the actuators' strokes


def solve(rows: int, columns: int) -> tuple[float, float, float, float]:
    """Processor seconds, peak memory (bytes), truncation error (0: nothing left out), how far strokes are missed."""
    height, width = (rows + 1) * PITCH, (columns + 1) * PITCH
    x, y = np.meshgrid(*(PITCH * (np.arange(n) - (n - 1) / 2) for n in (columns, rows)))
    points = np.column_stack([x.ravel(), y.ravel()])
    mesh = rectangle(width, height, max(width, height) / 16)
    begin = process_time()
    shapes = Plate(mesh, SECTION, "clamped").influence(points)
    elapsed = process_time() - begin
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    strokes = np.random.default_rng(1).uniform(-1, 1, len(points))
    with np.errstate(invalid="ignore"):  # at an actuator the Hessian is infinite
        held, _, _ = shapes.evaluate(points, strokes)
    missed = float(np.abs(held - strokes).max())
    assert missed < HELD, f"the shapes miss the strokes by {missed:.1e}"
    return elapsed, memory, shapes.truncation_error, missed


def table() -> list[str]:
    """Lines of a table, and a sentence with the exponent of time in the number of actuators."""
    found = []
    for lattice in LATTICES:
        command = [sys.executable, __file__, *map(str, lattice)]
        answer = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
        found.append([float(word) for word in answer.stdout.split()])
    lines = [
        "| actuators | time over that of 9 | peak memory | left out of a shape, at most | strokes met to |",
        "|---:|---:|---:|---:|---:|",
    ]
    counts = [rows * columns for rows, columns in LATTICES]
    for count, (elapsed, memory, truncation, missed) in zip(counts, found, strict=True):
        left_out = f"{truncation:.1e}" if truncation else "nothing"
        lines.append(
            f"| {count} | {elapsed / found[0][0]:.3g} | {memory / 2**30:.1f} GiB | {left_out} | {missed:.0e} |"
        )
    times = [elapsed for elapsed, *_ in found]
    whole, last = (np.polyfit(np.log(counts[k:]), np.log(times[k:]), 1)[0] for k in (0, -2))
    return [*lines, "", f"Time grows as N^{whole:.2f} over the whole range, and as N^{last:.2f} from the last but one."]


if __name__ == "__main__":
    with threadpool_limits(1):  # of BLAS
        print(*solve(*map(int, sys.argv[1:])))
