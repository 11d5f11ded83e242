"""The cost of the moving surface by the number of actuators: square lattices, pitch 150 um, with one drive each.

    .venv/bin/python benchmarks/evaluation.py       writes a table for docs/benchmarks.md

All shapes are found on patches with the same truncation, so that the lattices differ in their size alone. First every
surface must meet the sum of its shapes at the points that are then timed in turns.
"""

from __future__ import annotations

from statistics import median
from time import process_time
from typing import NamedTuple

import numpy as np
import report
from arrays import PITCH, SECTION
from numpy.typing import NDArray
from rivals import ours
from threadpoolctl import threadpool_limits

from coupling import surface_motion
from fem_plate import Plate, Shapes
from meshes import rectangle
from particle import ConstantFriction, Drive, Micropart, SurfaceMotion, simulate

FloatArray = NDArray[np.float64]

SIDES = (10, 32, 100)
TRUNCATION = 1e-6
STROKE, FREQUENCY, STAGGER = 20e-6, 400.0, 0.13  # m, Hz, of a period from one column to the next
MASS, FRICTION = 2e-9, 2.0 * 2e-9
MOMENT, SAMPLES, ROUNDS, REPEATS = 7e-4, 100, 20_000, 7  # s
DURATION, TOLERANCE = 20e-3, 1e-6  # s
AGREEMENT = 1e-5  # of a stroke


class Lattice(NamedTuple):
    """One of the lattices, with its surface and the points (SAMPLES, 2) [m] in its middle that are timed."""

    count: int
    shapes: Shapes
    surface: SurfaceMotion
    xy: FloatArray


def lattice(side: int) -> Lattice:
    x, y = np.meshgrid(*(PITCH * (np.arange(side) - (side - 1) / 2),) * 2)
    points = np.column_stack([x.ravel(), y.ravel()])
    width = (side + 1) * PITCH
    shapes = Plate(rectangle(width, width, 6 * PITCH), SECTION, "clamped").influence(points, truncation=TRUNCATION)
    delays = np.tile(np.arange(side), side) * STAGGER / FREQUENCY % (1 / FREQUENCY)
    surface = surface_motion(shapes, [Drive(STROKE, FREQUENCY, delay=delay) for delay in delays.tolist()])
    xy = np.random.default_rng(0).uniform(-PITCH, PITCH, (SAMPLES, 2))
    return Lattice(side * side, shapes, surface, xy)


def check(one: Lattice) -> None:
    """The surface is the sum of its shapes."""
    rows, values = one.shapes.nonzero_values(one.xy)
    heights = one.surface.drives.delay[rows]
    stroke = np.array([Drive(STROKE, FREQUENCY, delay=delay).evaluate(MOMENT)[0] for delay in heights.tolist()])
    wrong = np.abs(ours.evaluations(one.surface, one.xy, MOMENT, 1)[:, 0] - values @ stroke).max() / STROKE
    assert wrong < AGREEMENT, f"{one.count} actuators: the surface is off by {wrong:.1e} of a stroke"


def evaluation(one: Lattice) -> float:
    """Seconds for one evaluation in a cell that is ready."""
    begin = process_time()
    ours.evaluations(one.surface, one.xy, MOMENT, ROUNDS)
    return (process_time() - begin) / (SAMPLES * ROUNDS)


def path(one: Lattice) -> tuple[float, int]:
    """Seconds for one evaluation of a path, everything else included, and how many there were."""
    part, law = Micropart(MASS, (0.3 * PITCH, 0.2 * PITCH)), ConstantFriction(FRICTION)
    begin = process_time()
    evaluations = simulate(one.surface, part, law, DURATION, tolerance=TOLERANCE).evaluations
    return (process_time() - begin) / evaluations, evaluations


def table() -> list[str]:
    lattices = [lattice(side) for side in SIDES]
    for one in lattices:
        check(one)
        path(one)  # builds its cells
    alone: list[list[float]] = [[] for _ in lattices]
    within: list[list[float]] = [[] for _ in lattices]
    for _ in range(REPEATS):
        for k, one in enumerate(lattices):
            alone[k].append(evaluation(one))
            within[k].append(path(one)[0])
    lines = [
        "| actuators | drives that count in a cell | logarithms there | an evaluation | within a path, all included "
        "| evaluations of the path |",
        "|---:|---:|---:|---:|---:|---:|",
    ]
    units = median(alone[0]), median(within[0])
    for k, one in enumerate(lattices):
        cells = one.surface.record.cells
        ratios = [
            f"{median(times) / unit:.2f} ({min(times) / unit:.2f} - {max(times) / unit:.2f})"
            for times, unit in zip((alone[k], within[k]), units, strict=True)
        ]
        lines.append(
            f"| {one.count} | {cells.most_drives} | {cells.most_near} | {ratios[0]} | {ratios[1]} | {path(one)[1]} |"
        )
    print([f"{1e9 * unit:.0f} ns" for unit in units])
    return lines


def main() -> None:
    with threadpool_limits(1):  # of BLAS
        lines = table()
    print("\n".join(lines))
    report.write("evaluation", lines)


if __name__ == "__main__":
    main()
