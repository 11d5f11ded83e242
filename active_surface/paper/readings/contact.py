"""Contact: how much the statements depend on what the paper leaves open, or states otherwise, of the rough contact."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final, NamedTuple

from active_surface.paper.models import CLOSED, Bench
from active_surface.paper.parameters import Parameters
from active_surface.paper.readings.reading import Reading, SweepSize
from active_surface.paper.readings.single import Shares, converging, strokes_of, thresholds_of
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


class Variant(NamedTuple):
    """What becomes of statements about one actuator, with our equations on the closed form."""

    name: str
    limit: float  # m/s^2, friction limit at zero load over the mass
    pull_off: float  # m/s^2, over the mass
    threshold: float  # Hz, of figure 18; nan: none
    shares: Shares


def variants_of(reading: Reading, size: SweepSize, progress: Progress = silent) -> list[Variant]:
    """One thing changed at a time, the last of which is not the contact but what 1/f means."""
    base = reading.parameters()
    with progress("Varying the contact") as tell:
        rows = []
        for k, (name, fields) in enumerate(VARIANTS.items()):
            law = KogutEtsion(**({"plasticity_index": PAPER_PLASTICITY_INDEX} | fields))
            rows.append(_variant(name, replace(base, friction=law), size))
            tell(k + 1, len(VARIANTS) + 1)
        rows.append(_variant(TWICE, replace(base, period_share=0.5), size))
    return rows


def _variant(name: str, p: Parameters, size: SweepSize) -> Variant:
    bench = Bench(p)
    threshold, level = thresholds_of(bench, CLOSED, size)
    shares = strokes_of(bench, CLOSED) | converging(bench, CLOSED, size) | threshold
    return Variant(name, float(p.friction.friction_limit(0.0)) / p.mass, p.friction.pull_off / p.mass, level, shares)
