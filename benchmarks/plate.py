"""The plate against stock finite-element libraries: assembly, accuracy over time, large arrays.

    .venv/bin/python benchmarks/plate.py            compares with scikit-fem, and with NGSolve where it is installed
    .venv/bin/python benchmarks/plate.py --arrays   times large arrays instead (some minutes)

Every method must first agree with the exact answer within its own bound; then they are timed in turns. The tables are
printed, and written to `benchmarks/RESULTS.md` when none is missing.
"""

from __future__ import annotations

import argparse
from functools import partial
from importlib.util import find_spec
from statistics import median
from time import perf_counter

import arrays
import assembly
import numpy as np
import report
import with_scikit_fem
from problem import ACTUATORS, STROKES, W_SHARE, Run, Solution
from threadpoolctl import threadpool_limits

from fem_plate import Plate, PlateSection
from meshes import PlateMesh, disc

REPEATS = 5
POISSON_RATIO = 0.3
SECTION = PlateSection(youngs_modulus=12 * (1 - POISSON_RATIO**2), poisson_ratio=POISSON_RATIO, thickness=1.0)
# Cells from the centre to the rim, and the bound on the Hessian's error.
MESHES = [(2, 5e-2), (3, 1e-2), (4, 5e-3), (6, 1e-3), (8, 2e-4), (12, 3e-5), (16, 1e-5), (24, 3e-6)]
# The same with a tolerance, by which degrees are chosen, and that the estimate of a coarser solution must meet.
TOLERANCES = [(2, 1e-4, 8e-4), (3, 1e-6, 2e-5), (3, 1e-8, 5e-7), (4, 1e-8, 3e-8), (5, 1e-9, 2e-9)]
UNIT = 4  # the run that times are given in


def solve(mesh: PlateMesh, tolerance: float | None) -> Solution:
    """The problem by this project."""
    shapes = Plate(mesh, SECTION, "clamped", tolerance).influence(ACTUATORS)
    return Solution(shapes.unknowns, lambda xy: shapes.evaluate(xy, STROKES))


def own_runs() -> list[Run]:
    given = [(f"{report.OURS}, degree 5", cells, None, bound) for cells, bound in MESHES]
    given += [(f"{report.OURS}, to a tolerance", *row) for row in TOLERANCES]
    return [
        Run(name, partial(disc, 1.0, 1 / cells), partial(solve, tolerance=tolerance), bound)
        for name, cells, tolerance, bound in given
    ]


def timed(run: Run, mesh: object) -> tuple[float, Solution]:
    begin = perf_counter()
    solution = run.solve(mesh)
    return perf_counter() - begin, solution


def check(run: Run, mesh: object) -> Solution:
    """The answer of a run, which must be as good as the run claims."""
    solution = run.solve(mesh)
    w, gradient, hessian = solution.errors()
    right = hessian < run.bound and max(w, gradient) < W_SHARE * run.bound
    assert right, f"{run.method}, {solution.unknowns} unknowns: {w:.1e}, {gradient:.1e}, {hessian:.1e} > {run.bound}"
    return solution


def compare(runs: list[Run]) -> list[report.Figures]:
    """All runs checked, then timed in turns, each between two of the unit."""
    meshes = [run.mesh() for run in runs]
    solutions = [check(run, mesh) for run, mesh in zip(runs, meshes, strict=True)]
    ratios: list[list[float]] = [[] for _ in runs]
    for _ in range(REPEATS):
        before, _ = timed(runs[UNIT], meshes[UNIT])
        for run, mesh, found in zip(runs, meshes, ratios, strict=True):
            elapsed, _ = timed(run, mesh)
            after, _ = timed(runs[UNIT], meshes[UNIT])
            found.append(elapsed / np.sqrt(before * after))
            before = after
    return [
        report.Figures(run.method, solution.unknowns, solution.errors(), (median(found), min(found), max(found)))
        for run, solution, found in zip(runs, solutions, ratios, strict=True)
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--arrays", action="store_true", help="time large arrays instead")
    if parser.parse_args().arrays:
        blocks = {"arrays": arrays.table()}
    else:
        runs = own_runs() + with_scikit_fem.runs()
        if complete := find_spec("ngsolve") is not None:
            import with_ngsolve

            runs += with_ngsolve.runs()
        with threadpool_limits(1):  # of BLAS
            figures = compare(runs)
            blocks = {
                "targets": report.targets_table(figures),
                "runs": report.runs_table(figures),
                "assembly": assembly.table(),
            }
        if complete:
            report.draw(figures, figures[UNIT].unknowns)
        else:
            print("NGSolve is not installed: compared without it, and benchmarks/RESULTS.md left as it is.\n")
    for name, lines in blocks.items():
        print("\n".join(lines), end="\n\n")
        if name == "arrays" or complete:
            report.write(name, lines)


if __name__ == "__main__":
    main()
