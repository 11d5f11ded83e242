"""Scatter: where a part ends if friction, strokes and start are not quite what was planned."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from active_surface.steering.paths import Disturbance

FloatArray = NDArray[np.float64]

FRICTION, STROKES = 0.01, 0.01  # how much less or more at most, of each run
START = 1e-6  # m, how far off it is at most
SEARCHED, TOLD = 0, 1  # streams of random numbers, which do not depend on each other


@dataclass(frozen=True, eq=False)
class Scatter:
    """The ends of disturbed runs, and their distances from the target."""

    ends: FloatArray  # (n, 2) m
    distance: FloatArray  # (n,) m, inf of those that were lost: came off, left the plate or the like

    @property
    def lost(self) -> int:
        """How many were lost."""
        return int(np.isinf(self.distance).sum())

    def quantile(self, share: float) -> float:
        """The least distance [m] that a share of the parts is within; inf where too many were lost."""
        # That of one of the parts: between two of them, or between one and inf, there is none.
        return float(np.quantile(self.distance, share, method="inverted_cdf"))

    def as_dict(self) -> dict[str, Any]:
        """Its figures by name, in SI units; None where too many were lost."""
        shares = {"median": 0.5, "nine_in_ten": 0.9, "worst": 1.0}
        found = {name: self.quantile(share) for name, share in shares.items()}
        within = {name: distance if math.isfinite(distance) else None for name, distance in found.items()}
        return {"count": len(self.distance), **within, "lost": self.lost}


def disturbances(count: int, actuators: int, seed: int, stream: int) -> list[Disturbance]:
    """So many disturbances, each a function of seed, stream and its number alone.

    Friction and the stroke of each actuator are uniform within 1 % of their values, each by itself, and the start on a
    disc of 1 um around its place.
    """
    found = []
    for k in range(count):
        draw = np.random.default_rng((seed, stream, k)).random(actuators + 3)
        friction, radius, angle = 1 + FRICTION * (2 * draw[0] - 1), START * np.sqrt(draw[1]), 2 * np.pi * draw[2]
        strokes = 1 + STROKES * (2 * draw[3:] - 1)
        shift = float(radius * np.cos(angle)), float(radius * np.sin(angle))
        found.append(Disturbance(float(friction), tuple(strokes.tolist()), shift))
    return found
