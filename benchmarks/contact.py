"""The friction limit from the table against solving for the separation at every step.

    .venv/bin/python benchmarks/contact.py

Both answer the same loads and must first agree; then they are timed in turns, and a table is printed: medians of five
(least - most). Making the table and compiling its lookup, which a run does once, are not counted. The root is solved
with the quadrature as it is, on numpy; that is not compiled.
"""

from __future__ import annotations

from collections.abc import Callable
from statistics import median
from time import perf_counter

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from threadpoolctl import threadpool_limits

from particle import KogutEtsion
from particle.friction import FrictionLaw, friction_limit
from particle.jit import jit

FloatArray = NDArray[np.float64]

REPEATS = 5
LOOKUPS, ROOTS = 1_000_000, 100  # in one repeat
AGREEMENT = 1e-8


@jit
def look_up(law: FrictionLaw, loads: FloatArray, times: int) -> float:
    """The sum of Q over the loads, gone through `times` times, in one compiled loop as in a run."""
    total = 0.0
    for _ in range(times):
        for load in loads:
            total += friction_limit(law, load)
    return total


def solve(contact: KogutEtsion, loads: FloatArray) -> FloatArray:
    """Q as it is without a table: the root of the net load on the stable branch, and the forces there."""
    low, high = contact.branch
    roots = [brentq(lambda d, load=load: float(contact.net_load(d)) - load, low, high) for load in loads.tolist()]
    return np.array([float(contact.forces(d)[2]) for d in roots])


def timed(work: Callable[[], object]) -> float:
    begin = perf_counter()
    work()
    return perf_counter() - begin


def compare(contact: KogutEtsion) -> tuple[list[float], list[float], float]:
    """Seconds of a lookup and of a root in each repeat, and by how much the two differ at most."""
    # Loads as a part sees them: from close to pull-off to a few times it.
    loads = contact.pull_off * np.random.default_rng(1).uniform(-0.999, 3.0, ROOTS)
    table = contact.friction_limit(loads)
    apart = float(np.abs(table / solve(contact, loads) - 1).max())
    assert apart < AGREEMENT, f"the table is {apart:.1e} off the root, more than {AGREEMENT:.0e}"
    law, rounds = contact.law, LOOKUPS // ROOTS
    assert np.isclose(look_up(law, loads, 1), table.sum(), rtol=1e-12)  # also compiles it
    lookups, roots = [], []
    for _ in range(REPEATS):
        lookups.append(timed(lambda: look_up(law, loads, rounds)) / LOOKUPS)
        roots.append(timed(lambda: solve(contact, loads)) / ROOTS)
    return lookups, roots, apart


def shown(values: list[float], unit: float) -> str:
    """Median and range to two digits."""
    middle, least, most = (
        f"{float(f'{value / unit:.2g}'):,.6g}" for value in (median(values), min(values), max(values))
    )
    return f"{middle} ({least} - {most})"


def main() -> None:
    print("| contact | table [ns] | root [ms] | root over table | largest difference |")
    print("|---|---:|---:|---:|---:|")
    with threadpool_limits(1):
        for name, contact in {"defaults": KogutEtsion(), 'preset "paper"': KogutEtsion.paper()}.items():
            lookups, roots, apart = compare(contact)
            ratios = [root / lookup for root, lookup in zip(roots, lookups, strict=True)]
            print(f"| {name} | {shown(lookups, 1e-9)} | {shown(roots, 1e-3)} | {shown(ratios, 1)} | {apart:.0e} |")


if __name__ == "__main__":
    main()
