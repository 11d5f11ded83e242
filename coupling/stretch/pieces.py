"""Kernels: the corrections over time as quintics, bisected until those meet the equilibrium between their ends.

A node is c and g at one moment, (3, n+M), with their first and second derivatives in s (`interval`).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coupling.stretch.interval import (
    Interval,
    Moment,
    enter_drives,
    enter_interval,
    enter_moment,
    new_interval,
    new_moment,
)
from coupling.stretch.newton import FINE, State, find_equilibrium, find_rates, new_state
from coupling.stretch.response import Blend, Response, blend_node, enter_drive, new_blend
from fem_plate.large_deflection import Forms
from particle import grouped, kernel, kernel_device, kernel_device_no_arrays
from particle.drives import ORDER, DriveTable, copy_rows, evaluate_piece, quintic_end

FloatArray = NDArray[np.float64]

MAX_HALVINGS = 10  # of an interval between two breakpoints
# A quintic's error is s^3 (1-s)^3 times a sixth derivative, largest at its middle, where it is measured. If that
# derivative changes sign there, the error is largest beside: this share of the error of the first derivative.
BESIDE = 0.1189
SPARE = 1.03  # how many more pieces than the sixth order asks for
SAME = 1e-6  # of the largest jump of a drive's velocity or acceleration: a smaller one is none


@grouped
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
    response: Response
    blend: Blend


@kernel_device
def new_tools(forms: Forms, response: Response) -> Tools:
    """Room for it."""
    return Tools(new_interval(forms), new_moment(forms), new_state(forms), response, new_blend(response))


@kernel_device
def _enter(forms: Forms, tools: Tools, table: DriveTable, begin: float, end: float) -> None:
    """Enter an interval between two breakpoints [s]."""
    if len(tools.response.rows) > 0:
        enter_drives(table, begin, end, tools.interval)
    else:
        enter_interval(forms, table, begin, end, tools.interval)


@kernel_device_no_arrays
def find_node(forms: Forms, tools: Tools, s: float, node: FloatArray, largest: float) -> int:
    """The node at s of the interval, from c as the node has it unless there is a response."""
    if len(tools.response.rows) > 0:
        height = tools.blend.height
        for i in range(len(tools.interval.drives)):
            height[0], height[1], height[2] = evaluate_piece(tools.interval.drives[i], s, 1.0)
            enter_drive(tools.response, i, tools.blend)
        blend_node(tools.response, tools.blend, node)
        return FINE
    enter_moment(tools.interval, s, tools.moment)
    c = node[0, : len(forms.load)]
    outcome = find_equilibrium(forms, tools.moment, tools.state, c, largest)
    if outcome == FINE:
        find_rates(forms, tools.moment, tools.state, node)
    return outcome


@kernel
def find_nodes(
    forms: Forms, response: Response, table: DriveTable, edges: FloatArray, loop: int, nodes: FloatArray
) -> tuple[int, float, int]:
    """The nodes (I, 3, 3, n+M) at the begin, middle and end of all intervals between breakpoints (I+1,) [s].

    Neighbours share what is continuous, to the bit, and so do the end and the begin of a loop's first interval.

    Returns what came of it, the time [s] where, and the number of equilibria.
    """
    tools, n = new_tools(forms, response), len(forms.load)
    drives, count, largest = tools.interval.drives, len(edges) - 1, 0.0
    before, at_loop, solved = np.zeros_like(drives), np.zeros_like(drives), 0
    for k in range(count):
        half = 0.5 * (edges[k + 1] - edges[k])
        _enter(forms, tools, table, edges[k], edges[k + 1])
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
        copy_rows(drives, before)
        if k == loop:
            copy_rows(drives, at_loop)
    if loop >= 0:
        last, first = 0.5 * (edges[count] - edges[count - 1]), 0.5 * (edges[loop + 1] - edges[loop])
        _rescale(nodes[loop, 0], last / first, nodes[count - 1, 2], _shared(table, before, at_loop, last, first))
    return FINE, 0.0, solved


@kernel_device_no_arrays
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


@kernel_device_no_arrays
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
    response: Response,
    table: DriveTable,
    edges: FloatArray,
    nodes: FloatArray,
    limits: FloatArray,
    walk: Walk,
    k: int,
    laid: int,
) -> tuple[int, int, float, int]:
    """Lay the pieces of the intervals from the k-th on, while there is room in the walk; limits (n+M,): of errors.

    An interval has as many equal pieces as the error of a single one asks for, by the sixth order, and each of them is
    bisected where it is not good enough.

    Returns the interval that comes next, the number of pieces laid, the time [s] of a failure, -1: there is none, and
    how many equilibria it took.
    """
    tools, width = new_tools(forms, response), nodes.shape[3]
    stack, places = np.empty((MAX_HALVINGS + 2, 3, width)), np.empty(MAX_HALVINGS + 2)
    left, middle = np.empty((3, width)), np.empty((3, width))
    most, solved = 1 << MAX_HALVINGS, 0
    while k < len(edges) - 1 and laid + 2 * most <= len(walk.edges):
        half, known = 0.5 * (edges[k + 1] - edges[k]), True
        copy_rows(nodes[k, 0], left)
        copy_rows(nodes[k, 1], middle)
        at = -1.0
        over = _measure(left, middle, nodes[k, 2], 2.0, limits)
        count = 1 if over <= 1.0 else int(math.ceil(min(over ** (1 / 6) * SPARE, float(most))))
        if count > 1:
            _enter(forms, tools, table, edges[k], edges[k + 1])
            known = False
        for p in range(count):
            top, end = 0, -1.0 + 2.0 * (p + 1) / count
            if p + 1 == count:
                copy_rows(nodes[k, 2], stack[0])
                places[0] = 1.0
            else:
                # A guess for Newton's method, from the nodes of the whole interval.
                _between(nodes[k, 0], nodes[k, 2], 0.5 * (end + 1.0), stack[0])
                if find_node(forms, tools, end, stack[0], 0.0) != FINE:
                    return k, laid, edges[k] + (1.0 + end) * half, solved
                places[0] = end
                solved += 1
            while top >= 0:
                length = places[top] - at
                if not known:
                    _between(left, stack[top], 0.5, middle, length)
                    if find_node(forms, tools, at + 0.5 * length, middle, 0.0) != FINE:
                        return k, laid, edges[k] + (1.0 + at + 0.5 * length) * half, solved
                    solved += 1
                    over = _measure(left, middle, stack[top], length, limits)
                if over <= 1.0 or length * most <= 2.0:
                    _keep(left, middle, stack[top], length, half, walk)
                    lay_piece(left, stack[top], length, walk.coefficients[laid])
                    walk.edges[laid] = edges[k] + (1.0 + at) * half
                    laid += 1
                    copy_rows(stack[top], left)
                    at = places[top]
                    top -= 1
                else:
                    top += 1
                    copy_rows(middle, stack[top])
                    places[top] = at + 0.5 * length
                known = False
        k += 1
    return k, laid, -1.0, solved


@kernel_device_no_arrays
def _between(left: FloatArray, right: FloatArray, share: float, out: FloatArray, length: float = 2.0) -> None:
    """The first row of a node as the quintic between two others has it at a share of their distance in s."""
    for j in range(left.shape[1]):
        rise = right[0, j] - left[0, j]
        v_0, v_1 = length * left[1, j], length * right[1, j]
        a_0, a_1 = length**2 * left[2, j], length**2 * right[2, j]
        third, fourth, fifth = quintic_end(rise, v_0, v_1, a_0, a_1)
        value = (((fifth * share + fourth) * share + third) * share + 0.5 * a_0) * share + v_0
        out[0, j] = value * share + left[0, j]


@kernel_device_no_arrays
def _error(left: FloatArray, middle: FloatArray, right: FloatArray, length: float, j: int) -> float:
    """What a quintic between two nodes is off by, by the node in its middle."""
    v_0, v_1 = length * left[1, j], length * right[1, j]
    a_0, a_1 = length**2 * left[2, j], length**2 * right[2, j]
    value = 0.5 * (left[0, j] + right[0, j]) + 5 / 32 * (v_0 - v_1) + (a_0 + a_1) / 64
    rate = 15 / 8 * (right[0, j] - left[0, j]) - 7 / 16 * (v_0 + v_1) + (a_1 - a_0) / 32
    return abs(middle[0, j] - value) + BESIDE * abs(length * middle[1, j] - rate)


@kernel_device_no_arrays
def _measure(left: FloatArray, middle: FloatArray, right: FloatArray, length: float, limits: FloatArray) -> float:
    """The largest error of a quintic between two nodes over its limit."""
    over = 0.0
    for j in range(left.shape[1]):
        error = _error(left, middle, right, length, j)
        if error > over * limits[j]:
            over = error / limits[j] if limits[j] > 0.0 else math.inf
    return over


@kernel_device_no_arrays
def _keep(left: FloatArray, middle: FloatArray, right: FloatArray, length: float, half: float, walk: Walk) -> None:
    """Keep what a quintic that is laid is off by."""
    for j in range(left.shape[1]):
        walk.errors[j] = max(walk.errors[j], _error(left, middle, right, length, j))
        bend = 1.5 * length * (right[1, j] - left[1, j]) - 0.25 * length**2 * (left[2, j] + right[2, j])
        acceleration_off = abs(length**2 * middle[2, j] - bend) / (length * half) ** 2
        walk.acceleration_errors[j] = max(walk.acceleration_errors[j], acceleration_off)
        walk.largest[j] = max(walk.largest[j], abs(left[0, j]), abs(middle[0, j]), abs(right[0, j]))
        acceleration = max(abs(left[2, j]), abs(middle[2, j]), abs(right[2, j])) / half**2
        walk.largest_acceleration[j] = max(walk.largest_acceleration[j], acceleration)


@kernel_device_no_arrays
def lay_piece(left: FloatArray, right: FloatArray, length: float, out: FloatArray) -> None:
    """The quintics (n+M, 6) between two nodes."""
    for j in range(left.shape[1]):
        rise = right[0, j] - left[0, j]
        v_0, v_1 = length * left[1, j], length * right[1, j]
        a_0, a_1 = length**2 * left[2, j], length**2 * right[2, j]
        out[j, 0], out[j, 1], out[j, 2] = left[0, j], v_0, 0.5 * a_0
        out[j, 3], out[j, 4], out[j, 5] = quintic_end(rise, v_0, v_1, a_0, a_1)
