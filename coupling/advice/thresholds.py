"""Thresholds: the factors of a drive from which a part at rest slips, and comes off."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, NamedTuple

from scipy.optimize import brentq

from particle import PartAtRest

STEP: Final = 1.25  # ratio of factors between which a threshold is looked for
RANGE: Final = 64.0  # the largest factor
LEAST: Final = 1 / 4096  # the smallest
BEFORE: Final = 0.98  # of where it comes off
EXACT: Final = 1e-7  # of a threshold


class Thresholds(NamedTuple):
    """The factors from which a part at rest slips, and comes off; inf: none up to the largest."""

    slips: float
    comes_off: float


def thresholds_of(scaled: Callable[[float], PartAtRest]) -> Thresholds:
    """The thresholds of a part at rest under drives times a factor."""
    return Thresholds(_first(lambda x: _excess_pull(scaled(x))), _first(lambda x: _excess_load(scaled(x))))


def _excess_pull(rest: PartAtRest) -> float:
    """The logarithm of the largest pull over what friction holds: the part slips from 0 on."""
    return math.log(min(max(rest.slip().value, 1e-12), 1e12))


def _excess_load(rest: PartAtRest) -> float:
    """By how much the load leaves what contact bears, over the weight or so: the part is lost from 0 on."""
    law, part = rest.part.law, rest.part
    unit = part.mass * abs(part.gravity) + part.squeeze or part.mass
    excess = -math.inf
    if math.isfinite(law.pull_off):
        excess = -(rest.smallest_load().value + law.pull_off) / unit
    if math.isfinite(law.largest_load):
        excess = max(excess, (rest.largest_load().value - law.largest_load) / unit)
    return excess


def _first(excess: Callable[[float], float]) -> float:
    """The factor nearest to 1 from which an excess is positive, seen upwards; inf: none is up to the largest."""
    low = high = 1.0
    if excess(1.0) >= 0:
        while excess(low) >= 0:
            low, high = low / STEP, low
            if low < LEAST:
                return 0.0
    else:
        while excess(high) < 0:
            low, high = high, high * STEP
            if high > RANGE:
                return math.inf
    if math.isinf(excess(low)):
        return high
    return float(brentq(excess, low, high, xtol=EXACT * low, rtol=EXACT))
