"""Dense output: the path between its rows, marched to from the row before by the integrator itself."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from particle.events.equations import Part, energy_at_rest, pull
from particle.events.flight import fly
from particle.events.record import (
    COLUMNS,
    DISSIPATED,
    FLYING,
    MANIFOLD,
    MODE,
    RESTING,
    TIME,
    V_X,
    V_Y,
    V_Z,
    WORK,
    X,
    Y,
    Z,
    row_of,
)
from particle.events.runge_kutta import Pairs, Step, new_step
from particle.events.slide import GOES_ON, TURNED, Request, bridge, slide
from particle.jit import jit
from particle.surface import END, enter, fields, new_local

FloatArray = NDArray[np.float64]


@jit
def resume(surface: Any, request: Request, pairs: Pairs, rows: FloatArray, times: FloatArray) -> FloatArray:
    """The rows (k, COLUMNS) at ascending times (k,) [s], each marched to from the row of the path before it."""
    part, out = request.part, np.zeros((len(times), COLUMNS))
    local, step, count = new_local(surface), new_step(pairs), np.zeros(3, dtype=np.int64)
    state, row = np.zeros(8), 0
    for k in range(len(times)):
        while row + 1 < len(rows) and rows[row + 1, TIME] <= times[k]:
            row += 1
        time, mode = rows[row, TIME], int(rows[row, MODE])
        if times[k] <= time or row + 1 == len(rows):
            out[k] = rows[row]
            continue
        bridge(local, request, mode)
        if local.frame[END] < times[k]:
            local.frame[END] = time  # a span from there on lasts as long as the path's own
        if enter(surface, local, rows[row, X], rows[row, Y], time, math.inf) < 0:
            out[k] = rows[row]
            continue
        _restore(local, part, rows[row], state)
        if mode == RESTING:
            state[4] -= energy_at_rest(local, part, time, state)
            time = times[k]
            state[4] += energy_at_rest(local, part, time, state)
        mode = _to(surface, local, request, pairs, step, count, mode, time, times[k], state)
        out[k] = row_of(local, part, mode, times[k], state)
    return out


@jit
def _restore(local: Any, part: Part, row: FloatArray, state: FloatArray) -> None:
    """The state that a row was written from."""
    state[0], state[1], state[2], state[3] = row[X], row[Y], row[V_X], row[V_Y]
    state[4], state[5], state[6], state[7] = row[WORK], row[DISSIPATED], row[Z], row[V_Z]
    if row[MODE] == MANIFOLD:
        f = fields(local, row[X], row[Y], row[TIME])
        state[2], state[3] = pull(f, row[V_X], row[V_Y], part).speed, 0.0


@jit
def _to(
    surface: Any,
    local: Any,
    request: Request,
    pairs: Pairs,
    step: Step,
    count: NDArray[np.int64],
    mode: int,
    time: float,
    end: float,
    state: FloatArray,
) -> int:
    """Moves `state` on to a time `end` [s] between two rows; what the part does there."""
    verdict = GOES_ON
    while time < end and verdict == GOES_ON and mode != RESTING:
        if mode == FLYING:
            mode, time, _, verdict = fly(surface, local, request, count, time, end - time, end, state)
        else:
            mode, time, _, verdict = slide(
                surface, local, request, pairs, step, count, mode, time, end - time, end, state
            )
            mode = MANIFOLD if mode == TURNED else mode
    return mode
