"""Response: what a reduced plate answers to heights of a few drives, as splines over all these heights.

A sweep needs the corrections of thousands of paths. As they follow from the heights alone, they are found on a grid of
heights once; tensor products of quintic splines then give them, with two derivatives, at a twentieth of the cost of an
equilibrium.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coupling.stretch.interval import Moment, add_rows, clear, new_moment
from coupling.stretch.newton import FINE, fill_motions, find_equilibrium, new_state
from fem_plate.large_deflection import Forms, ReducedPlate
from particle import grouped, kernel, kernel_device, kernel_device_no_arrays
from particle.drives import ORDER, evaluate_piece

FloatArray = NDArray[np.float64]

MAX_DRIVES = 3
POINTS = (16, 24, 32)  # a drive on the grid, until that is fine enough
CHECKS = 200  # heights at which the error is measured
ROOM = 0.02  # of a drive's range: how far beyond it a model is good for, and the grid goes


@grouped
class Response(NamedTuple):
    """Splines over the heights of N drives, as kernels read them; empty rows: there are none."""

    low: FloatArray  # (N,) where the grid begins
    width: FloatArray  # (N,) of the grid's cells
    basis: FloatArray  # (P - 1, 6, 6), the splines that count in a cell, as polynomials in the share of it
    rows: FloatArray  # (P^N, n + M), coefficients of corrections and in-plane motions, the last drive's fastest


class Blend(NamedTuple):
    """What an evaluation works with."""

    height: FloatArray  # (3,), of a drive, with its first and second derivative in time
    splines: FloatArray  # (N, 3, 6), each drive's splines, with derivatives in time
    first: NDArray[np.int64]  # (N,), the first of these
    weights: FloatArray  # (3, 6), products of theirs for each of the last drive's splines, with derivatives


NO_RESPONSE = Response(np.zeros(0), np.zeros(0), np.zeros((0, ORDER, ORDER)), np.zeros((0, 0)))


def room_beyond(low: FloatArray, high: FloatArray) -> FloatArray:
    """How far beyond the lowest and highest heights (N,) of its drives a model is good for (N,)."""
    return ROOM * np.maximum(high - low, np.maximum(np.abs(low), np.abs(high)))


def find_response(plate: ReducedPlate, heights: FloatArray, limits: FloatArray) -> Response | None:
    """Splines over the box of `heights` (S, N); limits (n + M,): the largest errors, which are measured.

    None where that takes too many points, such as where the plate has more than one equilibrium, or for more than
    MAX_DRIVES drives or one that never moves.
    """
    count, forms = plate.drive_count, plate.forms
    low, high = heights.min(axis=0), heights.max(axis=0)
    room = room_beyond(low, high)
    low, high = low - room, high + room
    if count > MAX_DRIVES or not (high > low).all():
        return None
    checks = np.random.default_rng(0).uniform(low, high, (CHECKS, count))
    truth = np.zeros((CHECKS, len(limits)))
    if find_equilibria(forms, checks, truth) != FINE:
        return None
    for points in POINTS:
        axes = [np.linspace(*ends, points) for ends in zip(low, high, strict=True)]
        grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, count)
        rows = np.zeros((len(grid), len(limits)))
        if find_equilibria(forms, grid, rows) != FINE:
            return None
        response = _fitted(rows, low, high, points)
        off = np.abs(evaluate_response(response, checks) - truth).max(axis=0)
        if (off <= limits).all():
            return response
    return None


def _fitted(rows: FloatArray, low: FloatArray, high: FloatArray, points: int) -> Response:
    """The splines through values (P^N, n + M) on the grid."""
    from scipy.interpolate import BSpline, make_interp_spline  # here, because single runs do without it

    count, shares = len(low), np.arange(points, dtype=float)
    values = rows.reshape(*[points] * count, -1)
    for axis in range(count):
        spline = make_interp_spline(shares, values, k=ORDER - 1, axis=axis)
        values = np.moveaxis(spline.c, 0, axis)
    unit = BSpline(spline.t, np.eye(points), ORDER - 1)
    cells = np.arange(points - 1)
    first = np.clip(cells - 2, 0, points - ORDER)
    powers = np.stack([unit(cells.astype(float), nu) for nu in range(ORDER)], axis=-1)  # (cells, points, 6)
    powers /= np.cumprod([1.0, *range(1, ORDER)])
    basis = powers[cells[:, None], first[:, None] + np.arange(ORDER)]
    return Response(
        low,
        (high - low) / (points - 1),
        np.ascontiguousarray(basis),
        np.ascontiguousarray(values).reshape(len(rows), -1),
    )


@kernel
def find_equilibria(forms: Forms, heights: FloatArray, out: FloatArray) -> int:
    """Corrections and in-plane motions (S, n + M) at heights (S, N), one after the other; returns what came of it."""
    moment, state, n = new_moment(forms), new_state(forms), len(forms.load)
    c, largest = np.zeros(n), 0.0
    for k in range(len(heights)):
        _enter_heights(forms, heights[k], moment)
        outcome = find_equilibrium(forms, moment, state, c, largest)
        if outcome != FINE:
            return outcome
        for j in range(n):
            largest = max(largest, abs(c[j]))
            out[k, j] = c[j]
        fill_motions(forms, moment, state, c, out[k, n:])
    return FINE


@kernel_device_no_arrays
def _enter_heights(forms: Forms, d: FloatArray, moment: Moment) -> None:
    """What drives that stay at d (N,) do to each form."""
    own, mixed, count = moment.own[0], moment.mixed[0], len(d)
    for r in range(len(own)):
        clear(mixed[r])
        add_rows(mixed[r], 0, mixed.shape[1], forms.mixed[r], d, count)
        own[r] = 0.0
        for i in range(count):
            for k in range(count):
                own[r] += 0.5 * forms.drives[r, i, k] * d[i] * d[k]


@kernel_device
def new_blend(response: Response) -> Blend:
    """Room for an evaluation."""
    count = len(response.low)
    return Blend(np.zeros(3), np.zeros((count, 3, ORDER)), np.zeros(count, dtype=np.int64), np.zeros((3, ORDER)))


@kernel
def evaluate_response(response: Response, heights: FloatArray) -> FloatArray:
    """Corrections and in-plane motions (S, n + M) at heights (S, N)."""
    blend, node = new_blend(response), np.zeros((3, response.rows.shape[1]))
    out = np.zeros((len(heights), response.rows.shape[1]))
    for k in range(len(heights)):
        for i in range(heights.shape[1]):
            blend.height[0], blend.height[1], blend.height[2] = heights[k, i], 0.0, 0.0
            enter_drive(response, i, blend)
        blend_node(response, blend, node)
        out[k] = node[0]
    return out


@kernel_device_no_arrays
def enter_drive(response: Response, i: int, blend: Blend) -> None:
    """The splines of drive i at blend.height, with their derivatives in time."""
    height, cells = blend.height, len(response.basis)
    place = (height[0] - response.low[i]) / response.width[i]
    rate, bend = height[1] / response.width[i], height[2] / response.width[i]
    cell = min(max(int(place), 0), cells - 1)
    s = place - cell
    blend.first[i] = min(max(cell - 2, 0), cells + 1 - ORDER)
    for a in range(ORDER):
        value, slope, curvature = evaluate_piece(response.basis[cell, a], s, 1.0)
        blend.splines[i, 0, a] = value
        blend.splines[i, 1, a] = slope * rate
        blend.splines[i, 2, a] = curvature * rate * rate + slope * bend


@kernel_device_no_arrays
def blend_node(response: Response, blend: Blend, node: FloatArray) -> None:
    """Corrections and in-plane motions with two derivatives in time, (3, n + M), from the splines of all drives."""
    count, width, points = len(response.low), node.shape[1], len(response.basis) + 1
    clear(node[0])
    clear(node[1])
    clear(node[2])
    weights, last = blend.weights, count - 1
    for k in range(ORDER**last):
        # The product of the splines of all drives but the last, by the digits of k.
        value, rate, bend, row, digits = 1.0, 0.0, 0.0, 0, k
        for i in range(last):
            a = digits % ORDER
            digits //= ORDER
            p, q, r = blend.splines[i, 0, a], blend.splines[i, 1, a], blend.splines[i, 2, a]
            value, rate, bend = value * p, rate * p + value * q, bend * p + 2 * rate * q + value * r
            row = row * points + blend.first[i] + a
        row = row * points + blend.first[last]
        for a in range(ORDER):
            p, q, r = blend.splines[last, 0, a], blend.splines[last, 1, a], blend.splines[last, 2, a]
            weights[0, a] = value * p
            weights[1, a] = rate * p + value * q
            weights[2, a] = bend * p + 2 * rate * q + value * r
        rows = response.rows[row : row + ORDER]
        for order in range(3):
            add_rows(node[order], 0, width, rows, weights[order], ORDER)
