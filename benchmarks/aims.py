"""How near aims come to their targets, from random starts: the tables of docs/aim.md.

.venv/bin/python benchmarks/aims.py            prints a table for one actuator and one for nine
.venv/bin/python benchmarks/aims.py --robust   for nine, aimed as usual and at the 90 % quantile of disturbed runs
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from active_surface.steering import Aimed, Settings, Task
from active_surface.steering.aiming import aim_over
from coupling import Case, build_surface, read_case
from particle import SurfaceMotion

EXAMPLES = Path(__file__).parents[1] / "examples"
HORIZON = 50e-3  # s
COUNT, SEED = 10, 1
FARTHEST = 200e-6  # m, of a start from the one actuator
STARTS, TARGETS = 120e-6, 100e-6  # m, of both along x and y from the middle of nine, at most
ROBUST_COUNT = 4
HEADER = "| start | target | distance | paths | time | half within | 90 % within | all within | lost |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robust", action="store_true", help="robust aims instead")
    parser.add_argument("--seed", type=int, default=SEED, help=f"of the starts and targets [{SEED}]")
    asked = parser.parse_args()
    if asked.robust:
        case, surface = _prepared("array_3x3")
        tasks = list(_of_nine(asked.seed))[:ROBUST_COUNT]
        for quantile in (None, 0.9):
            _table(f"nine actuators, quantile {quantile}", case, surface, tasks, Settings(quantile=quantile))
        return
    for name, tasks in (("one_actuator", list(_of_one(asked.seed))), ("array_3x3", list(_of_nine(asked.seed)))):
        _table(name, *_prepared(name), tasks, Settings())


def _prepared(name: str) -> tuple[Case, SurfaceMotion]:
    case = read_case(EXAMPLES / f"{name}.toml")
    case = case.model_copy(update={"run": case.run.model_copy(update={"duration": HORIZON})})
    return case, build_surface(case)


def _of_one(seed: int) -> Iterator[tuple[tuple[float, float], tuple[float, float]]]:
    rng = np.random.default_rng(seed)
    for _ in range(COUNT):
        radius, angle = FARTHEST * np.sqrt(rng.random()), 2 * np.pi * rng.random()
        yield (float(radius * np.cos(angle)), float(radius * np.sin(angle))), (0.0, 0.0)


def _of_nine(seed: int) -> Iterator[tuple[tuple[float, float], tuple[float, float]]]:
    rng = np.random.default_rng(seed)
    for _ in range(COUNT):
        start, target = rng.uniform(-STARTS, STARTS, 2).tolist(), rng.uniform(-TARGETS, TARGETS, 2).tolist()
        yield (start[0], start[1]), (target[0], target[1])


def _table(name: str, case: Case, surface: SurfaceMotion, tasks: list, settings: Settings) -> None:
    print(f"{name}\n\n{HEADER}\n{'|---' * HEADER.count(' | ')}|---|", flush=True)
    for start, target in tasks:
        part = case.part.model_copy(update={"position": start})
        began = time.perf_counter()
        found = aim_over(surface, Task(case.model_copy(update={"part": part}), target, settings))
        print(_row(start, found, time.perf_counter() - began), flush=True)
    print()


def _row(start: tuple[float, float], found: Aimed, seconds: float) -> str:
    places = [f"({x * 1e6:.0f}, {y * 1e6:.0f})" for x, y in (start, found.task.target)]
    within = [found.scatter.quantile(share) for share in (0.5, 0.9, 1.0)]
    shares = [f"{distance * 1e6:.1f} um" if np.isfinite(distance) else "lost" for distance in within]
    lost = found.scatter.lost
    cells = [*places, f"{found.distance * 1e6:.3f} um", str(found.paths), f"{seconds:.1f} s", *shares, str(lost)]
    return f"| {' | '.join(cells)} |"


if __name__ == "__main__":
    main()
