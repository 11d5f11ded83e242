"""Embedded Runge-Kutta pairs, and which of them a path uses."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from particle.group import grouped
from particle.types import FloatArray

LOOSE_TOLERANCE = 1e-6  # tolerances from here on are met most cheaply by the pair of order 5


@grouped
class Tableau(NamedTuple):
    """An embedded pair: coefficients of Dormand and Prince (1980; order 8 by Hairer, Norsett and Wanner, 1993)."""

    a: FloatArray  # (stages + 1, stages): the last row is the step itself, evaluated for its error
    c: FloatArray  # (stages + 1,)
    error: FloatArray  # (2, stages + 1): error weights; the second row is zero when there is only one
    order: int
    between: FloatArray  # (m,), places in the step between its stages
    blend: FloatArray  # (m, stages + 1): a smooth quantity there, from its values at the stages


@grouped
class Pairs(NamedTuple):
    """The pairs that a path uses: for steps as long as the tolerance admits, and for those that a breakpoint ends."""

    long: Tableau
    short: Tableau


@cache
def tableau(order: int) -> Tableau:
    """The pair of order 5 or 8."""
    from scipy.integrate import DOP853, RK45  # here, because it takes .2 s

    if order == 5:
        return _tableau(RK45, np.stack([RK45.E, 0 * RK45.E]), 5)
    return _tableau(DOP853, np.stack([DOP853.E5, DOP853.E3]), 8)


def pairs_for(tolerance: float) -> Pairs:
    """Order 8 for long steps at tight tolerances, order 5 elsewhere."""
    return Pairs(long=tableau(5 if tolerance >= LOOSE_TOLERANCE else 8), short=tableau(5))


def _tableau(pair: Any, error: FloatArray, order: int) -> Tableau:
    stages = len(pair.B)
    a = np.zeros((stages + 1, stages))
    a[:stages, : pair.A.shape[1]] = pair.A[:stages, :stages]
    a[stages] = pair.B
    c = np.append(pair.C[:stages], 1.0)
    places = np.unique(c)
    between = 0.5 * (places[1:] + places[:-1])
    powers = np.arange(min(len(places), 6))
    blend = between[:, None] ** powers @ np.linalg.pinv(c[:, None] ** powers)
    return Tableau(a, c, error, order, between, blend)
