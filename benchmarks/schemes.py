"""Scheme "fixed" against scheme "events" at equal error of the end point, and what scheme "paper" is off by.

    .venv/bin/python benchmarks/schemes.py

"events" takes the cheapest of six tolerances that meets the error, "fixed" the step that does by its order, checked.
Both are then timed in turns; a table is printed, with medians of five (least - most).
"""

from __future__ import annotations

from functools import partial
from statistics import median
from time import perf_counter

import numpy as np
from threadpoolctl import threadpool_limits

from coupling import surface_motion
from fem_plate import DiscShapes
from particle import ConstantFriction, Drive, KogutEtsion, Micropart, Trajectory, simulate

RADIUS, MASS, G = 300e-6, 2e-9, 9.80665
PAIR = [[75e-6, 10e-6], [-75e-6, 10e-6]]
STROKES = [Drive(150e-6, 300), Drive(90e-6, 450, delay=0.4e-3)]
CONSTANT = ConstantFriction(20.9 * MASS)
# Actuators, drives, start [m], friction, duration [s], gravity [m/s^2].
CASES = {
    "300 Hz": ([[0.0, 0.0]], [Drive(150e-6, 300, cycles=1)], (100e-6, 0.0), CONSTANT, 8e-3, 0.0),
    "450 Hz": ([[0.0, 0.0]], [Drive(150e-6, 450, cycle="up")], (100e-6, 0.0), CONSTANT, 8e-3, 0.0),
    "two": (PAIR, STROKES, (60e-6, -40e-6), CONSTANT, 3e-3, G),
    "two, rough": (PAIR, STROKES, (60e-6, -40e-6), KogutEtsion.paper(), 3e-3, G),
}
ERROR, REPEATS = 1e-6, 5  # over the radius
TOLERANCES = (1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 1e-8)
COARSE, FINE, PAPER = 0.5e-6, 1e-8, 2e-8  # s


def main() -> None:
    print("| | order of fixed | events, evaluations | fixed, evaluations | ratio | ratio in time | paper is off by |")
    print("|---|---:|---:|---:|---:|---:|---:|")
    with threadpool_limits(1):
        for name, (actuators, drives, start, friction, duration, gravity) in CASES.items():
            surface, part = surface_motion(DiscShapes(actuators, RADIUS), drives), Micropart(MASS, start)
            run = partial(simulate, surface, part, friction, duration, gravity)
            print(f"| {name} | {row(run)} |", flush=True)


def row(run: partial[Trajectory]) -> str:
    truth = run(tolerance=1e-13).position[-1]

    def off(path: Trajectory) -> float:
        return float(np.hypot(*(path.position[-1] - truth))) / RADIUS

    errors = [off(run(scheme="fixed", time_step=step)) for step in (COARSE, FINE)]
    order = np.log(errors[0] / errors[1]) / np.log(COARSE / FINE)
    step = FINE * 0.95 * ERROR / errors[1]
    fixed = partial(run, scheme="fixed", time_step=step)
    good = [run(tolerance=tolerance) for tolerance in TOLERANCES]
    cost, tolerance = min(
        (path.evaluations, tolerance) for path, tolerance in zip(good, TOLERANCES, strict=True) if off(path) <= ERROR
    )
    events, slow = partial(run, tolerance=tolerance), fixed()
    assert off(slow) <= ERROR, f"a step of {step:.2e} s misses {ERROR:.0e}: {off(slow):.2e}"
    times = [timed(fixed) / min(timed(events) for _ in range(20)) for _ in range(REPEATS)]
    paper = off(run(scheme="paper", time_step=PAPER))
    ratio = f"{median(times):.0f} ({min(times):.0f} - {max(times):.0f})"
    return f"{order:.3f} | {cost} | {slow.evaluations} | {slow.evaluations / cost:.0f} | {ratio} | {paper:.1e}"


def timed(work: partial[Trajectory]) -> float:
    start = perf_counter()
    work()
    return perf_counter() - start


if __name__ == "__main__":
    main()
