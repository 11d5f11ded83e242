"""The gap between a face and a bent surface, with the film of air in it.

With H the second derivatives of the surface under the face, z roughnesses from its middle to that of the face, sigma
the roughness and psi_i the functions of the pressure,

    h(r) = offset + z sigma - r.H r/2,     p = p_a (1 + sum_i a_i psi_i),     c_i = <psi_i h p/p_a>

where <.> is the mean over the face. The contents c follow the flow,

    c_i' = -<grad psi_i . k p grad p>/p_a,     k = h^3 Qbar/(12 mu),

and the gap follows from them and from the load N, which asperities and film bear together:

    N_c(z) + p_a A sum_i <psi_i> a_i = N,     sum_j <psi_i psi_j h> a_j = c_i - <psi_i h>.

With its contents given the film is a stiff spring. Where it is stiffer than the asperities pull z is unique.

Asperities that are not `bends` meet a flat surface instead, z roughnesses below the face, on which their load is that
on the bent one if it falls as exp(-z sigma/lambda):

    h(r) = offset + z sigma + plane - r.H r/2,     plane = lambda ln <exp(r.H r/(2 lambda))>,

the mean height of a surface that bends little, and nearly its top where that stands out by several lambda.
"""

from __future__ import annotations

import math
from typing import Annotated

from particle.air import POWER
from particle.film.film import FUNCTIONS, Layer
from particle.friction import FrictionLaw, friction_limit, pressures, rule_for, spread_of, sums
from particle.jit import device_no_arrays
from particle.modes import Verdict
from particle.records import Record
from particle.types import FloatArray

TURNS, SETTLED = 100, 1e-6  # Newton's steps, and roughnesses: the next would be the square of that
TRUST = 3e-5  # roughnesses, over which the asperities' load is a parabola
LEAST = 0.05  # roughnesses, of the gap at the nearest point
FARTHEST = 100.0  # roughnesses at the nearest point: where a film holds nothing, and the part's own inertia counts
WALK = 0.05, 9.0  # roughnesses: steps in which the gap at rest is looked for, and over the nearest point, to where
THIN = 1e-6  # of the pressure around, the least in a flow


class Gap(Record):
    """The gap at one moment."""

    xx: float  # 1/m, second derivatives of the surface
    xy: float
    yy: float
    z: float  # roughnesses, between the middles of face and surface
    near: float  # roughnesses, at the nearest point
    width: float  # m, the mean gap
    plane: (
        float  # m, over the middle of the surface, what flat asperities meet, and its derivatives by xx, xy, yy [m^2]
    )
    by_xx: float
    by_xy: float
    by_yy: float
    load: float  # N, of the asperities
    limit: float  # N, of friction while sliding
    air: float  # N, of the film
    slope: float  # N, by which both loads change with z
    rise: float  # N, by which that of the asperities does
    slowing: float  # m/s^2, of the slip
    demand: float  # N, the friction that a part at rest needs
    normal: float  # N, on the part
    speed: float  # m/s, of the slip
    pull_x: float  # m/s^2, the part's acceleration without friction
    pull_y: float
    verdict: int  # GOES_ON, or why there is no such gap
    at: float  # roughnesses, the z of the asperities' forces that follow, on a surface with these second derivatives
    at_xx: float
    at_xy: float
    at_yy: float
    net: float  # N, and its first two derivatives by z
    net_slope: float
    net_bend: float
    borne: float  # N, their friction limit, and its derivative
    borne_slope: float
    excess: Annotated[FloatArray, FUNCTIONS]  # a
    change: Annotated[FloatArray, FUNCTIONS]  # of a with z
    matrix: Annotated[FloatArray, FUNCTIONS, FUNCTIONS]  # <psi_i psi_j h>, then its factors


@device_no_arrays
def fill_gap(layer: Layer, law: FrictionLaw, contents: FloatArray, load: float, g: Gap) -> None:
    """The gap of a film with the contents c (FUNCTIONS,) [m] under a load [N], near g.z, into `g`.

    Where the load closes the gap or no gap is wide enough g.verdict says so.
    """
    over = _fill_plane(layer, g)
    lowest = max(layer.closed + (over if layer.bends else 0.0), over + LEAST - layer.offset / layer.law.roughness)
    low, high, z, step = -math.inf, math.inf, max(g.z, lowest), 0.0
    net = net_slope = off = 0.0
    g.verdict = Verdict.GOES_ON
    for _ in range(TURNS):
        if not (abs(z - g.at) <= TRUST and g.xx == g.at_xx and g.xy == g.at_xy and g.yy == g.at_yy):
            fill_asperities(layer, z, g)
        _fill_film(layer, contents, z, g)
        off = z - g.at
        net, net_slope = g.net + off * (g.net_slope + 0.5 * off * g.net_bend), g.net_slope + off * g.net_bend
        above, slope = net + g.air - load, net_slope + g.slope
        if above > 0.0:
            low = z
        else:
            high = z
        if z == lowest and above <= 0.0:
            g.verdict, step = Verdict.OVERLOADED, 0.0
            break
        if above > 0.0 and z - over > FARTHEST:
            g.verdict, step = Verdict.DETACHED, 0.0
            break
        step = -above / slope if slope < 0.0 else math.inf
        if low == -math.inf and not z + step > lowest:
            step = lowest - z
        elif high == math.inf:
            step = min(step, 1.0 + abs(z))
        elif not low < z + step < high:
            step = 0.5 * (max(low, lowest) + high) - z
        if abs(step) < SETTLED:
            break
        z += step
    for i in range(FUNCTIONS):
        g.excess[i] += step * g.change[i]
    g.z, g.near = z + step, z + step - over
    g.load, g.air = net + step * net_slope, g.air + step * g.slope
    g.slope, g.rise = g.slope + net_slope, net_slope
    if g.near > FARTHEST:
        g.verdict = Verdict.DETACHED
    g.width = _middle(layer, g.z, g) - _mean_rise(layer, g)
    fill_limit(layer, law, off + step, g)


@device_no_arrays
def fill_limit(layer: Layer, law: FrictionLaw, ahead: float, g: Gap) -> None:
    """Friction's limit at g.z, `ahead` [roughnesses] of where asperities were looked at, under g.load, into g.limit."""
    if layer.grips:
        g.limit = g.borne + ahead * g.borne_slope
    elif g.z > layer.law.fold and law.pull_off < math.inf:
        g.limit = 0.0  # beyond pull-off, where the law ends and the same load comes again
    else:
        g.limit = friction_limit(law, g.load)


@device_no_arrays
def fill_gap_at_rest(layer: Layer, load: float, contents: FloatArray, g: Gap) -> None:
    """The contents c of a film at the pressure around, under a load [N], and z into `g`; g.verdict: there is none."""
    over = _fill_plane(layer, g)
    top = over if layer.bends else 0.0
    low = z = max(layer.closed + top, over + LEAST - layer.offset / layer.law.roughness)
    g.verdict = Verdict.GOES_ON if _load_at(layer, z, g) >= load else Verdict.OVERLOADED
    while g.verdict == Verdict.GOES_ON and _load_at(layer, z, g) > load:
        low, z = z, z + WALK[0]
        if z > top + WALK[1]:
            g.verdict = Verdict.DETACHED
    high = z
    while high - low > 1e-14 * high:
        z = 0.5 * (low + high)
        if z <= low or z >= high:
            break
        if _load_at(layer, z, g) > load:
            low = z
        else:
            high = z
    g.z = z
    for i in range(FUNCTIONS):
        contents[i] = _mean(layer, i, z, g)


@device_no_arrays
def fill_flow(layer: Layer, g: Gap, rate: FloatArray) -> None:
    """c' [m/s] into `rate` (FUNCTIONS,)."""
    for i in range(FUNCTIONS):
        rate[i] = 0.0
    unit = layer.pressure / (12.0 * layer.viscosity * layer.half * layer.half)
    middle = _middle(layer, g.z, g)
    for k in range(len(layer.places)):
        values, slopes, place = layer.values[k], layer.slopes[k], layer.places[k]
        p, p_x, p_y = 1.0, 0.0, 0.0
        for i in range(FUNCTIONS):
            p += g.excess[i] * values[i]
            p_x += g.excess[i] * slopes[0, i]
            p_y += g.excess[i] * slopes[1, i]
        p, h = max(p, THIN), middle - place[0] * g.xx - place[1] * g.xy - place[2] * g.yy
        flow = place[3] * unit * h * h * h * p * (1.0 + layer.rarefied * (p * h) ** -POWER)
        for i in range(FUNCTIONS):
            rate[i] -= flow * (slopes[0, i] * p_x + slopes[1, i] * p_y)


@device_no_arrays
def stored(layer: Layer, g: Gap) -> float:
    """p_a A/2 sum a_i a_j <psi_i psi_j h> [J], what the film stores."""
    middle = _middle(layer, g.z, g)
    return 0.5 * layer.pressure * layer.area * _quadratic(layer, middle, g.xx, g.xy, g.yy, g)


@device_no_arrays
def pumped(layer: Layer, z: float, xx: float, xy: float, yy: float, g: Gap) -> float:
    """-int (p - p_a) (1 + (p/p_a - 1)/2) h_t dA [W], the work of the gap on the film, as z, xx, ... change at rates."""
    rise, total, m = z * layer.law.roughness + g.by_xx * xx + g.by_xy * xy + g.by_yy * yy, 0.0, layer.means
    for i in range(FUNCTIONS):
        total += g.excess[i] * (m[0, i] * rise - m[1, i] * xx - m[2, i] * xy - m[3, i] * yy)
    return -layer.pressure * layer.area * (total + 0.5 * _quadratic(layer, rise, xx, xy, yy, g))


@device_no_arrays
def _quadratic(layer: Layer, rise: float, xx: float, xy: float, yy: float, g: Gap) -> float:
    """sum a_i a_j <psi_i psi_j (rise - x^2/2 xx - x y xy - y^2/2 yy)>."""
    total, m = 0.0, layer.products
    for i in range(FUNCTIONS):
        for j in range(FUNCTIONS):
            mean = m[0, i, j] * rise - m[1, i, j] * xx - m[2, i, j] * xy - m[3, i, j] * yy
            total += g.excess[i] * g.excess[j] * mean
    return total


@device_no_arrays
def _middle(layer: Layer, z: float, g: Gap) -> float:
    """The gap [m] over the middle of the surface."""
    return float(layer.offset + z * layer.law.roughness + g.plane)


@device_no_arrays
def fill_separation(layer: Layer, g: Gap) -> None:
    """z of the mean gap g.width into `g`."""
    _fill_plane(layer, g)
    g.z = (g.width + _mean_rise(layer, g) - layer.offset - g.plane) / layer.law.roughness


@device_no_arrays
def _mean_rise(layer: Layer, g: Gap) -> float:
    """<r.H r/2> [m]."""
    mean = layer.heights
    return float(mean[0] * g.xx + mean[1] * g.xy + mean[2] * g.yy)


@device_no_arrays
def _fill_plane(layer: Layer, g: Gap) -> float:
    """The plane that flat asperities meet, into `g`; returns how far the surface rises over it, in roughnesses."""
    g.plane = g.by_xx = g.by_xy = g.by_yy = 0.0
    if layer.bends:
        return _highest(layer, g) / layer.law.roughness
    places, most, total = layer.places, -math.inf, 0.0
    for k in range(len(places)):
        most = max(most, places[k, 0] * g.xx + places[k, 1] * g.xy + places[k, 2] * g.yy)
    for k in range(len(places)):
        rise = places[k, 0] * g.xx + places[k, 1] * g.xy + places[k, 2] * g.yy
        weight = places[k, 3] * math.exp((rise - most) / layer.decay)
        total += weight
        g.by_xx += weight * places[k, 0]
        g.by_xy += weight * places[k, 1]
        g.by_yy += weight * places[k, 2]
    g.plane = most + layer.decay * math.log(total)
    g.by_xx, g.by_xy, g.by_yy = g.by_xx / total, g.by_xy / total, g.by_yy / total
    return (most - g.plane) / layer.law.roughness


@device_no_arrays
def _highest(layer: Layer, g: Gap) -> float:
    """The most [m] that the surface rises over its middle within a square."""
    xx, xy, yy = g.xx, abs(g.xy), g.yy
    most = max(xx + yy + 2 * xy, 0.0)  # at a corner, in the middle, and below along a side
    if yy < 0.0 and xy < -yy:
        most = max(most, xx - xy * xy / yy)
    if xx < 0.0 and xy < -xx:
        most = max(most, yy - xy * xy / xx)
    return 0.5 * layer.half * layer.half * most


@device_no_arrays
def _mean(layer: Layer, i: int, z: float, g: Gap) -> float:
    """<psi_i h> [m]."""
    m, middle = layer.means, _middle(layer, z, g)
    return float(m[0, i] * middle - m[1, i] * g.xx - m[2, i] * g.xy - m[3, i] * g.yy)


@device_no_arrays
def fill_asperities(layer: Layer, z: float, g: Gap) -> None:
    """N_c and Q [N] at z, with derivatives by it, into `g`."""
    law = layer.law
    spread = spread_of(law, g.xx, g.xy, g.yy) if layer.bends else 0.0
    g.at, g.at_xx, g.at_xy, g.at_yy = z, g.xx, g.xy, g.yy
    if spread == 0.0:
        p, area = pressures(law, z), layer.area
        g.net, g.net_slope, g.net_bend = area * p.net, area * p.slope, area * p.bend
        g.borne, g.borne_slope = area * p.limit, area * p.limit_slope
        return
    first, end = rule_for(law, spread)
    p = sums(law, first, end, z, g.xx, g.xy, g.yy)
    g.net, g.net_slope, g.net_bend, g.borne, g.borne_slope = p.net, p.slope, p.bend, p.limit, p.limit_slope


@device_no_arrays
def _load_at(layer: Layer, z: float, g: Gap) -> float:
    """N_c [N] at z."""
    fill_asperities(layer, z, g)
    return float(g.net)


@device_no_arrays
def _fill_film(layer: Layer, contents: FloatArray, z: float, g: Gap) -> None:
    """a and its derivative by z, the film's load and its slope, into `g`."""
    roughness, m, c = layer.law.roughness, g.matrix, layer.products
    middle = _middle(layer, z, g)
    for i in range(FUNCTIONS):
        for j in range(i + 1):
            m[i, j] = c[0, i, j] * middle - c[1, i, j] * g.xx - c[2, i, j] * g.xy - c[3, i, j] * g.yy
        for j in range(i + 1):  # Cholesky's factors
            for k in range(j):
                m[i, j] -= m[i, k] * m[j, k]
            m[i, j] = m[i, j] / m[j, j] if j < i else math.sqrt(m[i, i])
        g.excess[i] = contents[i] - _mean(layer, i, z, g)
    _divide(m, g.excess)
    g.air = g.slope = 0.0
    for i in range(FUNCTIONS):
        g.change[i] = layer.means[0, i]
        for j in range(FUNCTIONS):
            g.change[i] += c[0, i, j] * g.excess[j]
        g.change[i] *= -roughness
    _divide(m, g.change)
    for i in range(FUNCTIONS):
        g.air += layer.pressure * layer.area * layer.means[0, i] * g.excess[i]
        g.slope += layer.pressure * layer.area * layer.means[0, i] * g.change[i]


@device_no_arrays
def _divide(m: FloatArray, out: FloatArray) -> None:
    """M^-1 times a vector, in place, by the factors of M."""
    for i in range(FUNCTIONS):
        for k in range(i):
            out[i] -= m[i, k] * out[k]
        out[i] /= m[i, i]
    for i in range(FUNCTIONS - 1, -1, -1):
        for k in range(i + 1, FUNCTIONS):
            out[i] -= m[k, i] * out[k]
        out[i] /= m[i, i]
