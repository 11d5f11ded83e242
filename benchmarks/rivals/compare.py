"""One problem by every method: first they must agree, then they are timed in turns at equal errors of the end point."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from importlib.util import find_spec
from statistics import median
from time import process_time

import contact
import numpy as np
from numpy.typing import NDArray

from particle import KogutEtsion
from rivals import ours, with_numba, with_numpy, with_scipy
from rivals.problem import PathProblem

FloatArray = NDArray[np.float64]

TARGETS = (1e-3, 1e-6, 1e-9)  # of the path's length
REPEATS = 5
PARTS = 1000
TRUTH, TIGHTEST = 1e-13, 1e-11  # tolerances
OUR_TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)
SCIPY_TOLERANCES = (1e-3, 1e-4, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, TIGHTEST)
TRUTHS_AGREE = 5e-10  # of the path: ours on cells and scipy on exact sums, each at its tightest
MANY_ACTUATORS, MANY_AGREE = 5000, 5e-8  # of so many the sums agree less: they are compared to what this allows, once
STEPS_AGREE = 1e-9  # of the path: the same fixed steps in numpy, numba, JAX and by this project's scheme "fixed"
FEW, COARSE, FINE = 200, 20_000, 200_000  # steps: in which methods must agree, and from which the order is measured
ORDER = (0.9, 1.1)
MOST_TRIED, MORE = 2_000_000_000, 1.05  # steps times actuators, and the steps' growth where they do not do
MIN_TIME = 0.02  # s, of one measurement

OURS = "active-surface"
LOOP, NUMPY_SCIPY, SCIPY = "Python loop", "scipy, numpy right side", "scipy, numba right side"
MANY, COMPILED, FIXED, JAX = "numpy, 1 000 parts", "numba, exact sum", 'our scheme "fixed"', "JAX, 1 000 parts"


Steps = Callable[[int, float], FloatArray]  # so many steps of a length [s], to the first part's place (2,) [m]


@dataclass(frozen=True)
class Row:
    """One method at one error. ratio: median, least, most of its time over ours.

    work: evaluations of the surface, or steps.  extrapolated: nobody took so many steps.
    """

    problem: str
    actuators: int
    target: float
    method: str
    ratio: tuple[float, float, float]
    work: int
    extrapolated: bool


def processor_seconds(run: Callable[[], object]) -> float:
    begin = process_time()
    run()
    return process_time() - begin


def seconds(run: Callable[[], object]) -> float:
    """The processor's, of one call, from as many as take MIN_TIME."""
    count, elapsed = 0, 0.0
    while elapsed < MIN_TIME:
        elapsed += processor_seconds(run)
        count += 1
    return elapsed / count


def cheapest(errors: dict[float, tuple[float, int]], target: float) -> tuple[float, int]:
    """The tolerance of least work among those that, with all tighter ones, meet a target; error and work of each."""
    good: list[tuple[int, float]] = []
    for tolerance in sorted(errors):
        error, work = errors[tolerance]
        if error > target:
            break
        good.append((work, tolerance))
    assert good, f"no tolerance reaches {target:.0e}: the tightest is off by {errors[min(errors)][0]:.1e}"
    work, tolerance = min(good)
    return tolerance, work


class Comparison:
    """One problem, prepared: surfaces and forces are made here and count for nobody."""

    def __init__(self, problem: PathProblem) -> None:
        self.problem = problem
        self.surface = ours.surface_of(problem)
        self.run = ours.path_of(problem, self.surface)
        self.rates = {NUMPY_SCIPY: with_scipy.rate_in_numpy(problem), SCIPY: with_scipy.rate_in_numba(problem)}
        truth = self.run(tolerance=TRUTH)
        self.end, self.length = truth.position[-1], float(np.hypot(*np.diff(truth.position, axis=0).T).sum())
        self.starts = np.array(problem.start) + np.zeros((PARTS, 1))
        self.rough = isinstance(problem.friction, KogutEtsion)
        self.steppers, self.most = self._steppers(), MOST_TRIED // max(len(problem.points), 100)
        many = len(problem.points) >= MANY_ACTUATORS
        self.agreement, self.repeats = (MANY_AGREE, 1) if many else (TRUTHS_AGREE, REPEATS)
        self.targets = [target for target in TARGETS if target > self.agreement]
        self._agree()
        self.per_step = self._first_order()

    def off(self, place: FloatArray) -> float:
        """The distance from the true end, over the path's length."""
        return float(np.hypot(*(place - self.end))) / self.length

    def _steppers(self) -> dict[str, tuple[Steps, int, int]]:
        """By method what makes fixed steps, how many of them to time, and how many parts it moves at once."""
        problem, limit = self.problem, self.problem.friction.friction_limit
        root = partial(contact.solve, problem.friction) if self.rough else limit

        def compiled(count: int, step: float) -> FloatArray:
            law, data = problem.friction.law, (problem.points, problem.breakpoints, problem.forces)
            return np.array(with_numba.fixed_steps(*problem.start, *data, law, step, count))

        def fixed(count: int, step: float) -> FloatArray:
            run = ours.path_of(replace(problem, duration=count * step), self.surface)
            return run(scheme="fixed", time_step=step).position[-1]

        march = partial(with_numpy.fixed_steps, problem)
        found: dict[str, tuple[Steps, int, int]] = {
            LOOP: (lambda count, step: march(self.starts[:1], root, step, count)[0], 100, 1),
            MANY: (lambda count, step: march(self.starts, limit, step, count)[0], 10, PARTS),
            COMPILED: (compiled, 20_000, 1),
            FIXED: (fixed, 20_000, 1),
        }
        if find_spec("jax") is not None and not self.rough:
            from rivals import with_jax

            by_jax = with_jax.new_fixed_steps(problem)
            found[JAX] = (lambda count, step: by_jax(self.starts, step, count)[0], 50, PARTS)
        return found

    def _agree(self) -> None:
        """Asserts that both truths and all fixed steps agree."""
        other = with_scipy.trace(self.problem, self.rates[SCIPY], TIGHTEST).place
        assert self.off(other) < self.agreement, f"{self.problem.name}: scipy ends {self.off(other):.1e} off"
        places = {name: steps(FEW, self.problem.duration / FEW) for name, (steps, _, _) in self.steppers.items()}
        for name, place in places.items():
            apart = float(np.hypot(*(place - places[COMPILED]))) / self.length
            same = apart < max(STEPS_AGREE, self.agreement)
            assert same, f"{self.problem.name}: {name} ends {apart:.1e} off the same steps by numba"

    def _first_order(self) -> float:
        """The error of fixed steps, times their number."""
        steps, _, _ = self.steppers[COMPILED]
        coarse, fine = (self.off(steps(count, self.problem.duration / count)) for count in (COARSE, FINE))
        order = np.log(coarse / fine) / np.log(FINE / COARSE)
        assert ORDER[0] < order < ORDER[1], f"{self.problem.name}: fixed steps are of order {order:.2f}"
        return fine * FINE

    def rows(self) -> Iterator[Row]:
        """All methods at all errors, timed in turns."""
        evaluations = {tolerance: self._ours(tolerance) for tolerance in OUR_TOLERANCES}
        traces = {tolerance: self._scipy(tolerance) for tolerance in SCIPY_TOLERANCES}
        chosen = {target: (cheapest(evaluations, target), cheapest(traces, target)) for target in self.targets}
        own: dict[float, list[float]] = {target: [] for target in self.targets}
        theirs: dict[tuple[str, float], list[float]] = {(name, t): [] for name in self.rates for t in self.targets}
        step_times: dict[str, list[float]] = {name: [] for name in self.steppers}
        short = self.problem.duration / FINE
        for _ in range(self.repeats):
            for target, ((mine, _), (tolerance, _)) in chosen.items():
                own[target].append(seconds(partial(self.run, tolerance=mine)))
                for name, rate in self.rates.items():
                    trace = partial(with_scipy.trace, self.problem, rate, tolerance)
                    theirs[name, target].append(seconds(trace))
            for name, (steps, count, parts) in self.steppers.items():
                step_times[name].append(seconds(partial(steps, count, short)) / count / parts)
        for target, ((_, mine), (_, asked)) in chosen.items():
            yield self._row(target, OURS, own[target], own[target], mine)
            for name in self.rates:
                yield self._row(target, name, theirs[name, target], own[target], asked)
            count = self._count(target)
            for name, times in step_times.items():
                yield self._row(target, name, [count * time for time in times], own[target], count)

    def _count(self, target: float) -> int:
        """How many fixed steps meet a target: tried out up to `most`, by their order above."""
        count, steps = int(np.ceil(self.per_step / target)), self.steppers[COMPILED][0]
        while count <= self.most and self.off(steps(count, self.problem.duration / count)) > target:
            count = int(np.ceil(MORE * count))
        return count

    def _row(self, target: float, method: str, times: list[float], own: list[float], work: int) -> Row:
        ratios = [time / base for time, base in zip(times, own, strict=True)]
        figures = median(ratios), min(ratios), max(ratios)
        beyond = method in self.steppers and work > self.most
        return Row(self.problem.name, len(self.problem.points), target, method, figures, work, beyond)

    def _ours(self, tolerance: float) -> tuple[float, int]:
        path = self.run(tolerance=tolerance)
        return self.off(path.position[-1]), path.evaluations

    def _scipy(self, tolerance: float) -> tuple[float, int]:
        found = with_scipy.trace(self.problem, self.rates[SCIPY], tolerance)
        return self.off(found.place), found.evaluations
