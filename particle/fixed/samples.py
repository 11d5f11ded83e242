"""Samples between the rows of a path by fixed steps: cubics through places and velocities, on the true surface."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from particle.events import COLUMNS, DISSIPATED, MODE, RESTING, TIME, V_X, V_Y, WORK, Part, X, Y
from particle.fixed.steps import fixed_row
from particle.jit import jit
from particle.surface import UNBUILT, enter, new_local

FloatArray = NDArray[np.float64]


@jit
def between(
    surface: Any, part: Part, scheme: int, rows: FloatArray, times: FloatArray
) -> tuple[FloatArray, NDArray[np.bool_]]:
    """The rows (k, COLUMNS) at ascending times (k,) [s], and (k,) which of them are where a cell is lacking.

    Place and velocity are those of the cubic Hermite polynomial between two rows, work and dissipation are linear
    between them, and height, forces, kinetic and potential energy are those of the surface there. Where there is no
    surface, as over a hole that one step has jumped, these are as in the row before.
    """
    out, missing = np.zeros((len(times), COLUMNS)), np.zeros(len(times), dtype=np.bool_)
    state, local, row = np.zeros(8), new_local(surface), 0
    for k in range(len(times)):
        while row + 1 < len(rows) and rows[row + 1, TIME] <= times[k]:
            row += 1
        out[k] = rows[row]
        if times[k] <= rows[row, TIME] or row + 1 == len(rows):
            continue
        _hermite(rows[row], rows[row + 1], times[k], state)
        # Steps, and the cubic between rows that are far apart, may pass over cells where no step began or ended.
        cell = enter(surface, local, state[0], state[1], times[k], math.inf)
        missing[k] = cell == UNBUILT
        if cell >= 0:
            out[k] = fixed_row(local, part, scheme, int(rows[row, MODE]), times[k], state)
        else:
            out[k, TIME], out[k, X], out[k, Y] = times[k], state[0], state[1]
            out[k, V_X], out[k, V_Y] = state[2], state[3]
            out[k, WORK], out[k, DISSIPATED] = state[4], state[5]
    return out, missing


@jit
def _hermite(one: FloatArray, other: FloatArray, time: float, state: FloatArray) -> None:
    """x, y, v_x, v_y, work and dissipation at a time [s] between two rows into `state`."""
    h = other[TIME] - one[TIME]
    s = (time - one[TIME]) / h
    state[4] = one[WORK] + s * (other[WORK] - one[WORK])
    state[5] = one[DISSIPATED] + s * (other[DISSIPATED] - one[DISSIPATED])
    state[0], state[1], state[2], state[3] = one[X], one[Y], 0.0, 0.0
    if one[MODE] == RESTING:
        return
    for i, x, v in ((0, X, V_X), (1, Y, V_Y)):
        rise, v_0, v_1 = other[x] - one[x], one[v], other[v]
        bend, twist = 3 * rise - h * (2 * v_0 + v_1), h * (v_0 + v_1) - 2 * rise
        state[i] = one[x] + s * (h * v_0 + s * (bend + s * twist))
        state[2 + i] = v_0 + s * (2 * bend + s * 3 * twist) / h
