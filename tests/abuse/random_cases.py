"""Random cases of every contact, start and drive: their ends against those of runs a hundred times tighter.

`python tests/abuse/random_cases.py --count 10000` prints work, ledgers and how far ends are apart. A case follows from
its seed alone: `--first SEED --count 1` runs one again.
"""

from __future__ import annotations

import argparse
import math
from collections import Counter
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from coupling import surface_motion
from fem_plate import DiscShapes
from particle import (
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    KogutEtsion,
    Micropart,
    SurfaceMotion,
    Trajectory,
    simulate,
)
from particle.friction import Contact

FloatArray = NDArray[np.float64]

RADIUS, MASS = 300e-6, 2e-9
SURFACES = 30
TOLERANCE = 1e-9
BALANCE = 1e-6  # goal for every case's energy ledger
AGREES = 1e-6  # of the radius, between ends at TOLERANCE and at a hundredth of it
NUDGE = 1e-12  # of the radius, by which a start is moved
CONTACTS = ("constant", "coulomb", "adhesive", "rough")


@dataclass(frozen=True)
class RandomCase:
    """What one seed stands for."""

    seed: int
    surface: SurfaceMotion
    part: Micropart
    contact: str
    friction: Contact
    duration: float  # s
    flies: bool

    def run(self, tolerance: float = TOLERANCE) -> Trajectory:
        after = "fly" if self.flies else "stop"
        return simulate(
            self.surface, self.part, self.friction, self.duration, tolerance=tolerance, after_detachment=after
        )


@cache
def layout(number: int) -> SurfaceMotion:
    """A surface of 1 to 4 actuators on the clamped disc in closed form; the drives are yet to come."""
    rng, count = np.random.default_rng([7, number]), 1 + number % 4
    points: list[FloatArray] = []
    while len(points) < count:
        at = RADIUS * rng.uniform(-0.75, 0.75, 2)
        if np.hypot(*at) < 0.75 * RADIUS and all(np.hypot(*(at - p)) > 0.2 * RADIUS for p in points):
            points.append(at)
    return surface_motion(DiscShapes(points, RADIUS), [Drive(0.0, 300.0)] * count, 1e-10)


def chance(seed: int) -> tuple[np.random.Generator, int]:
    """What a case is drawn from, and the number of its layout."""
    rng = np.random.default_rng([11, seed])
    return rng, int(rng.integers(SURFACES))


@cache
def rough() -> KogutEtsion:
    return KogutEtsion.paper()


def random_case(seed: int) -> RandomCase:
    """The case of a seed: near an actuator, near the rim or anywhere; from without friction to glued."""
    rng, number = chance(seed)
    plain = layout(number)
    drives = []
    for _ in plain.sources:
        cycle = "up" if rng.random() < 0.2 else "up-down"
        cycles = int(rng.integers(1, 6)) if cycle == "up-down" and rng.random() < 0.3 else None
        stroke = rng.choice([-1, 1], p=[0.2, 0.8]) * 150e-6 * 10 ** rng.uniform(-1.5, 0)
        delay = rng.choice([0.0, rng.uniform(0, 2e-3)])
        drives.append(Drive(float(stroke), rng.uniform(100, 800), cycle, cycles, float(delay)))
    duration = rng.uniform(5e-3, 20e-3)
    part = Micropart(MASS, start(rng, plain.sources), velocity(rng))
    contact = str(rng.choice(CONTACTS))
    law = friction(rng, contact)
    return RandomCase(seed, plain.driven_by(drives), part, contact, law, duration, bool(rng.random() < 0.5))


def start(rng: np.random.Generator, sources: FloatArray) -> tuple[float, float]:
    place = rng.choice(["actuator", "rim", "anywhere"])
    angle = rng.uniform(0, 2 * math.pi)
    if place == "actuator":
        r, (x, y) = RADIUS * 10 ** rng.uniform(-4, -1), sources[rng.integers(len(sources))]
    elif place == "rim":
        r, x, y = RADIUS * (1 - 10 ** rng.uniform(-4, -1)), 0.0, 0.0
    else:
        r, x, y = 0.9 * RADIUS * math.sqrt(rng.random()), 0.0, 0.0
    return float(x + r * math.cos(angle)), float(y + r * math.sin(angle))


def velocity(rng: np.random.Generator) -> tuple[float, float]:
    speed = rng.choice([0.0, 10 ** rng.uniform(-4, -0.5)], p=[0.7, 0.3])
    angle = rng.uniform(0, 2 * math.pi)
    return float(speed * math.cos(angle)), float(speed * math.sin(angle))


def friction(rng: np.random.Generator, contact: str) -> Contact:
    if contact == "constant":
        return ConstantFriction(MASS * float(rng.choice([0.0, 10 ** rng.uniform(0, 3), 1e5], p=[0.1, 0.8, 0.1])))
    if contact == "rough":
        return rough()
    coefficient = float(rng.choice([0.0, rng.uniform(0.05, 1.0), 10.0], p=[0.1, 0.8, 0.1]))
    return CoulombAdhesion(coefficient, MASS * 10 ** rng.uniform(0, 3) if contact == "adhesive" else 0.0)


def gap(one: Trajectory, other: Trajectory) -> float:
    """The distance between two ends, over the radius."""
    return float(np.hypot(*(one.position[-1] - other.position[-1]))) / RADIUS


def growth(case: RandomCase, path: Trajectory) -> float:
    """How far the end of a path moves over how far its start is moved."""
    x, y = case.part.position
    inwards = -NUDGE * RADIUS / max(math.hypot(x, y), 1e-9 * RADIUS)
    nudged = replace(case.part, position=(x + inwards * x, y + inwards * y))
    return gap(path, replace(case, part=nudged).run(TOLERANCE / 100)) / NUDGE


def is_finite(path: Trajectory) -> bool:
    rows = (path.time, path.position, path.velocity, path.height, path.normal_force, path.friction_force)
    energies = (path.energy.kinetic, path.energy.potential, path.energy.work, path.energy.dissipated)
    return all(bool(np.isfinite(values).all()) for values in (*rows, *energies))


def report(first: int, count: int) -> list[str]:
    """Work and ledgers of so many cases, and those whose ends differ by more than errors of 100 tolerances grow to."""
    outcomes, work, balances, apart, strange = Counter[str](), [], [], 0, []
    for seed in range(first, first + count):
        case = random_case(seed)
        path, tight = case.run(), case.run(TOLERANCE / 100)
        assert is_finite(path), f"seed {seed} is not finite"
        outcomes[path.outcome.value] += 1
        work.append(path.evaluations)
        balances.append(path.energy.balance)
        if not (off := gap(path, tight)) <= AGREES:
            apart += 1
            if not off < 100 * TOLERANCE * growth(case, tight):
                strange.append(f"    {off:.1e} apart: seed {seed}, {case.contact}, {path.outcome.value}")
    worst = first + int(np.argmax(balances))
    return [
        f"cases            {count}, tolerance {TOLERANCE:g}: {dict(outcomes.most_common())}",
        "evaluations      median {:.0f}, 99 % {:.0f}, most {:.0f}".format(*np.quantile(work, [0.5, 0.99, 1])),
        "energy gap       median {:.1e}, 99 % {:.1e}, largest {:.1e}".format(*np.quantile(balances, [0.5, 0.99, 1]))
        + f" (seed {worst}); above {BALANCE:g}: {sum(balance > BALANCE for balance in balances)}",
        f"ends apart       {apart} by more than {AGREES:g} of the radius from a run 100 times tighter, "
        f"{len(strange)} of them by more than their paths magnify 100 tolerances",
        *strange,
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    asked = parser.parse_args()
    print("\n".join(report(asked.first, asked.count)))


if __name__ == "__main__":
    main()
