"""Scatter: where a part ends when friction, strokes and start deviate from the plan."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.steering.paths import Disturbance

FRICTION, STROKES = 0.01, 0.01  # largest relative changes of a run
START = 1e-6  # m, its largest displacement
SEARCHED, REPORTED = 0, 1  # independent streams of random numbers


@dataclass(frozen=True, eq=False)
class Scatter:
    """The ends of disturbed runs, and their distances from the target."""

    ends: FloatArray  # (n, 2) m
    distance: FloatArray  # (n,) m, inf for lost parts: detached, beyond the rim or the like

    @property
    def lost(self) -> int:
        """How many were lost."""
        return int(np.isinf(self.distance).sum())

    def quantile(self, share: float) -> float:
        """The distance [m] within which a share of the parts ends; inf where too many were lost."""
        # That of one of the parts: between two of them, or between one and inf, there is none.
        return float(np.quantile(self.distance, share, method="inverted_cdf"))

    def as_dict(self) -> dict[str, Any]:
        """Its figures by name, in SI units; None where too many were lost."""
        shares = {"median": 0.5, "nine_in_ten": 0.9, "worst": 1.0}
        quantiles = {name: self.quantile(share) for name, share in shares.items()}
        within = {name: distance if math.isfinite(distance) else None for name, distance in quantiles.items()}
        return {"count": len(self.distance), **within, "lost": self.lost}


def disturbances(count: int, actuators: int, seed: int, stream: int) -> list[Disturbance]:
    """Disturbances, each a function of seed, stream and its number alone.

    Friction and the stroke of each actuator are independent and uniform within 1 % of their values, the start on a
    disc of 1 um around its place.
    """
    drawn = []
    for k in range(count):
        draw = np.random.default_rng((seed, stream, k)).random(actuators + 3)
        friction, radius, angle = 1 + FRICTION * (2 * draw[0] - 1), START * np.sqrt(draw[1]), 2 * np.pi * draw[2]
        strokes = 1 + STROKES * (2 * draw[3:] - 1)
        shift = float(radius * np.cos(angle)), float(radius * np.sin(angle))
        drawn.append(Disturbance(float(friction), tuple(strokes.tolist()), shift))
    return drawn
