"""How often identified fields' 95 % intervals hold the true ones, and what a track costs: tracks made with noise.

`python benchmarks/identification.py [TRIES] [NUMBER ...]` prints the figures of docs/howto/identify.md, for all
problems or those with these numbers. Each try has its own noise and begins at other values than the true ones. With
--picture FILE it draws the first try of the plate, with --pictures FILE that of two tables.
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
FASTEST = 3  # runs of one path, of which the fastest counts


class Problem(NamedTuple):
    """Cases with what is to be found of them."""

    name: str
    truths: tuple[Case, ...]
    free: tuple[str, ...]
    noise: tuple[float, ...]  # m, of each track
    places: int
    loss: Any = "squares"
    outliers: float = 0.0
    own: tuple[str, ...] = ()

    @property
    def values(self) -> FloatArray:
        """The true values: shared ones, then track by track own ones."""
        own = [_value(truth, name) for truth in self.truths for name in self.own]
        return np.array([*(_value(self.truths[0], name) for name in self.free), *own])


def _value(case: Case, name: str) -> float:
    table, key = name.split(".")
    return float(getattr(getattr(case, table), key))


def conveyor(frequency: str, squeeze: str) -> Case:
    """A table that shakes along x, and along z too, so that friction and squeeze differ in what they do."""
    motion = {"frequency": frequency, "cycle": "sine"}
    return Case(
        plate={
            "shape": "platform",
            "motion": {"x": motion | {"stroke": "300 um"}, "z": motion | {"stroke": "80 um", "phase": "40 deg"}},
        },
        actuators=(),
        part={"mass": "2e-9 kg", "position": ("0 um", "0 um"), "squeeze": squeeze},
        friction={"model": "coulomb", "coefficient": 0.3},
        run={"duration": "15 ms"},
        name=f"table_{frequency.replace(' ', '')}",
    )


def problems() -> list[Problem]:
    squeezed = read_case(EXAMPLES / "shaker.toml").vary(
        {"friction": {"model": "coulomb", "coefficient": 0.8}, "part.squeeze": "30 nN"}
    )
    point = {"mass": "2e-9 kg", "centre_height": "45 um", "position": ["-120 um", "-80 um"]}
    changes = {"part": point, "friction.adhesion": "0.65 uN", "run.duration": "12 ms", "run.tolerance": 1e-9}
    plate = read_case(EXAMPLES / "transport.toml").vary(changes)
    short = plate.vary({"run.duration": "4 ms"})
    both, shaken = ("friction.coefficient", "friction.adhesion"), ((squeezed,), ("part.squeeze",), (1e-3,), 81)
    tables = conveyor("50 Hz", "5 nN"), conveyor("60 Hz", "10 nN")
    return [
        Problem("shaker", *shaken),
        Problem("shaker with outliers, absolute", *shaken, "absolute", OUTLIERS),
        Problem("shaker with outliers, squares", *shaken, "squares", OUTLIERS),
        Problem("plate for 4 ms", (short,), ("friction.adhesion",), (0.5e-6,), 41),
        Problem("plate", (plate,), both, (0.5e-6,), 61),
        Problem("two tables", tables, ("friction.coefficient",), (2e-6, 1e-6), 41, own=("part.squeeze",)),
    ]


def paths_of(problem: Problem) -> list[Trajectory]:
    """The true path of each track."""
    return [follow_part(truth, build_surface(truth), build_friction(truth)) for truth in problem.truths]


def attempt(problem: Problem, paths: Sequence[Trajectory], number: int) -> Identified:
    """What a try finds, from tracks along paths with noise of their own."""
    generator, begins, tracks = np.random.default_rng((number, 1)), [], []
    shared = 3 ** generator.uniform(-1, 1, len(problem.free))
    for truth, path, size in zip(problem.truths, paths, problem.noise, strict=True):
        times = np.linspace(0, truth.run.duration, problem.places)
        exact = path.at(times).position
        noise = size * generator.standard_normal(exact.shape)
        noise *= np.where(generator.random(exact.shape) < problem.outliers, FAR, 1.0)
        tracks.append(Track(times, exact + noise))
        factors = [*shared, *3 ** generator.uniform(-1, 1, len(problem.own))]
        names = (*problem.free, *problem.own)
        begins.append(truth.vary({name: _value(truth, name) * f for name, f in zip(names, factors, strict=True)}))
    return identify(begins, tracks, problem.free, own=problem.own, loss=problem.loss, seed=number, threads=1)


def one_path(problem: Problem) -> float:
    """The processor time of one path, a mean over tracks [s]."""
    total = 0.0
    for truth in problem.truths:
        surface, law, took = build_surface(truth), build_friction(truth), []
        follow_part(truth, surface, law)
        for _ in range(FASTEST):
            start = time.process_time()
            follow_part(truth, surface, law)
            took.append(time.process_time() - start)
        total += min(took)
    return total / len(problem.truths)


def measure(problem: Problem, tries: int) -> None:
    """Print for each field how many intervals hold the true value, and how near the values are."""
    values, paths, one = problem.values, paths_of(problem), one_path(problem)
    found, took = [], []
    for number in range(tries):
        start = time.process_time()
        found.append(attempt(problem, paths, number))
        took.append((time.process_time() - start) / one)
    low, high, value = (
        np.array([[getattr(field, end) for field in result.estimates] for result in found])
        for end in ("low", "high", "value")
    )
    held, followed = (low <= values) & (values <= high), np.median([result.paths for result in found])
    errors, widths = np.abs(value / values - 1), (high - low) / values
    print(f"{problem.name}: {tries} tries; one path takes {1e3 * one:.1f} ms of a processor")
    print(
        f"  a try takes {followed:.0f} paths, and the time of {np.median(took):.0f} (median), {max(took):.0f} at most"
    )
    for k, field in enumerate(found[0].estimates):
        error, width, missed = np.median(errors[:, k]), np.median(widths[:, k]), np.flatnonzero(~held[:, k])
        print(
            f"  {field.label}: {held[:, k].sum()} of {tries} hold it; median error {error:.2g}, "
            f"width {width:.2g} of it; missed in {missed.tolist()}"
        )
    sys.stdout.flush()


def draw(problem: Problem, file: str) -> None:
    """Draw the first try of a problem."""
    found = attempt(problem, paths_of(problem), 0)
    print(*found.lines(), *found.warnings(), sep="\n")
    found.plot().savefig(file, dpi=110)


def main(words: Sequence[str]) -> None:
    if words[:1] in (["--picture"], ["--pictures"]):
        draw(problems()[4 if words[0] == "--picture" else 5], words[1])
        return
    tries, *numbers = map(int, words or ["100"])
    for number, problem in enumerate(problems()):
        if not numbers or number in numbers:
            measure(problem, tries)


if __name__ == "__main__":
    main(sys.argv[1:])
