"""Kernels: nodes at equal steps as quintics in time, each over as many steps as the acceleration admits."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from coupling.stretch import lay_piece
from particle import kernel, kernel_device_no_arrays

FloatArray = NDArray[np.float64]

HALVED = 16.0  # a quintic's error of the acceleration over that of each half of it


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
