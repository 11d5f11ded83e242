"""Sensitivity: how much each figure depends on what the paper leaves open."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final, NamedTuple

import numpy as np

from paper.accuracy import BAND, FREQUENCIES, STATES
from paper.convergence import ANY, HIGH, LOW, states
from paper.deceleration import DURATION, later
from paper.handover import HANDOVERS
from paper.models import CLOSED, PAPER, Bench
from paper.neighbours import CYCLES, goes_over
from paper.pairs import SURFACES, paths_of
from paper.parameters import PARAMETERS, QUICK, Effort, Parameters, Place
from paper.radial import START, one_cycle
from particle import ConstantFriction, KogutEtsion, Micropart
from particle.kogut_etsion import PAPER_PLASTICITY_INDEX as INDEX
from studies.feasible import find_feasible

STARTS: Final = 16
STEP, FROM, TO = 20.0, 160.0, 760.0  # Hz, of the threshold
STATES_STARTS: Final = 2
PLACES: Final = 50
STEPS: Final = 1e-7, 1e-6, 1e-5  # s, of the paper's scheme


class Row(NamedTuple):
    """What becomes of the figures; None: there is no such number."""

    limit: float  # m/s^2, friction limit at zero load over the mass
    pull_off: float  # m/s^2, over the mass
    moves_from: float | None  # Hz, lowest at which a stroke of 150 um moves a part: figure 5
    deceleration: float | None  # m/s^2: figure 13; none after the cycle if it rests then or has come off
    converge: float  # share: figure 17a
    leave: float  # share: figure 17b
    come_off: float  # share: figure 17b
    threshold: float  # Hz, median: figure 18
    all_converge: float  # share: figure 19
    in_band: float  # share: figure 22


def variants(base: Parameters = PARAMETERS) -> dict[str, Parameters]:
    """The base, and one thing changed at a time."""

    def contact(**fields: Any) -> Parameters:
        return replace(base, friction=KogutEtsion(**({"plasticity_index": INDEX} | fields)))

    return {
        "as everywhere": base,
        "a = 290 um": replace(base, radius=290e-6),
        "a = 310 um": replace(base, radius=310e-6),
        "beta = 0.05": contact(asperity_beta=0.05),
        "beta = 0.07": contact(asperity_beta=0.07),
        "eps = 0.2 nm": contact(intermolecular_distance=0.2e-9),
        "eps = 0.4 nm": contact(intermolecular_distance=0.4e-9),
        "plasticity index 4.8": contact(plasticity_index=4.8),
        "plasticity index 5.0": contact(plasticity_index=5.0),
        "plasticity index 2.5 (Table 1)": contact(plasticity_index=2.5),
        "coefficients of (5) unrounded": contact(coefficients="unrounded"),
        "constant friction of 20.9 m/s^2, no pull-off": replace(base, friction=ConstantFriction(20.9 * base.mass)),
        "no gravity": replace(base, gravity=0.0),
        "each stroke takes 1/f": replace(base, period_share=0.5),
        "starts displaced by up to 0.1 um": replace(base, jitter=1e-7),
        "100 cycles": replace(base, cycles=100),
    }


def row_of(p: Parameters, starts: int = STARTS) -> Row:
    """The figures with our equations on the closed form."""
    bench = Bench(p)
    places = bench.starts(p.start, starts)
    low = bench.paths(CLOSED, [bench.drive(LOW)], places, p.cycles / LOW / p.period_share)
    high = bench.paths(CLOSED, [bench.drive(HIGH)], places, p.cycles / HIGH / p.period_share)
    around, velocities = states(p.seed, starts)
    many = bench.paths(CLOSED, [bench.drive(ANY)], around, p.cycles / ANY / p.period_share, velocities)
    (slowing,) = bench.paths(CLOSED, [one_cycle(p.stroke)], [START], DURATION)
    slowed = later(slowing, p.mass)[0] if slowing.attached else float("nan")
    return Row(
        limit=float(p.friction.friction_limit(0.0)) / p.mass,
        pull_off=p.friction.pull_off / p.mass,
        moves_from=moves_from(bench),
        deceleration=slowed if np.isfinite(slowed) else None,
        converge=_share([path.converged(1 / LOW / p.period_share, p.near) for path in low]),
        leave=_share([path.leaves_at(p.far) < np.inf for path in high]),
        come_off=_share([path.outcome == "detached" for path in high]),
        threshold=threshold(bench, CLOSED, starts // 2 or 1),
        all_converge=_share([path.converged(1 / ANY / p.period_share, p.near) for path in many]),
        in_band=in_band(bench),
    )


def moves_from(bench: Bench) -> float | None:
    """The lowest frequency [Hz] at which the stroke moves a part at rest anywhere, to some 2 %."""
    p, ground = bench.parameters, bench.ground(CLOSED)
    drive = bench.drive(50.0)
    factors = np.geomspace(1.0, 40.0, 180)
    part = Micropart(p.mass, (0.0, 0.0))
    surface = ground.surface.driven_by([drive])
    window = 1 / drive.frequency
    found = find_feasible(surface, ground.outline, part, p.friction, window, factors, p.gravity, PLACES)
    moves = np.flatnonzero(found.slipping.peak > 0)
    return float(50.0 * found.factors[moves[0]]) if len(moves) else None


def threshold(bench: Bench, model: str, count: int) -> float:
    """The median over starts of the lowest frequency [Hz] at which they are lost."""
    p = bench.parameters
    places = bench.starts(p.start, count)
    found = np.full(count, TO + STEP)
    for frequency in np.arange(FROM, TO + 1, STEP).tolist():
        left = np.flatnonzero(found > TO)
        if len(left):
            drive = bench.drive(frequency)
            paths = bench.paths(model, [drive], places[left], p.cycles / drive.frequency)
            lost = [path.lost(p.far) for path in paths]
            found[left[lost]] = frequency
    return float(np.median(found))


def in_band(bench: Bench) -> float:
    """The share of parts of figure 22 within the paper's band."""
    p = bench.parameters
    places = np.concatenate([bench.starts(place, STATES_STARTS) for place, _ in STATES])
    speeds = np.repeat([velocity for _, velocity in STATES], STATES_STARTS, axis=0)
    near = []
    for frequency in FREQUENCIES.tolist():
        drive = bench.drive(frequency)
        paths = bench.paths(CLOSED, [drive], places, p.cycles / drive.frequency, speeds)
        near += [path.attached and path.away()[-1] <= BAND for path in paths]
    return _share(near)


def steps_of_the_scheme(count: int) -> dict[float, tuple[float, float]]:
    """By step [s] of the paper's scheme: the share that converges in figure 17a, and the threshold [Hz] of "
    "figure 18."""
    found = {}
    for step in STEPS:
        bench = Bench(replace(PARAMETERS, time_step=step))
        p = bench.parameters
        paths = bench.paths(PAPER, [bench.drive(LOW)], bench.starts(p.start, count), p.cycles / LOW)
        share = _share([path.converged(1 / LOW, p.near) for path in paths])
        found[step] = share, threshold(bench, PAPER, max(count // 2, 1))
    return found


READINGS: Final[dict[str, tuple[tuple[float, float], Place]]] = {
    "450 Hz at (150, 0), start (100, 0) um": HANDOVERS[0][1:3],
    "450 Hz at (0, 0), start (100, 0) um": ((450.0, 300.0), (100e-6, 0.0)),
    "450 Hz at (0, 0), start 100 um from the point half-way": ((450.0, 300.0), (175e-6, 0.0)),
    "450 Hz at (0, 0), start 100 um beyond it": ((450.0, 300.0), (-100e-6, 0.0)),
}
"""Of figure 20."""
BEGINNINGS: Final = ((-50e-6, 15e-6), (-100e-6, 0.0), (-100e-6, -100e-6), (50e-6, 50e-6))
"""Of figure 16, m."""
LOW_AND_HIGH: Final = 250.0, 450.0  # Hz


def readings(effort: Effort = QUICK) -> dict[str, dict[str, float]]:
    """By reading of figure 20 and by surface the share of starts that arrive."""
    bench = Bench()
    p = bench.parameters
    found = {}
    for name, (frequencies, start) in READINGS.items():
        drives = [bench.drive(frequency) for frequency in frequencies]
        target = (int(np.argmin(frequencies)) * p.pitch, 0.0)
        paths = paths_of(bench, effort, drives, start, p.cycles / min(frequencies))
        period = 1 / min(frequencies)
        found[name] = {
            surface: _share([path.converged(period, p.near, target) for path in rows])
            for surface, rows in paths.items()
        }
    return found


def beginnings(effort: Effort = QUICK) -> dict[Place, dict[str, tuple[float, ...]]]:
    """By start of figure 16 and by surface the shares that go over, at the low and at a high frequency."""
    bench = Bench()
    found: dict[Place, dict[str, tuple[float, ...]]] = {}
    for start in BEGINNINGS:
        shares: dict[str, list[float]] = {surface: [] for surface in SURFACES}
        for frequency in LOW_AND_HIGH:
            paths = paths_of(bench, effort, [bench.drive(frequency)] * 2, start, CYCLES / frequency)
            for surface, rows in paths.items():
                shares[surface].append(_share([goes_over(path, bench.parameters.pitch) for path in rows]))
        found[start] = {surface: tuple(pair) for surface, pair in shares.items()}
    return found


def _share(holds: list[bool]) -> float:
    return float(np.mean(holds))
