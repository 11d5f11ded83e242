"""One problem by every method: first they must agree, then they are timed in turns at equal errors of the end point.

Times are printed over ours, at each error, and how much work each method takes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from statistics import median
from time import process_time

import numpy as np
from numpy.typing import NDArray
from report import short

from rivals import with_numba, with_scipy
from rivals.problem import PathProblem, path_of, surface_of

FloatArray = NDArray[np.float64]

TARGETS = (1e-3, 1e-6, 1e-9)  # of the path's length
REPEATS = 5
TRUTH, TIGHTEST = 1e-13, 1e-11  # tolerances
OUR_TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)
SCIPY_TOLERANCES = (1e-3, 1e-4, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, TIGHTEST)
TRUTHS_AGREE = 5e-10  # of the path: ours on cells and scipy on exact sums, each at its tightest
MANY_ACTUATORS, MANY_AGREE = 5000, 5e-8  # of so many the sums agree less: they are compared to what this allows, once
STEPS_AGREE = 1e-9  # of the path: the same fixed steps by numba and by this project's scheme "fixed"
FEW, COARSE, FINE = 200, 20_000, 200_000  # steps: in which methods must agree, and from which the order is measured
ORDER = (0.9, 1.1)
MOST_TRIED, MORE = 2_000_000_000, 1.05  # steps times actuators, and the steps' growth where they do not do
MIN_TIME = 0.02  # s, of one measurement
TIMED = 20_000  # steps

OURS, SCIPY = "active-surface", "scipy"
COMPILED, FIXED = "numba, exact sum", 'our scheme "fixed"'

Steps = Callable[[int, float], FloatArray]  # so many steps of a length [s], to the place (2,) [m]


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
        self.surface = surface_of(problem)
        self.run, self.rate = path_of(problem, self.surface), with_scipy.rate_of(problem)
        truth = self.run(tolerance=TRUTH)
        self.end, self.length = truth.position[-1], float(np.hypot(*np.diff(truth.position, axis=0).T).sum())
        self.steppers, self.most = self._steppers(), MOST_TRIED // max(len(problem.points), 100)
        many = len(problem.points) >= MANY_ACTUATORS
        self.agreement, self.repeats = (MANY_AGREE, 1) if many else (TRUTHS_AGREE, REPEATS)
        self.targets = [target for target in TARGETS if target > self.agreement]
        self._agree()
        self.per_step = self._first_order()

    def off(self, place: FloatArray) -> float:
        """The distance from the true end, over the path's length."""
        return float(np.hypot(*(place - self.end))) / self.length

    def _steppers(self) -> dict[str, Steps]:
        """By method what makes fixed steps."""
        problem = self.problem

        def compiled(count: int, step: float) -> FloatArray:
            law, data = problem.friction.law, (problem.points, problem.breakpoints, problem.forces)
            return np.array(with_numba.fixed_steps(*problem.start, *data, law, step, count))

        def fixed(count: int, step: float) -> FloatArray:
            run = path_of(replace(problem, duration=count * step), self.surface)
            return run(scheme="fixed", time_step=step).position[-1]

        return {COMPILED: compiled, FIXED: fixed}

    def _agree(self) -> None:
        """Asserts that both truths and all fixed steps agree."""
        other = with_scipy.trace(self.problem, self.rate, TIGHTEST).place
        assert self.off(other) < self.agreement, f"{self.problem.name}: scipy ends {self.off(other):.1e} off"
        places = {name: steps(FEW, self.problem.duration / FEW) for name, steps in self.steppers.items()}
        for name, place in places.items():
            apart = float(np.hypot(*(place - places[COMPILED]))) / self.length
            same = apart < max(STEPS_AGREE, self.agreement)
            assert same, f"{self.problem.name}: {name} ends {apart:.1e} off the same steps by numba"

    def _first_order(self) -> float:
        """The error of fixed steps, times their number."""
        steps = self.steppers[COMPILED]
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
        theirs: dict[float, list[float]] = {target: [] for target in self.targets}
        step_times: dict[str, list[float]] = {name: [] for name in self.steppers}
        step = self.problem.duration / FINE
        for _ in range(self.repeats):
            for target, ((mine, _), (tolerance, _)) in chosen.items():
                own[target].append(seconds(partial(self.run, tolerance=mine)))
                trace = partial(with_scipy.trace, self.problem, self.rate, tolerance)
                theirs[target].append(seconds(trace))
            for name, steps in self.steppers.items():
                step_times[name].append(seconds(partial(steps, TIMED, step)) / TIMED)
        for target, ((_, mine), (_, asked)) in chosen.items():
            yield self._row(target, OURS, own[target], own[target], mine)
            yield self._row(target, SCIPY, theirs[target], own[target], asked)
            count = self._count(target)
            for name, times in step_times.items():
                yield self._row(target, name, [count * time for time in times], own[target], count)

    def _count(self, target: float) -> int:
        """How many fixed steps meet a target: tried out up to `most`, by their order above."""
        count, steps = int(np.ceil(self.per_step / target)), self.steppers[COMPILED]
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
        found = with_scipy.trace(self.problem, self.rate, tolerance)
        return self.off(found.place), found.evaluations


def ratios_table(rows: Sequence[Row]) -> list[str]:
    """Time over ours: a line for each error and method, a column for each problem."""
    return _table(rows, {name: name for name in (COMPILED, FIXED, SCIPY)}, "method", _ratio)


def work_table(rows: Sequence[Row]) -> list[str]:
    """Evaluations of the surface, and steps of fixed length."""
    labels = {OURS: "evaluations, ours", SCIPY: "evaluations, scipy", COMPILED: "fixed steps"}
    return _table(rows, labels, "work", lambda row: _count(row.work))


def _table(rows: Sequence[Row], labels: dict[str, str], head: str, cell: Callable[[Row], str]) -> list[str]:
    names = list(dict.fromkeys(row.problem for row in rows))
    lines = [f"| error | {head} | " + " | ".join(names) + " |", "|---|---|" + "---:|" * len(names)]
    for target in TARGETS:
        for method, label in labels.items():
            found = {row.problem: row for row in rows if (row.target, row.method) == (target, method)}
            if found:
                cells = [cell(found[name]) if name in found else "-" for name in names]
                lines.append(f"| {target:.0e} | {label} | " + " | ".join(cells) + " |")
    return lines


def _ratio(row: Row) -> str:
    middle, least, most = (short(value) for value in row.ratio)
    return f"{middle} ({least} - {most})" + " *" * row.extrapolated


def _count(number: int) -> str:
    return f"{number:,}".replace(",", " ") if number < 1_000_000 else f"{number:.1e}"
