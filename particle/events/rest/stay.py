"""When the drives have done all that they will ever do."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from particle.drives import DriveTable

MAX_PASSES = 1000  # of any endless drive in the period that all have in common
ROUNDING = 1e-12


def horizon(table: DriveTable, time: float) -> float | None:
    """When [s] the drives have done all that they will ever do, seen from `time` [s].

    None where that is not known: the endless drives have no common period of up to a thousand passes of each, or a
    drive is a polynomial without end.
    """
    bounded, endless = np.isfinite(table.span), ~np.isfinite(table.repeats)
    for i in np.flatnonzero(~bounded):
        if table.coefficients[table.first[i] : table.first[i + 1], 1:].any():
            return None
    passes = np.where(endless, 0.0, table.repeats)[bounded]
    lead, tail = -table.start[table.first[:-1]], table.first[1:] - 1
    tail_time = np.where(tail < table.loop[:, 1], 0.0, table.start[tail] + table.scale[tail])
    ends = table.delay + lead + tail_time
    last = float((ends[bounded] + table.span[bounded] * passes).max(initial=time))
    spans = table.span[endless]
    if len(spans) == 0:
        return last
    ratios = [Fraction(float(span / spans[0])).limit_denominator(MAX_PASSES) for span in spans]
    if any(abs(float(ratio) * spans[0] / span - 1) > ROUNDING for ratio, span in zip(ratios, spans, strict=True)):
        return None
    # The least whole number of passes of the first in which all others make whole numbers of theirs.
    common = math.lcm(*(ratio.numerator for ratio in ratios)) / math.gcd(*(ratio.denominator for ratio in ratios))
    if common * spans[0] / spans.min() > MAX_PASSES:
        return None
    return last + float(common * spans[0])
