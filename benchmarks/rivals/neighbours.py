"""One evaluation of the surface by a sum over the actuators nearby, against one of ours.

Shapes fall off within a few pitches, so that a sum may leave out the far ones. Each shape is a polynomial on the cell
around the part, and logarithms close by. As many neighbours take part as make the
sum as good as our surface's stated error.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from statistics import median
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from report import short

from rivals import ours, with_numpy
from rivals.compare import REPEATS, seconds
from rivals.problem import OUT_TO, RADIUS, PathProblem, problem
from rivals.with_numba import compiled, quintics

FloatArray = NDArray[np.float64]

FEWEST = 25  # actuators: with fewer all are neighbours
DEGREE, NODES = 8, 14
NEAR, HALF = 3.0, 0.25  # pitches: how close logarithms are kept, half the width of the cell
PLACE, MOMENT = (0.3, 0.1), 0.4  # of the radius and of the duration: where and when
SAMPLES, ROUNDS, SPREAD = 200, 20, 1.2
AGREEMENT = 1e-3  # of the Hessian's largest value, between the two that are timed
MONOMIALS = np.array([(i, j) for i in range(DEGREE + 1) for j in range(DEGREE + 1 - i)])


class Neighbours(NamedTuple):
    """The shapes of n actuators on one cell."""

    smooth: FloatArray  # (M, n), coefficients in the distances from the centre over `half`
    strengths: FloatArray  # (J, n), of the logarithms, 1 / m^2 per m with r in m: f r^2 ln(r^2)
    sources: FloatArray  # (J, 2) m
    centre: FloatArray  # (2,) m
    half: float  # m


@compiled
def fill(u: float, half: float, out: FloatArray) -> None:
    """Powers of u with two derivatives in the length, into `out` (DEGREE + 1, 3)."""
    out[:] = 0.0
    out[0, 0] = 1.0
    for i in range(1, len(out)):
        out[i, 0] = u * out[i - 1, 0]
        out[i, 1] = i * out[i - 1, 0] / half
        out[i, 2] = i * out[i - 1, 1] / half


@compiled
def fields(x: float, y: float, heights: FloatArray, of: Neighbours, monomials: FloatArray, out: FloatArray) -> None:
    """w, w_t, w_tt, gradient, its rate, and second derivatives xx, xy, yy into `out` (10,); heights: (n, 3) m."""
    cell, force = of.smooth @ heights, of.strengths @ heights
    rows, columns = np.empty((DEGREE + 1, 3)), np.empty((DEGREE + 1, 3))
    fill((x - of.centre[0]) / of.half, of.half, rows)
    fill((y - of.centre[1]) / of.half, of.half, columns)
    out[:] = 0.0
    for m in range(len(monomials)):
        a, b = rows[monomials[m, 0]], columns[monomials[m, 1]]
        c, c_t, c_tt = cell[m]
        add(out, c, c_t, c_tt, a[0] * b[0], a[1] * b[0], a[0] * b[1], a[2] * b[0], a[1] * b[1], a[0] * b[2])
    for j in range(len(of.sources)):
        p, q = x - of.sources[j, 0], y - of.sources[j, 1]
        square = p * p + q * q
        logarithm = math.log(square)
        slope = 2 * (logarithm + 1)
        f, f_t, f_tt = force[j]
        bend_x, bend_xy, bend_y = slope + 4 * p * p / square, 4 * p * q / square, slope + 4 * q * q / square
        add(out, f, f_t, f_tt, square * logarithm, slope * p, slope * q, bend_x, bend_xy, bend_y)


@compiled
def add(
    out: FloatArray,
    f: float,
    f_t: float,
    f_tt: float,
    w: float,
    x: float,
    y: float,
    xx: float,
    xy: float,
    yy: float,
) -> None:
    """Adds a shape, with its derivatives, that is raised by f."""
    out[0] += f * w
    out[1] += f_t * w
    out[2] += f_tt * w
    out[3] += f * x
    out[4] += f * y
    out[5] += f_t * x
    out[6] += f_t * y
    out[7] += f * xx
    out[8] += f * xy
    out[9] += f * yy


@compiled
def repeat(
    xy: FloatArray, drives: FloatArray, since: float, of: Neighbours, monomials: FloatArray, rounds: int
) -> FloatArray:
    """The fields (k, 10) at points (k, 2) [m], `rounds` times over.

    drives: (n, 6), in powers of the time since the span began.
    """
    out, heights = np.empty((len(xy), 10)), np.empty((len(drives), 3))
    for _ in range(rounds):
        for n in range(len(xy)):
            quintics(drives, since, heights)
            fields(xy[n, 0], xy[n, 1], heights, of, monomials, out[n])
    return out


def neighbours(which: PathProblem, centre: FloatArray, pitch: float, nearest: NDArray[np.int64]) -> Neighbours:
    """The shapes of the actuators `nearest` (n,) as such a user would keep them."""
    half = HALF * pitch
    nodes = SPREAD * np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
    local = np.stack(np.meshgrid(nodes, nodes, indexing="ij"), axis=-1).reshape(-1, 2)
    xy = centre + half * local
    near = np.hypot(*(which.points - centre).T) < NEAR * pitch
    strengths = which.shapes.strengths[np.ix_(near, nearest)] / (16 * np.pi * RADIUS**2)
    square = ((xy[:, None] - which.points[near]) ** 2).sum(axis=-1)
    # Logarithms in m: what that adds to a shape is smooth.
    rest = with_numpy.shapes(xy, which).value @ which.shapes.strengths[:, nearest] - square * np.log(square) @ strengths
    matrix = local[:, None, 0] ** MONOMIALS[:, 0] * local[:, None, 1] ** MONOMIALS[:, 1]
    smooth = np.linalg.lstsq(matrix, rest, rcond=None)[0]
    return Neighbours(np.ascontiguousarray(smooth), np.ascontiguousarray(strengths), which.points[near], centre, half)


def row(count: int) -> str:
    """A line of the table: actuators, errors of w over the stroke, how many neighbours, time over ours."""
    which = problem(count, (0.0, 0.0))
    surface = ours.surface_of(which)
    pitch = OUT_TO * RADIUS * math.sqrt(math.pi / count)
    centre, time = RADIUS * np.array(PLACE), MOMENT * which.duration
    xy = centre + HALF * pitch * np.random.default_rng(1).uniform(-1, 1, (SAMPLES, 2))
    span = np.searchsorted(which.breakpoints[1:-1], time, side="right")
    since = time - which.breakpoints[span]
    exact = with_numpy.shapes(xy, which).value @ which.forces[span] @ with_numpy.powers(since)[:, 0]
    drives = np.linalg.solve(which.shapes.strengths, which.forces[span])

    def error(w: FloatArray) -> float:
        return float(np.abs(w - exact).max()) / which.stroke

    mine = ours.evaluations(surface, xy, time, 1)
    order = np.argsort(np.hypot(*(which.points - centre).T))
    for n in np.unique(np.append(np.arange(9, count, 4), count)).tolist():  # the first that is good enough, else all
        of, some = neighbours(which, centre, pitch, order[:n]), np.ascontiguousarray(drives[order[:n]])
        found = repeat(xy, some, since, of, MONOMIALS, 1)
        if error(found[:, 0]) <= surface.error:
            break
    apart = float(np.abs(found - mine)[:, 7:].max() / np.abs(mine[:, 7:]).max())
    assert apart < AGREEMENT, f"the sum over {n} neighbours and our surface differ by {apart:.1e}"
    ratios = []
    for _ in range(REPEATS):
        sum_time = seconds(partial(repeat, xy, some, since, of, MONOMIALS, ROUNDS))
        ratios.append(sum_time / seconds(partial(ours.evaluations, surface, xy, time, ROUNDS)))
    middle, least, most = map(short, (median(ratios), min(ratios), max(ratios)))
    errors = f"{surface.error:.0e} | {error(mine[:, 0]):.0e} | {error(found[:, 0]):.0e}"
    return f"| {count} | {errors} | {n} | {middle} ({least} - {most}) |"


def table(counts: Sequence[int]) -> list[str]:
    """Lines of a table."""
    lines = [
        "| actuators | our stated error | ours there | the sum there | neighbours | time of an evaluation over ours |",
        "|---:|---:|---:|---:|---:|---:|",
    ]
    return lines + [row(count) for count in counts]
