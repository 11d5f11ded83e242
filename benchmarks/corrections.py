"""The cost of a reduced von Karman plate over time, by the number of its drives, corrections and membrane forms.

    .venv/bin/python benchmarks/corrections.py       writes a table for docs/benchmarks.md

First the corrections must meet the equilibrium that numpy finds at random times, to the error that they state. The
models are random, with numbers that fall as those of real plates do. The unit is a path of 20 ms on a linear plate.
"""

from __future__ import annotations

from statistics import median
from time import process_time

import numpy as np
import report

from coupling import surface_motion
from coupling.stretch import Corrections, correction_drives
from fem_plate import DiscShapes
from fem_plate.large_deflection import ReducedPlate, reduced_equilibrium
from particle import AnyDrive, ConstantFriction, Drive, Micropart, simulate

SIZES = ((2, 14, 14), (2, 22, 20), (25, 24, 30))  # drives, corrections, membrane
MOTIONS = 8  # in the plane
DURATION, TOLERANCE = 20e-3, 1e-6  # s
STRETCH = 1.5  # how large the membrane's forms are: at unit strokes forces of the membrane are those of bending
MOMENTS, ROUNDS, REPEATS = 25, 9, 10
RADIUS, POINTS, START = 1e-3, [[300e-6, 100e-6], [-250e-6, -350e-6]], (300e-6, 200e-6)  # m


def reduced_plate(drives: int, corrections: int, membrane: int) -> ReducedPlate:
    """Random forms, smaller for later corrections and functions."""
    rng = np.random.default_rng(corrections)
    share = np.concatenate([np.full(drives, drives**-0.5), 1 / (1.0 + np.arange(corrections))])
    forms = rng.normal(size=(membrane + MOTIONS, drives + corrections, drives + corrections)) * share[:, None] * share
    forms = 0.5 * (forms + forms.swapaxes(1, 2))
    forms[:membrane] *= STRETCH / (membrane**0.5 * (1.0 + np.arange(membrane)[:, None, None]))
    return ReducedPlate(np.diag((1.0 + np.arange(corrections)) ** 2), forms[:membrane], in_plane=forms[membrane:])


def drives_of(count: int) -> list[AnyDrive]:
    """Strokes of two frequencies, all unlike."""
    return [Drive((-1) ** k * (1 - 0.3 * k / count), 300.0 + 100.0 * (k % 2)) for k in range(count)]


def check(plate: ReducedPlate, drives: list[AnyDrive], found: Corrections) -> None:
    """The corrections meet the equilibrium as well as they state."""
    largest = off = 0.0
    for time in np.random.default_rng(0).uniform(0, DURATION, MOMENTS):
        truth = reduced_equilibrium(plate, *np.array([drive.evaluate(time) for drive in drives]).T).corrections[0]
        values = np.array([drive.evaluate(time)[0] for drive in found.drives])
        largest, off = max(largest, np.abs(truth).max()), max(off, np.abs(values - truth).max())
    assert found.error <= TOLERANCE
    assert off < 2 * TOLERANCE * largest, f"{plate}: off by {off / largest:.1e} of the largest"


def linear_path() -> float:
    """Seconds for a path of that time over two actuators of a linear plate."""
    surface = surface_motion(DiscShapes(POINTS, RADIUS), [Drive(50e-6, 300.0), Drive(-30e-6, 400.0)])
    simulate(surface, Micropart(2e-9, START), ConstantFriction(4e-9), DURATION)  # builds the cells
    times = []
    for _ in range(ROUNDS):
        begin = process_time()
        for _ in range(REPEATS):
            simulate(surface, Micropart(2e-9, START), ConstantFriction(4e-9), DURATION)
        times.append((process_time() - begin) / REPEATS)
    return median(times)


def cost(plate: ReducedPlate, drives: list[AnyDrive]) -> float:
    """Seconds for the corrections of all that time."""
    times = []
    for _ in range(ROUNDS):
        begin = process_time()
        for _ in range(REPEATS):
            correction_drives(plate, drives, DURATION, TOLERANCE)
        times.append((process_time() - begin) / REPEATS)
    return median(times)


def main() -> None:
    unit = linear_path()
    lines = [
        "| drives, corrections, membrane | pieces of a period | equilibria | time over a linear path's |",
        "|---|---:|---:|---:|",
    ]
    for size in SIZES:
        plate, drives = reduced_plate(*size), drives_of(size[0])
        found = correction_drives(plate, drives, DURATION, TOLERANCE)
        check(plate, drives, found)
        seconds = cost(plate, drives)
        print(f"{size}: {1e6 * seconds / found.equilibria:.1f} us an equilibrium, {1e3 * seconds:.2f} ms in all")
        name = ", ".join(map(str, size))
        lines.append(f"| {name} | {found.pieces} | {found.equilibria} | {seconds / unit:.2f} |")
    print(f"linear path: {1e3 * unit:.2f} ms")
    print("\n".join(lines))
    report.write("corrections", lines)


if __name__ == "__main__":
    main()
