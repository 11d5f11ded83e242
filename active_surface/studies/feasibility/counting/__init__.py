"""Counting: on how much of each square a part at rest slips between two moments, and at which speeds it stays on.

Fields are linear between moments, and between a square and its neighbours. A square in one state, with its neighbours,
at both moments counts as a whole. Others are looked at in SHARES of the time, each at two of 16 points, so that over
all shares each is met once. So slips shorter than the time between moments and rings narrower than a square are met.

The folder is of its own because an edit elsewhere then does not compile these kernels anew.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle import kernel, kernel_device_no_arrays
from particle.body import Balance, Face, Search, least_pressure, quick_gauge
from particle.events import Part, pull
from particle.friction import friction_limit
from particle.surface import SurfacePoint

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int64]
StateArray = NDArray[np.int8]

SIDE: Final = 4  # points along a square's side
SHARES: Final = 8  # of the time between two moments
RESTS, SLIPS, HANGS, SLIPS_HANGING, OFF, OVERLOADED = range(6)  # HANGS: held by adhesion against its net load
SAMPLES: Final = np.array([[0, 2, 4, 6], [5, 7, 1, 3], [2, 0, 6, 4], [7, 5, 3, 1]])
"""(SIDE, SIDE) the share of the time in which a point of the square is looked at."""
HALVES: Final = np.array([0, 1, 1, 0])
"""(SIDE,) the half of the points that a row is in. Its mirror image is itself, so mirrored plates tell them apart."""


class Fields(NamedTuple):
    """What moves a part at rest at n places at one moment."""

    w_tt: FloatArray  # (n,) m/s^2
    slope: FloatArray  # (n, 2)
    slope_t: FloatArray  # (n, 2) 1/s
    slope_tt: FloatArray  # (n, 2) 1/s^2
    base: FloatArray  # (n, 2) m/s^2, the acceleration in the plane


class Resting(NamedTuple):
    """A face at rest, and scratch memory for whether friction holds it."""

    face: Face
    levers: FloatArray  # (c, 2) 1/m: N + levers.(M_1, M_2) is the pressure at a corner times the area; the first is N
    balance: NDArray[Balance]  # (1,)
    search: NDArray[Search]  # (1,)


@kernel
def find_responses(f: Fields, part: Part, responses: FloatArray) -> None:
    """Load a + b q [N] and pull c + d q [m/s^2] on a part at rest under drives sqrt(q) times as fast.

    responses: (n, 8) a, b, then c and d, each along x, y and the normal of the plane.
    """
    for n in range(len(f.w_tt)):
        for q in range(2):
            x, y = f.slope[n, 0], f.slope[n, 1]
            p = pull(
                SurfacePoint(
                    *(0.0, 0.0, q * f.w_tt[n], x, y, q * f.slope_t[n, 0], q * f.slope_t[n, 1], 0.0, 0.0, 0.0),
                    *(q * f.slope_tt[n, 0], q * f.slope_tt[n, 1]),
                    *(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, q * f.base[n, 0], q * f.base[n, 1]),
                    *(1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
                ),
                *(0.0, 0.0, part),
            )
            responses[n, q] = p.normal - q * responses[n, 0]
            responses[n, 2 + 3 * q] = p.x - q * responses[n, 2]
            responses[n, 3 + 3 * q] = p.y - q * responses[n, 3]
            responses[n, 4 + 3 * q] = p.x * x + p.y * y - q * responses[n, 4]


@kernel_device_no_arrays
def state_of(r: FloatArray, q: float, part: Part, resting: Resting | None) -> int:
    """The state of a part at rest with a response (8,), of a face (12,), under drives sqrt(q) times as fast.

    A face rests within the limit surface, where its gauge is at most 1. It is lost where an edge lifts, too.
    """
    load, law = r[0] + q * r[1], part.law
    if load < -law.pull_off:
        return OFF
    if load > law.largest_load:
        return OVERLOADED
    limit = law.static_ratio * friction_limit(law, load)
    if resting is None:
        x, y, z = r[2] + q * r[5], r[3] + q * r[6], r[4] + q * r[7]
        limit /= part.mass
        slips = x * x + y * y + z * z > limit * limit
    else:
        b, s = resting.balance[0], resting.search[0]
        for i in range(3):
            b.load[i], s.needed[i] = r[2 * i] + q * r[2 * i + 1], r[6 + i] + q * r[9 + i]
        if resting.face.tips and least_pressure(resting.face, b) < -law.pull_off:
            return OFF
        force = s.needed[0] * s.needed[0] + s.needed[1] * s.needed[1]  # the torque only adds to its gauge
        slips = force > limit * limit or quick_gauge(part, resting.face, b, s) > 1.0
    if load < 0.0:
        return SLIPS_HANGING if slips else HANGS
    return SLIPS if slips else RESTS


@kernel_device_no_arrays
def offset(k: int) -> float:
    """Where the k-th of the points along a side is, from the square's centre, over the side."""
    return (k + 0.5) / SIDE - 0.5


@kernel_device_no_arrays
def along(responses: FloatArray, neighbours: IndexArray, n: int, k: int, axis: int) -> float:
    """By how much the k-th number of responses (n, 8) grows over a side of the n-th square."""
    before, after = neighbours[n, 2 * axis], neighbours[n, 2 * axis + 1]
    return float((responses[after, k] - responses[before, k]) / max((after != n) + (before != n), 1))


@kernel_device_no_arrays
def borne(r: FloatArray, corner: int, resting: Resting | None) -> tuple[float, float]:
    """a and b [N] of the load a + b q in a response, or of the pressure at a corner of a face times the area."""
    if resting is None:
        return r[0], r[1]
    one, two = resting.levers[corner, 0], resting.levers[corner, 1]
    return r[0] + one * r[2] + two * r[4], r[1] + one * r[3] + two * r[5]


@kernel_device_no_arrays
def borne_along(
    responses: FloatArray, neighbours: IndexArray, n: int, axis: int, corner: int, resting: Resting | None
) -> tuple[float, float]:
    """By how much they grow over a side of the n-th square."""
    before, after = neighbours[n, 2 * axis], neighbours[n, 2 * axis + 1]
    a_0, b_0 = borne(responses[before], corner, resting)
    a_1, b_1 = borne(responses[after], corner, resting)
    sides = max((after != n) + (before != n), 1)
    return (a_1 - a_0) / sides, (b_1 - b_0) / sides


@kernel
def find_held(
    responses: FloatArray, neighbours: IndexArray, part: Part, resting: Resting | None, held: FloatArray
) -> None:
    """Narrow the values of q, in `held` (n, SIDE, SIDE, 2), between which contact holds a part at rest at a point.

    responses: (n, 8) at one moment, of a face (n, 12).  neighbours: as of `Squares`.
    """
    low, corners = -part.law.pull_off, 1 if resting is None else len(resting.levers)
    for n in range(len(responses)):
        for corner in range(corners):
            high = part.law.largest_load if corner == 0 else math.inf
            a_0, b_0 = borne(responses[n], corner, resting)
            a_x, b_x = borne_along(responses, neighbours, n, 0, corner, resting)
            a_y, b_y = borne_along(responses, neighbours, n, 1, corner, resting)
            for i in range(SIDE):
                for j in range(SIDE):
                    a = a_0 + offset(i) * a_x + offset(j) * a_y
                    b = b_0 + offset(i) * b_x + offset(j) * b_y
                    if b == 0.0:
                        if not low <= a <= high:
                            held[n, i, j, 1] = -1.0
                    else:
                        first, last = (low - a) / b, (high - a) / b
                        held[n, i, j, 0] = max(held[n, i, j, 0], min(first, last))
                        held[n, i, j, 1] = min(held[n, i, j, 1], max(first, last))


@kernel
def find_states(
    responses: FloatArray, scales: FloatArray, part: Part, resting: Resting | None, states: StateArray
) -> None:
    """The states (n, F) of a part at rest at the places, at values (F,) of q."""
    for n in range(len(responses)):
        for k in range(len(scales)):
            states[n, k] = state_of(responses[n], scales[k], part, resting)


@kernel_device_no_arrays
def sample(before: FloatArray, after: FloatArray, neighbours: IndexArray, n: int, samples: FloatArray) -> None:
    """Responses at the points of a square, each in its share of the time between two moments: (SIDE, SIDE, 8 or 12)."""
    for k in range(before.shape[1]):
        a, a_x, a_y = before[n, k], along(before, neighbours, n, k, 0), along(before, neighbours, n, k, 1)
        b, b_x, b_y = after[n, k], along(after, neighbours, n, k, 0), along(after, neighbours, n, k, 1)
        for i in range(SIDE):
            for j in range(SIDE):
                share, u, v = (SAMPLES[i, j] + 0.5) / SHARES, offset(i), offset(j)
                first, second = a + u * a_x + v * a_y, b + u * b_x + v * b_y
                samples[i, j, k] = first + share * (second - first)


@kernel
def count_slips(
    before: FloatArray,
    after: FloatArray,
    neighbours: IndexArray,
    scales: FloatArray,
    part: Part,
    resting: Resting | None,
    held: FloatArray,
    lost: StateArray,
    first: StateArray,
    second: StateArray,
    counts: FloatArray,
    slips: FloatArray,
) -> None:
    """Add the shares of squares on which a part at rest slips between two moments to `counts` (2, 2, F, SHARES).

    before, after: (n, 8) responses at the moments, of a face (n, 12).  first, second: (n, F) states then.
    held: as of `find_held`.  lost: (n, F) points of each square where it comes off at some moment.
    scales: (F,) values of q.
    counts: by halves of the points, each for itself; without points where it comes off at some moment, and all.
    slips: (n,) shares of the time and the square at the last of `scales`, which are added to it.
    """
    samples = np.empty((SIDE, SIDE, before.shape[1]))
    points = SIDE * SIDE
    for n in range(len(before)):
        sampled = False
        for k in range(len(scales)):
            state, q = second[n, k], scales[k]
            alike = first[n, k] == state
            for side in range(4):
                m = neighbours[n, side]
                alike = alike and first[m, k] == state and second[m, k] == state
            if alike:
                if state in (SLIPS, SLIPS_HANGING):
                    for half in range(2):
                        for share in range(SHARES):
                            counts[half, 0, k, share] += 1.0 - lost[n, k] / points
                            counts[half, 1, k, share] += 1.0
                    slips[n] += 1.0 if k == len(scales) - 1 else 0.0
                continue
            if not sampled:
                sample(before, after, neighbours, n, samples)
                sampled = True
            for i in range(SIDE):
                for j in range(SIDE):
                    state = state_of(samples[i, j], q, part, resting)
                    if state in (SLIPS, SLIPS_HANGING):
                        half, share = HALVES[i], SAMPLES[i, j]
                        counts[half, 1, k, share] += 2.0 * SHARES / points
                        if held[n, i, j, 0] <= q <= held[n, i, j, 1]:
                            counts[half, 0, k, share] += 2.0 * SHARES / points
                        slips[n] += 1.0 / points if k == len(scales) - 1 else 0.0
