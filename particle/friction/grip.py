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
from particle.jit import device_no_arrays, jit, spliced
from particle.types import FloatArray

LEAST, NEAR, HIGHEST = -4.0, 12.0, 8.0  # roughnesses: the table's begin, where asperities end, above any pull-off
STEPS, FAR_STEPS = 128, 96  # intervals of the table in a roughness, and in 1/d from NEAR on
SIDES: Final = 12, 16, 24, 48  # points along a side of the square, and
SPREADS: Final = 2.0, 5.0, 16.0, math.inf  # up to which spread of c they do
TURNS, SETTLED = 60, 1e-6  # Newton's steps, and roughnesses: the next would be the square of that
GROWTH = 1.9  # 1/roughness, of the root of the load above its least


class Grip(NamedTuple):
    """What a contact bears under a load at one place."""

    limit: float  # N, largest friction while sliding
    load: float  # N, as far above pull-off as on a flat surface


class Pressures(NamedTuple):
    """p - a and q [Pa] at a separation, with derivatives by it in roughnesses; or N and Q [N] at a gap."""

    net: float
    slope: float
    bend: float
    limit: float
    limit_slope: float


@spliced
def grip(law: FrictionLaw, load: float, xx: float, xy: float, yy: float) -> Grip:
    """Q under the net normal force `load` [N] on a surface with the second derivatives xx, xy and yy [1/m].

    Beyond pull-off and beyond a closed gap it goes on as it is there.
    """
    return _local_grip(law, load, xx, xy, yy) if law.kind == LOCAL else Grip(friction_limit(law, load), load)


@device_no_arrays
def _local_grip(law: FrictionLaw, load: float, xx: float, xy: float, yy: float) -> Grip:
    """`grip` of a rough contact, point by point."""
    spread = spread_of(law, xx, xy, yy)
    if not spread < math.inf:  # off the plate
        return Grip(friction_limit(law, load), load)
    first, end = rule_for(law, spread)
    highest = -math.inf
    for k in range(first, end):
        highest = max(highest, _height(law.places, k, xx, xy, yy))
    # Where N is least.
    low, high, z = 0.0, HIGHEST, law.fold - min(0.1 * spread, 1.0)
    step, s = math.inf, sums(law, first, end, z + highest, xx, xy, yy)
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
        s = sums(law, first, end, z + highest, xx, xy, yy)
    z, least = z + step, s.net + 0.5 * s.slope * step
    if load > least:
        # The root of the load above the least, nearly linear in z, is taken for an exponential at first.
        wanted, low, high = math.sqrt(load - least), 0.0, z
        z = max(z - math.log1p(GROWTH * wanted * math.sqrt(2.0 / s.bend)) / GROWTH, 0.0)
        for _ in range(TURNS):
            s = sums(law, first, end, z + highest, xx, xy, yy)
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
def spread_of(law: FrictionLaw, xx: float, xy: float, yy: float) -> float:
    """The largest c under the face, in roughnesses, or somewhat more."""
    corner = law.places[len(law.places) - 1]
    return float(corner[0] * abs(xx) + corner[1] * abs(xy) + corner[2] * abs(yy))


@device_no_arrays
def rule_for(law: FrictionLaw, spread: float) -> tuple[int, int]:
    """The first place of the rule for a spread of c, and the place after its last."""
    rule = 0
    while spread > SPREADS[rule]:
        rule += 1
    return (int(law.ends[rule - 1]) if rule > 0 else 0), int(law.ends[rule])


@device_no_arrays
def _height(places: FloatArray, k: int, xx: float, xy: float, yy: float) -> float:
    """c at the k-th point."""
    return float(places[k, 0] * xx + places[k, 1] * xy + places[k, 2] * yy)


@device_no_arrays
def sums(law: FrictionLaw, first: int, end: int, top: float, xx: float, xy: float, yy: float) -> Pressures:
    """N and Q of a part whose face is `top` roughnesses over the middle, and their derivatives by the gap."""
    net = slope = bend = limit = limit_slope = 0.0
    for k in range(first, end):
        weight, p = law.places[k, 3], pressures(law, top - _height(law.places, k, xx, xy, yy))
        net += weight * p.net
        slope += weight * p.slope
        bend += weight * p.bend
        limit += weight * p.limit
        limit_slope += weight * p.limit_slope
    return Pressures(net, slope, bend, limit, limit_slope)


@device_no_arrays
def pressures(law: FrictionLaw, d: float) -> Pressures:
    """p - a and q at a separation of d roughnesses, from `law.per_area`."""
    c, rows = law.per_area, int((NEAR - LEAST) * STEPS)
    if d < NEAR:
        at = (d - LEAST) * STEPS
        m = max(int(at), 0)
        s = (at - m) / STEPS
        return Pressures(
            ((c[m, 0] * s + c[m, 1]) * s + c[m, 2]) * s + c[m, 3],
            (3 * c[m, 0] * s + 2 * c[m, 1]) * s + c[m, 2],
            6 * c[m, 0] * s + 2 * c[m, 1],
            ((c[m, 4] * s + c[m, 5]) * s + c[m, 6]) * s + c[m, 7],
            (3 * c[m, 4] * s + 2 * c[m, 5]) * s + c[m, 6],
        )
    over = 1.0 / d
    at = over * (NEAR * FAR_STEPS)
    m = min(rows + int(at), rows + FAR_STEPS - 1)
    s = (at - (m - rows)) / (NEAR * FAR_STEPS)
    f = ((c[m, 0] * s + c[m, 1]) * s + c[m, 2]) * s + c[m, 3]
    f_s, f_ss = (3 * c[m, 0] * s + 2 * c[m, 1]) * s + c[m, 2], 6 * c[m, 0] * s + 2 * c[m, 1]
    square = over * over
    return Pressures(
        f * square,
        -(f_s * over + 2 * f) * square * over,
        ((f_ss * over + 6 * f_s) * over + 6 * f) * square * square,
        *(0.0, 0.0),
    )


@jit
def grips(law: FrictionLaw, loads: FloatArray, bends: FloatArray) -> tuple[FloatArray, FloatArray]:
    """`grip` under loads (n,) on surfaces with the second derivatives (n, 3); (n,) each."""
    limits, flat = np.empty(len(loads)), np.empty(len(loads))
    for n in range(len(loads)):
        found = grip(law, loads[n], bends[n, 0], bends[n, 1], bends[n, 2])
        limits[n], flat[n] = found.limit, found.load
    return limits, flat
