"""The problem, and this project's answer: a clamped disc over actuators at the places of a sunflower's seeds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from coupling import surface_motion
from fem_plate import DiscShapes
from particle import (
    ConstantFriction,
    Drive,
    KogutEtsion,
    Micropart,
    SurfaceMotion,
    Trajectory,
    simulate,
    simulate_many,
)
from particle.friction import Contact

FloatArray = NDArray[np.float64]

RADIUS, MASS, GRAVITY = 300e-6, 2e-9, 9.80665
OUT_TO = 0.8  # of the radius, the outermost actuator
COUNTS, MOST = (1, 2, 9, 25, 100), 10_000  # actuators by default, and at most
FEWEST_IN_WAVES = 5000  # actuators: the forces of that many drives, each with its breakpoints, would not fit in memory
DELAYS, WAVE = 100, 0.06  # delays that differ in a wave; its stroke, over the radius
SURFACE_TOLERANCE = 1e-11  # of a unit stroke
QUINTIC = np.array([0.0, 0.0, 0.0, 10.0, -15.0, 6.0])  # a stroke from 0 to 1
CONSTANT = ConstantFriction(20.9 * MASS)


@dataclass(frozen=True)
class PathProblem:
    """One part on one plate: N actuators go up and down, each with its own frequency, from its own delay on."""

    name: str
    points: FloatArray  # (N, 2) m
    stroke: float  # m, of every actuator
    frequencies: FloatArray  # (N,) Hz
    delays: FloatArray  # (N,) s
    start: tuple[float, float]  # m
    duration: float  # s
    friction: Contact = field(default=CONSTANT)

    @cached_property
    def shapes(self) -> DiscShapes:
        """The plate's influence shapes in closed form (Boggio's function)."""
        return DiscShapes(self.points, RADIUS)

    @cached_property
    def breakpoints(self) -> FloatArray:
        """(S + 1,) s: 0, the times at which any stroke begins or ends, and the duration."""
        halves = 0.5 / self.frequencies
        most = math.ceil(self.duration / halves.min()) + 1
        times = (self.delays[:, None] + halves[:, None] * np.arange(most)).ravel()
        return np.unique(np.concatenate([[0.0], times[(times > 0) & (times < self.duration)], [self.duration]]))

    @cached_property
    def forces(self) -> FloatArray:
        """(S, N, 6): the actuators' forces over each span, as powers of the time since the span began.

        In units that leave the deflection in m: w = sum_j forces_j G(x / RADIUS, points_j / RADIUS).
        """
        begins, middles = self.breakpoints[:-1, None], 0.5 * (self.breakpoints[:-1] + self.breakpoints[1:])[:, None]
        rate = 2 * self.frequencies
        strokes = np.floor((middles - self.delays) * rate)
        place = (begins - self.delays) * rate - strokes
        pieces = np.zeros((*place.shape, 6))
        for k in range(6):
            for j in range(k, 6):
                pieces[..., k] += math.comb(j, k) * QUINTIC[j] * place ** (j - k)
            pieces[..., k] *= rate**k
        pieces[strokes % 2 == 1] *= -1
        pieces[..., 0] += strokes % 2
        pieces[strokes < 0] = 0.0
        return np.ascontiguousarray(self.shapes.strengths @ (self.stroke * pieces))


def sunflower(count: int) -> FloatArray:
    """(count, 2) m: seeds at the golden angle, as evenly as they grow."""
    k = np.arange(count)
    angle = math.pi * (3 - math.sqrt(5)) * k
    r = OUT_TO * RADIUS * np.sqrt((k + 0.5) / count)
    return np.column_stack([r * np.cos(angle), r * np.sin(angle)])


# Starts [m] whose ends are well conditioned: one moved by 1e-9 of the radius moves its end by at most four times that.
STARTS = {
    1: (143e-6, -46e-6),
    2: (-104e-6, 54e-6),
    9: (-161e-6, 103e-6),
    25: (-7e-6, 94e-6),
    100: (143e-6, -46e-6),
    1000: (90e-6, -47e-6),
    10_000: (73e-6, 49e-6),
}
ROUGH_START = (145e-6, -18e-6)
CYCLES = 3.0  # of the slowest drive


def problem(count: int, start: tuple[float, float], duration: float | None = None, rough: bool = False) -> PathProblem:
    """`count` actuators. Strokes shrink with the pitch; frequencies grow, so that the part is always about to slip.

    Very many have one frequency, and delays that grow along x: a wave.
    """
    rng = np.random.default_rng([5, count])
    points = sunflower(count)
    stroke = min(0.2, 0.28 / math.sqrt(count)) * RADIUS
    slowest = 400.0 * count**0.25
    frequencies, delays = rng.uniform(1.0, 1.5, count) * slowest, rng.uniform(0.0, 0.5 / slowest, count)
    if count >= FEWEST_IN_WAVES:
        stroke, frequencies = WAVE * RADIUS, np.full(count, slowest)
        delays = np.floor((points[:, 0] / RADIUS + 1) / 2 * DELAYS) / DELAYS * 2 / slowest
    return PathProblem(
        name=f"{count}, rough" if rough else str(count),
        points=points,
        stroke=stroke,
        frequencies=frequencies,
        delays=delays,
        start=start,
        duration=CYCLES / slowest if duration is None else duration,
        friction=KogutEtsion.paper() if rough else CONSTANT,
    )


def problems(counts: Sequence[int]) -> list[PathProblem]:
    """With constant friction for each count of actuators, and with rough contact where 25 are among them."""
    found = [problem(count, STARTS.get(count, STARTS[100])) for count in counts]
    return found + [problem(25, ROUGH_START, rough=True)] * (25 in counts)


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
