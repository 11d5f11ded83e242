"""Kernels: the ringing modes in time, by Dormand and Prince's Runge-Kutta method of order 8, and then as quintics."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from coupling.ringing.forces import Bench, Ringing, accelerate, fill_node
from coupling.stretch import FINE, lay_piece
from particle import kernel, kernel_device_no_arrays
from particle.drives import copy_rows, quintic_end
from particle.events import Tableau

FloatArray = NDArray[np.float64]

HALVED = 16.0  # a quintic's error of the acceleration over that of each half of it


@kernel
def march(
    ringing: Ringing,
    bench: Bench,
    pair: Tableau,
    pieces: FloatArray,
    begin: float,
    end: float,
    q: FloatArray,
    q_t: FloatArray,
    nodes: FloatArray,
) -> tuple[int, float]:
    """Take equal steps from `begin` to `end` [s], two breakpoints, and leave all nodes (steps + 1, 3, a + n + M).

    pair: the method.  pieces: (N, 6) of the drives.
    q, q_t: (a,) m and m/s, of the modes at the begin; then at the end.
    Returns what came of it, and the largest error of a step: that of velocities, over the fastest mode's frequency.
    """
    steps, stages, half = len(nodes) - 1, pair.a.shape[1], 0.5 * (end - begin)
    own, h = len(q), (end - begin) / steps
    rates, speeds = np.zeros((stages + 1, own)), np.zeros((stages + 1, own))  # q'' and q' of each stage
    at, speed = np.zeros(own), np.zeros(own)
    fastest, worst = math.sqrt(ringing.square.max()), 0.0
    copy_rows(pieces, bench.pieces)
    outcome = accelerate(ringing, bench, -1.0, half, q, q_t, rates[0], False, True)
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
            _guess(nodes[max(n - 1, 0), :, own:], nodes[n, :, own:], pair.c[stage] * h, h, n > 0, bench.corrections)
            last = stage == stages
            outcome = max(outcome, accelerate(ringing, bench, s, half, at, speed, rates[stage], True, last))
        worst = max(worst, _error(pair, rates, speeds, h, fastest))
        q[:], q_t[:], rates[0, :] = at, speed, rates[stages]
        fill_node(ringing, bench, q, q_t, rates[0], nodes[n + 1])
    return outcome, worst


@kernel_device_no_arrays
def _guess(before: FloatArray, node: FloatArray, time: float, h: float, has_before: bool, out: FloatArray) -> None:
    """The corrections a time [s] after a node, by the quintic from the one before, h [s] earlier, if there is one."""
    s = -time / h
    for j in range(len(out)):
        v, a = -h * node[1, j], h**2 * node[2, j]
        out[j] = node[0, j] + s * (v + 0.5 * s * a)
        if has_before:
            v_before, a_before = -h * before[1, j], h**2 * before[2, j]
            third, fourth, fifth = quintic_end(before[0, j] - node[0, j], v, v_before, a, a_before)
            out[j] += s**3 * (third + s * (fourth + s * fifth))


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


@kernel
def lay_steps(
    nodes: FloatArray, h: float, limits: FloatArray, most: int, lengths: NDArray[np.int64], rows: FloatArray
) -> tuple[int, float]:
    """Lay pieces over all steps of h [s] between nodes (steps + 1, 3, w), with derivatives in time [s].

    limits: (w,) m/s^2, of the error of each acceleration; they share 1.  most: steps of a piece at most, a power of 2.
    Fills the pieces' lengths (steps,) in steps and their rows (steps, w, 6). Returns how many pieces there are, and the
    largest sum of errors over limits of one; that of a single step is taken from the error over two.
    """
    laid, k, worst, steps = 0, 0, 0.0, len(nodes) - 1
    length = most
    while k < steps:
        length = min(2 * length, most)
        while length > 1 and (k % length != 0 or k + length > steps):
            length //= 2
        over = 0.0
        while length > 1:
            over = _over(nodes[k], nodes[k + length // 2], nodes[k + length], length * h, limits)
            if over <= 1.0:
                break
            length //= 2
        if length == 1:
            pair = k - k % 2
            if pair + 2 <= steps:
                over = _over(nodes[pair], nodes[pair + 1], nodes[pair + 2], 2 * h, limits) / HALVED
        worst = max(worst, over)
        lay_piece(nodes[k], nodes[k + length], length * h, rows[laid])
        lengths[laid] = length
        laid += 1
        k += length
    return laid, worst


@kernel_device_no_arrays
def _over(left: FloatArray, middle: FloatArray, right: FloatArray, length: float, limits: FloatArray) -> float:
    """The errors of quintics' accelerations in their middle, where they are largest, over their limits, in all."""
    over = 0.0
    for j in range(len(limits)):
        bend = 1.5 * (right[1, j] - left[1, j]) / length - 0.25 * (left[2, j] + right[2, j])
        error = abs(middle[2, j] - bend)
        if error > 0.0:
            over += error / limits[j] if limits[j] > 0.0 else math.inf
    return over
