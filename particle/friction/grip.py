"""What a contact bears at one place: on a flat surface its law, else a rough contact's, point by point (`local`).

Under a square part on a surface with the second derivatives H the surfaces are d(r) roughnesses apart, and

    N(z) = int (p - a) dA,   Q(z) = int q dA,   d(r) = z + max(c) - c(r),   c(r) = r.H r / (2 roughness).

z is the gap at the highest point. A square is symmetric about its middle, so it does not tilt, and half of it counts
twice. The pull-off force is minus the least N.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from particle.friction.contact import LOCAL, FrictionLaw, friction_limit
from particle.jit import device_no_arrays, jit
from particle.types import FloatArray

LEAST, NEAR, HIGHEST = -4.0, 12.0, 8.0  # roughnesses: the table's begin, where asperities end, above any pull-off
STEPS, FAR_STEPS = 128, 96  # intervals of the table in a roughness, and in 1/d from NEAR on
SIDES: Final = 12, 16, 24, 48  # points along a side of the square, and
SPREADS: Final = 2.0, 5.0, 16.0, math.inf  # up to which spread of c they do
ENDS: Final = tuple(int(end) for end in np.cumsum([n * n // 2 for n in SIDES]))
TURNS, SETTLED = 60, 1e-6  # Newton's steps, and roughnesses: the next would be the square of that
GROWTH = 1.9  # 1/roughness, of the root of the load above its least


class Grip(NamedTuple):
    """What a contact bears under a load at one place."""

    limit: float  # N, largest friction while sliding
    load: float  # N, as far above pull-off as on a flat surface


class _Sums(NamedTuple):
    """N and Q at a gap z, and derivatives by z."""

    net: float
    slope: float
    bend: float
    limit: float
    limit_slope: float


@device_no_arrays
def grip(law: FrictionLaw, load: float, xx: float, xy: float, yy: float) -> Grip:
    """Q under the net normal force `load` [N] on a surface with the second derivatives xx, xy and yy [1/m].

    Beyond pull-off and beyond a closed gap it goes on as it is there.
    """
    if law.kind != LOCAL:
        return Grip(friction_limit(law, load), load)
    spread = law.places[ENDS[-1], 0] * (abs(xx) + abs(yy)) + law.places[ENDS[-1], 1] * abs(xy)
    if not spread < math.inf:  # off the plate
        return Grip(friction_limit(law, load), load)
    rule = 0
    while spread > SPREADS[rule]:
        rule += 1
    first, end, highest = (ENDS[rule - 1] if rule > 0 else 0), ENDS[rule], -math.inf
    for k in range(first, end):
        highest = max(highest, _height(law.places, k, xx, xy, yy))
    # Where N is least.
    low, high, z = 0.0, HIGHEST, law.fold - min(0.1 * spread, 1.0)
    step, s = math.inf, _sums(law, first, end, z + highest, xx, xy, yy)
    for _ in range(TURNS):
        if s.slope < 0.0:
            low = z
        else:
            high = z
        step = -s.slope / s.bend if s.bend > 0.0 else math.inf
        if not (low < z + step < high or abs(step) < SETTLED):
            step = 0.5 * (low + high) - z
        if abs(step) < SETTLED:
            break
        z += step
        s = _sums(law, first, end, z + highest, xx, xy, yy)
    z, least = z + step, s.net + 0.5 * s.slope * step
    if load > least:
        # The root of the load above the least, nearly linear in z, is taken for an exponential at first.
        wanted, low, high = math.sqrt(load - least), 0.0, z
        z = max(z - math.log1p(GROWTH * wanted * math.sqrt(2.0 / s.bend)) / GROWTH, 0.0)
        for _ in range(TURNS):
            s = _sums(law, first, end, z + highest, xx, xy, yy)
            above = math.sqrt(max(s.net - least, 0.0))
            if s.net > load:
                low = z
            else:
                high = z
            step = 2.0 * above * (wanted - above) / s.slope if s.slope < 0.0 else math.inf
            if not (low < z + step < high or abs(step) < SETTLED):
                step = 0.5 * (low + high) - z
            if abs(step) < SETTLED:
                break
            z += step
    return Grip(s.limit + s.limit_slope * step, load - least - law.pull_off)


@device_no_arrays
def _height(places: FloatArray, k: int, xx: float, xy: float, yy: float) -> float:
    """c at the k-th point."""
    return float(places[k, 0] * xx + places[k, 1] * xy + places[k, 2] * yy)


@device_no_arrays
def _sums(law: FrictionLaw, first: int, end: int, top: float, xx: float, xy: float, yy: float) -> _Sums:
    """N and Q of a part whose face is `top` roughnesses over the middle."""
    net = slope = bend = limit = limit_slope = 0.0
    places, c = law.places, law.per_area
    rows, last = int((NEAR - LEAST) * STEPS), int((NEAR - LEAST) * STEPS) + FAR_STEPS - 1
    for k in range(first, end):
        d, weight = top - _height(places, k, xx, xy, yy), places[k, 3]
        if d < NEAR:
            at = (d - LEAST) * STEPS
            m = max(int(at), 0)
            s = (at - m) / STEPS
            net += weight * (((c[m, 0] * s + c[m, 1]) * s + c[m, 2]) * s + c[m, 3])
            slope += weight * ((3 * c[m, 0] * s + 2 * c[m, 1]) * s + c[m, 2])
            bend += weight * (6 * c[m, 0] * s + 2 * c[m, 1])
            limit += weight * (((c[m, 4] * s + c[m, 5]) * s + c[m, 6]) * s + c[m, 7])
            limit_slope += weight * ((3 * c[m, 4] * s + 2 * c[m, 5]) * s + c[m, 6])
        else:
            over = 1.0 / d
            at = over * (NEAR * FAR_STEPS)
            m = min(rows + int(at), last)
            s = (at - (m - rows)) / (NEAR * FAR_STEPS)
            f = ((c[m, 0] * s + c[m, 1]) * s + c[m, 2]) * s + c[m, 3]
            f_s, f_ss = (3 * c[m, 0] * s + 2 * c[m, 1]) * s + c[m, 2], 6 * c[m, 0] * s + 2 * c[m, 1]
            square = over * over
            net += weight * f * square
            slope -= weight * (f_s * over + 2 * f) * square * over
            bend += weight * ((f_ss * over + 6 * f_s) * over + 6 * f) * square * square
    return _Sums(net, slope, bend, limit, limit_slope)


@jit
def grips(law: FrictionLaw, loads: FloatArray, bends: FloatArray) -> tuple[FloatArray, FloatArray]:
    """`grip` under loads (n,) on surfaces with the second derivatives (n, 3); (n,) each."""
    limits, flat = np.empty(len(loads)), np.empty(len(loads))
    for n in range(len(loads)):
        found = grip(law, loads[n], bends[n, 0], bends[n, 1], bends[n, 2])
        limits[n], flat[n] = found.limit, found.load
    return limits, flat
