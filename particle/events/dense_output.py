"""Dense output: the path between its rows, marched to from the row before by the integrator itself."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from particle.events.flight import fly
from particle.events.mechanics import Motion, Now, Part, energy_at_rest, pull
from particle.events.memory import Memory
from particle.events.record import ROW, Row, fill_row
from particle.events.request import Request
from particle.events.sliding import bridge, slide
from particle.events.tableau import Pairs
from particle.jit import jit
from particle.modes import Mode, Verdict
from particle.surface import LocalSurface, Surface, enter, surface_at
from particle.types import FloatArray


@jit
def resume(
    surface: Surface, request: Request, pairs: Pairs, memory: Memory, rows: NDArray[Row], times: FloatArray
) -> NDArray[Row]:
    """The rows (k,) at ascending times (k,) [s], each marched to from the row of the path before it."""
    part, out = request.part, np.zeros(len(times), ROW)
    now: Now = memory.now[0]
    motion: Motion = memory.motion[0]
    local, place = memory.local, 0
    for k in range(len(times)):
        while place + 1 < len(rows) and rows[place + 1].time <= times[k]:
            place += 1
        row = rows[place]
        out[k] = row
        if times[k] <= row.time or place + 1 == len(rows):
            continue
        bridge(local, request, row.mode)
        if local.frame[0].end < times[k]:
            local.frame[0].end = row.time  # a span from there on lasts as long as the path's own
        if enter(surface, local, row.x, row.y, row.time, math.inf) < 0:
            continue
        _restore(local, part, row, motion)
        now.mode, now.time = row.mode, row.time
        if row.mode == Mode.RESTING:
            motion.work -= energy_at_rest(local, part, row.time, motion)
            motion.work += energy_at_rest(local, part, times[k], motion)
        else:
            _go_to(surface, request, pairs, memory, times[k])
        fill_row(local, part, now.mode, times[k], motion, out[k])
    return out


@jit
def _restore(local: LocalSurface, part: Part, row: Row, motion: Motion) -> None:
    """The motion that a row was written from."""
    motion.x, motion.y, motion.v_x, motion.v_y = row.x, row.y, row.v_x, row.v_y
    motion.work, motion.dissipated, motion.z, motion.v_z = row.work, row.dissipated, row.z, row.v_z
    if row.mode == Mode.MANIFOLD:
        f = surface_at(local, row.x, row.y, row.time)
        motion.v_x, motion.v_y = pull(f, row.v_x, row.v_y, part).speed, 0.0


@jit
def _go_to(surface: Surface, request: Request, pairs: Pairs, memory: Memory, end: float) -> None:
    """Moves the part on to a time `end` [s] between two rows."""
    now: Now = memory.now[0]
    now.verdict, now.span_end = Verdict.GOES_ON, end
    while now.time < end and now.verdict == Verdict.GOES_ON and now.mode != Mode.RESTING:
        now.h = end - now.time
        if now.mode == Mode.FLYING:
            fly(surface, request, memory)
        else:
            slide(surface, request, pairs, memory)
            now.mode = Mode.MANIFOLD if now.mode == Mode.TURNED else now.mode
