"""Scatter: where a part ends when friction, strokes and start deviate from the plan."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from active_surface.arrays import FloatArray


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

    def cvar(self, share: float) -> float:
        """The conditional value at risk: the mean distance [m] of parts beyond a quantile; inf where one is lost."""
        return float(conditional_value_at_risk(self.distance, share)) if not self.lost else math.inf

    def as_dict(self) -> dict[str, Any]:
        """Its figures by name, in SI units; None where too many were lost."""
        shares = {"median": 0.5, "nine_in_ten": 0.9, "worst": 1.0}
        quantiles = {name: self.quantile(share) for name, share in shares.items()}
        within = {name: distance if math.isfinite(distance) else None for name, distance in quantiles.items()}
        cvar = self.cvar(0.9)
        tail = {"cvar_nine_in_ten": cvar if math.isfinite(cvar) else None}
        return {"count": len(self.distance), **within, **tail, "lost": self.lost}


def conditional_value_at_risk(distances: FloatArray, share: float) -> FloatArray:
    """The mean of the largest 1 - share of distances (..., n), by Rockafellar and Uryasev's (2000) formula."""
    # The one in which the share ends counts in part, so that it is continuous in the share.
    quantile = np.quantile(distances, share, axis=-1, method="inverted_cdf", keepdims=True)
    beyond = np.maximum(distances - quantile, 0).mean(axis=-1) / (1 - share)
    return np.asarray(quantile[..., 0] + beyond)
