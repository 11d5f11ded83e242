"""The surface under a face: its local polynomials, one for each cell that the face touches, and averages over it.

With the place P(X, t) = (X + u, w) of a point X of the mid-plane and the points X_k = X + R(theta) rho_k under the
face, the plane of least squares through P(X_k) has the origin P_0 = <P> and the edges a_i = S^-1 <rho_i P>. Both are
linear in P, so their derivatives by x, y, theta and t are the same averages of derivatives of P.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

from particle.body.face import Face
from particle.jit import device_no_arrays, spliced
from particle.surface import (
    UNBUILT,
    Jet,
    LocalSurface,
    Surface,
    allow_bridges,
    cell_at,
    enter,
    height_here,
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


@device_no_arrays
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
def enter_all(
    surface: Surface,
    locals_: LocalSurface,
    slots: IntArray,
    face: Face,
    x: float,
    y: float,
    heading: float,
    time: float,
    end: float,
    bridged: tuple[float, float],
) -> tuple[int, float]:
    """Prepare for a face at (x, y) [m] from `time` [s] on: a cell, NOWHERE or UNBUILT; when [s] the first span ends.

    slots: (n,) which local surface each point of the face has from then on.
    """
    cosine, sine = math.cos(heading), math.sin(heading)
    until = end
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
    return 0, until


@device_no_arrays
def within_cells(locals_: LocalSurface, slots: IntArray, face: Face, x: float, y: float, heading: float) -> bool:
    """Whether all points of a face at (x, y) [m] lie where their cells' polynomials hold."""
    cosine, sine = math.cos(heading), math.sin(heading)
    for k in range(len(face.places)):
        p, q = face.places[k, 0], face.places[k, 1]
        if not within_frame(locals_.frame[slots[k]], x + cosine * p - sine * q, y + sine * p + cosine * q):
            return False
    return True


@device_no_arrays
def fill_averages(
    locals_: LocalSurface, slots: IntArray, face: Face, x: float, y: float, heading: float, time: float, out: FloatArray
) -> None:
    """P_0, a_1 and a_2 and their derivatives, (15, 9), of a face at (x, y) [m]."""
    cosine, sine = math.cos(heading), math.sin(heading)
    for i in range(ROWS):
        for j in range(PLACE):
            out[i, j] = 0.0
    # Of (X + R rho, 0).
    out[AT, 0], out[AT, 1], out[AT, 3], out[AT, 4], out[AT, 6], out[AT, 7] = x, y, cosine, sine, -sine, cosine
    out[X, 0] = out[Y, 1] = 1.0
    out[BY, 3], out[BY, 4], out[BY, 6], out[BY, 7] = -sine, cosine, -cosine, -sine
    out[BY_BY, 3], out[BY_BY, 4], out[BY_BY, 6], out[BY_BY, 7] = -cosine, -sine, sine, -cosine
    stretches = locals_.frame[0].in_plane > 0
    for k in range(len(face.places)):
        if slots[k] == k:
            set_time(local_of(locals_, k), time)
    local, last = local_of(locals_, 0), 0
    for k in range(len(face.places)):
        if slots[k] != last:
            local, last = local_of(locals_, slots[k]), slots[k]
        rho_1, rho_2 = face.places[k, 0], face.places[k, 1]
        r_x, r_y = cosine * rho_1 - sine * rho_2, sine * rho_1 + cosine * rho_2
        weight = face.weights[k]
        w_1 = weight * (face.unmoments[0, 0] * rho_1 + face.unmoments[0, 1] * rho_2)
        w_2 = weight * (face.unmoments[1, 0] * rho_1 + face.unmoments[1, 1] * rho_2)
        _add(out, 2, weight, w_1, w_2, r_x, r_y, height_here(local, x + r_x, y + r_y))
        if stretches:
            for along in range(2):
                _add(out, along, weight, w_1, w_2, r_x, r_y, plane_jet(local, along, x + r_x, y + r_y))


@spliced
def _add(out: FloatArray, along: int, w: float, w_1: float, w_2: float, r_x: float, r_y: float, f: Jet) -> None:
    """Add a point's share, along x, y or z, with the weights of P_0, a_1 and a_2."""
    turn_x, turn_y = -r_y * f.xx + r_x * f.xy, -r_y * f.xy + r_x * f.yy
    _put(out[AT], along, w, w_1, w_2, f.f)
    _put(out[T], along, w, w_1, w_2, f.t)
    _put(out[TT], along, w, w_1, w_2, f.tt)
    _put(out[X], along, w, w_1, w_2, f.x)
    _put(out[Y], along, w, w_1, w_2, f.y)
    _put(out[BY], along, w, w_1, w_2, -r_y * f.x + r_x * f.y)
    _put(out[XT], along, w, w_1, w_2, f.xt)
    _put(out[YT], along, w, w_1, w_2, f.yt)
    _put(out[BY_T], along, w, w_1, w_2, -r_y * f.xt + r_x * f.yt)
    _put(out[XX], along, w, w_1, w_2, f.xx)
    _put(out[XY], along, w, w_1, w_2, f.xy)
    _put(out[YY], along, w, w_1, w_2, f.yy)
    _put(out[X_BY], along, w, w_1, w_2, turn_x)
    _put(out[Y_BY], along, w, w_1, w_2, turn_y)
    _put(out[BY_BY], along, w, w_1, w_2, -r_y * turn_x + r_x * turn_y - r_x * f.x - r_y * f.y)


@spliced
def _put(row: FloatArray, along: int, w: float, w_1: float, w_2: float, value: float) -> None:
    """Add a value to a row."""
    row[along] += w * value
    row[3 + along] += w_1 * value
    row[6 + along] += w_2 * value
