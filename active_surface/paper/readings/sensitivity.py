"""Sensitivity: what becomes of statements about one actuator when one thing changes that readings leave alone."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final, NamedTuple

from active_surface.paper.figures import HIGH, from_start
from active_surface.paper.models import CLOSED, PAPER, Bench
from active_surface.paper.parameters import Parameters
from active_surface.paper.readings.reading import Reading, SweepSize
from active_surface.paper.readings.single import Shares, converging, strokes_of, thresholds_of
from active_surface.paper.share import share_of
from coupling import Progress, silent
from particle import PAPER_PLASTICITY_INDEX, KogutEtsion

VARIANTS: Final[dict[str, dict[str, Any]]] = {
    "as everywhere": {},
    "beta = 0.05": {"asperity_beta": 0.05},
    "beta = 0.07": {"asperity_beta": 0.07},
    "eps = 0.2 nm": {"intermolecular_distance": 0.2e-9},
    "eps = 0.4 nm": {"intermolecular_distance": 0.4e-9},
    "plasticity index 4.8": {"plasticity_index": 4.8},
    "plasticity index 5.0": {"plasticity_index": 5.0},
    "plasticity index 2.5 (Table 1)": {"plasticity_index": 2.5},
    "coefficients of (5) unrounded": {"coefficients": "unrounded"},
}
TWICE: Final = "each stroke takes 1/f"
STEPS: Final = (1e-6, 2e-6, 5e-6, 10e-6, 20e-6)  # s, of the paper's scheme
FARS: Final = (150e-6, 175e-6, 200e-6, 225e-6, 250e-6)  # m, beyond which a part has left
TWO_CYCLES: Final = 2.0
MORE: Final = 4  # times more starts for these, whose paths are few


class Variant(NamedTuple):
    """What becomes of statements about one actuator."""

    name: str
    limit: float  # m/s^2, friction limit at zero load over the mass
    pull_off: float  # m/s^2, over the mass
    threshold: float  # Hz, of figure 18; nan: none
    shares: Shares


class Left(NamedTuple):
    """Figure 17b's parts that leave, by the distance that counts as far."""

    model: str
    far: float  # m
    leave: float  # share, at any time
    in_two: float  # share, in two cycles


class Sensitivity(NamedTuple):
    """All three."""

    contact: list[Variant]
    steps: list[Variant]
    left: list[Left]


def sensitivity_of(reading: Reading, size: SweepSize, progress: Progress = silent) -> Sensitivity:
    """From one reading: our equations over another contact, the paper's scheme by other steps, and what has left."""
    base = reading.parameters()
    benches: list[tuple[str, str, Parameters]] = [
        *(
            (CLOSED, name, replace(base, friction=KogutEtsion(**({"plasticity_index": PAPER_PLASTICITY_INDEX} | own))))
            for name, own in VARIANTS.items()
        ),
        (CLOSED, TWICE, replace(base, period_share=0.5)),
        *((PAPER, f"{1e6 * step:g} us", replace(base, time_step=step)) for step in STEPS),
    ]
    rows = []
    with progress("Changing one thing at a time") as tell:
        for k, (model, name, p) in enumerate(benches):
            rows.append(_variant(name, p, model, size))
            tell(k + 1, len(benches) + 1)
        left = [one for model in (PAPER, CLOSED) for one in _left(Bench(base), model, MORE * size.starts)]
        tell(len(benches) + 1, len(benches) + 1)
    return Sensitivity(rows[: -len(STEPS)], rows[-len(STEPS) :], left)


def _variant(name: str, p: Parameters, model: str, size: SweepSize) -> Variant:
    bench = Bench(p)
    threshold, level = thresholds_of(bench, model, size)
    shares = strokes_of(bench, model) | converging(bench, model, size) | threshold
    return Variant(name, float(p.friction.friction_limit(0.0)) / p.mass, p.friction.pull_off / p.mass, level, shares)


def _left(bench: Bench, model: str, starts: int) -> list[Left]:
    paths = from_start(bench, model, HIGH, starts)
    soon = TWO_CYCLES / bench.drive(HIGH).frequency
    return [
        Left(
            model, far,
            share_of(path.leaves_at(far) < float("inf") for path in paths).value,
            share_of(path.leaves_at(far) <= soon for path in paths).value,
        )
        for far in FARS
    ]  # fmt: skip
