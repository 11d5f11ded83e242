"""What a mid-plane that moves in its plane costs, with 2 and 25 actuators.

    .venv/bin/python benchmarks/in_plane.py       writes a table for docs/benchmarks.md

Twenty motions in the plane, as corrections of large deflection would have: smooth ones, and ones with r^3 around the
actuators. First every surface must meet the sum of its shapes at the points that are then timed in turns.
"""

from __future__ import annotations

from statistics import median
from time import process_time
from typing import NamedTuple

import numpy as np
import report
from numpy.typing import NDArray
from rivals import ours

from coupling import surface_motion
from fem_plate import DiscShapes
from particle import ConstantFriction, Drive, Micropart, SurfaceMotion, simulate

FloatArray = NDArray[np.float64]

RADIUS, THICKNESS, COUNTS, MOTIONS = 1e-3, 100e-6, (2, 25), 20  # m, m
STROKE, STRAIN, FREQUENCY, MASS, LIMIT = 20e-6, 1e-3, 1.6e3, 2e-9, 2e-9  # m, -, Hz, kg, N
MOMENT, SAMPLES, ROUNDS, REPEATS, DURATION = 7e-4, 50, 10_000, 7, 20e-3  # s, s
AGREEMENT = 1e-6  # of a stroke


class Stretched(DiscShapes):
    """A clamped disc with motions in its plane that vanish at the rim; `sharpness` is the share of r^3 in them."""

    def __init__(self, points: FloatArray, sharpness: float) -> None:
        super().__init__(points, RADIUS)
        self.weights, self.sharpness = np.random.default_rng(1).uniform(-1, 1, (MOTIONS, 2, 6)), sharpness

    def in_plane_values(self, xy: FloatArray) -> FloatArray:
        x, y = (xy / RADIUS).T
        cubes = np.hypot(*(xy[:, None] - self.points[:2]).T / RADIUS).T ** 3
        terms = np.stack([1 + 0 * x, x, y, x * y, *(self.sharpness * cubes).T], axis=1)
        return np.einsum("nk,mck->nmc", (1 - x * x - y * y)[:, None] * terms, self.weights)

    def in_plane_heights(self) -> FloatArray:
        return np.ones(MOTIONS)


class Measured(NamedTuple):
    """A surface, and its times [s]: of an evaluation, and of a path over its evaluations."""

    name: str
    surface: SurfaceMotion
    alone: list[float]
    within: list[float]


def surfaces(count: int) -> list[Measured]:
    """Without motion in the plane, with a smooth one and with a sharp one."""
    rng = np.random.default_rng(0)
    r, angle = 0.7 * RADIUS * np.sqrt(rng.uniform(0, 1, count)), rng.uniform(0, 2 * np.pi, count)
    points = np.column_stack([r * np.cos(angle), r * np.sin(angle)])
    drives = [Drive(STROKE, FREQUENCY, delay=k % 6 / 6 / FREQUENCY) for k in range(count)]
    planar = [Drive(STRAIN * RADIUS / MOTIONS, FREQUENCY, delay=k % 6 / 6 / FREQUENCY) for k in range(MOTIONS)]
    found = [Measured("none", surface_motion(DiscShapes(points, RADIUS), drives, 1e-8, THICKNESS / 2), [], [])]
    for name, sharpness in (("smooth", 0.0), ("with r^3", 1.0)):
        shapes = Stretched(points, sharpness)
        surface = surface_motion(shapes, drives, 1e-8, THICKNESS / 2, planar)
        check(shapes, surface)
        found.append(Measured(name, surface, [], []))
    return found


def places() -> FloatArray:
    return np.random.default_rng(2).uniform(-0.2, 0.2, (SAMPLES, 2)) * RADIUS


def check(shapes: Stretched, surface: SurfaceMotion) -> None:
    """The motion in the plane is the sum of its shapes."""
    planar = [Drive(STRAIN * RADIUS / MOTIONS, FREQUENCY, delay=k % 6 / 6 / FREQUENCY) for k in range(MOTIONS)]
    heights = [float(drive.evaluate(MOMENT)[0]) for drive in planar]
    truth = np.einsum("nmc,m->nc", shapes.in_plane_values(places()), heights)
    wrong = np.abs(surface.evaluate(places(), MOMENT).u - truth).max() / (STRAIN * RADIUS)
    assert wrong < AGREEMENT, f"the motion in the plane is off by {wrong:.1e}"


def measure(one: Measured) -> int:
    """Adds to its times; the evaluations of the path."""
    begin = process_time()
    ours.evaluations(one.surface, places(), MOMENT, ROUNDS)
    one.alone.append((process_time() - begin) / (SAMPLES * ROUNDS))
    part = Micropart(MASS, (0.2 * RADIUS, 0.1 * RADIUS))
    begin = process_time()
    evaluations = simulate(one.surface, part, ConstantFriction(LIMIT), DURATION).evaluations
    one.within.append((process_time() - begin) / evaluations)
    return evaluations


def main() -> None:
    lines = [
        "| actuators | motion in the plane | degree | an evaluation | within a path | evaluations of the path |",
        "|---:|---|---:|---:|---:|---:|",
    ]
    for count in COUNTS:
        found = surfaces(count)
        evaluations = [[measure(one) for one in found] for _ in range(REPEATS + 1)][-1]
        for one, path in zip(found, evaluations, strict=True):
            alone, within = (
                median(a / b for a, b in zip(own[1:], plain[1:], strict=True))
                for own, plain in ((one.alone, found[0].alone), (one.within, found[0].within))
            )
            degree = one.surface.record.cells.plane_highest
            lines.append(f"| {count} | {one.name} | {degree or ''} | {alone:.2f} | {within:.2f} | {path} |")
    print("\n".join(lines))
    report.write("motion in the plane", lines)


if __name__ == "__main__":
    main()
