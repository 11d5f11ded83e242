"""Fixed steps in numpy for any number of parts at once, over the exact sum of all actuators.

With one part and a root search for the contact this is the paper's way; with many it is how numpy is best used. The
step is Moreau's, of first order: friction's impulse brings the part to rest when it can, else it opposes the motion.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rivals.problem import GRAVITY, MASS, RADIUS, PathProblem

FloatArray = NDArray[np.float64]
SCALE = 1 / (16 * np.pi)
Limit = Callable[[FloatArray], FloatArray]  # friction limits [N] under net loads [N]


class Plate(NamedTuple):
    """The plate at points (n, 2) and one time; w_tt, gradient and its rate, second derivatives."""

    w_tt: FloatArray  # (n,) m/s^2
    gradient: FloatArray  # (n, 2)
    gradient_t: FloatArray  # (n, 2) 1/s
    hessian: FloatArray  # (n, 2, 2) 1/m


class Shapes(NamedTuple):
    """Boggio's function, 16 pi G = R ln(R/S) + S - R, of n points and N actuators, and what its Hessian needs."""

    value: FloatArray  # (n, N)
    gradient: FloatArray  # (n, N, 2) 1/m
    offset: FloatArray  # (n, N, 2), half the gradient of R
    image: FloatArray  # (n, N, 2), half the gradient of S
    big_r: FloatArray  # (n, N)
    big_s: FloatArray
    level: FloatArray  # (n, N), the part of the Hessian on its diagonal, over 2


def powers(since: float) -> FloatArray:
    """(6, 3): what the coefficients of a quintic give at a time, and with one and two derivatives."""
    k = np.arange(6)
    first, second = np.maximum(k - 1, 0), np.maximum(k - 2, 0)
    return np.column_stack([since**k, k * since**first, k * (k - 1) * since**second])


def shapes(xy: FloatArray, problem: PathProblem) -> Shapes:
    """Boggio's function of each actuator at points (n, 2) [m], without its second derivatives."""
    x, sources = xy / RADIUS, problem.points / RADIUS
    square = (sources**2).sum(axis=1)
    offset = x[:, None] - sources
    image = x[:, None] * square[:, None] - sources
    big_r = (offset**2).sum(axis=2)
    big_s = (x**2).sum(axis=1)[:, None] * square - 2 * x @ sources.T + 1
    ratio = big_r / big_s
    by_r = np.log(ratio)
    value = big_r * by_r + big_s - big_r
    gradient = 2 / RADIUS * (by_r[..., None] * offset + (1 - ratio)[..., None] * image)
    return Shapes(SCALE * value, SCALE * gradient, offset, image, big_r, big_s, by_r + square * (1 - ratio))


def plate(xy: FloatArray, time: float, problem: PathProblem) -> Plate:
    """The sum over all actuators at points (n, 2) [m] and one time [s]."""
    span = np.searchsorted(problem.breakpoints[1:-1], time, side="right")
    forces = problem.forces[span] @ powers(time - problem.breakpoints[span])
    f = shapes(xy, problem)
    slopes = np.einsum("pni,nk->pki", f.gradient, forces[:, :2])
    force = 4 * SCALE / RADIUS**2 * forces[:, 0]
    cross = np.einsum("pn,pni,pnj->pij", -force / f.big_s, f.offset, f.image)
    hessian = np.einsum("pn,pni,pnj->pij", force / f.big_r, f.offset, f.offset)
    hessian += cross + np.swapaxes(cross, 1, 2)
    hessian += np.einsum("pn,pni,pnj->pij", force * f.big_r / f.big_s**2, f.image, f.image)
    hessian += (0.5 * f.level @ force)[:, None, None] * np.eye(2)
    return Plate(f.value @ forces[:, 2], slopes[:, 0], slopes[:, 1], hessian)


def pull(f: Plate, v: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Acceleration without friction (n, 2) [m/s^2] and net load (n,) [N] at velocities (n, 2) [m/s]."""
    b = GRAVITY + f.w_tt + 2 * (v * f.gradient_t).sum(axis=1) + np.einsum("pi,pij,pj->p", v, f.hessian, v)
    square = 1 + (f.gradient**2).sum(axis=1)
    return -(b / square)[:, None] * f.gradient, MASS * b / np.sqrt(square)


def length(f: Plate, v: FloatArray) -> FloatArray:
    """Lengths (n,) along the surface of vectors (n, 2)."""
    return np.sqrt((v**2).sum(axis=1) + (v * f.gradient).sum(axis=1) ** 2)


def fixed_steps(problem: PathProblem, starts: FloatArray, limit: Limit, step: float, count: int) -> FloatArray:
    """Places (n, 2) [m] of parts that start from rest, after so many steps [s]."""
    xy, v = starts.copy(), np.zeros_like(starts)
    for k in range(count):
        xy += 0.5 * step * v
        f = plate(xy, (k + 0.5) * step, problem)
        acceleration, load = pull(f, v)
        free = v + step * acceleration
        speed, most = length(f, free), step * limit(load) / MASS
        kept = np.where(speed > most, 1 - most / np.where(speed > 0, speed, 1.0), 0.0)
        v = kept[:, None] * free
        xy += 0.5 * step * v
    return xy
