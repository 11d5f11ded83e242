"""Samples between the rows of a path by fixed steps: cubics through places and velocities, on the true surface."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from particle.events import ROW, Motion, Part, Row
from particle.fixed.steps import FixedMemory, fill_fixed_row
from particle.jit import device, inlined, jit
from particle.modes import Mode
from particle.surface import UNBUILT, Surface, enter
from particle.types import BoolArray, FloatArray


@jit
def between(
    surface: Surface, part: Part, memory: FixedMemory, scheme: int, rows: NDArray[Row], times: FloatArray
) -> tuple[NDArray[Row], BoolArray]:
    """The rows (k,) at ascending times (k,) [s], and (k,) which of them are where a cell is lacking.

    Place and velocity are those of the cubic Hermite polynomial between two rows, work and dissipation are linear
    between them, and height, forces, kinetic and potential energy are those of the surface there. Where there is no
    surface, as over a hole that one step has jumped, these are as in the row before.
    """
    out, missing = np.zeros(len(times), ROW), np.zeros(len(times), dtype=np.bool_)
    motion: Motion = memory.motion[0]
    place = 0
    for k in range(len(times)):
        while place + 1 < len(rows) and rows[place + 1].time <= times[k]:
            place += 1
        row = rows[place]
        out[k] = row
        if times[k] <= row.time or place + 1 == len(rows):
            continue
        _hermite(row, rows[place + 1], times[k], motion)
        # Steps, and the cubic between rows that are far apart, may pass over cells where no step began or ended.
        cell = enter(surface, memory.local, motion.x, motion.y, times[k], math.inf)
        missing[k] = cell == UNBUILT
        if cell >= 0:
            fill_fixed_row(memory.local, part, scheme, row.mode, times[k], motion, out[k])
        else:
            here = out[k]
            here.time, here.x, here.y, here.v_x, here.v_y = times[k], motion.x, motion.y, motion.v_x, motion.v_y
            here.work, here.dissipated = motion.work, motion.dissipated
    return out, missing


@inlined
def _hermite(one: Row, other: Row, time: float, motion: Motion) -> None:
    """The motion at a time [s] between two rows into `motion`."""
    h = other.time - one.time
    s = (time - one.time) / h
    motion.work = one.work + s * (other.work - one.work)
    motion.dissipated = one.dissipated + s * (other.dissipated - one.dissipated)
    motion.x, motion.y, motion.v_x, motion.v_y = one.x, one.y, 0.0, 0.0
    if one.mode != Mode.RESTING:
        motion.x, motion.v_x = _cubic(one.x, one.v_x, other.x, other.v_x, s, h)
        motion.y, motion.v_y = _cubic(one.y, one.v_y, other.y, other.v_y, s, h)


@device
def _cubic(x_0: float, v_0: float, x_1: float, v_1: float, s: float, h: float) -> tuple[float, float]:
    """Place and velocity at the share s of a time h [s] between two places and velocities."""
    rise = x_1 - x_0
    bend, twist = 3 * rise - h * (2 * v_0 + v_1), h * (v_0 + v_1) - 2 * rise
    return x_0 + s * (h * v_0 + s * (bend + s * twist)), v_0 + s * (2 * bend + s * 3 * twist) / h
