"""Sensitivity: how much each figure depends on what the paper leaves open."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final, NamedTuple

import numpy as np

from active_surface.paper.figures import (
    ANY,
    BAND,
    CYCLES,
    HANDOVERS,
    HIGH,
    HIGHEST,
    LOW,
    LOWEST,
    STATED_STROKE,
    SURFACES,
    Handover,
    Trend,
    arrives,
    converge,
    distances,
    ends_of,
    from_start,
    from_states,
    leave,
    one_cycle,
    onset,
    paths_of,
    slowing,
    slowing_paths,
    thresholds,
    trend_of,
    within,
)
from active_surface.paper.models import CLOSED, PAPER, Bench
from active_surface.paper.parameters import PARAMETERS, QUICK, Effort, Parameters, Place
from active_surface.paper.share import Share, share_of
from active_surface.paper.split import Split
from particle import PAPER_PLASTICITY_INDEX as INDEX
from particle import ConstantFriction, KogutEtsion

STARTS: Final = 20  # of our equations
STATES_STARTS: Final = 2
STEP: Final = 20.0  # Hz, of the threshold
PLACES: Final = 50
STEPS: Final = 1e-7, 1e-6, 1e-5  # s, of the paper's scheme
NO_PULL_OFF: Final = "constant friction of 20.9 m/s^2, no pull-off"


class Row(NamedTuple):
    """What becomes of the figures; nan: there is no such number."""

    limit: float  # m/s^2, friction limit at zero load over the mass
    pull_off: float  # m/s^2, over the mass
    moves_from: float  # Hz, lowest at which a stroke of 150 um moves a part: figure 5
    deceleration: float  # m/s^2: figure 13; none after the cycle if it rests then or has come off
    converge: Share  # figure 17a
    leave: Share  # figure 17b
    come_off: Share  # figure 17b
    threshold: Split  # figure 18
    all_converge: Share  # figure 19
    in_band: Share  # figure 22


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
        NO_PULL_OFF: replace(base, friction=ConstantFriction(20.9 * base.mass)),
        "no gravity": replace(base, gravity=0.0),
        "each stroke takes 1/f": replace(base, period_share=0.5),
        "starts displaced by up to 0.1 um": replace(base, jitter=1e-7),
        "100 cycles": replace(base, cycles=100),
        "it has left beyond 150 um": replace(base, far=150e-6),
        "it has left beyond 175 um": replace(base, far=175e-6),
        "it has left beyond 225 um": replace(base, far=225e-6),
        "it has left beyond 250 um": replace(base, far=250e-6),
        "it converges within 20 um": replace(base, near=20e-6),
        "it converges within 40 um": replace(base, near=40e-6),
    }


def row_of(p: Parameters, starts: int = STARTS) -> Row:
    """The figures with our equations on the closed form."""
    bench = Bench(p)
    low, high = (from_start(bench, CLOSED, frequency, starts) for frequency in (LOW, HIGH))
    cycle = one_cycle(bench)
    return Row(
        limit=float(p.friction.friction_limit(0.0)) / p.mass,
        pull_off=p.friction.pull_off / p.mass,
        moves_from=onset(bench, CLOSED, p.stroke, PLACES),
        deceleration=slowing(slowing_paths(bench, CLOSED, cycle)[0], p.mass, cycle).rate,
        converge=converge(bench, low, LOW),
        leave=leave(bench, high),
        come_off=share_of(path.came_off for path in high),
        threshold=threshold(bench, CLOSED, starts),
        all_converge=converge(bench, from_states(bench, CLOSED, starts), ANY),
        in_band=within(distances(bench, CLOSED, STATES_STARTS), BAND),
    )


def threshold(bench: Bench, model: str, count: int) -> Split:
    """The threshold of figure 18 at 150 um."""
    strokes, frequencies = np.array([STATED_STROKE]), np.arange(LOWEST, HIGHEST + 1, STEP)
    return thresholds(strokes, frequencies, ends_of(bench, model, strokes, frequencies, count)).split[0]


def steps_of_the_scheme(count: int) -> dict[float, tuple[Share, Split]]:
    """By step [s] of the paper's scheme: the share that converges in figure 17a, and the threshold of figure 18."""
    results = {}
    for step in STEPS:
        bench = Bench(replace(PARAMETERS, time_step=step))
        share = converge(bench, from_start(bench, PAPER, LOW, count), LOW)
        results[step] = share, threshold(bench, PAPER, max(count // 2, 1))
    return results


READINGS: Final = {
    "450 Hz at (150, 0), start (100, 0) um": HANDOVERS["20"],
    "450 Hz at (0, 0), start (100, 0) um": Handover((450.0, 300.0), (100e-6, 0.0)),
    "450 Hz at (0, 0), start 100 um from the point half-way": Handover((450.0, 300.0), (175e-6, 0.0)),
    "450 Hz at (0, 0), start 100 um beyond it": Handover((450.0, 300.0), (-100e-6, 0.0)),
}
"""Of figure 20."""
BEGINNINGS: Final[tuple[Place, ...]] = ((-50e-6, 15e-6), (-100e-6, 0.0), (-100e-6, -100e-6), (50e-6, 50e-6))
"""Of figure 16, m."""
LOW_AND_HIGH: Final = 250.0, 450.0  # Hz


def readings(effort: Effort = QUICK) -> dict[str, dict[str, Share]]:
    """By reading of figure 20 and by surface the share of starts that arrive; the first also without pull-off."""
    bench, loose = Bench(), Bench(variants()[NO_PULL_OFF])
    results = {name: _arrivals(bench, effort, one) for name, one in READINGS.items()}
    return results | {f"the first, {NO_PULL_OFF}": _arrivals(loose, effort, HANDOVERS["20"])}


def _arrivals(bench: Bench, effort: Effort, one: Handover) -> dict[str, Share]:
    paths = paths_of(bench, effort, *one, bench.parameters.cycles)
    return {surface: share_of(arrives(bench, one, path) for path in rows) for surface, rows in paths.items()}


def beginnings(effort: Effort = QUICK) -> dict[str, dict[str, Trend]]:
    """By start of figure 16 and by surface what becomes of parts at a low and a high frequency; the first as above."""
    bench, loose = Bench(), Bench(variants()[NO_PULL_OFF])
    results = {f"({1e6 * x:g}, {1e6 * y:g}) um": _trends(bench, effort, (x, y)) for x, y in BEGINNINGS}
    return results | {f"the first, {NO_PULL_OFF}": _trends(loose, effort, BEGINNINGS[0])}


def _trends(bench: Bench, effort: Effort, start: Place) -> dict[str, Trend]:
    paths = {frequency: paths_of(bench, effort, [frequency] * 2, start, CYCLES) for frequency in LOW_AND_HIGH}
    return {
        surface: trend_of({frequency: both[surface] for frequency, both in paths.items()}, bench.parameters.pitch)
        for surface in SURFACES
    }
