"""How many evaluations of the surface a path takes: for each cycle of two drives, for each breakpoint of many.

.venv/bin/python benchmarks/cycles.py       writes tables for docs/benchmarks.md
"""

from __future__ import annotations

import math

import numpy as np
import report
from rivals import ours
from rivals.problem import MASS, RADIUS, STARTS, problem

from coupling import surface_motion
from fem_plate import DiscShapes
from particle import ConstantFriction, Drive, Micropart, simulate

FREQUENCY, LATER = 300.0, 5e-4  # Hz, s: two drives, one later than the other
APART = 300e-6  # m
CASES = ((30e-6, 5.0), (150e-6, 20.9))  # strokes [m], friction [m/s^2]
TOLERANCES = (1e-6, 1e-9)
STARTED, CYCLES, OUT_TO = 200, 3, 0.8


def per_cycle(stroke: float, friction: float, tolerance: float) -> np.ndarray:
    """Evaluations a cycle of paths from random starts that slip."""
    shapes = DiscShapes([[APART / 2, 0.0], [-APART / 2, 0.0]], RADIUS)
    surface = surface_motion(shapes, [Drive(stroke, FREQUENCY), Drive(stroke, FREQUENCY, delay=LATER)])
    rng, found = np.random.default_rng(1), []
    for _ in range(STARTED):
        r, angle = OUT_TO * RADIUS * math.sqrt(rng.uniform()), rng.uniform(0, 2 * math.pi)
        part = Micropart(MASS, (r * math.cos(angle), r * math.sin(angle)))
        path = simulate(surface, part, ConstantFriction(friction * MASS), CYCLES / FREQUENCY, tolerance=tolerance)
        if len(path.events) > 1:
            found.append(path.evaluations / CYCLES)
    return np.array(found)


def cycles_table() -> list[str]:
    lines = [
        "| strokes | friction over mass | tolerance | paths that slip | evaluations a cycle, median | 10 % - 90 % |",
        "|---:|---:|---:|---:|---:|---:|",
    ]
    for stroke, friction in CASES:
        for tolerance in TOLERANCES:
            found = per_cycle(stroke, friction, tolerance)
            low, high = np.percentile(found, [10, 90])
            lines.append(
                f"| {stroke * 1e6:g} um | {friction:g} m/s^2 | {tolerance:.0e} | {len(found)} | {np.median(found):.0f} "
                f"| {low:.0f} - {high:.0f} |"
            )
    return lines


def breakpoints_table() -> list[str]:
    lines = ["| actuators | breakpoints | tolerance | evaluations a breakpoint |", "|---:|---:|---:|---:|"]
    for count in (25, 100):
        one = problem(count, STARTS[count])
        surface, breakpoints = ours.surface_of(one), len(one.breakpoints) - 1
        for tolerance in TOLERANCES:
            path = ours.path_of(one, surface)(tolerance=tolerance)
            lines.append(f"| {count} | {breakpoints} | {tolerance:.0e} | {path.evaluations / breakpoints:.1f} |")
    return lines


def main() -> None:
    for block, lines in (("cycles", cycles_table()), ("breakpoints", breakpoints_table())):
        print("\n".join(lines), end="\n\n")
        report.write(block, lines)


if __name__ == "__main__":
    main()
