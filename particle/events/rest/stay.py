"""Whether a part that rests at the end of a run stays for good: whatever the drives still do."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from particle.drives import DriveTable
from particle.events.mechanics import Part
from particle.events.rest.stick import Rest, leaves_rest, new_rest
from particle.jit import jit
from particle.surface import LocalSurface, Surface, SurfaceMotion, enter, new_local

MAX_PASSES = 1000  # of any endless drive in the period that all have in common
ROUNDING = 1e-12


def stays(surface: SurfaceMotion, part: Part, x: float, y: float, time: float) -> bool | None:
    """Whether a part that rests at (x, y) [m] at a time [s] does so for ever.

    None: not known, as the endless drives have no common period of up to a thousand passes of each, a drive is
    a polynomial without end, or a drive's velocity jumps.
    """
    if (surface.drives.jump[:, 0] > 0).any():
        return None
    after = horizon(surface.drives, time)
    if after is None:
        return None
    record = surface.record
    return bool(_rests(record, new_local(record), new_rest(), part, x, y, time, after))


def horizon(table: DriveTable, time: float) -> float | None:
    """When [s] the drives have done all that they will ever do, seen from `time`; None as in `stays`."""
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


@jit
def _rests(
    surface: Surface, local: LocalSurface, rest: Rest, part: Part, x: float, y: float, time: float, end: float
) -> bool:
    """Whether a part at rest stays from `time` to `end` [s], and at the end of it all."""
    while True:
        if enter(surface, local, x, y, time, math.inf) < 0:
            return False
        span_end = local.frame[0].end
        over = not math.isfinite(span_end)
        span_end = time + 1.0 if over else span_end
        if math.isfinite(leaves_rest(local, part, rest, x, y, time, span_end)):
            return False
        if over or span_end >= end:
            return True
        time = span_end
