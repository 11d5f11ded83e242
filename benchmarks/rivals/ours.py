"""This project's side: the one place where the benchmarks of paths touch more than its public functions."""

from __future__ import annotations

from functools import partial
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from coupling import surface_motion
from particle import Drive, Micropart, SurfaceMotion, Trajectory, simulate, simulate_many
from particle.friction import friction_limit
from particle.surface.at_point import surface_at
from particle.surface.local import cell_at, new_local, within_cell
from particle.surface.span import enter
from rivals.problem import GRAVITY, MASS, PathProblem

__all__ = ["ends", "evaluations", "friction_limit", "path_of", "surface_of"]

FloatArray = NDArray[np.float64]

SURFACE_TOLERANCE = 1e-11  # of a unit stroke


def surface_of(problem: PathProblem) -> SurfaceMotion:
    drives = [
        Drive(problem.stroke, frequency, delay=delay)
        for frequency, delay in zip(problem.frequencies.tolist(), problem.delays.tolist(), strict=True)
    ]
    return surface_motion(problem.shapes, drives, SURFACE_TOLERANCE)


def path_of(problem: PathProblem, surface: SurfaceMotion) -> partial[Trajectory]:
    """What runs the problem: call it with `tolerance=...` or `scheme="fixed", time_step=...`."""
    part = Micropart(MASS, problem.start)
    return partial(simulate, surface, part, problem.friction, problem.duration, GRAVITY)


def ends(
    problem: PathProblem, surface: SurfaceMotion, starts: FloatArray, tolerance: float, threads: int = 1
) -> FloatArray:
    """The ends (n, 2) [m] of parts that begin at `starts` (n, 2) [m]."""
    parts = [Micropart(MASS, (x, y)) for x, y in starts.tolist()]
    run = {"gravity": GRAVITY, "tolerance": tolerance, "threads": threads}
    paths = simulate_many(surface, parts, problem.friction, problem.duration, **run)
    return np.array([path.position[-1] for path in paths])


def evaluations(surface: SurfaceMotion, xy: FloatArray, time: float, rounds: int) -> FloatArray:
    """w, w_t, w_tt, gradient, its rate, xx, xy, yy (n, 10) at points (n, 2) [m], `rounds` times over."""
    surface.evaluate(xy, time)  # so that all the cells are built
    record = surface.record
    # A part stays in a cell for many evaluations: those of each cell together.
    order = np.argsort([cell_at(record.cells, x, y) for x, y in xy.tolist()], kind="stable")
    out = np.empty((len(xy), 10))
    out[order] = _evaluations(record, new_local(record), np.ascontiguousarray(xy[order]), time, rounds)
    return out


@numba.njit(error_model="numpy", nogil=True)
def _evaluations(surface: Any, local: Any, xy: FloatArray, time: float, rounds: int) -> FloatArray:
    out = np.empty((len(xy), 10))
    for n in range(len(xy)):
        if n == 0 or not within_cell(local, xy[n, 0], xy[n, 1]):
            enter(surface, local, xy[n, 0], xy[n, 1], time, np.inf)
        for _ in range(rounds):
            f = surface_at(local, xy[n, 0], xy[n, 1], time)
            row = out[n]
            row[0], row[1], row[2], row[3], row[4] = f.w, f.w_t, f.w_tt, f.w_x, f.w_y
            row[5], row[6], row[7], row[8], row[9] = f.w_xt, f.w_yt, f.w_xx, f.w_xy, f.w_yy
    return out
