"""How often identified fields' 95 % intervals hold the true ones, and what a track costs: tracks made with noise.

`python benchmarks/identification.py [TRIES]` prints the table of docs/howto/identify.md. Each try has its own noise and
begins at other values of the fields than the true ones. With --picture FILE it draws the first try of the plate.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from active_surface import Identified, Track, Trajectory, build_surface, identify, read_case
from coupling import build_friction, follow_part
from coupling.case import Case

FloatArray = NDArray[np.float64]

EXAMPLES = Path(__file__).parents[1] / "examples"
OUTLIERS = 0.1  # of the places
FAR = 20.0  # times the noise


class Problem(NamedTuple):
    """A case with what is to be found of it."""

    name: str
    truth: Case
    free: tuple[str, ...]
    noise: float  # m
    places: int
    loss: Any = "squares"
    outliers: float = 0.0


def problems() -> list[Problem]:
    squeezed = read_case(EXAMPLES / "shaker.toml").vary(
        {"friction": {"model": "coulomb", "coefficient": 0.8}, "part.squeeze": "30 nN"}
    )
    plate = read_case(EXAMPLES / "transport.toml").vary({"run.duration": "12 ms"})
    short = plate.vary({"run.duration": "4 ms"})
    both = ("friction.coefficient", "friction.adhesion")
    return [
        Problem("shaker, squeeze", squeezed, ("part.squeeze",), 1e-3, 81),
        Problem("plate, coefficient and adhesion", plate, both, 0.5e-6, 61),
        Problem("plate for 4 ms, adhesion", short, ("friction.adhesion",), 0.5e-6, 41),
        Problem("shaker with outliers, squeeze, absolute", squeezed, ("part.squeeze",), 1e-3, 81, "absolute", OUTLIERS),
        Problem("shaker with outliers, squeeze, squares", squeezed, ("part.squeeze",), 1e-3, 81, "squares", OUTLIERS),
    ]


def attempt(problem: Problem, path: Trajectory, number: int) -> Identified:
    """What a try finds, from a track along a path with noise of its own."""
    truth, generator = problem.truth, np.random.default_rng((number, 1))
    times = np.linspace(0, truth.run.duration, problem.places)
    exact = path.at(times).position
    noise = problem.noise * generator.standard_normal(exact.shape)
    noise *= np.where(generator.random(exact.shape) < problem.outliers, FAR, 1.0)
    starts = values_of(problem) * 3 ** generator.uniform(-1, 1, len(problem.free))
    begin = truth.vary(dict(zip(problem.free, starts, strict=True)))
    return identify(begin, Track(times, exact + noise), problem.free, loss=problem.loss, seed=number, threads=1)


def values_of(problem: Problem) -> FloatArray:
    """The true values of the free fields."""
    keys = (name.split(".") for name in problem.free)
    return np.array([getattr(getattr(problem.truth, table), key) for table, key in keys])


def measure(problem: Problem, tries: int) -> None:
    """Print for each field how many intervals hold the true value, and how near the values are."""
    truth, values = problem.truth, values_of(problem)
    surface, law = build_surface(truth), build_friction(truth)
    path = follow_part(truth, surface, law)
    start = time.process_time()
    follow_part(truth, surface, law)
    one = time.process_time() - start
    found, took = [], []
    for number in range(tries):
        start = time.process_time()
        found.append(attempt(problem, path, number))
        took.append((time.process_time() - start) / one)
    low, high, value = (
        np.array([[getattr(field, end) for field in result.estimates] for result in found])
        for end in ("low", "high", "value")
    )
    held, paths = (low <= values) & (values <= high), np.median([result.paths for result in found])
    errors, widths = np.abs(value / values - 1), (high - low) / values
    print(f"{problem.name}: {tries} tries; one path takes {1e3 * one:.1f} ms of a processor")
    print(f"  a track takes {paths:.0f} paths, and the time of {np.median(took):.0f} (median), {max(took):.0f} at most")
    for k, field in enumerate(problem.free):
        error, width = np.median(errors[:, k]), np.median(widths[:, k])
        print(f"  {field}: {held[:, k].sum()} of {tries} hold it; median error {error:.2g}, width {width:.2g} of it")
    sys.stdout.flush()


def draw(file: str) -> None:
    """Draw the first try of the plate."""
    problem = problems()[1]
    path = follow_part(problem.truth, build_surface(problem.truth), build_friction(problem.truth))
    found = attempt(problem, path, 0)
    print(*found.lines(), *found.warnings(), sep="\n")
    found.plot().savefig(file, dpi=110)


def main(words: Sequence[str]) -> None:
    if words[:1] == ["--picture"]:
        draw(words[1])
        return
    tries = int(words[0]) if words else 20
    for problem in problems():
        measure(problem, tries)


if __name__ == "__main__":
    main(sys.argv[1:])
