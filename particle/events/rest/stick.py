"""How long a part that rests on the surface stays: a search that can miss no break-away.

At a fixed place the surface is polynomial in time, and so are C = (N - squeeze) s / m, the square of the force along
the surface times s^2, and s^2 itself. Positive Bernstein coefficients of

    Q^2 s^2 - (m s x force along the surface)^2     with the least Q that the subinterval's loads allow,

prove that the part sticks throughout it. What is not proved is halved, the earlier half first. `stick_level` has these
polynomials. A centre of mass off the mid-plane adds to them (`stick_raised`); they are others where the mid-plane moves
in its plane (`stick_stretched`).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from particle.drives import ORDER
from particle.events.bernstein import MAX_HALVINGS, halve, to_bernstein
from particle.events.mechanics import Part
from particle.events.polynomials import narrow
from particle.events.rest.stick_level import DEGREE, fill_level, holds_level, is_safe_level
from particle.events.rest.stick_raised import DEGREE as RAISED_DEGREE
from particle.events.rest.stick_raised import X, Y, holds_raised, is_safe_raised
from particle.events.rest.stick_stretched import BOUND_DEGREE, NARROW, fill_stretched, is_safe_stretched, largest_force
from particle.events.rest.stick_stretched import DEGREE as STRETCHED_DEGREE
from particle.friction import friction_limit
from particle.jit import jit, jit_no_arrays
from particle.surface import Frame, LocalSurface, motion_at, planar_motion_at
from particle.types import FloatArray

SLACK = 1e-15  # of the largest squared force in the span
LEVEL, RAISED, STRETCHED = range(3)  # a point on the mid-plane; off it; on or off one that moves in its plane


class Rest(NamedTuple):
    """Scratch memory of the search: subintervals still to be proved, the earliest on top."""

    polynomials: FloatArray  # (MAX_HALVINGS + 2, 3, DEGREE + 1): C, squared force times s^2, s^2, in Bernstein form
    raised: FloatArray  # (MAX_HALVINGS + 2, 6, RAISED_DEGREE + 1), those of `stick_raised`
    stretched: FloatArray  # (MAX_HALVINGS + 2, 6, STRETCHED_DEGREE + 1), those of `stick_stretched`
    low: FloatArray  # (MAX_HALVINGS + 2,)
    width: FloatArray  # (MAX_HALVINGS + 2,)
    motion: FloatArray  # (3, 6), w, w_x and w_y at the place as polynomials of the share of the time
    plane: FloatArray  # (6, 6), motion in the plane and its gradient there
    part_motion: FloatArray  # (3, 6), the same over a part of the time
    part_plane: FloatArray  # (6, 6)
    bounds: FloatArray  # (6,), one of these in Bernstein form
    force: FloatArray  # (BOUND_DEGREE + 1,), of `stick_stretched`


def new_rest() -> Rest:
    return Rest(
        np.zeros((MAX_HALVINGS + 2, 3, DEGREE + 1)),
        np.zeros((MAX_HALVINGS + 2, 6, RAISED_DEGREE + 1)),
        np.zeros((MAX_HALVINGS + 2, 6, STRETCHED_DEGREE + 1)),
        np.zeros(MAX_HALVINGS + 2),
        np.zeros(MAX_HALVINGS + 2),
        np.zeros((3, ORDER)),
        np.zeros((6, ORDER)),
        np.zeros((3, ORDER)),
        np.zeros((6, ORDER)),
        np.zeros(ORDER),
        np.zeros(BOUND_DEGREE + 1),
    )


@jit
def leaves_rest(local: LocalSurface, part: Part, rest: Rest, x: float, y: float, begin: float, end: float) -> float:
    """When [s] a part at rest at (x, y) [m] first slips, comes off or is overloaded; inf when it does not.

    The search goes from `begin` to `end` [s], within the prepared span.
    """
    motion_at(local, x, y, rest.motion)
    low, width = (begin - local.frame[0].time) / local.frame[0].unit, (end - begin) / local.frame[0].unit
    for row in range(3):
        narrow(rest.motion[row], low, width)
    frame: Frame = local.frame[0]
    if frame.in_plane > 0:
        _plane(local, rest, x, y, low, width)
        return _leaves_stretched(part, rest, begin, end)
    straight = frame.base_drives == 0 and part.tilt_x == 0.0 and part.tilt_y == 0.0
    if straight and _safe_by_extremes(part, rest, end - begin):
        return math.inf
    kind = RAISED if part.centre > 0.0 else LEVEL
    polynomials = rest.raised if kind == RAISED else rest.polynomials
    fill_level(local, part, rest.motion, begin, end, polynomials[0])
    rest.low[0], rest.width[0] = 0.0, 1.0
    # What rounding leaves of the squared force where it is small: a part that is about to come off does not slip of it.
    largest = np.abs(polynomials[0, 1]).max()
    if kind == RAISED:
        z = part.centre
        largest += 2 * z * np.abs(polynomials[0, X]).max() + z * z * np.abs(polynomials[0, Y]).max()
    share = _first_slip(part, rest, kind, polynomials, SLACK * largest, 0)
    return float(begin + share * (end - begin)) if share < math.inf else math.inf


@jit
def _first_slip(part: Part, rest: Rest, kind: int, polynomials: FloatArray, slack: float, first: int) -> float:
    """The share of the time at which the part leaves rest within the subinterval `first`; inf: it does not."""
    narrowest = 0.5**MAX_HALVINGS
    top = first
    while top >= first:
        if _safe_by_bernstein(part, kind, polynomials[top - first], slack):
            top -= 1
        elif rest.width[top] <= narrowest:
            # Neither provable nor divisible: a slip if the far end says so, else the limit was only touched.
            if not _holds_at_end(part, kind, polynomials[top - first], slack):
                return float(rest.low[top] + rest.width[top])
            top -= 1
        else:
            _divide(rest, top)
            for row in range(polynomials.shape[1]):
                halve(polynomials[top - first, row], polynomials[top - first + 1, row])
            top += 1
    return math.inf


@jit_no_arrays
def _divide(rest: Rest, top: int) -> None:
    """The subinterval on top in two, the earlier one on top of the other."""
    half = 0.5 * rest.width[top]
    rest.low[top + 1] = rest.low[top]
    rest.low[top] += half
    rest.width[top] = rest.width[top + 1] = half


@jit
def _leaves_stretched(part: Part, rest: Rest, begin: float, end: float) -> float:
    """When [s] the part leaves rest where it moves in its plane, as rest.motion and rest.plane have it."""
    slack = SLACK * largest_force(part, rest.motion, rest.plane, end - begin, rest.force) ** 2
    rest.low[0], rest.width[0], top = 0.0, 1.0, 0
    while top >= 0:
        low, width = rest.low[top], rest.width[top]
        lasting = width * (end - begin)
        rest.part_motion[:], rest.part_plane[:] = rest.motion, rest.plane
        for row in range(3):
            narrow(rest.part_motion[row], low, width)
        for row in range(6):
            narrow(rest.part_plane[row], low, width)
        if is_safe_stretched(part, rest.part_motion, rest.part_plane, lasting, rest.bounds, rest.force):
            top -= 1
        elif width > NARROW:
            _divide(rest, top)
            top += 1
        else:
            fill_stretched(part, rest.part_motion, rest.part_plane, lasting, rest.stretched[0])
            share = _first_slip(part, rest, STRETCHED, rest.stretched, slack, top)
            if share < math.inf:
                return float(begin + share * (end - begin))
            top -= 1
    return math.inf


@jit_no_arrays
def _plane(local: LocalSurface, rest: Rest, x: float, y: float, low: float, width: float) -> None:
    """The motion in the plane, the base's included, and its gradient into rest.plane."""
    planar_motion_at(local, x, y, rest.plane)
    for k in range(ORDER):
        rest.plane[0, k] += local.base[k, 0]
        rest.plane[3, k] += local.base[k, 1]
    for row in range(6):
        narrow(rest.plane[row], low, width)


@jit_no_arrays
def _safe_by_extremes(part: Part, rest: Rest, lasting: float) -> bool:
    """Whether the largest slope and the extreme accelerations of `lasting` [s] together leave the part at rest.

    This costs little and settles most cases, with the base at rest and no tilt.
    """
    square = 0.0
    for row in (1, 2):
        to_bernstein(rest.motion[row], rest.bounds)
        steepest = 0.0
        for k in range(ORDER):
            steepest = max(steepest, abs(rest.bounds[k]))
        square += steepest * steepest
    # The second derivative of a quintic has the second differences of its Bernstein coefficients.
    to_bernstein(rest.motion[0], rest.bounds)
    b, factor = rest.bounds, 20.0 / (lasting * lasting)
    least, most = math.inf, -math.inf
    for k in range(ORDER - 2):
        bend = factor * (b[k] - 2 * b[k + 1] + b[k + 2])
        least, most = min(least, part.gravity + bend), max(most, part.gravity + bend)
    s = math.sqrt(1.0 + square)
    if part.centre > 0.0:
        # |n'| is at most |grad w_t|, and n'' along the surface at most |grad w_tt| + 2 |grad w_t|^2.
        turn = bend = 0.0
        for row in (1, 2):
            to_bernstein(rest.motion[row], b)
            fastest = sharpest = 0.0
            for k in range(ORDER - 1):
                fastest = max(fastest, abs(b[k + 1] - b[k]))
            for k in range(ORDER - 2):
                sharpest = max(sharpest, abs(b[k] - 2 * b[k + 1] + b[k + 2]))
            turn, bend = turn + (5 * fastest / lasting) ** 2, bend + (factor * sharpest) ** 2
        shift, less = part.centre * (math.sqrt(bend) + 2 * turn), part.centre * turn
        load_low = part.mass * ((least / s if least > 0 else least) - less) + part.squeeze
        load_high = part.mass * (most if most > 0 else most / s) + part.squeeze
        if load_low < -part.law.pull_off or load_high > part.law.largest_load:
            return False
        limit = part.law.static_ratio * friction_limit(part.law, load_low) / part.mass
        return max(abs(least), abs(most)) * math.sqrt(square) + shift <= limit
    load_low = part.mass * (least / s if least > 0 else least) + part.squeeze
    load_high = part.mass * (most if most > 0 else most / s) + part.squeeze
    if load_low < -part.law.pull_off or load_high > part.law.largest_load:
        return False
    limit = part.law.static_ratio * friction_limit(part.law, load_low) / part.mass
    return max(least * least, most * most) * square <= limit * limit


@jit_no_arrays
def _holds_at_end(part: Part, kind: int, rest: FloatArray, slack: float) -> bool:
    """Whether the part stays at the end of a subinterval."""
    return holds_level(part, rest, slack) if kind == LEVEL else holds_raised(part, rest, slack)


@jit
def _safe_by_bernstein(part: Part, kind: int, rest: FloatArray, slack: float) -> bool:
    """Whether the Bernstein coefficients of a subinterval prove that the part stays."""
    if kind == LEVEL:
        return is_safe_level(part, rest, slack)
    # Where the mid-plane keeps its area, s is at least 1.
    return rest[2].min() > 0.0 and is_safe_raised(part, rest, slack, 0.0 if kind == STRETCHED else 1.0)
