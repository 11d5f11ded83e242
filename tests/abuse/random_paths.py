"""A million random paths: does any hang, give no number, work without bound, lose energy, or depend on how it is run?

`python tests/abuse/random_paths.py --count 1000000` follows paths in blocks over one surface each: random plates (discs
in closed form, and rectangles, annuli, ellipses and polygons of finite elements), drives, parts, laws, tilts. Each
20th block is followed again by another number of threads and in other chunks, and must have the same bits. A block
follows from its number alone: `--first BLOCK --count 250` follows it again. `--oracle N` compares paths with the
reference integrator of the tests, which shares nothing with this one but the equations.
"""

from __future__ import annotations

import argparse
import hashlib
import math
import sys
from collections import Counter
from functools import cache
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from random_cases import CONTACTS, MASS, RADIUS, SURFACES, friction, is_finite, layout, start, velocity

from coupling import build_scene
from coupling.case import Case
from particle import AnyDrive, Drive, Micropart, SurfaceMotion, Trajectory, simulate, simulate_many
from particle.friction import Contact
from particle.surface import rim_gap

BLOCK = 250  # paths
AGAIN = 20  # blocks, of which one is followed again
TOLERANCE = 1e-9
FINER = 1e-13  # the finest there is
CELLS, FINER_CELLS = 1e-8, 1e-10  # the surface_tolerance, and that which tells whether a gap comes from it
SEEN = 1e-7  # m; a part that goes less counts as at rest
BALANCE = 1e-6  # of the energy that went through a path
PLATES: tuple[dict[str, Any], ...] = (
    {"shape": "rectangle", "width": 600e-6, "height": 400e-6},
    {"shape": "annulus", "inner_radius": 80e-6, "outer_radius": 300e-6},
    {"shape": "ellipse", "semi_axis_x": 300e-6, "semi_axis_y": 220e-6},
    {"shape": "polygon", "sides": 5, "radius": 300e-6},
    {"shape": "disc", "radius": 300e-6, "supports": "simply-supported"},
)


class Block(NamedTuple):
    """Paths over one surface."""

    surface: SurfaceMotion
    which: int  # the surface's number
    parts: list[Micropart]
    laws: list[Contact]
    drives: list[list[AnyDrive]]
    duration: float  # s
    gravity: tuple[float, float, float]  # m/s^2
    after: str
    contacts: list[str]

    def follow(self, threads: int, chunk: int = BLOCK) -> list[Trajectory]:
        """All paths, by so many threads, so many at once."""
        paths: list[Trajectory] = []
        for first in range(0, len(self.parts), chunk):
            some = slice(first, first + chunk)
            paths += simulate_many(
                self.surface, self.parts[some], self.laws[some], self.duration, self.gravity, TOLERANCE,
                self.after, self.drives[some], threads,
            )  # fmt: skip
        return paths


@cache
def surfaces(tolerance: float) -> tuple[SurfaceMotion, ...]:
    """Those in closed form, and plates of finite elements, whose cells meet the tolerance."""
    made = []
    for plate in PLATES:
        places = [(150e-6, 20e-6), (-140e-6, -60e-6), (10e-6, 130e-6)]
        material = {"youngs_modulus": 169e9, "poisson_ratio": 0.3, "thickness": 5e-6}
        case = Case(
            plate=material | plate,
            actuators=[{"position": place, "stroke": 5e-6, "frequency": 300.0} for place in places],
            part={"mass": MASS, "position": (-100e-6, 100e-6)},
            friction={"model": "constant", "limit": 4e-8},
            run={"duration": 1e-3, "surface_tolerance": tolerance},
        )
        made.append(build_scene(case).surface)
    return (*map(layout, range(SURFACES)), *made)


def block(number: int, seed: int) -> Block:
    """The block of a number."""
    rng = np.random.default_rng([13, seed, number])
    which = int(rng.integers(len(surfaces(CELLS))))
    surface = surfaces(CELLS)[which]
    duration = float(10 ** rng.uniform(-3.7, -2.2))
    tilt = rng.normal(0, 1, 2) * rng.choice([0.0, 0.5, 3.0])
    parts, laws, drives, contacts = [], [], [], []
    while len(parts) < BLOCK:
        place = start(rng, surface.sources)
        if not rim_gap(surface.record, *place) > 0:
            continue
        contacts.append(str(rng.choice(CONTACTS)))
        laws.append(friction(rng, contacts[-1]))
        squeeze = float(rng.choice([0.0, MASS * 10 ** rng.uniform(0, 3)], p=[0.8, 0.2]))
        parts.append(Micropart(MASS, place, velocity(rng), squeeze=squeeze))
        drives.append([_drive(rng) for _ in surface.sources])
    after = str(rng.choice(["stop", "fly"]))
    gravity = (*map(float, tilt), -9.80665)
    return Block(surface, which, parts, laws, drives, duration, gravity, after, contacts)


def _drive(rng: np.random.Generator) -> Drive:
    cycle = str(rng.choice(["up-down", "up", "sine", "cosine"], p=[0.6, 0.15, 0.15, 0.1]))
    stroke = float(rng.choice([-1, 1], p=[0.2, 0.8]) * 150e-6 * 10 ** rng.uniform(-2.5, 0))
    delay = float(rng.choice([0.0, rng.uniform(0, 2e-3)]))
    cycles = int(rng.integers(1, 6)) if cycle == "up-down" and rng.random() < 0.3 else None
    return Drive(stroke, float(10 ** rng.uniform(2, 3.3)), cycle, cycles, delay)


def digest(paths: list[Trajectory]) -> str:
    """What the bits of paths are known by."""
    bits = hashlib.sha256()
    for path in paths:
        for rows in (path.time, path.position, path.velocity, path.height, path.normal_force, path.state):
            bits.update(np.ascontiguousarray(rows).tobytes())
    return bits.hexdigest()


def wrong(one: Block, paths: list[Trajectory], closed: list[float]) -> list[tuple[int, str]]:
    """The paths, by their numbers in the block, that are not as they must be, and why.

    closed: gets the gap in the ledger of each that only closes at finer tolerances: of a part that hardly moves, or
    that crosses the borders of many cells.
    """
    found = []
    for k, path in enumerate(paths):
        if not is_finite(path):
            found.append((k, "not finite"))
        elif not path.energy.balance <= BALANCE:
            gaps = [path.energy.balance]
            for cells in (CELLS, FINER_CELLS):
                if not gaps[-1] <= BALANCE:
                    surface = surfaces(cells)[one.which]
                    finer = simulate(
                        surface.driven_by(one.drives[k]), one.parts[k], one.laws[k], one.duration, one.gravity, FINER,
                        after_detachment=one.after,
                    )  # fmt: skip
                    gaps.append(finer.energy.balance)
            if gaps[-1] <= BALANCE:
                closed.append(path.energy.balance)
            else:
                found.append(
                    (k, "energy off by {:.1e}, at a finer tolerance by {:.1e}, on finer cells by {:.1e}".format(*gaps))
                )
    return found


def against_oracle(count: int, seed: int) -> list[str]:
    """What paths on discs differ in from the reference integrator; lengths over the way of each."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "reference"))
    from motion_cases import breakpoints, limit_of, path_length
    from motion_oracle import trace
    from motion_problem import Problem
    from motion_surfaces import boggio, up_down

    from coupling import surface_motion
    from fem_plate import DiscShapes

    off, same, failed, moved = [], 0, 0, 0
    for number in range(count):
        rng = np.random.default_rng([17, seed, number])
        points = [RADIUS * rng.uniform(-0.5, 0.5, 2) for _ in range(1 + number % 2)]
        strokes = [
            (float(10 ** rng.uniform(-5, -3.9)), float(10 ** rng.uniform(2.3, 3)), float(rng.choice([0.0, 4e-4])))
            for _ in points
        ]
        part = Micropart(MASS, start(rng, np.array(points)), velocity(rng))
        law = friction(rng, str(rng.choice(["constant", "coulomb", "adhesive"])))
        duration = float(rng.uniform(5e-4, 2e-3))
        problem = Problem(
            boggio(points, RADIUS, [up_down(*stroke) for stroke in strokes]), MASS, limit_of(law),
            breakpoints(strokes, duration), pull_off=law.pull_off,
            gap=lambda x, y: RADIUS - math.hypot(x, y), stroke_time=0.5 / max(f for _, f, _ in strokes),
        )  # fmt: skip
        if math.hypot(*part.position) >= RADIUS:
            continue
        try:
            theirs = trace(problem, part.position, part.velocity, duration)
        except Exception as error:  # the reference is no program for all cases
            failed += 1
            print(f"oracle {number}: {type(error).__name__} {error}", flush=True)
            continue
        drives = [Drive(stroke, frequency, delay=delay) for stroke, frequency, delay in strokes]
        ours = simulate(surface_motion(DiscShapes(points, RADIUS), drives, 1e-11), part, law, duration, tolerance=1e-11)
        way = path_length(theirs, part.position) + 1e-9
        apart = float(np.hypot(*(ours.position[-1] - theirs.position))) / way
        off.append((apart, number, len(theirs.events)))
        moved += way > SEEN
        same += len(ours.events) == len(theirs.events)
    off.sort(reverse=True)
    quantiles = np.quantile([gap for gap, *_ in off], [0.5, 0.9, 0.99, 1.0])
    return [
        f"oracle           {len(off)} paths, {failed} more that it could not follow; {moved} paths move",
        f"                 as many events in {same}",
        "                 ends apart, over the way: median {:.1e}, 90 % {:.1e}, 99 % {:.1e}, largest {:.1e}".format(
            *quantiles
        ),
        *[f"    {gap:.1e}  number {number}, {events} events" for gap, number, events in off[:10]],
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description="Follow a million random paths.")
    parser.add_argument("--count", type=int, default=1_000_000)
    parser.add_argument("--seconds", type=float, default=math.inf)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="the first block")
    parser.add_argument("--oracle", type=int, default=0, help="paths to compare with the reference integrator")
    asked = parser.parse_args()
    surfaces(CELLS)
    begun, outcomes, total = perf_counter(), Counter[str](), hashlib.sha256()
    bad: list[str] = []
    closed: list[float] = []
    done = again = most = work = 0
    longest = 0.0
    for number in range(asked.first, asked.first + -(-asked.count // BLOCK)):
        if perf_counter() - begun > asked.seconds:
            break
        one, began = block(number, asked.seed), perf_counter()
        paths = one.follow(2)
        longest = max(longest, perf_counter() - began)
        done += len(paths)
        outcomes.update(path.outcome.value for path in paths)
        most = max(most, *(path.evaluations for path in paths))
        work += sum(path.evaluations for path in paths)
        for k, why in wrong(one, paths, closed):
            bad.append(f"block {number} path {k}, {one.contacts[k]}, {paths[k].outcome.value}: {why}")
            print(bad[-1], flush=True)
        bits = digest(paths)
        total.update(bits.encode())
        if done % (200 * BLOCK) == 0:
            print(f"{done} paths in {perf_counter() - begun:.0f} s, {len(bad)} wrong", file=sys.stderr, flush=True)
        if number % AGAIN == 0:
            again += 1
            for threads, chunk in ((1, BLOCK), (2, 7), (1, 61)):
                if digest(one.follow(threads, chunk)) != bits:
                    bad.append(f"block {number}: other bits by {threads} threads, {chunk} at once")
                    print(bad[-1], flush=True)
    print(f"paths            {done} in {perf_counter() - begun:.0f} s; the slowest block took {longest:.1f} s")
    print(f"outcomes         {dict(outcomes.most_common())}")
    print(f"evaluations      mean {work / max(done, 1):.0f}, most {most}")
    ways = "by 1 and 2 threads, 250, 61 and 7 paths at once"
    print(f"same bits        {again} blocks {ways}; all: {total.hexdigest()[:16]}")
    largest = f"at {TOLERANCE:g} the gap is up to {max(closed, default=0):.1e}"
    gaps = f", {len(closed)} of them at a tolerance of {FINER:g} or on finer cells only; {largest}"
    print(f"energy           closes to {BALANCE:g} in {done - len(bad)} paths{gaps}")
    print(f"wrong            {len(bad)}")
    for line in against_oracle(asked.oracle, asked.seed) if asked.oracle else ():
        print(line)
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
