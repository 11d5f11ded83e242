"""Random runs of the integrator: does any hang, give no number, lose energy, or disagree with a tighter tolerance?

`python benchmarks/random_cases.py --count 10000` prints a table. Every case comes from its seed alone, so that a bad
one can be run again: `python benchmarks/random_cases.py --first SEED --count 1`.
"""

from __future__ import annotations

import argparse
import math
import os
import sys
import threading
from collections import Counter
from dataclasses import dataclass, replace
from functools import cache
from time import perf_counter

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
NUDGE = 1e-12  # of the radius, by which a start is moved to see how far its end moves
HANGS = 120.0  # s
QUANTILES = {"median": 0.5, "90 %": 0.9, "99 %": 0.99, "largest": 1.0}
CONTACTS = ("constant", "coulomb", "adhesive", "rough")


@dataclass(frozen=True)
class RandomCase:
    """What one seed stands for."""

    seed: int
    surface: SurfaceMotion
    spans: int  # between breakpoints of the drives
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


@dataclass(frozen=True)
class Finding:
    """What came of one case; lengths are over the radius."""

    seed: int
    contact: str
    outcome: str
    flies: bool
    landings: int
    evaluations: int
    share: float  # of the work limit
    finite: bool
    balance: float
    gap: float  # between the ends at TOLERANCE and at a hundredth of it
    moved: float  # how far the end moves at the tight tolerance when the start is nudged; 0 where the ends agree


@cache
def layouts() -> tuple[SurfaceMotion, ...]:
    """Surfaces of 1 to 4 actuators on the clamped disc in closed form; the drives are yet to come."""
    found = []
    for seed in range(SURFACES):
        rng, count = np.random.default_rng([7, seed]), 1 + seed % 4
        points: list[FloatArray] = []
        while len(points) < count:
            at = RADIUS * rng.uniform(-0.75, 0.75, 2)
            if np.hypot(*at) < 0.75 * RADIUS and all(np.hypot(*(at - p)) > 0.2 * RADIUS for p in points):
                points.append(at)
        found.append(surface_motion(DiscShapes(points, RADIUS), [Drive(0.0, 300.0)] * count, 1e-10))
    return tuple(found)


@cache
def rough() -> KogutEtsion:
    return KogutEtsion.paper()


def random_case(seed: int) -> RandomCase:
    """The case of a seed: near an actuator, near the rim or anywhere; from without friction to glued."""
    rng = np.random.default_rng([11, seed])
    plain = layouts()[rng.integers(SURFACES)]
    drives = []
    for _ in plain.sources:
        cycle = "up" if rng.random() < 0.2 else "up-down"
        cycles = int(rng.integers(1, 6)) if cycle == "up-down" and rng.random() < 0.3 else None
        stroke = rng.choice([-1, 1], p=[0.2, 0.8]) * 150e-6 * 10 ** rng.uniform(-1.5, 0)
        delay = rng.choice([0.0, rng.uniform(0, 2e-3)])
        drives.append(Drive(float(stroke), rng.uniform(100, 800), cycle, cycles, float(delay)))
    duration = rng.uniform(5e-3, 20e-3)
    part = Micropart(MASS, _start(rng, plain.sources), _velocity(rng))
    contact = str(rng.choice(CONTACTS))
    spans = sum(1 + 2 * math.ceil(duration * drive.frequency) for drive in drives)
    surface = plain.driven_by(drives)
    return RandomCase(seed, surface, spans, part, contact, _friction(rng, contact), duration, bool(rng.random() < 0.5))


def _start(rng: np.random.Generator, sources: FloatArray) -> tuple[float, float]:
    place = rng.choice(["actuator", "rim", "anywhere"])
    angle = rng.uniform(0, 2 * math.pi)
    if place == "actuator":
        r, (x, y) = RADIUS * 10 ** rng.uniform(-4, -1), sources[rng.integers(len(sources))]
    elif place == "rim":
        r, x, y = RADIUS * (1 - 10 ** rng.uniform(-4, -1)), 0.0, 0.0
    else:
        r, x, y = 0.9 * RADIUS * math.sqrt(rng.random()), 0.0, 0.0
    return float(x + r * math.cos(angle)), float(y + r * math.sin(angle))


def _velocity(rng: np.random.Generator) -> tuple[float, float]:
    speed = rng.choice([0.0, 10 ** rng.uniform(-4, -0.5)], p=[0.7, 0.3])
    angle = rng.uniform(0, 2 * math.pi)
    return float(speed * math.cos(angle)), float(speed * math.sin(angle))


def _friction(rng: np.random.Generator, contact: str) -> Contact:
    if contact == "constant":
        return ConstantFriction(MASS * float(rng.choice([0.0, 10 ** rng.uniform(0, 3), 1e5], p=[0.1, 0.8, 0.1])))
    if contact == "rough":
        return rough()
    coefficient = float(rng.choice([0.0, rng.uniform(0.05, 1.0), 10.0], p=[0.1, 0.8, 0.1]))
    return CoulombAdhesion(coefficient, MASS * 10 ** rng.uniform(0, 3) if contact == "adhesive" else 0.0)


def examine(case: RandomCase, compare: bool = True) -> Finding:
    """Runs a case; with `compare` also a hundred times tighter and, where these differ, from a nudged start."""
    path = case.run()
    gap = moved = 0.0
    if compare:
        tight = case.run(TOLERANCE / 100)
        gap = _apart(path, tight)
        if not gap <= AGREES:
            x, y = case.part.position
            inwards = -NUDGE * RADIUS / max(math.hypot(x, y), 1e-9 * RADIUS)
            nudged = replace(case.part, position=(x + inwards * x, y + inwards * y))
            moved = _apart(tight, replace(case, part=nudged).run(TOLERANCE / 100))
    rows = (path.time, path.position, path.velocity, path.height, path.normal_force, path.friction_force)
    energies = (path.energy.kinetic, path.energy.potential, path.energy.work, path.energy.dissipated)
    return Finding(
        seed=case.seed,
        contact=case.contact,
        outcome=path.outcome.value,
        flies=case.flies,
        landings=sum(event.kind.name == "LANDS" for event in path.events),
        evaluations=path.evaluations,
        share=path.evaluations / (20_000 + 2_000 * case.spans),
        finite=all(bool(np.isfinite(values).all()) for values in (*rows, *energies)),
        balance=path.energy.balance,
        gap=gap,
        moved=moved,
    )


def _apart(one: Trajectory, other: Trajectory) -> float:
    return float(np.hypot(*(one.position[-1] - other.position[-1]))) / RADIUS


def table(found: list[Finding]) -> list[str]:
    """The lines of the report."""
    count, lines = len(found), []
    most = max(found, key=lambda f: f.evaluations)
    lines.append(f"cases            {count}, tolerance {TOLERANCE:g}; none hung")
    strange = [f.seed for f in found if not f.finite]
    lines.append(f"not finite       {len(strange)} {strange[:10]}")
    outcomes = Counter((f.outcome, f.flies) for f in found)
    for outcome in sorted({f.outcome for f in found}):
        lines.append(f"{outcome:16} {outcomes[outcome, False]} stopping, {outcomes[outcome, True]} flying on")
    landed = [f.landings for f in found if f.landings]
    lines.append(f"landed           {len(landed)} cases, {sum(landed)} times")
    work = np.array([f.evaluations for f in found])
    lines.append(
        f"evaluations      median {np.median(work):.0f}, 99 % {np.quantile(work, 0.99):.0f}, "
        f"most {most.evaluations} (seed {most.seed}, {most.share:.2f} of its limit)"
    )
    balance = np.array([f.balance for f in found])
    shares = ", ".join(f"{name} {np.quantile(balance, q):.1e}" for name, q in QUANTILES.items())
    lines.append(f"energy gap       {shares}; above {BALANCE:g}: {(balance > BALANCE).sum()}")
    for f in sorted(found, key=lambda f: -f.balance)[:10]:
        lines.append(f"    {f.balance:.1e}  seed {f.seed}, {f.contact}, {f.outcome}, {f.landings} landings")
    apart = [f for f in found if not f.gap <= AGREES]
    lines.append(f"ends agree       {1 - len(apart) / count:.4f} of all to {AGREES:g} of the radius")
    for contact in CONTACTS:
        kind = [f for f in found if f.contact == contact]
        if kind:
            lines.append(f"    {contact:12} {sum(f.gap <= AGREES for f in kind) / len(kind):.4f} of {len(kind)}")
    # An error of one step's tolerance grows as the nudge does; a run makes many such errors.
    grown = [f for f in apart if f.gap < 100 * TOLERANCE * f.moved / NUDGE]
    far = [f for f in apart if f.moved > 0.1 * f.gap]
    lines.append(f"ends disagree    {len(apart)}; a start nudged by {NUDGE:g} moves {len(far)} of them comparably;")
    lines.append(f"                 {len(grown)} by less than 100 tolerances times the nudge's growth; the rest:")
    for f in sorted((f for f in apart if f not in grown), key=lambda f: -f.gap)[:20]:
        lines.append(
            f"    {f.gap:.1e}  nudged {f.moved:.1e}  seed {f.seed}, {f.contact}, {f.outcome}, {f.landings} landings"
        )
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    asked = parser.parse_args()
    layouts()
    # Kernels run without the interpreter's lock, so that a thread can tell which case does not come back.
    running = [asked.first, math.inf]

    def watch() -> None:
        while True:
            if perf_counter() > running[1] + HANGS:
                print(f"seed {running[0]} has not come back for {HANGS:g} s", file=sys.stderr, flush=True)
                os._exit(1)
            threading.Event().wait(1.0)

    random_case(asked.first).run()  # compiles
    threading.Thread(target=watch, daemon=True).start()
    found = []
    for seed in range(asked.first, asked.first + asked.count):
        running[:] = [seed, perf_counter()]
        found.append(examine(random_case(seed)))
    print("\n".join(table(found)))


if __name__ == "__main__":
    main()
