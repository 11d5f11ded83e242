"""Kernels: the corrections over time as quintics, bisected until those meet the equilibrium between their ends.

A node is c and g at one moment, (3, n+M), with their first and second derivatives in s (`interval`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coupling.stretch.interval import Interval, Moment, enter_interval, enter_moment, new_interval, new_moment
from coupling.stretch.newton import FINE, State, find_equilibrium, find_rates, new_state
from fem_plate.large_deflection import Forms
from particle import kernel, kernel_no_arrays
from particle.drives import ORDER, DriveTable

FloatArray = NDArray[np.float64]

MAX_HALVINGS = 10  # of an interval between two breakpoints
# A quintic's error is s^3 (1-s)^3 times a sixth derivative, largest at its middle, where it is measured. If that
# derivative changes sign there, the error is largest beside: this share of the error of the first derivative.
BESIDE = 0.1189
SAME = 1e-6  # of the largest jump of a drive's velocity or acceleration: a smaller one is none


class Walk(NamedTuple):
    """The pieces so far, and what is measured."""

    edges: FloatArray  # (room,) s, where each begins
    coefficients: FloatArray  # (room, n+M, 6), in (t - start) / length
    errors: FloatArray  # (n+M,), the largest of each
    acceleration_errors: FloatArray  # (n+M,) 1/s^2
    largest: FloatArray  # (n+M,), of each
    largest_acceleration: FloatArray  # (n+M,) 1/s^2


class Tools(NamedTuple):
    """What is worked with, made once."""

    interval: Interval
    moment: Moment
    state: State


@kernel
def new_tools(forms: Forms) -> Tools:
    """Room for it."""
    return Tools(new_interval(forms), new_moment(forms), new_state(forms))


@kernel_no_arrays
def find_node(forms: Forms, tools: Tools, s: float, node: FloatArray, largest: float) -> int:
    """The node at s of the interval, from c as the node has it."""
    enter_moment(tools.interval, s, tools.moment)
    c = node[0, : len(forms.load)]
    outcome = find_equilibrium(forms, tools.moment, tools.state, c, largest)
    if outcome == FINE:
        find_rates(forms, tools.moment, tools.state, node)
    return outcome


@kernel
def find_nodes(
    forms: Forms, table: DriveTable, edges: FloatArray, loop: int, nodes: FloatArray
) -> tuple[int, float, int]:
    """The nodes (I, 3, 3, n+M) at the begin, middle and end of all intervals between breakpoints (I+1,) [s].

    Neighbours share what is continuous, to the bit, and so do the end and the begin of a loop's first interval.

    Returns what came of it, the time [s] where, and the number of equilibria.
    """
    tools, n = new_tools(forms), len(forms.load)
    drives, count, largest = tools.interval.drives, len(edges) - 1, 0.0
    before, at_loop, solved = np.zeros_like(drives), np.zeros_like(drives), 0
    for k in range(count):
        half = 0.5 * (edges[k + 1] - edges[k])
        enter_interval(forms, table, edges[k], edges[k + 1], tools.interval)
        left, middle, right = nodes[k, 0], nodes[k, 1], nodes[k, 2]
        shared = 0
        if k > 0:
            ratio = half / (0.5 * (edges[k] - edges[k - 1]))
            shared = _shared(table, before, drives, half / ratio, half)
            _rescale(nodes[k - 1, 2], ratio, left, 3)
        if shared < 3:
            outcome, kept = find_node(forms, tools, -1.0, left, largest), shared
            solved += 1
            if outcome != FINE:
                return outcome, edges[k], solved
            if kept:
                _rescale(nodes[k - 1, 2], half / (0.5 * (edges[k] - edges[k - 1])), left, kept)
        for s, node, last in ((0.0, middle, left), (1.0, right, middle)):
            for j in range(n):
                node[0, j] = last[0, j] + last[1, j] + 0.5 * last[2, j]
            outcome = find_node(forms, tools, s, node, largest)
            solved += 1
            if outcome != FINE:
                return outcome, edges[k] + (1.0 + s) * half, solved
        for j in range(n):
            largest = max(largest, abs(left[0, j]), abs(middle[0, j]), abs(right[0, j]))
        before[:] = drives
        if k == loop:
            at_loop[:] = drives
    if loop >= 0:
        last, first = 0.5 * (edges[count] - edges[count - 1]), 0.5 * (edges[loop + 1] - edges[loop])
        _rescale(nodes[loop, 0], last / first, nodes[count - 1, 2], _shared(table, before, at_loop, last, first))
    return FINE, 0.0, solved


@kernel_no_arrays
def _shared(table: DriveTable, before: FloatArray, after: FloatArray, half: float, half_after: float) -> int:
    """How many of c, c' and c'' are the same on both sides of a breakpoint between two intervals' drives."""
    shared = 3
    for i in range(len(before)):
        velocity = acceleration = 0.0
        for k in range(1, ORDER):
            sign = 1.0 if k % 2 else -1.0  # powers of -1, at the begin of an interval
            velocity += k * (before[i, k] / half - sign * after[i, k] / half_after)
            acceleration += k * (k - 1) * (before[i, k] / half**2 + sign * after[i, k] / half_after**2)
        if table.jump[i, 0] > 0.0 and abs(velocity) > SAME * table.jump[i, 0]:
            return 1
        if table.jump[i, 1] > 0.0 and abs(acceleration) > SAME * table.jump[i, 1]:
            shared = 2
    return shared


@kernel_no_arrays
def _rescale(node: FloatArray, ratio: float, out: FloatArray, orders: int) -> None:
    """The node in another interval's s: ratio: the latter's length over its own."""
    factor = 1.0
    for order in range(orders):
        for j in range(node.shape[1]):
            out[order, j] = factor * node[order, j]
        factor *= ratio


@kernel
def lay_pieces(
    forms: Forms,
    table: DriveTable,
    edges: FloatArray,
    nodes: FloatArray,
    limits: FloatArray,
    walk: Walk,
    k: int,
    laid: int,
) -> tuple[int, int, float, int]:
    """Lay the pieces of the intervals from the k-th on, while there is room in the walk; limits (n+M,): of errors.

    Returns the interval that comes next, the number of pieces laid, the time [s] of a failure, -1: there is none, and
    how many equilibria it took.
    """
    tools, width = new_tools(forms), nodes.shape[3]
    stack, places = np.empty((MAX_HALVINGS + 2, 3, width)), np.empty(MAX_HALVINGS + 2)
    left, middle = np.empty((3, width)), np.empty((3, width))
    most, solved = 1 << MAX_HALVINGS, 0
    while k < len(edges) - 1 and laid + most <= len(walk.edges):
        half, entered = 0.5 * (edges[k + 1] - edges[k]), False
        left[:], middle[:], stack[0], places[0] = nodes[k, 0], nodes[k, 1], nodes[k, 2], 1.0
        at, top, known = -1.0, 0, True
        while top >= 0:
            length = places[top] - at
            if not known:
                if not entered:
                    enter_interval(forms, table, edges[k], edges[k + 1], tools.interval)
                    entered = True
                _middle(left, stack[top], length, middle)
                if find_node(forms, tools, at + 0.5 * length, middle, 0.0) != FINE:
                    return k, laid, edges[k] + (1.0 + at + 0.5 * length) * half, solved
                solved += 1
            last = length * most <= 2.0
            if _measure(left, middle, stack[top], length, half, limits, last, walk):
                _lay(left, stack[top], length, walk.coefficients[laid])
                walk.edges[laid] = edges[k] + (1.0 + at) * half
                laid += 1
                left[:], at = stack[top], places[top]
                top -= 1
            else:
                top += 1
                stack[top], places[top] = middle, at + 0.5 * length
            known = False
        k += 1
    return k, laid, -1.0, solved


@kernel_no_arrays
def _middle(left: FloatArray, right: FloatArray, length: float, out: FloatArray) -> None:
    """The first row of a node as the quintic between two others has it in its middle."""
    for j in range(left.shape[1]):
        out[0, j] = (
            0.5 * (left[0, j] + right[0, j])
            + length * 5 / 32 * (left[1, j] - right[1, j])
            + length**2 / 64 * (left[2, j] + right[2, j])
        )


@kernel
def _measure(
    left: FloatArray,
    middle: FloatArray,
    right: FloatArray,
    length: float,
    half: float,
    limits: FloatArray,
    last: bool,
    walk: Walk,
) -> bool:
    """Whether a quintic between two nodes is good enough, by the node in its middle; then what it is off by is kept."""
    off = np.empty(left.shape[1])
    for j in range(left.shape[1]):
        v_0, v_1 = length * left[1, j], length * right[1, j]
        a_0, a_1 = length**2 * left[2, j], length**2 * right[2, j]
        value = 0.5 * (left[0, j] + right[0, j]) + 5 / 32 * (v_0 - v_1) + (a_0 + a_1) / 64
        rate = 15 / 8 * (right[0, j] - left[0, j]) - 7 / 16 * (v_0 + v_1) + (a_1 - a_0) / 32
        off[j] = abs(middle[0, j] - value) + BESIDE * abs(length * middle[1, j] - rate)
        if off[j] > limits[j] and not last:
            return False
    for j in range(left.shape[1]):
        walk.errors[j] = max(walk.errors[j], off[j])
        bend = 1.5 * length * (right[1, j] - left[1, j]) - 0.25 * length**2 * (left[2, j] + right[2, j])
        acceleration_off = abs(length**2 * middle[2, j] - bend) / (length * half) ** 2
        walk.acceleration_errors[j] = max(walk.acceleration_errors[j], acceleration_off)
        walk.largest[j] = max(walk.largest[j], abs(left[0, j]), abs(middle[0, j]), abs(right[0, j]))
        acceleration = max(abs(left[2, j]), abs(middle[2, j]), abs(right[2, j])) / half**2
        walk.largest_acceleration[j] = max(walk.largest_acceleration[j], acceleration)
    return True


@kernel_no_arrays
def _lay(left: FloatArray, right: FloatArray, length: float, out: FloatArray) -> None:
    """The quintics (n+M, 6) between two nodes."""
    for j in range(left.shape[1]):
        rise = right[0, j] - left[0, j]
        v_0, v_1 = length * left[1, j], length * right[1, j]
        a_0, a_1 = length**2 * left[2, j], length**2 * right[2, j]
        out[j, 0], out[j, 1], out[j, 2] = left[0, j], v_0, 0.5 * a_0
        out[j, 3] = 10 * rise - 6 * v_0 - 4 * v_1 - 1.5 * a_0 + 0.5 * a_1
        out[j, 4] = -15 * rise + 8 * v_0 + 7 * v_1 + 1.5 * a_0 - a_1
        out[j, 5] = 6 * rise - 3 * v_0 - 3 * v_1 - 0.5 * a_0 + 0.5 * a_1
