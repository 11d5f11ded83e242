"""How long a part that rests on the surface stays: a search that can miss no break-away.

At a fixed place the surface is polynomial in time, and so is what friction must resist. `stick_bound` proves that the
part stays over a subinterval, or else, once that is narrow, the Bernstein coefficients of `stick_margin` do. A
subinterval without a proof is divided, the earlier part first: in halves, or next to where the part slips.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from particle.drives import ORDER, copy_rows
from particle.events.mechanics import Part
from particle.events.polynomials import MAX_HALVINGS, divide, narrow
from particle.events.rest.stick_bound import DEGREE as BOUND_DEGREE
from particle.events.rest.stick_bound import is_safe_by_bound, largest_force
from particle.events.rest.stick_margin import (
    DEGREE,
    NARROW,
    best_division,
    fill_margin,
    holds_at_end,
    is_safe_by_margin,
)
from particle.events.rest.stick_search import leaves_rest_by_search
from particle.friction import LOCAL
from particle.group import grouped
from particle.jit import device_no_arrays, inlined
from particle.surface import LocalSurface, motion_at
from particle.types import FloatArray

MOST_DIVISIONS = 16  # next to a slip, in a span; then there are halvings alone
ROOM = MAX_HALVINGS + MOST_DIVISIONS + 2  # subintervals
SLACK = 1e-15  # of the largest squared force in the span


@grouped
class Rest(NamedTuple):
    """Scratch memory of the search: subintervals still to be proved, the earliest on top."""

    low: FloatArray  # (ROOM,)
    width: FloatArray  # (ROOM,)
    margins: FloatArray  # (ROOM, 2, DEGREE + 1), of `stick_margin`, from the narrow subinterval on
    motion: FloatArray  # (6, 6), w at the place, w_x, w_y, w_xx, w_xy, w_yy, as polynomials of the share of the time
    plane: FloatArray  # (2, 6, 6), the same of u + base along x and along y
    part_motion: FloatArray  # (6, 6), these over a part of the time
    part_plane: FloatArray  # (2, 6, 6)
    quintic: FloatArray  # (6,), one of these in Bernstein form
    force: FloatArray  # (BOUND_DEGREE + 1,), of `stick_bound`


def new_rest() -> Rest:
    return Rest(
        np.zeros(ROOM),
        np.zeros(ROOM),
        np.zeros((ROOM, 2, DEGREE + 1)),
        np.zeros((6, ORDER)),
        np.zeros((2, 6, ORDER)),
        np.zeros((6, ORDER)),
        np.zeros((2, 6, ORDER)),
        np.zeros(ORDER),
        np.zeros(BOUND_DEGREE + 1),
    )


@inlined
def leaves_rest(local: LocalSurface, part: Part, rest: Rest, x: float, y: float, begin: float, end: float) -> float:
    """When [s] a part at rest at (x, y) [m] first slips, comes off or is overloaded; inf when it does not.

    The search goes from `begin` to `end` [s], within the prepared span.
    """
    if part.law.kind == LOCAL:
        return leaves_rest_by_search(local, part, x, y, begin, end)
    unit, lasting = local.frame[0].unit, end - begin
    motion_at(local, x, y, rest.motion, rest.plane)
    _narrow(rest.motion, rest.plane, (begin - local.frame[0].time) / unit, lasting / unit)
    # What rounding leaves of the squared force where it is small: a part that is about to come off does not slip of it.
    slack = SLACK * largest_force(part, rest.motion, rest.plane, lasting, rest.force) ** 2
    rest.low[0], rest.width[0] = 0.0, 1.0
    top, first, divisions = 0, -1, 0  # first: the narrow subinterval that those above it on the stack are shares of
    while top >= 0:
        width = rest.width[top]
        proved = False
        if first < 0 or top < first:
            first = -1
            copy_rows(rest.motion, rest.part_motion)
            for i in range(len(rest.plane)):
                copy_rows(rest.plane[i], rest.part_plane[i])
            _narrow(rest.part_motion, rest.part_plane, rest.low[top], width)
            seconds = width * lasting
            proved = is_safe_by_bound(part, rest.part_motion, rest.part_plane, seconds, rest.quintic, rest.force)
            if not proved and width <= NARROW:
                fill_margin(part, rest.part_motion, rest.part_plane, seconds, rest.margins[0])
                first = top
        if first >= 0:
            margin = rest.margins[top - first]
            proved = is_safe_by_margin(part, margin, slack)
            if not proved and width <= 0.5**MAX_HALVINGS:
                # Neither provable nor divisible: a slip if the far end says so, else the limit was only touched.
                if not holds_at_end(part, margin, slack):
                    return float(begin + (rest.low[top] + width) * lasting)
                proved = True
        if proved:
            top -= 1
            continue
        share = 0.5
        if first >= 0 and divisions < MOST_DIVISIONS:
            share = best_division(part, rest.margins[top - first], slack)
            divisions += share != 0.5
        rest.low[top + 1], rest.low[top] = rest.low[top], rest.low[top] + share * width
        rest.width[top], rest.width[top + 1] = (1.0 - share) * width, share * width
        if first >= 0:
            for row in range(rest.margins.shape[1]):
                divide(rest.margins[top - first, row], rest.margins[top - first + 1, row], share)
        top += 1
    return math.inf


@device_no_arrays
def _narrow(motion: FloatArray, plane: FloatArray, low: float, width: float) -> None:
    """Polynomials of s on [low, low + width] as ones of the share of it, in place."""
    for row in range(motion.shape[0]):
        narrow(motion[row], low, width)
        narrow(plane[0, row], low, width)
        narrow(plane[1, row], low, width)
