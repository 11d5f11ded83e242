"""The surface under a face: its local polynomials, one for each cell that the face touches, and averages over it.

With the place P(X, t) = (X + u, w) of a point X of the mid-plane and the points X_k = X + R(theta) rho_k under the
face, the plane of least squares through P(X_k) has the origin P_0 = <P> and the edges a_i = S^-1 <rho_i P>. Both are
linear in P, so their derivatives by x, y, theta and t are the same averages of derivatives of P.
"""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np

from particle.body.face import Face
from particle.jit import device_no_arrays, inlined, spliced
from particle.lanes import LANES, load, store
from particle.surface import (
    UNBUILT,
    Jet,
    LocalSurface,
    Surface,
    allow_bridges,
    cell_at,
    enter,
    height_here,
    jet,
    new_local,
    plane_jet,
    prepare,
    set_time,
    within_frame,
)
from particle.types import FloatArray, IntArray

# Rows of averages: P and its derivatives; `BY` is that by theta, along z x R rho.
AT, T, TT, X, Y, BY, XT, YT, BY_T, XX, XY, YY, X_BY, Y_BY, BY_BY = range(15)
ROWS: Final = 15
PLACE = 9  # columns: P_0, a_1 and a_2, each along x, y and z


def new_locals(surface: Surface, count: int) -> LocalSurface:
    """Scratch memory for so many cells: that of `new_local`, with an axis in front."""
    one = new_local(surface)
    stacked: Any = (np.stack([array] * count) for array in one[1:])
    return LocalSurface(one.frame.repeat(count), *stacked)


def prepare_locals(surface: Surface, locals_: LocalSurface) -> None:
    """Make the scratch memory as good as new."""
    for k in range(len(locals_.frame)):
        prepare(surface, LocalSurface(locals_.frame[k : k + 1], *(array[k] for array in locals_[1:])))


class Under(NamedTuple):
    """How the points of a face share cells: in groups of as many as there are lanes."""

    slots: IntArray  # (n,) which local surface each point has
    groups: IntArray  # (n + 1,) which each group has; -1 after the last
    places: FloatArray  # (5, LANES n) of groups: rho [m], and weights of P_0, a_1 and a_2, 0 in lanes to spare
    sums: FloatArray  # (15, 9, LANES) averages, not yet added up
    placed: FloatArray  # (4,) x, y, heading and time of the last averages; time nan: there are none


def new_under(count: int) -> Under:
    """Scratch memory for so many points."""
    slots, groups = np.zeros(count, dtype=np.int64), np.zeros(count + 1, dtype=np.int64)
    places, sums = np.zeros((5, LANES * count)), np.zeros((ROWS, PLACE, LANES))
    return Under(slots, groups, places, sums, np.full(4, math.nan))


@spliced
def local_of(locals_: LocalSurface, k: int) -> LocalSurface:
    """The k-th of them."""
    return LocalSurface(
        locals_.frame[k : k + 1],
        locals_.clock[k],
        locals_.pieces[k],
        locals_.smooth[k],
        locals_.at[k],
        locals_.sources[k],
        locals_.base[k],
        locals_.plane[k],
        locals_.plane_at[k],
        locals_.ahead[k],
    )


@device_no_arrays
def forget(under: Under) -> None:
    """Have the next averages be made anew."""
    under.placed[3] = math.nan


@device_no_arrays
def enter_all(
    surface: Surface,
    locals_: LocalSurface,
    under: Under,
    face: Face,
    x: float,
    y: float,
    heading: float,
    time: float,
    end: float,
    bridged: tuple[float, float],
) -> tuple[int, float]:
    """Prepare for a face at (x, y) [m] from `time` [s] on: a cell, NOWHERE or UNBUILT; when [s] the first span ends."""
    cosine, sine = math.cos(heading), math.sin(heading)
    until, slots = end, under.slots
    forget(under)
    for k in range(len(face.places)):
        p, q = face.places[k, 0], face.places[k, 1]
        p, q = x + cosine * p - sine * q, y + sine * p + cosine * q
        cell, slots[k] = cell_at(surface.cells, p, q), k
        for j in range(k):
            if slots[j] == j and locals_.frame[j].cell == cell and cell >= 0:
                slots[k] = j
                break
        if slots[k] == k:
            local = local_of(locals_, k)
            allow_bridges(local, bridged[0], bridged[1])
            cell = enter(surface, local, p, q, time, end)
            if cell == UNBUILT:
                locals_.frame[0].missing_x, locals_.frame[0].missing_y = p, q
            if cell < 0:
                return cell, until
            until = min(until, local.frame[0].end)
    _group(face, under)
    return 0, until


@inlined
def _group(face: Face, under: Under) -> None:
    """Sort the face's points into groups by their slots."""
    slots, out, count, lane = under.slots, under.places, 0, 0
    for slot in range(len(slots)):
        if slots[slot] != slot:
            continue
        lane = LANES
        for k in range(slot, len(slots)):
            if slots[k] != slot:
                continue
            if lane == LANES:
                under.groups[count], count, lane = slot, count + 1, 0
                for spare in range(LANES * (count - 1), LANES * count):
                    out[0, spare], out[1, spare] = face.places[k, 0], face.places[k, 1]
                    out[2, spare] = out[3, spare] = out[4, spare] = 0.0
            at, lane = LANES * (count - 1) + lane, lane + 1
            p, q, weight = face.places[k, 0], face.places[k, 1], face.weights[k]
            out[0, at], out[1, at], out[2, at] = p, q, weight
            for i in range(2):
                out[3 + i, at] = weight * (face.unmoments[i, 0] * p + face.unmoments[i, 1] * q)
    under.groups[count] = -1


@device_no_arrays
def within_cells(locals_: LocalSurface, under: Under, face: Face, x: float, y: float, heading: float) -> bool:
    """Whether all points of a face at (x, y) [m] lie where their cells' polynomials hold."""
    cosine, sine = math.cos(heading), math.sin(heading)
    for k in range(len(face.places)):
        p, q = face.places[k, 0], face.places[k, 1]
        if not within_frame(locals_.frame[under.slots[k]], x + cosine * p - sine * q, y + sine * p + cosine * q):
            return False
    return True


@device_no_arrays
def fill_averages(
    locals_: LocalSurface, under: Under, x: float, y: float, heading: float, time: float, out: FloatArray
) -> bool:
    """P_0, a_1 and a_2 and their derivatives, (15, 9), of a face at (x, y) [m]; False where `out` has them already."""
    sums, places, placed = under.sums, under.places, under.placed
    if time == placed[3] and x == placed[0] and y == placed[1] and heading == placed[2]:
        return False
    placed[0], placed[1], placed[2], placed[3] = x, y, heading, time
    cosine, sine = math.cos(heading), math.sin(heading)
    for i in range(ROWS):
        for j in range(PLACE):
            out[i, j] = 0.0
            for lane in range(LANES):
                sums[i, j, lane] = 0.0
    # Of (X + R rho, 0).
    out[AT, 0], out[AT, 1], out[AT, 3], out[AT, 4], out[AT, 6], out[AT, 7] = x, y, cosine, sine, -sine, cosine
    out[X, 0] = out[Y, 1] = 1.0
    out[BY, 3], out[BY, 4], out[BY, 6], out[BY, 7] = -sine, cosine, -cosine, -sine
    out[BY_BY, 3], out[BY_BY, 4], out[BY_BY, 6], out[BY_BY, 7] = -cosine, -sine, sine, -cosine
    stretches = locals_.frame[0].in_plane > 0
    for group in range(len(under.groups)):
        slot = under.groups[group]
        if slot < 0:
            break
        local, first = local_of(locals_, slot), LANES * group
        set_time(local, time)
        rho_1, rho_2 = load(places[0], first), load(places[1], first)
        w, w_1, w_2 = load(places[2], first), load(places[3], first), load(places[4], first)
        r_x, r_y = cosine * rho_1 - sine * rho_2, sine * rho_1 + cosine * rho_2
        _add(sums, 2, w, w_1, w_2, r_x, r_y, height_here(local, x + r_x, y + r_y, jet))
        if stretches:
            for along in range(2):
                _add(sums, along, w, w_1, w_2, r_x, r_y, plane_jet(local, along, x + r_x, y + r_y, jet))
    for i in range(ROWS):
        for j in range(PLACE):
            for lane in range(LANES):
                out[i, j] += sums[i, j, lane]
    return True


@spliced
def _add(sums: FloatArray, along: int, w: Any, w_1: Any, w_2: Any, r_x: Any, r_y: Any, f: Jet) -> None:
    """Add a group's share, along x, y or z, with the weights of P_0, a_1 and a_2."""
    turn_x, turn_y = r_x * f.xy - r_y * f.xx, r_x * f.yy - r_y * f.xy
    _put(sums[AT], along, w, w_1, w_2, f.f)
    _put(sums[T], along, w, w_1, w_2, f.t)
    _put(sums[TT], along, w, w_1, w_2, f.tt)
    _put(sums[X], along, w, w_1, w_2, f.x)
    _put(sums[Y], along, w, w_1, w_2, f.y)
    _put(sums[BY], along, w, w_1, w_2, r_x * f.y - r_y * f.x)
    _put(sums[XT], along, w, w_1, w_2, f.xt)
    _put(sums[YT], along, w, w_1, w_2, f.yt)
    _put(sums[BY_T], along, w, w_1, w_2, r_x * f.yt - r_y * f.xt)
    _put(sums[XX], along, w, w_1, w_2, f.xx)
    _put(sums[XY], along, w, w_1, w_2, f.xy)
    _put(sums[YY], along, w, w_1, w_2, f.yy)
    _put(sums[X_BY], along, w, w_1, w_2, turn_x)
    _put(sums[Y_BY], along, w, w_1, w_2, turn_y)
    _put(sums[BY_BY], along, w, w_1, w_2, r_x * turn_y - r_y * turn_x - r_x * f.x - r_y * f.y)


@spliced
def _put(row: FloatArray, along: int, w: Any, w_1: Any, w_2: Any, value: Any) -> None:
    """Add lanes to a row (9, LANES)."""
    store(row[along], 0, load(row[along], 0) + w * value)
    store(row[3 + along], 0, load(row[3 + along], 0) + w_1 * value)
    store(row[6 + along], 0, load(row[6 + along], 0) + w_2 * value)
