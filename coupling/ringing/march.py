"""Kernels: the ringing modes in time, by Dormand and Prince's Runge-Kutta method of order 8."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from coupling.ringing.forces import Bench, Ringing, accelerate, enter_pieces, fill_node
from coupling.stretch import FINE
from particle import kernel, kernel_device_no_arrays
from particle.drives import DriveTable
from particle.events import Tableau

FloatArray = NDArray[np.float64]


@kernel
def march(
    ringing: Ringing,
    bench: Bench,
    pair: Tableau,
    table: DriveTable,
    begin: float,
    end: float,
    q: FloatArray,
    q_t: FloatArray,
    nodes: FloatArray,
) -> tuple[int, float]:
    """Take equal steps from `begin` to `end` [s], two breakpoints, and leave all nodes (steps + 1, 3, a + n + M).

    pair: the method.  table: the drives.  q, q_t: (a,) m and m/s, of the modes at the begin; then at the end.
    Returns what came of it, and the largest error of a step: that of velocities, over the fastest mode's frequency.
    """
    steps, stages, half = len(nodes) - 1, pair.a.shape[1], 0.5 * (end - begin)
    own, h = len(q), (end - begin) / steps
    rates, speeds = np.zeros((stages + 1, own)), np.zeros((stages + 1, own))  # q'' and q' of each stage
    at, speed = np.zeros(own), np.zeros(own)
    fastest, worst = math.sqrt(ringing.square.max()), 0.0
    enter_pieces(table, begin, end, bench)
    outcome = accelerate(ringing, bench, -1.0, half, q, q_t, rates[0], False)
    fill_node(ringing, bench, q, q_t, rates[0], nodes[0])
    for n in range(steps):
        if outcome != FINE:
            return outcome, worst
        speeds[0, :] = q_t
        for stage in range(1, stages + 1):
            s = -1.0 + 2.0 * (n + pair.c[stage]) / steps
            for k in range(own):
                moved = gained = 0.0
                for m in range(stage):
                    moved += pair.a[stage, m] * speeds[m, k]
                    gained += pair.a[stage, m] * rates[m, k]
                at[k], speed[k] = q[k] + h * moved, q_t[k] + h * gained
            for k in range(own):
                speeds[stage, k] = speed[k]
            _guess(nodes[n, :, own:], pair.c[stage] * h, bench.corrections)
            outcome = max(outcome, accelerate(ringing, bench, s, half, at, speed, rates[stage], stage < stages))
        worst = max(worst, _error(pair, rates, speeds, h, fastest))
        q[:], q_t[:], rates[0, :] = at, speed, rates[stages]
        fill_node(ringing, bench, q, q_t, rates[0], nodes[n + 1])
    return outcome, worst


@kernel_device_no_arrays
def _guess(node: FloatArray, time: float, out: FloatArray) -> None:
    """The corrections a time [s] after a node."""
    for j in range(len(out)):
        out[j] = node[0, j] + time * (node[1, j] + 0.5 * time * node[2, j])


@kernel_device_no_arrays
def _error(pair: Tableau, rates: FloatArray, speeds: FloatArray, h: float, fastest: float) -> float:
    """The error of a step [m], as Hairer, Norsett and Wanner join their estimates of orders 5 and 3."""
    fine = coarse = 0.0
    for k in range(rates.shape[1]):
        for values, unit in ((speeds, 1.0), (rates, 1.0 / fastest)):
            five = three = 0.0
            for m in range(len(rates)):
                five += pair.error[0, m] * values[m, k]
                three += pair.error[1, m] * values[m, k]
            fine, coarse = max(fine, abs(five) * unit), max(coarse, abs(three) * unit)
    if fine == 0.0:
        return 0.0
    return float(h * fine**2 / math.sqrt(fine**2 + 0.01 * coarse**2))
