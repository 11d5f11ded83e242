"""The parameters of friction laws: their defaults, and what they must be. Loads no numerics, for readers of files."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Final

PAPER_PLASTICITY_INDEX: Final = 4.9128  # makes the friction limit 20.9 m/s^2 times the paper's mass at zero load
COEFFICIENTS: Final = ("printed", "unrounded")
MIN_POINTS: Final = 3  # of a measured law


@dataclass(frozen=True)
class KogutEtsionInput:
    """The parameters of Kogut and Etsion's contact; raises ValueError, naming every field that is wrong."""

    roughness: float = 20e-9  # m, standard deviation of surface heights
    contact_area: float = 1e-8  # m^2, nominal
    hardness: float = 1.96133e9  # Pa
    poisson_ratio: float = 0.3  # 1, of the softer surface
    adhesion_energy: float = 1.0  # J/m^2
    plasticity_index: float = 2.5  # 1; large where asperities yield early
    asperity_beta: float = 0.0601  # asperity density times tip radius times roughness
    intermolecular_distance: float = 0.3e-9  # m
    coefficients: str = "printed"

    def __post_init__(self) -> None:
        wrong = []
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name not in ("coefficients", "poisson_ratio") and not (math.isfinite(value) and value > 0):
                wrong.append(f"Input {field.name} of KogutEtsion must be positive; got {value!r}")
        if not 0 <= self.poisson_ratio < 0.5:
            wrong.append(f"Input poisson_ratio of KogutEtsion must be in [0, 0.5); got {self.poisson_ratio!r}")
        if self.asperity_beta**2 <= 3.717e-4:
            wrong.append(f"Input asperity_beta of KogutEtsion must exceed 0.01928; got {self.asperity_beta!r}")
        if self.coefficients not in COEFFICIENTS:
            wrong.append(
                f"Input coefficients of KogutEtsion must be one of {list(COEFFICIENTS)}; got {self.coefficients!r}"
            )
        if wrong:
            raise ValueError("; ".join(wrong))


def point_mistakes(
    loads: Sequence[float], limits: Sequence[float], static_ratio: float = 1.0
) -> list[tuple[str, int | None, str]]:
    """What is wrong with a measured law: the field, the point from 0 or None for all of it, and what it must be."""
    wrong: list[tuple[str, int | None, str]] = []
    count = len(loads)
    if count < MIN_POINTS:
        wrong.append(("loads", None, f"must be {MIN_POINTS} forces in N or more; got {count}"))
    if len(limits) != count:
        wrong.append(("limits", None, f"must be as many as the loads, {count}; got {len(limits)}"))
    loads, limits = [float(load) for load in loads], [float(limit) for limit in limits]
    for k, load in enumerate(loads):
        if not math.isfinite(load):
            wrong.append(("loads", k, f"must be finite; got {load!r}"))
        elif k == 0 and load > 0:
            wrong.append(("loads", k, f"must be minus the pull-off force, so 0 or negative; got {load!r} N"))
        elif k > 0 and load <= loads[k - 1]:
            wrong.append(("loads", k, f"must be greater than the one before, {loads[k - 1]!r} N; got {load!r} N"))
    for k, limit in enumerate(limits):
        if not math.isfinite(limit):
            wrong.append(("limits", k, f"must be finite; got {limit!r}"))
        elif limit < 0:
            wrong.append(("limits", k, f"must be 0 or positive; got {limit!r} N"))
        elif k > 0 and limit < limits[k - 1]:
            wrong.append(("limits", k, f"must not be less than the one before, {limits[k - 1]!r} N; got {limit!r} N"))
    if not 1 <= static_ratio < math.inf:
        wrong.append(("static_ratio", None, f"must be at least 1; got {static_ratio!r}"))
    return wrong
