"""A thousand paths of 20 ms over 25 actuators: paths a second, and how many times slower others are."""

from __future__ import annotations

import math
from dataclasses import replace
from statistics import median
from time import perf_counter

import numpy as np
from numpy.typing import NDArray
from report import short

from rivals import with_numba, with_scipy
from rivals.compare import COMPILED, OURS, REPEATS, SCIPY, processor_seconds
from rivals.problem import RADIUS, STARTS, ends, problem, surface_of

FloatArray = NDArray[np.float64]

PATHS, DURATION, TOLERANCE = 1000, 20e-3, 1e-6
SAMPLE = 5  # of the paths, by the others
ROUNDS = 3  # of all paths on one and on two threads
TRUTH, SCIPY_TOLERANCE, STEPS = 1e-10, 1e-7, 1_000_000
AGREEMENT = 1e-3  # of the radius, median over the sample


def table() -> list[str]:
    """Lines of a table; paths a second are printed only."""
    base = problem(25, STARTS[25], DURATION)
    surface = surface_of(base)
    rng = np.random.default_rng(1)
    r, angle = 0.7 * RADIUS * np.sqrt(rng.uniform(0, 1, PATHS)), rng.uniform(0, 2 * math.pi, PATHS)
    starts = np.column_stack([r * np.cos(angle), r * np.sin(angle)])
    problems = [replace(base, start=(x, y)) for x, y in starts[:SAMPLE].tolist()]
    rate, data = with_scipy.rate_of(base), (base.points, base.breakpoints, base.forces, base.friction.law)
    step = DURATION / STEPS
    methods = {
        OURS: lambda which: ends(base, surface, np.array([which.start]), TOLERANCE)[0],
        SCIPY: lambda which: with_scipy.trace(which, rate, SCIPY_TOLERANCE).place,
        COMPILED: lambda which: np.array(with_numba.fixed_steps(*which.start, *data, step, STEPS)),
    }
    truth = ends(base, surface, starts[:SAMPLE], TRUTH)
    lines = ["| method | median error over the radius | time of a path over ours |", "|---|---:|---:|"]
    times: dict[str, list[float]] = {name: [] for name in methods}
    for _ in range(REPEATS):
        for name, method in methods.items():
            times[name].append(processor_seconds(lambda run=method: [run(which) for which in problems]))
    for name, method in methods.items():
        places = np.array([method(which) for which in problems])
        error = float(np.median(np.hypot(*(places - truth).T))) / RADIUS
        assert error < AGREEMENT, f"{name} is {error:.1e} off"
        ratios = [time / own for time, own in zip(times[name], times[OURS], strict=True)]
        middle, least, most = map(short, (median(ratios), min(ratios), max(ratios)))
        lines.append(f"| {name} | {error:.0e} | {middle} ({least} - {most}) |")
    seconds: dict[int, list[float]] = {1: [], 2: []}
    places = {}
    for _ in range(ROUNDS):
        for threads, spent in seconds.items():
            start = perf_counter()
            places[threads] = ends(base, surface, starts, TOLERANCE, threads)
            spent.append(perf_counter() - start)
    assert np.array_equal(places[1], places[2]), "threads change the paths"
    for threads, spent in seconds.items():
        print(f"{PATHS} paths of {DURATION * 1e3:g} ms, {threads} threads: {PATHS / median(spent):.0f} paths a second")
    gains = [one / two for one, two in zip(seconds[1], seconds[2], strict=True)]
    lines.append(f"| {OURS}, all {PATHS}, on two threads | - | 1/{median(gains):.2f} of that on one |")
    return lines
