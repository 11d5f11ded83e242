"""Kernels: the smoothest motion near measurements, by a Kalman filter and the recursions back.

The smoothing spline of order m minimises the squares of the differences over their variances, plus the integral of the
square of its m-th derivative over `roughness`. It is the mean of a motion whose m-th derivative is white noise of that
intensity (Wahba 1978), so a filter over height, velocity and further derivatives finds it in a time that grows with the
number of samples, at any times. A kick lets one of these jump at a node.

The recursions back give, besides the states, the score of a jump at each node and its variance (de Jong and Penzer
1998): what the data say of a jump there that the motion does not have.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle import kernel, kernel_device, kernel_inlined

FloatArray = NDArray[np.float64]

ANYTHING = 1e8  # variance of what is not known, over that of the noise: so large that it does not count


class Nodes(NamedTuple):
    """N moments of samples and kicks, in units of a step and of the noise of a height."""

    time: FloatArray  # (N,), not decreasing
    value: FloatArray  # (N, 3) heights, velocities and accelerations
    weight: FloatArray  # (N, 3) 1 / variance of each; 0: not measured there
    kick: FloatArray  # (N, m) variance of a jump of each derivative there, from the height on; 0: none


class Smoothed(NamedTuple):
    """What `smooth` makes of N nodes."""

    before: FloatArray  # (N, 3) height, velocity and acceleration just before a kick
    after: FloatArray  # (N, 3) and just after it
    leverage: FloatArray  # (N, 3) by how much the motion follows each value, 0 to 1
    score: FloatArray  # (N, m) of a shock to the state at the node
    information: FloatArray  # (N, m, m) the score's variance


@kernel
def smooth(nodes: Nodes, roughness: float, start: FloatArray, out: Smoothed) -> tuple[float, float]:
    """Fill `out`; returns the sum of squares of the innovations over their variances, and of the variances' logarithms.

    start: (m,) about where the state begins, of which nothing is taken as known; its length is the order.
    """
    count, m = len(nodes.time), len(start)
    state, p, work = start.copy(), np.zeros((m, m)), np.zeros((m, m))
    f_shape, q_shape = np.zeros((m, m)), np.zeros((m, m))
    before, after = np.empty((count, m, m)), np.empty((count, m, m))
    predicted = np.empty((count, m))
    innovation, spread, gain = np.zeros((count, 3)), np.zeros((count, 3)), np.zeros((count, 3, m))
    squares = logarithms = 0.0
    for i in range(m):
        p[i, i] = ANYTHING
    for k in range(count):
        if k > 0:
            _transition(nodes.time[k] - nodes.time[k - 1], roughness, f_shape, q_shape)
            _advance(f_shape, q_shape, state, p, work)
        for i in range(m):
            predicted[k, i] = state[i]
            for n in range(m):
                before[k, i, n] = p[i, n]
        for i in range(m):
            p[i, i] += nodes.kick[k, i]
        for i in range(m):
            for n in range(m):
                after[k, i, n] = p[i, n]
        for j in range(3):
            if nodes.weight[k, j] > 0.0:
                f = p[j, j] + 1.0 / nodes.weight[k, j]
                v = nodes.value[k, j] - state[j]
                innovation[k, j], spread[k, j] = v, f
                for i in range(m):
                    gain[k, j, i] = p[i, j] / f
                for i in range(m):
                    state[i] += gain[k, j, i] * v
                    for n in range(m):
                        p[i, n] -= gain[k, j, i] * gain[k, j, n] * f
                squares += v * v / f
                logarithms += math.log(f * nodes.weight[k, j])
    r, info, across = np.zeros(m), np.zeros((m, m)), np.zeros(m)
    for k in range(count - 1, -1, -1):
        for j in range(2, -1, -1):
            if spread[k, j] > 0.0:
                known = _undo(innovation[k, j], spread[k, j], gain, k, j, r, info, across)
                out.leverage[k, j] = 1.0 - known / nodes.weight[k, j]
        for i in range(m):
            out.score[k, i] = r[i]
            for n in range(m):
                out.information[k, i, n] = info[i, n]
        for i in range(3):
            out.before[k, i] = out.after[k, i] = predicted[k, i]
            for n in range(m):
                out.before[k, i] += before[k, i, n] * r[n]
                out.after[k, i] += after[k, i, n] * r[n]
        if k > 0:
            _transition(nodes.time[k] - nodes.time[k - 1], roughness, f_shape, q_shape)
            _return(f_shape, r, info, work)
    return squares, logarithms


@kernel_device
def _transition(d: float, roughness: float, f_shape: FloatArray, q_shape: FloatArray) -> None:
    """What the state becomes after a time d, and what the unknown highest derivative adds to its covariance."""
    m = len(f_shape)
    for i in range(m):
        factor = 1.0
        for j in range(i, m):
            if j > i:
                factor *= d / (j - i)
            f_shape[i, j] = factor
    for i in range(m):
        for j in range(m):
            a, b, factor = m - 1 - i, m - 1 - j, roughness * d
            for n in range(1, a + 1):
                factor *= d / n
            for n in range(1, b + 1):
                factor *= d / n
            q_shape[i, j] = factor / (a + b + 1)


@kernel_inlined
def _advance(f: FloatArray, q: FloatArray, state: FloatArray, p: FloatArray, work: FloatArray) -> None:
    """State and covariance after a transition, in place."""
    m = len(state)
    for i in range(m):
        for j in range(i + 1, m):
            state[i] += f[i, j] * state[j]
        for j in range(m):
            work[i, j] = 0.0
            for n in range(i, m):
                work[i, j] += f[i, n] * p[n, j]
    for i in range(m):
        for j in range(i, m):
            total = q[i, j]
            for n in range(j, m):
                total += work[i, n] * f[j, n]
            p[i, j] = p[j, i] = total


@kernel_inlined
def _undo(
    v: float, f: float, gain: FloatArray, k: int, j: int, r: FloatArray, info: FloatArray, across: FloatArray
) -> float:
    """Score and information before a measurement j from those after it, in place; the measurement's own information."""
    m, along, both = len(r), 0.0, 0.0
    for i in range(m):
        along += gain[k, j, i] * r[i]
        across[i] = 0.0
        for n in range(m):
            across[i] += info[i, n] * gain[k, j, n]
    for i in range(m):
        both += gain[k, j, i] * across[i]
    r[j] += v / f - along
    for i in range(m):
        info[i, j] -= across[i]
        info[j, i] -= across[i]
    info[j, j] += 1.0 / f + both
    return 1.0 / f + both


@kernel_inlined
def _return(f: FloatArray, r: FloatArray, info: FloatArray, work: FloatArray) -> None:
    """Score and information of a shock before a transition, in place."""
    m = len(r)
    for i in range(m - 1, -1, -1):
        for n in range(i):
            r[i] += f[n, i] * r[n]
        for j in range(m):
            work[i, j] = 0.0
            for n in range(i + 1):
                work[i, j] += f[n, i] * info[n, j]
    for i in range(m):
        for j in range(i, m):
            total = 0.0
            for n in range(j + 1):
                total += work[i, n] * f[n, j]
            info[i, j] = info[j, i] = total
